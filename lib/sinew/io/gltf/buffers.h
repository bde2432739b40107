// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes that a glTF file's buffers stand for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sinew/io/gltf/document.h>

namespace sinew {

/// All buffers one after the other, each as long as it says. `binary` is the GLB's chunk, `folder`
/// where the glTF file lies: buffers in files are looked for there and below, nowhere else. Throws
/// bad input (without the path) for what is missing, too short, or too long in all.
std::vector<char> gltf_bytes(const std::vector<GltfBuffer>& buffers,
                             const std::optional<std::string>& binary,
                             const std::filesystem::path& folder);

}  // namespace sinew
