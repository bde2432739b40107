// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/text_file.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>

#include <sinew/settings/table.h>

namespace sinew {

namespace {

constexpr auto end_of_text = std::string_view::npos;

unsigned char byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

bool continues(unsigned char byte) { return (byte & 0xC0) == 0x80; }

/// Bytes of the UTF-8 character at `i`, 0 when there is none (RFC 3629, table 3).
std::size_t utf8_length(std::string_view text, std::size_t i) {
  const unsigned char first = byte_at(text, i), second = byte_at(text, i + 1);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (length == 0 || first > 0xF4 || !continues(second)) return 0;
  if (first == 0xE0 && second < 0xA0) return 0;  // longer than needed
  if (first == 0xED && second > 0x9F) return 0;  // half of a surrogate pair
  if (first == 0xF0 && second < 0x90) return 0;
  if (first == 0xF4 && second > 0x8F) return 0;  // above U+10FFFF
  for (std::size_t k = 2; k < length; ++k)
    if (!continues(byte_at(text, i + k))) return 0;
  return length;
}

std::size_t first_non_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) return i;
    i += length;
  }
  return end_of_text;
}

std::size_t first_control(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char c = byte_at(text, i);
    if ((c < 0x20 && c != '\n' && c != '\r' && c != '\t') || c == 0x7F) return i;
  }
  return end_of_text;
}

std::size_t first_indenting_tab(std::string_view text) {
  for (std::size_t line = 0; line < text.size();) {
    const std::size_t shape = text.find_first_not_of(' ', line);
    if (shape != end_of_text && text[shape] == '\t') return shape;
    const std::size_t end = text.find('\n', line);
    line = end == end_of_text ? text.size() : end + 1;
  }
  return end_of_text;
}

std::string reason() { return std::generic_category().message(errno); }

}  // namespace

std::string read_text(const std::filesystem::path& path) {
  const Place file = {path.string()};
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw bad_input(file, "this is a folder, not a scene", "name the scene's .yaml file in it");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw bad_input(file, "cannot be read (" + reason() + ")", "check the path of the scene");
  std::string text;
  std::array<char, 1 << 14> piece;
  while (text.size() <= longest_scene && in) {  // the size of a pipe is not known beforehand
    in.read(piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) throw bad_input(file, "cannot be read (" + reason() + ")", "check the disk");
  if (text.size() > longest_scene)
    throw bad_input(file, "is larger than 64 MiB",
                    "a scene is a short text; is this the right file?");
  return text;
}

void check_text(std::string_view text, const std::string& file) {
  const auto refuse = [&](std::size_t at, const char* what, const char* cure) {
    if (at != end_of_text) throw bad_input(place_of(text, at, file), what, cure);
  };
  refuse(first_control(text), "a control character, so this is no text",
         "name a scene, or remove the character");
  refuse(first_non_utf8(text), "this is not UTF-8 text", "save the scene as UTF-8");
  refuse(first_indenting_tab(text), "a tab in the indentation", "indent with spaces");
}

Place place_of(std::string_view text, std::size_t offset, const std::string& file) {
  Place place = {file, 1, 1};
  for (std::size_t i = 0; i < offset && i < text.size(); ++i) {
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    } else if (!continues(byte_at(text, i))) {
      ++place.column;
    }
  }
  return place;
}

std::size_t offset_of(std::string_view text, const Place& place) {
  Place here = {"", 1, 1};
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (here.line == place.line && here.column == place.column && !continues(byte_at(text, i)))
      return i;
    if (text[i] == '\n') {
      ++here.line;
      here.column = 1;
    } else if (!continues(byte_at(text, i))) {
      ++here.column;
    }
  }
  return text.size();
}

}  // namespace sinew

namespace fs = std::filesystem;

namespace sinew {

fs::path seen_from(const fs::path& folder, const fs::path& path) {
  const fs::path here = ".";
  std::error_code error;
  const fs::path route = fs::proximate(here / path.parent_path(), here / folder, error);
  if (error) return path;
  return route == here ? path.filename() : route / path.filename();
}

std::string path_in(const fs::path& folder, const std::string& path) {
  return path.empty() || fs::path(path).is_absolute() ? path : seen_from(folder, path).string();
}

std::vector<std::string> files_of(const Settings& settings) {
  std::vector<std::string> files;
  for (const auto& row : settings_table()) {
    if (row.kind != FieldKind::path) continue;
    const FieldValue value = row.get(settings);
    if (const auto* path = std::get_if<std::string>(&value)) files.push_back(*path);
  }
  for (const PartOptions& part : settings.bodies) files.push_back(part.body.mesh);
  for (const LocalMaterialSettings& one : settings.materials) files.push_back(one.part.mesh);
  for (const ObstacleSettings& obstacle : settings.world.obstacles) files.push_back(obstacle.mesh);
  return files;
}

void open_paths_from_here(Settings& settings, const fs::path& folder) {
  const std::string scene = settings.place("").file;
  for (const auto& row : settings_table()) {
    if (row.kind != FieldKind::path) continue;
    const std::string name = std::string(row.section) + '.' + std::string(row.name);
    const FieldValue value = row.get(settings);
    const auto* path = std::get_if<std::string>(&value);
    if (path == nullptr || settings.place(name).file != scene || fs::path(*path).is_absolute())
      continue;
    row.set(settings, seen_from("", folder / *path).string());
  }
  const auto open = [&](std::string& mesh) {
    if (!mesh.empty() && !fs::path(mesh).is_absolute())
      mesh = seen_from("", folder / mesh).string();
  };
  for (PartOptions& part : settings.bodies) open(part.body.mesh);
  for (LocalMaterialSettings& material : settings.materials) open(material.part.mesh);
  for (ObstacleSettings& obstacle : settings.world.obstacles) open(obstacle.mesh);
}

}  // namespace sinew
