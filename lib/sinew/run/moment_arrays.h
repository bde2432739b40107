// SPDX-License-Identifier: GPL-3.0-or-later
// The arrays of particles that the forces and the bones of a moment define: acceleration, reference
// points and the parts of the bones' pull (Komiya and Tokoi, figure 3).
//
//     const std::vector<Column> columns = moment_arrays(moment, stepped_arrays());
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <sinew/body/forces.h>
#include <sinew/core/dataset.h>

namespace sinew {

/// A moment of a body.
struct BodyMoment {
  const Body& body;
  const Points& positions;  ///< n x 3, by id, m
  const Particles& now;     ///< in any order; only mass, radius and ids are used
  const Forces& forces;     ///< in the order of `now`
  const Pose& pose;
  Vec3 gravity;  ///< m/s^2
};

/// Returns those of stepped_arrays() that are named, by id. The pulls of several bones on a
/// particle are summed; its point is that of the heaviest one. Particles without a bone have no
/// point (not-a-number) and no pull. In parallel.
std::vector<Column> moment_arrays(const BodyMoment& moment,
                                  std::span<const std::string_view> names);

/// Returns those of `names` that the body has. Throws bad input for another one, unless `all` are
/// asked for.
std::vector<std::string_view> defined_moment_arrays(const Body& body,
                                                    std::vector<std::string_view> names, bool all);

}  // namespace sinew
