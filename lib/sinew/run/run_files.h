// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a run read back: what measuring and drawing begin with.
#pragma once

#include <deque>
#include <future>
#include <string>
#include <vector>

#include <sinew/core/simulation_state.h>
#include <sinew/core/triangles.h>
#include <sinew/io/series.h>
#include <sinew/io/single_files.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/rest_body.h>
#include <sinew/physics/material.h>
#include <sinew/rig/skeleton.h>
#include <sinew/run/run_folder.h>
#include <sinew/settings/settings.h>

namespace sinew {

struct RunFiles {
  RunFolder folder;
  std::string scene_text;
  Settings settings;
  Skeleton skeleton;
  BodyFile body;                           ///< at rest, with the bone of each particle
  Triangles surface;                       ///< at rest
  std::vector<std::int32_t> surface_bone;  ///< that moves each point most, -1 for none
  std::vector<PvdRow> particle_rows, surface_rows, frame_rows;  ///< as many of each
  std::vector<PvdRow> lbs_rows, dqs_rows;  ///< of the surface by skinning; none if not written

  std::size_t frames_named = 0;  ///< by the series that has most

  std::size_t frames() const { return particle_rows.size(); }
};

/// Opens a run. Throws bad input, naming the file, for a folder that is none, and for series of
/// different times. Frames that only some of the series have (a run still going, or cut off) are
/// left out.
RunFiles open_run(const RunFolder& folder);

/// Everything about one frame, in the written order.
struct RunFrame {
  double time = 0;                               ///< s
  Points positions, velocities, surface_points;  ///< m, m/s, m
  std::vector<double> displacement;              ///< its size per particle, m
  std::vector<RigidFrame> bones;                 ///< heads and axes
  std::vector<double> bone_lengths;              ///< head to tail, m: some stretch
  Energies energies;
  std::vector<std::int32_t> broken_bonds;  ///< of each particle; empty: it has no bonds
};

/// Throws bad input, naming the file, when it is damaged or of another body.
RunFrame read_frame(const RunFiles& run, std::size_t frame);

/// The frames of a run one after the other; those that come are read while the caller works on the
/// one before.
class FramesInOrder {
 public:
  /// Not `ahead`: by the caller's thread, when it asks.
  FramesInOrder(const RunFiles& run, bool ahead);

  /// As many times as there are frames. Throws what read_frame does.
  RunFrame next();

 private:
  void begin();

  const RunFiles& run_;
  bool ahead_;
  std::size_t index_ = 0;
  std::deque<std::future<RunFrame>> coming_;
};

// What metrics have to know of a body and of the forces in it.

/// The constants that the run's particles had.
Material material_of(const RunFiles& run);

/// The material's forces between particles, as far as their positions decide them: empty where
/// bonds break or creep, which depends on the past.
PairLaw pair_law(const Material& material);

/// Radius, range, mass and forces from the material; the bones from the skeleton. Positions,
/// surface and the bones of particles are the caller's.
RestInput measured_body(const Material& material, const Skeleton& skeleton);

/// The same of a run's files, with its body at rest.
RestInput measured_body(const RunFiles& run);

/// A frame as metrics take it.
FrameState measured_frame(RunFrame frame);

}  // namespace sinew
