// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtu_header.h>

#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/io/vtu_blocks.h>
#include <sinew/io/xml_bounds.h>

namespace sinew {
namespace {

constexpr std::uint64_t most_components = 1000;

struct NumberType {
  std::string_view name;
  std::size_t size;  // bytes
};

constexpr std::array<NumberType, 10> number_types = {{{"Int8", 1},
                                                      {"UInt8", 1},
                                                      {"Int16", 2},
                                                      {"UInt16", 2},
                                                      {"Int32", 4},
                                                      {"UInt32", 4},
                                                      {"Int64", 8},
                                                      {"UInt64", 8},
                                                      {"Float32", 4},
                                                      {"Float64", 8}}};

/// Where data within an element has been left out of the bare XML.
struct Cut {
  std::size_t at;    ///< place in the bare XML
  std::size_t gone;  ///< characters left out up to here
};

/// What the checks of the elements need to know of the file.
struct Document {
  std::ifstream file;
  std::string xml;         ///< without the appended data, which may be binary
  std::string bare;        ///< without the long data within elements: soon parsed
  std::vector<Cut> cuts;   ///< ascending
  std::uint64_t data = 0;  ///< where the appended data begins; 0 when there is none
  bool data_base64 = true;
  BlockCoding coding;
};

Error refused(const std::string& what) {
  return bad_input(what, "use a VTU file as sinew writes them");
}

std::string quoted(std::string_view text) { return '\'' + std::string(text.substr(0, 60)) + '\''; }

std::string_view attribute(vtkXMLDataElement& element, const char* name) {
  const char* value = element.GetAttribute(name);
  return value ? value : "";
}

std::uint64_t checked_count(std::string_view name, std::string_view text, std::uint64_t most) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count > most)
    throw refused(std::string(name) + " is " + quoted(text) + ", which its size cannot hold");
  return count;
}

std::string read_at(std::ifstream& file, std::uint64_t place, std::size_t count) {
  std::string text(count, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(place));
  file.read(text.data(), static_cast<std::streamsize>(count));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return text;
}

void check_start_and_end(Document& document) {
  const std::string start = read_at(document.file, 0, 4096);
  if (!start.starts_with('<') || start.find("<VTKFile") == std::string::npos)
    throw refused("it is not a VTK XML file");
  const std::uint64_t bytes = document.coding.bytes;
  std::string end = read_at(document.file, bytes - std::min<std::uint64_t>(bytes, 64), 64);
  end.erase(end.find_last_not_of(" \t\r\n") + 1);
  // A writer that was stopped leaves a file without its last tag.
  if (!end.ends_with("</VTKFile>")) throw refused("it is cut short");
}

void find_data(Document& document, std::size_t tag) {
  const std::string start = read_at(document.file, tag, 1000);
  const auto mark = start.find('_');
  if (mark == std::string::npos) throw refused("its appended data is damaged");
  document.data = tag + mark + 1;
  document.data_base64 = start.substr(0, mark).find("\"base64\"") != std::string::npos;
}

void read_xml(Document& document) {
  constexpr std::string_view mark = "<AppendedData";
  std::string& xml = document.xml;
  for (std::string piece; !(piece = read_at(document.file, xml.size(), 1 << 16)).empty();) {
    const std::size_t from = xml.size() < mark.size() ? 0 : xml.size() - mark.size();
    xml += piece;
    const auto tag = xml.find(mark, from);
    if (tag == std::string::npos) continue;
    find_data(document, tag);
    xml.replace(tag, std::string::npos, "</VTKFile>");
    return;
  }
}

constexpr std::size_t long_data = 256;  // characters

/// Whether there is nothing but base64 and white space: no part of a tag, whatever surrounds it.
bool is_base64(std::string_view text) {
  static const auto plain = [] {
    std::array<bool, 256> table{};
    for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                         "0123456789+/= \t\r\n"))
      table[static_cast<unsigned char>(c)] = true;
    return table;
  }();
  bool all = true;
  for (const char c : text) all &= plain[static_cast<unsigned char>(c)];
  return all;
}

void leave_data_out(Document& document) {
  const std::string_view xml = document.xml;
  std::size_t kept = 0;  // up to here
  for (auto tag = xml.find('<'); tag != xml.npos;) {
    const auto begin = std::min(xml.find('>', tag), xml.size() - 1) + 1;
    tag = xml.find('<', begin);
    if (tag == xml.npos || tag - begin < long_data) continue;
    if (!is_base64(xml.substr(begin, tag - begin))) continue;
    document.bare += xml.substr(kept, begin - kept);
    kept = tag;
    document.cuts.push_back({document.bare.size(), kept - document.bare.size()});
  }
  document.bare += xml.substr(kept);
}

