// SPDX-License-Identifier: GPL-3.0-or-later
// One Dataset as a VTU file (VTK's XML unstructured grid) and back. Units (UNITS_LABEL), component
// names, number types and active arrays come from the table in arrays.h.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include <sinew/core/dataset.h>
#include <sinew/core/options.h>

namespace sinew {

struct VtuFormat {
  /// zlib (level 1), lz4 and none: base64 within the elements, which every reader takes; raw:
  /// appended raw, which VTK 9.1 and 9.2 cannot read with a newer expat. UInt64 headers, Int32
  /// cells.
  Encoding encoding = Encoding::zlib;
  bool double_precision = false;  ///< Float64 for every real number
  std::string series;             ///< whose rows of the table hold
  double radius = 0;  ///< of the particles, m; Float32 cannot place them beyond 1e4 radii
};

/// Writes `path` whole or not at all. Throws not written, naming the file.
void write_vtu(const std::filesystem::path& path, const Dataset& data, const VtuFormat& format);

/// VTK's number for cells of this kind.
int vtk_type(CellKind kind);

/// Reads a VTU file whose cells are all vertices, all lines of two points or all triangles.
/// Integers beyond Int32 become doubles; a field array becomes one row. Throws bad input, naming
/// the file, for anything else: never a crash, nothing on the console. Arrays may be of any type of
/// numbers, as words, base64 or appended, compressed by ZLib, LZ4 or not, with counts of 32 or 64
/// bits.
Dataset read_vtu(const std::filesystem::path& path);

/// The same with only those arrays of the points that are named and there: much sooner.
Dataset read_vtu(const std::filesystem::path& path,
                 std::initializer_list<const char*> point_arrays);

}  // namespace sinew
