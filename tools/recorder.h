// SPDX-License-Identifier: GPL-3.0-or-later
// Writes what a simulation is at this moment as one frame of each series.
#pragma once

#include <filesystem>

#include "core/settings.h"
#include "core/triangles.h"
#include "io/series.h"
#include "physics/simulation.h"
#include "rig/skin.h"

namespace sinew {

class Recorder {
 public:
  /// `surface`: the body's skin at rest. Throws not written.
  Recorder(const std::filesystem::path& folder, const OutputSettings& output, const Body& body,
           const Triangles& surface);

  /// Adds the frame at `time` (s). Throws not written.
  void add(Simulation& simulation, double time);
  void close();

  const std::vector<PvdRow>& rows() const { return particles_.rows(); }

 private:
  Points surface_now(const Particles& particles) const;

  RestShape shape_;
  Skin skin_;
  Triangles surface_;  ///< its points as they are now
  std::vector<std::int32_t> particle_bone_, surface_bone_;
  Series particles_, skins_, bones_, frames_;
};

/// The bone that holds each particle most, in the written order.
std::vector<std::int32_t> bones_of_particles(const Body& body);

}  // namespace sinew