/// The place in the whole XML of a tag that begins at `at` in the bare one.
std::size_t whole_place(const Document& document, std::size_t at) {
  const auto after =
      std::upper_bound(document.cuts.begin(), document.cuts.end(), at,
                       [](std::size_t place, const Cut& cut) { return place < cut.at; });
  return after == document.cuts.begin() ? at : at + std::prev(after)->gone;
}

/// Every attribute NumberOf...
void check_counts(vtkXMLDataElement& element, std::uint64_t bytes) {
  for (int i = 0; i < element.GetNumberOfAttributes(); ++i) {
    const std::string_view name = element.GetAttributeName(i);
    if (!name.starts_with("NumberOf")) continue;
    checked_count(name, element.GetAttributeValue(i),
                  name == "NumberOfComponents" ? most_components : most_expansion * bytes);
  }
}

std::size_t value_size(vtkXMLDataElement& array) {
  const auto type = attribute(array, "type");
  const auto* found = std::find_if(number_types.begin(), number_types.end(),
                                   [&](const NumberType& known) { return known.name == type; });
  if (found == number_types.end())
    throw refused("array " + quoted(attribute(array, "Name")) + " is not numeric");
  return found->size;
}

/// Whether an array has no values: in field data it says so itself, elsewhere its piece does.
bool declares_none(vtkXMLDataElement& array) {
  if (array.GetAttribute("NumberOfTuples")) return attribute(array, "NumberOfTuples") == "0";
  vtkXMLDataElement* group = array.GetParent();
  vtkXMLDataElement* piece = group ? group->GetParent() : nullptr;
  if (!piece) return false;
  const bool of_cells = std::string_view(group->GetName()).starts_with("Cell");
  return attribute(*piece, of_cells ? "NumberOfCells" : "NumberOfPoints") == "0";
}

bool block_is_sound(vtkXMLDataElement& array, Document& document) {
  const BlockValues values{value_size(array), declares_none(array)};
  BlockCoding coding = document.coding;
  // VTK goes by the offset, whatever the format says.
  if (array.GetAttribute("offset")) {
    if (document.data == 0) return false;
    const auto place =
        document.data + checked_count("offset", attribute(array, "offset"), coding.bytes);
    coding.base64 = document.data_base64;
    return block_is_sound([&](std::size_t count) { return read_at(document.file, place, count); },
                          values, coding);
  }
  if (attribute(array, "format") != "binary") return true;
  std::string_view text = document.xml;  // the element itself keeps no data
  const auto place = whole_place(document, static_cast<std::size_t>(array.GetXMLByteIndex()));
  text.remove_prefix(std::min(place, text.size()));
  text.remove_prefix(std::min(text.find('>'), text.size() - 1) + 1);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return block_is_sound([&](std::size_t count) { return std::string(text.substr(0, count)); },
                        values, coding);
}

void check_elements(vtkXMLDataElement& element, Document& document) {
  check_counts(element, document.coding.bytes);
  const std::string_view name = element.GetName();
  if ((name == "DataArray" || name == "Array") && !block_is_sound(element, document))
    throw refused("array " + quoted(attribute(element, "Name")) + " is damaged");
  for (int i = 0; i < element.GetNumberOfNestedElements(); ++i)
    check_elements(*element.GetNestedElement(i), document);
}

void check_xml(Document& document) {
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
      vtkXMLUtilities::ReadElementFromString(document.bare.c_str()));
  if (!root || std::string_view(root->GetName()) != "VTKFile")
    throw refused("it is not a VTK XML file");
  if (const auto type = attribute(*root, "type"); type != "UnstructuredGrid")
    throw refused("it holds " + quoted(type) + ", not an UnstructuredGrid");
  if (!root->FindNestedElementWithName("UnstructuredGrid")) throw refused("it holds no grid");
  document.coding.compressed = root->GetAttribute("compressor") != nullptr;
  document.coding.big_endian = attribute(*root, "byte_order") == "BigEndian";
  document.coding.word = attribute(*root, "header_type") == "UInt64" ? 8 : 4;
  check_elements(*root, document);
}

}  // namespace

void check_vtu_header(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw bad_input("it is not a file", "check the path");
  Document document;
  document.coding.bytes = std::filesystem::file_size(path, error);
  document.file.open(path, std::ios::binary);
  if (!document.file) throw bad_input("it cannot be opened", "check the path and the permissions");
  check_start_and_end(document);
  read_xml(document);
  leave_data_out(document);
  if (!is_within_bounds(document.bare))
    throw refused("its elements are too many, too deep or too long");
  check_xml(document);
}

}  // namespace sinew
