// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/mesh_formats.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <sinew/core/text.h>
#include <sinew/mesh/detail/readers/mesh_readers.h>

namespace sinew {
namespace {

std::string first_word(std::string_view content) {
  return lower(Words(content.substr(0, 100)).next());
}

bool begins_off(std::string_view content) {
  return is_off_keyword(Words(content.substr(0, 100)).next());
}

/// Binary files may begin with "solid" as well.
bool begins_stl(std::string_view content) {
  return first_word(content) == "solid" &&
         lower(content.substr(0, 500)).find("facet") != std::string::npos;
}

bool begins_ply(std::string_view content) { return first_word(content) == "ply"; }

template <PolygonSoup (*Reader)(const MeshFile&)>
PolygonSoup read_whole(const std::string& path);

constexpr std::array<MeshFormat, 4> formats = {{
    {"OBJ", ".obj", read_whole<read_obj>},
    {"OFF", ".off", read_whole<read_off>, begins_off},
    {"STL", ".stl", read_whole<read_stl>, begins_stl},
    {"PLY", ".ply", read_whole<read_ply>, begins_ply},
}};

std::string extension_of(const std::string& path) {
  return lower(std::filesystem::path(path).extension().string());
}

void check_content(const MeshFile& file) {
  const auto* seen = std::find_if(formats.begin(), formats.end(), [&](const MeshFormat& format) {
    return format.recognizes != nullptr && format.recognizes(file.content);
  });
  if (seen == formats.end() || seen->extension == extension_of(file.path)) return;
  const std::string extension(seen->extension);
  throw bad_input({file.path},
                  "the extension is not the content's: this is a " + extension.substr(1) + " file",
                  "rename it to " + extension);
}

template <PolygonSoup (*Reader)(const MeshFile&)>
PolygonSoup read_whole(const std::string& path) {
  const MeshFile file = open_mesh(path);
  check_content(file);
  return Reader(file);
}

std::vector<MeshFormat> with(std::span<const MeshFormat> more) {
  std::vector<MeshFormat> all(formats.begin(), formats.end());
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

const MeshFormat* format_of(const std::string& path, const std::vector<MeshFormat>& all) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const MeshFormat& format) {
    return format.extension == extension_of(path);
  });
  return found == all.end() ? nullptr : &*found;
}

Error unknown_format(const std::string& path, const std::vector<MeshFormat>& all) {
  const std::string extension = extension_of(path);
  std::string cure = "give an ";
  for (const MeshFormat& format : all) {
    if (&format != &all.front()) cure += &format == &all.back() ? " or " : ", ";
    cure += format.extension;
  }
  return bad_input({path},
                   "a mesh cannot be a " + (extension.size() < 2 ? "file without extension"
                                                                 : "'" + extension + "' file"),
                   cure + " file");
}

}  // namespace

std::string mesh_format_names(std::span<const MeshFormat> more) {
  std::vector<std::string_view> names;
  for (const MeshFormat& format : with(more)) names.push_back(format.name);
  return listed(names);
}

bool names_mesh(const std::string& path, std::span<const MeshFormat> more) {
  return format_of(path, with(more)) != nullptr;
}

PolygonSoup read_polygons(const std::string& path, std::span<const MeshFormat> more,
                          std::optional<double> level) {
  const std::vector<MeshFormat> all = with(more);
  const MeshFormat* format = format_of(path, all);
  if (format != nullptr && !level) return format->read(path);
  check_mesh_file(path);  // first check that the file exists
  if (format == nullptr) throw unknown_format(path, all);
  if (format->read_level == nullptr)
    throw bad_input({path}, "it holds no image, which a level needs", "leave out body.level");
  return format->read_level(path, *level);
}

PolygonSoup read_obj_look(const std::string& path, PolygonLook& look) {
  return read_obj(open_mesh(path), look);
}

std::vector<SurfaceLook::Material> read_materials(const std::string& path) {
  return read_mtl(path);
}

std::string ply_text(const PolygonSoup& soup) {
  static_assert(std::endian::native == std::endian::little);
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(soup.points.size()) +
                     "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                     std::to_string(soup.polygons.size()) +
                     "\nproperty list uint int vertex_indices\nend_header\n";
  const auto append = [&](const void* from, std::size_t bytes) {
    text.append(static_cast<const char*>(from), bytes);
  };
  for (const Vec3& point : soup.points) append(point.data(), 3 * sizeof(double));
  for (const std::vector<int>& polygon : soup.polygons) {
    const auto corners = static_cast<std::uint32_t>(polygon.size());
    append(&corners, sizeof corners);
    append(polygon.data(), corners * sizeof(int));
  }
  return text;
}

}  // namespace sinew
