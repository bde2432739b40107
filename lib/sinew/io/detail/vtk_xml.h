// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's XML files of any kind of grid: their elements, and their arrays still encoded.
//
//     const VtkXmlFile file = vtk_xml_file(text);
//     for (const auto piece : file.pieces()) read(file.arrays_in(piece, "Piece/Points"));
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/io/detail/vtu_array.h>
#include <sinew/io/detail/xml.h>

namespace sinew {

struct VtkXmlFile {
  std::string type;  ///< "UnstructuredGrid", "PolyData", "ImageData" and others
  std::vector<XmlElement> elements;
  VtuArrays arrays;

  /// Returns the element of the grid itself. Throws bad input where there is none.
  const XmlElement& grid() const;

  /// The elements of each piece: the first is the piece, those within it follow.
  std::vector<std::span<const XmlElement>> pieces() const;

  /// The arrays in a group of the grid, such as "Piece/PointData" or "FieldData".
  std::vector<const XmlElement*> arrays_in(std::span<const XmlElement> piece,
                                           const std::string& group) const;
};

/// Throws bad input where a file that begins so is no VTK XML file.
void check_start_of_xml(std::string_view text);

/// The text of a file that `check_start` takes by its first bytes. Throws what that does, without
/// the path, and bad input for a file of which each byte's share of memory is not free.
std::string read_begun(const std::filesystem::path& path, double memory_per_byte,
                       void (*check_start)(std::string_view));

/// Reads a file of any writer: as text, base64 or appended data, compressed by ZLib, LZ4 or not.
/// `text` must outlive it. Throws bad input where that is no such file, cut short, or encoded in a
/// manner that sinew does not read.
VtkXmlFile vtk_xml_file(std::string_view text);

}  // namespace sinew
