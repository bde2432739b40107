// SPDX-License-Identifier: GPL-3.0-or-later
// The two shapes of glTF files, plain JSON and GLB, which packs JSON and binary data together; and
// the bytes that their buffers stand for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sinew/io/gltf/document.h>

namespace sinew {

struct GltfContainer {
  std::string json;
  std::optional<std::string> binary;  ///< the binary chunk of a GLB
};

/// What a file of that extension (".gltf", ".glb", in any case) holds. Throws bad input (without
/// the path) when it is neither, is cut short, or is the one under the other's name.
GltfContainer gltf_container(std::string file, const std::filesystem::path& extension);

/// All buffers one after the other, each as long as it says. `binary` is the GLB's chunk, `folder`
/// where the glTF file lies: buffers in files are looked for there and below, nowhere else. Throws
/// bad input (without the path) for what is missing, too short, or too long in all.
std::vector<char> gltf_bytes(const std::vector<GltfBuffer>& buffers,
                             const std::optional<std::string>& binary,
                             const std::filesystem::path& folder);

}  // namespace sinew
