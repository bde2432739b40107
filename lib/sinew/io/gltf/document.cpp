// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/document.h>

#include <algorithm>
#include <array>
#include <utility>

namespace sinew {

int size_of(GltfNumber number) {
  switch (number) {
    case GltfNumber::int8:
    case GltfNumber::uint8:
      return 1;
    case GltfNumber::int16:
    case GltfNumber::uint16:
      return 2;
    default:
      return 4;
  }
}

int components_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, int>, 7> types = {{{"SCALAR", 1},
                                                                      {"VEC2", 2},
                                                                      {"VEC3", 3},
                                                                      {"VEC4", 4},
                                                                      {"MAT2", 4},
                                                                      {"MAT3", 9},
                                                                      {"MAT4", 16}}};
  const auto* found = std::find_if(types.begin(), types.end(),
                                   [&](const auto& known) { return known.first == type; });
  return found == types.end() ? 0 : found->second;
}

}  // namespace sinew
