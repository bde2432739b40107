// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/detail/vtk_xml.h>

#include <algorithm>
#include <limits>
#include <map>

#include <sinew/core/file.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::string_view appended_path = "VTKFile/AppendedData";

constexpr std::size_t bytes_of_start = 4096;  // bytes that have the first tag

}  // namespace

void check_start_of_xml(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark
  if (!text.starts_with('<') || text.substr(0, bytes_of_start).find("<VTKFile") == text.npos)
    throw vtu_refused("it is not a VTK XML file");
}

namespace {

void check_end(std::string_view text) {
  // An interrupted writer leaves a file without its last tag.
  if (!text.substr(0, text.find_last_not_of(" \t\r\n") + 1).ends_with("</VTKFile>"))
    throw vtu_refused("it is cut short");
}

void check_root(const XmlElement& root) {
  if (root.path != "VTKFile") throw vtu_refused("it is not a VTK XML file");
  if (root.attribute("byte_order") == "BigEndian")
    throw vtu_refused("it is of a big-endian machine");
}

Coding coding_of(const XmlElement& root) {
  const auto compressor = root.attribute("compressor");
  const auto header = root.attribute("header_type");
  Coding coding;
  coding.word = header == "UInt64" ? 8 : 4;
  if (!header.empty() && header != "UInt64" && header != "UInt32")
    throw vtu_refused("its header_type is " + quoted(header));
  if (compressor.empty())
    coding.encoding = Encoding::none;
  else if (compressor == "vtkZLibDataCompressor")
    coding.encoding = Encoding::zlib;
  else if (compressor == "vtkLZ4DataCompressor")
    coding.encoding = Encoding::lz4;
  else
    throw vtu_refused("it is compressed by " + quoted(compressor) + ", not by ZLib or LZ4");
  return coding;
}

}  // namespace

const XmlElement& VtkXmlFile::grid() const {
  const std::string path = "VTKFile/" + type;
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const XmlElement& one) { return one.path == path; });
  if (found == elements.end()) throw vtu_refused("it has no element " + shown(type));
  return *found;
}

std::vector<std::span<const XmlElement>> VtkXmlFile::pieces() const {
  const std::string path = "VTKFile/" + type + "/Piece", within = path + '/';
  std::vector<std::span<const XmlElement>> found;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (elements[i].path != path) continue;
    std::size_t end = i + 1;
    while (end < elements.size() && elements[end].path.starts_with(within)) ++end;
    found.emplace_back(&elements[i], end - i);
  }
  return found;
}

std::vector<const XmlElement*> VtkXmlFile::arrays_in(std::span<const XmlElement> piece,
                                                     const std::string& group) const {
  const std::string path = "VTKFile/" + type + '/' + group;
  std::vector<const XmlElement*> found;
  for (const XmlElement& element : piece)
    if (element.path == path + "/DataArray" || element.path == path + "/Array")
      found.push_back(&element);
  return found;
}

namespace {

/// Arrays are read one by one: data of which there are few bytes would be read again and again.
void check_shared(const std::vector<XmlElement>& elements) {
  constexpr int max_shared = 16;
  std::map<std::string_view, int> uses;
  for (const XmlElement& element : elements)
    if (element.attribute("format") == "appended" &&
        ++uses[element.attribute("offset")] > max_shared)
      throw vtu_refused("more than 16 arrays are the same appended data");
}

}  // namespace

std::string read_begun(const std::filesystem::path& path, double memory_per_byte,
                       void (*check_start)(std::string_view)) {
  const std::string head = read_head(path, bytes_of_start);
  if (!head.empty()) check_start(head);
  const double available = available_memory();
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  if (size * memory_per_byte > available)
    throw bad_input("its " + bytes_text(size) + " are too many for the " + bytes_text(available) +
                        " of memory that are free",
                    "make the file smaller, or read it on a larger machine");
  return read_file(path, std::numeric_limits<std::uint64_t>::max() - 1);
}

VtkXmlFile vtk_xml_file(std::string_view text) {
  check_start_of_xml(text);
  text.remove_prefix(text.find('<'));  // a byte order mark may come before
  check_end(text);
  VtkXmlFile file{"", xml_elements(text, appended_path), {}};
  const XmlElement& root = file.elements.front();
  check_root(root);
  check_shared(file.elements);
  file.type = root.attribute("type");
  VtuArrays& arrays = file.arrays;
  arrays.within = arrays.behind = coding_of(root);
  arrays.most = text.size() * max_expansion;
  const XmlElement& last = file.elements.back();
  if (last.path != appended_path) return file;
  arrays.behind.base64 = last.attribute("encoding") != "raw";
  const auto mark = last.text.find('_');
  if (mark != last.text.npos) arrays.appended = last.text.substr(mark + 1);
  return file;
}

}  // namespace sinew
