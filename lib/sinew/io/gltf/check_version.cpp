// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <string_view>

#include <sinew/core/text.h>
#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

/// What is drawn onto a shape, or lights it, leaves the shape alone.
bool leaves_shapes(std::string_view extension) {
  constexpr std::array<std::string_view, 8> harmless = {
      "KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
      "KHR_lights_",    "EXT_lights_",  "KHR_xmp",      "KHR_animation_pointer"};
  return std::any_of(harmless.begin(), harmless.end(),
                     [&](std::string_view start) { return extension.starts_with(start); });
}

std::string cure_for(std::string_view extension) {
  const auto names = [&](const char* part) { return extension.find(part) != extension.npos; };
  if (names("draco") || names("meshopt")) return "export without mesh compression";
  if (names("quantization")) return "export without quantization";
  if (names("instancing")) return "export without instancing";
  return "export without it";
}

}  // namespace

void check_gltf_version(const GltfDocument& document) {
  const auto is_2 = [](std::string_view version) { return version.starts_with("2."); };
  if (!is_2(document.version) || document.least_version > "2.0")
    throw bad_input("it is of glTF version " +
                        shown(is_2(document.version) ? document.least_version : document.version),
                    "export it as glTF 2.0");
  for (const std::string& extension : document.extensions_required)
    if (!leaves_shapes(extension))
      throw bad_input("it needs the extension " + shown(extension), cure_for(extension));
}

}  // namespace sinew
