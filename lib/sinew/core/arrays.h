// SPDX-License-Identifier: GPL-3.0-or-later
// The table of written arrays, always or on request, from which the writer takes units, component
// names, number types and active arrays, --arrays and output.arrays their names, and the
// documentation its tables. To write another array, add its row in arrays.cpp.
//
//     const WrittenArray* row = find_written("particles", ArrayPlace::point, "velocity");
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace sinew {

enum class ArrayPlace { point, cell, field };

/// How numbers are stored: Int32, Float32 (Float64 in double precision), always Float64, or bytes.
enum class ArrayNumbers { whole, real, exact, bytes };

/// The arrays that a viewer shows first: the active scalars and vectors of the points.
enum class ArrayRole { plain, scalars, vectors };

struct WrittenArray {
  std::string_view series;  ///< "body", "particles", "surface", "bones", "frames", "obstacles",
                            ///< "volume", "defects", "blowup"; "all": each
  ArrayPlace place;
  std::string_view name;                     ///< "Points" for the coordinates themselves
  std::string_view unit;                     ///< "1" for pure numbers
  std::vector<std::string_view> components;  ///< their names; empty for scalars
  ArrayNumbers numbers;
  ArrayRole role;
  std::string_view help;  ///< one line
  bool partial = false;   ///< not-a-number where a particle has no such value
};

std::span<const WrittenArray> written_arrays();

/// The row of that array in `series` or in all of them, or nullptr. The points of "volume" have
/// those of "particles" as well, and the surface may: see skin_arrays().
const WrittenArray* find_written(std::string_view series, ArrayPlace place, std::string_view name);

/// "point", "cell", "field".
std::string_view place_text(ArrayPlace place);

// Arrays of particles that are written only when somebody asks for them.

/// Arrays that positions define, at any time later too: F, J, stretch, ...
std::span<const std::string_view> measured_arrays();
/// Arrays that forces and bones of the moment define: acceleration, bone_point, force_radial, ...
std::span<const std::string_view> stepped_arrays();

/// Arrays of the surface alone, of what presses on it: contact_pressure, contact_area.
std::span<const std::string_view> contact_arrays();

struct RequestedArrays {
  std::vector<std::string_view> measured, stepped;  ///< in the order of the table, each once
  bool all = false;  ///< asked for by "all": those that a body lacks are left out
};

/// The arrays of particles in every frame that a text names; none for all of them. Throws bad input
/// for any other name, with the nearest one.
std::vector<std::string_view> frame_arrays(std::string_view words);

/// Picks those that a text names, with commas or spaces between them, or "all". Throws bad input
/// for any other name, with the nearest one.
RequestedArrays requested_arrays(std::string_view words);

struct SkinArrays {
  bool usual = true;                      ///< arrays that need no request: strain_eq, von_mises
  std::vector<std::string_view> frame;    ///< see frame_arrays()
  std::vector<std::string_view> contact;  ///< see contact_arrays()
  RequestedArrays requested;
};

/// Picks the arrays of particles, of each frame and on request, that the surface shall have as
/// well. "none": without those that it has unasked; "all": each. Names that the surface has of its
/// own are left out. Throws bad input for any other name, with the nearest one.
SkinArrays skin_arrays(std::string_view words);

}  // namespace sinew
