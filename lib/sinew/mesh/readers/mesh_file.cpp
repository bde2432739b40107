// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/readers/mesh_file.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/mesh/readers/mesh_text.h>

namespace sinew {
namespace {

constexpr std::array<std::string_view, 4> names = {"obj", "off", "stl", "ply"};  // as in MeshFormat

// Reading, cleaning and the search tree need several times the file's size.
constexpr double memory_per_byte = 8;

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  return extension.empty() ? extension : lower(extension.substr(1));
}

MeshFormat format_of(const std::string& path) {
  const std::string extension = extension_of(path);
  const auto* found = std::find(names.begin(), names.end(), extension);
  if (found == names.end())
    throw bad_input({path},
                    "a mesh cannot be a " + (extension.empty() ? "file without extension"
                                                               : "'." + extension + "' file"),
                    "give an .obj, .off, .stl, .ply, .gltf or .glb file");
  return static_cast<MeshFormat>(found - names.begin());
}

/// The format that the first word gives away, if it does.
std::optional<MeshFormat> format_seen(std::string_view content) {
  const std::string word = lower(Words(content.substr(0, 100)).next());
  if (word == "ply") return MeshFormat::ply;
  if (word == "off" || word == "coff" || word == "noff" || word == "cnoff") return MeshFormat::off;
  if (word == "solid" && lower(content.substr(0, 500)).find("facet") != std::string::npos)
    return MeshFormat::stl;
  return std::nullopt;
}

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

MeshFile open_mesh(const std::string& path) {
  const std::size_t size = size_of(path);  // first: whether there is a file at all
  MeshFile file{path, format_of(path), std::string(size, '\0')};
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw bad_input({path}, std::string("the file cannot be opened: ") + std::strerror(errno),
                    "check its permissions");
  in.read(file.content.data(), static_cast<std::streamsize>(file.content.size()));
  if (static_cast<std::size_t>(in.gcount()) != file.content.size())
    throw bad_input({path}, "the file could not be read to its end", "check the disk, try again");
  if (file.content.starts_with("\xEF\xBB\xBF")) file.content.erase(0, 3);  // byte order mark
  const auto seen = format_seen(file.content);
  if (seen && *seen != file.format) {
    const std::string name(names[static_cast<std::size_t>(*seen)]);
    throw bad_input({path}, "the extension is not the content's: this is a " + name + " file",
                    "rename it to ." + name);
  }
  return file;
}

}  // namespace sinew
