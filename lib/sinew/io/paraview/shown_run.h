// SPDX-License-Identifier: GPL-3.0-or-later
// What must be known of a run before it is shown: its series, whether its body has cells, the room
// it needs, the range of colors, the largest forces, and the moment at which its body is most
// deformed.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sinew/core/value_range.h>
#include <sinew/core/vector.h>

namespace sinew {

/// Length of the longest arrow in the size of the body.
constexpr double arrow_fraction = 0.2;

/// What a user may choose.
struct ViewOptions {
  std::string array = {};  ///< array that colors body and skin; "": strain_eq, or else displacement
  std::string cut = "y";   ///< axis across which the body is cut open: x, y, z or none
  std::optional<std::string> forces = {};  ///< array of the arrows; "": force_pair
  std::optional<double> time = {};         ///< s; none: when the array is largest
  double aspect = 1;                       ///< width over height of each of the two views
  std::optional<ValueRange> range = {};    ///< range of the colors; none: the run's
  ValueRanges ranges = {};                 ///< ranges of the run's quantities, as far as known
  bool live = false;  ///< follows the run by the plugin's source SinewSeries, with room to bend
};

struct ShownRun {
  std::filesystem::path folder;     ///< absolute
  std::vector<std::string> series;  ///< series shown that it has
  std::vector<double> times;        ///< times of its frames, s
  Vec3 origin = Vec3::Zero();       ///< near the body, relative to which it is shown, m
  std::array<Vec3, 2> rest;         ///< corners of the box around the body at rest, m, from there
  Points corners;                   ///< corners of boxes around all that is shown
  std::size_t particles = 0;
  double radius = 0;        ///< radius of the particles, m
  bool can_be_cut = false;  ///< the frames tell where particles were at rest
  bool has_bones = false;
  bool has_cells = false;       ///< the series `volume` has the array
  bool skin_has_array = false;  ///< and so has the series `surface`
  std::string array, unit;      ///< array that colors body and skin
  int components = 1;           ///< number of its components
  ValueRange range{0, 1};       ///< range of its values
  bool grows = false;           ///< the range is not known yet: there is only the body at rest
  double moment = 0;            ///< to begin with, s
  std::string forces;           ///< shown as arrows; "" where the frames lack them
  double strongest = 0;         ///< the largest of these, N
  double hardest = 0;           ///< the largest force of a support or a load, N

  bool has(const std::string& name) const;
  /// Longest side of the box around all corners, m.
  double size() const;
};

/// Reads at most 12 frames, spread over the run. Throws bad input where the folder has no frame,
/// and where the particles have no array of that name.
ShownRun shown_run(const std::filesystem::path& folder, const ViewOptions& options);

}  // namespace sinew
