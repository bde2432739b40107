// SPDX-License-Identifier: GPL-3.0-or-later
// The two forms of glTF files, plain JSON and GLB, which contains JSON and binary data; and the
// bytes of their buffers.
//
//     const GltfContainer container = gltf_container(read_gltf_file(path), path.extension());
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

/// The bytes of a file; of one that does not begin as glTF does only the first, which show why.
/// Throws bad input, with the path, where it cannot be read or a GLB has another length than its
/// header says.
std::string read_gltf_file(const std::filesystem::path& path);

/// The content of a file of that extension (".gltf", ".glb", ".vrm", in any case). Throws bad input
/// (without the path) where it is neither, is truncated, or has the other's extension.
GltfContainer gltf_container(std::string file, const std::filesystem::path& extension);

/// The file that a URI names in `folder` or below. Throws bad input (without the path), as of a
/// buffer, for places elsewhere.
std::filesystem::path gltf_file_of(const std::string& uri, const std::filesystem::path& folder);

/// All buffers concatenated, each of its declared length. `binary` is the GLB's chunk, `folder`
/// that of the glTF file: buffers in files must lie there or below. Throws bad input (without the
/// path) for buffers that are missing (of fallbacks without data the length becomes 0), too short,
/// or too long in total.
std::vector<char> gltf_bytes(std::vector<GltfBuffer>& buffers,
                             const std::optional<std::string>& binary,
                             const std::filesystem::path& folder);

}  // namespace sinew
