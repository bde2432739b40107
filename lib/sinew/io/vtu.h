// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a Dataset to a VTU file (VTK's XML unstructured grid) and reads one. Units (UNITS_LABEL),
// component names, number types and active arrays come from the table in arrays.h.
//
//     write_vtu("particles.vtu", data, {.series = "particles"});
//     const Dataset read = read_vtu("particles.vtu");
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include <sinew/core/dataset.h>
#include <sinew/core/options.h>

namespace sinew {

struct VtuFormat {
  /// zlib (level 1), lz4 and none: base64 in the elements, which every reader accepts; raw:
  /// appended raw data, which VTK 9.1 and 9.2 cannot read with a newer expat. UInt64 headers, Int32
  /// cells.
  Encoding encoding = Encoding::zlib;
  bool double_precision = false;  ///< Float64 for every real number
  std::string series;             ///< which rows of the table apply
  double radius = 0;              ///< radius, m; beyond 1e4 radii Float32 is too coarse
  bool double_points = false;     ///< Float64 for the points
  bool finite = false;  ///< refuses values that are not finite, or become so in Float32; of partial
                        ///< arrays infinite ones alone
};

/// Writes `path` atomically. Throws not written, naming the file, and Error (unstable) naming the
/// array for a value that the format refuses.
void write_vtu(const std::filesystem::path& path, const Dataset& data, const VtuFormat& format);

// A file that several processes write by write_part(): how it begins, a piece of each, and the end.
// The pieces have the same arrays.

/// How the file begins.
std::string vtu_beginning(const VtuFormat& format);
/// Points, cells and their arrays. Not in the encoding raw.
std::string vtu_piece(const Dataset& data, const VtuFormat& format);
/// Adds the field columns of `data` and the end: finish_parts(). Throws not written.
void finish_vtu(const std::filesystem::path& path, const Dataset& data, const VtuFormat& format);

/// Whether points are so far out that Float32 is too coarse for particles of `radius` (m).
bool beyond_float32(const Points& points, double radius);

/// VTK's number for cells of this kind.
int vtk_type(CellKind kind);

/// Reads a VTU file whose cells are all vertices, all lines of two points, all triangles or
/// all tetrahedra, in one
/// piece or, of vertices, in several, which are joined.
/// Integers beyond Int32 become doubles; a field array becomes one row. Arrays may be of any number
/// type, as text, base64 or appended data, compressed by ZLib, LZ4 or not, with counts of 32 or 64
/// bits. Throws bad input, naming the file, for anything else, however damaged.
Dataset read_vtu(const std::filesystem::path& path);

/// The same with only the named point arrays, where they exist: much faster.
Dataset read_vtu(const std::filesystem::path& path,
                 std::initializer_list<const char*> point_arrays);

}  // namespace sinew
