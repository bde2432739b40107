// SPDX-License-Identifier: GPL-3.0-or-later
// What files of meshes do not say: the unit of their lengths, and where up is.
//
//     const UnitGuess unit = guess_unit("part.stl", longest);
#pragma once

#include <filesystem>
#include <string>

#include <sinew/core/options.h>

namespace sinew {

struct UnitGuess {
  LengthUnit unit = LengthUnit::m;
  std::string why;
};

/// From the format and the longest side of the box, as the file has it.
UnitGuess guess_unit(const std::filesystem::path& mesh, double longest);

struct UpGuess {
  Axis up = Axis::z;
  std::string why;
};

/// From the format, and from the axis in which the body stands on 0, as the file has it.
UpGuess guess_up(const std::filesystem::path& mesh, const Box& box);

}  // namespace sinew
