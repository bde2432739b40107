// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <sinew/core/file.h>
#include <sinew/mesh/detail/readers/mesh_readers.h>

namespace sinew {
namespace {

/// The rest of a line after its keyword, without the spaces around it.
std::string rest_of(std::string_view line, std::string_view keyword) {
  line.remove_prefix(line.find(keyword) + keyword.size());
  while (!line.empty() && static_cast<unsigned char>(line.back()) <= ' ') line.remove_suffix(1);
  while (!line.empty() && static_cast<unsigned char>(line.front()) <= ' ') line.remove_prefix(1);
  return std::string(line);
}

/// The file of a texture in the folder or below, which options may precede: of these only the last
/// word is taken.
std::string image_in(std::string text, const std::filesystem::path& folder) {
  if (text.starts_with('-')) text.erase(0, text.find_last_of(" \t") + 1);
  std::replace(text.begin(), text.end(), '\\', '/');
  return file_below(folder, text).string();
}

/// Between 0 and 1; `other` where it is no number.
double fraction_in(Words& words, double other) {
  const double number = number_in(words.next()).value_or(other);
  return std::isfinite(number) ? std::clamp(number, 0.0, 1.0) : other;
}

void take_line(std::string_view line, const std::filesystem::path& folder,
               SurfaceLook::Material& material) {
  Words words(line);
  const std::string_view keyword = words.next();
  if (keyword == "Kd")
    for (double& part : material.color) part = fraction_in(words, part);
  if (keyword == "d") material.opacity = fraction_in(words, 1);
  if (keyword == "Tr") material.opacity = 1 - fraction_in(words, 0);
  if (keyword == "map_Kd") material.image = image_in(rest_of(line, keyword), folder);
}

std::string text_of(const std::string& path) {
  try {
    return read_file(path);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

std::vector<SurfaceLook::Material> read_mtl(const std::string& path) {
  const std::string text = text_of(path);
  const auto folder = std::filesystem::path(path).parent_path();
  std::vector<SurfaceLook::Material> materials;
  for (Lines lines(text); lines.next();) {
    if (Words(lines.line()).next() == "newmtl") {
      materials.emplace_back();
      materials.back().name = rest_of(lines.line(), "newmtl");
    } else if (!materials.empty()) {
      take_line(lines.line(), folder, materials.back());
    }
  }
  return materials;
}

}  // namespace sinew
