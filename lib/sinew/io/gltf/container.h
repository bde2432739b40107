// SPDX-License-Identifier: GPL-3.0-or-later
// The two shapes of glTF files: plain JSON, and GLB, which packs JSON and binary data together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace sinew {

/// VTK counts bytes in Int32.
inline constexpr std::int64_t most_gltf_bytes = 2147483647;

struct GltfContainer {
  std::string json;
  std::optional<std::string> binary;  ///< the binary chunk of a GLB
};

/// What a file of that extension (".gltf", ".glb", in any case) holds. Throws bad input (without
/// the path) when it is neither, is cut short, or is the one under the other's name.
GltfContainer gltf_container(std::string file, const std::filesystem::path& extension);

}  // namespace sinew
