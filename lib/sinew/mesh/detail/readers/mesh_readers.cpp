// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/detail/readers/mesh_readers.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include <sinew/core/system.h>
#include <sinew/core/text.h>

namespace sinew {

namespace {

// Reading, cleaning and the search tree need several times the file's size.
constexpr double memory_per_byte = 8;

std::size_t size_of(const std::string& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status))
    throw bad_input({path}, "there is no such file", "check the mesh's path");
  if (!std::filesystem::is_regular_file(status))
    throw bad_input({path}, "this is a folder or device, not a file", "give the mesh file itself");
  const auto size = std::filesystem::file_size(path, failure);
  if (failure) throw bad_input({path}, failure.message(), "check the mesh's path");
  if (size == 0) throw bad_input({path}, "the file is empty", "export the mesh again");
  if (static_cast<double>(size) * memory_per_byte > available_memory())
    throw bad_input({path}, "the mesh has " + std::to_string(size) + " bytes, too many for memory",
                    "reduce its number of triangles");
  return size;
}

}  // namespace

Error MeshFile::broken(int line, const std::string& what, const std::string& cure) const {
  return bad_input(Place{path, line}, what, cure);
}

void check_mesh_file(const std::string& path) { size_of(path); }

MeshFile open_mesh(const std::string& path) {
  MeshFile file{path, std::string(size_of(path), '\0')};
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw bad_input({path}, std::string("the file cannot be opened: ") + std::strerror(errno),
                    "check its permissions");
  in.read(file.content.data(), static_cast<std::streamsize>(file.content.size()));
  if (static_cast<std::size_t>(in.gcount()) != file.content.size())
    throw bad_input({path}, "the file could not be read to its end", "check the disk, try again");
  if (file.content.starts_with("\xEF\xBB\xBF")) file.content.erase(0, 3);  // byte order mark
  // Lines of old Macs end in '\r' alone.
  if (file.content.find_first_of(std::string_view("\n\0", 2)) == std::string::npos)
    std::replace(file.content.begin(), file.content.end(), '\r', '\n');
  return file;
}

Vec3 next_point(Words& words, const MeshFile& file) {
  Vec3 point;
  for (double& coordinate : point) {
    const std::string_view word = words.next();
    const auto number = number_in(word);
    if (!number || !std::isfinite(*number))
      throw file.broken(words.line(),
                        word.empty() ? "the vertex has fewer than 3 coordinates"
                                     : "the coordinate " + shown(word) + " is not a finite number",
                        "correct the line or export the mesh again");
    coordinate = *number;
  }
  return point;
}

void refuse_too_many_points(const MeshFile& file, std::size_t points) {
  if (points <= std::numeric_limits<int>::max()) return;
  throw file.broken(0, "there are " + std::to_string(points) + " points, more than 2147483647",
                    "reduce the number of triangles");
}

void tell_of_left_out(const MeshFile& file, std::size_t faces, PolygonSoup& soup) {
  if (faces == 0) return;
  const std::string told = std::to_string(faces) + (faces == 1 ? " face has" : " faces have") +
                           " fewer than three corners";
  if (!soup.warning.empty())  // counts that are wrong make such faces of other rows
    throw file.broken(0, told + ", and " + soup.warning, "export the mesh again");
  if (soup.polygons.empty())
    throw file.broken(0, "there are no faces but " + told, "export the mesh again with its faces");
  soup.warning = told + ": left out";
}

}  // namespace sinew
