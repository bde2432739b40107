// SPDX-License-Identifier: GPL-3.0-or-later
// Strain, stress and the other arrays of a body's particles, while it is stepped.
//
//     ParticleMeter meter(prepared.body, prepared.surface.triangles);
//     const std::vector<Column> found = meter.arrays(simulation, "stress, strain");
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/arrays.h>
#include <sinew/core/dataset.h>
#include <sinew/core/triangles.h>
#include <sinew/metrics/frame.h>
#include <sinew/metrics/rest_body.h>

namespace sinew {

class Simulation;

class ParticleMeter {
 public:
  /// `surface`: of the body at rest; `near`: its neighbors there; none: searched. Throws bad input
  /// where the surface has no area.
  ParticleMeter(const Body& body, const Triangles& surface, SharedNeighbors near = {});

  const RestBody& rest() const { return rest_; }
  /// The body at rest.
  FrameState at_rest() const;
  /// The present moment, without velocities and surface.
  FrameState now(Simulation& simulation) const;
  /// Takes what forces depend on beside positions: bonds and muscles at `time` (s).
  void take_forces(Simulation& simulation, double time, FrameState& state) const;
  /// The arrays that are named, in words as output.arrays has them, at the present moment: by id,
  /// in the units of written_arrays(). Throws bad input for one that the body has not.
  std::vector<Column> arrays(Simulation& simulation, std::string_view words);

 private:
  std::shared_ptr<const World> world_;
  RestBody rest_;
  std::map<std::string, RequestedArrays, std::less<>> asked_;  ///< index: words
};

}  // namespace sinew
