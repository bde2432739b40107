// SPDX-License-Identifier: GPL-3.0-or-later
// What pictures and the report show of the world around a run's body: held particles, obstacles.
//
//     show_world(playback, run, [](std::size_t frame) { return frame; });
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <sinew/metrics/report/playback.h>
#include <sinew/run/run_files.h>

namespace sinew {

/// Lists names by the numbers in array material of the particles: 0 is what no entry of the scene's
/// list holds.
std::vector<std::string> names_of_materials(const RunFiles& run);

/// The index of a particle of the body in the frames; -1 where they do not contain it.
std::ptrdiff_t place_in_frames(const RunFiles& run, std::size_t particle);

/// Indices of the held particles in the frames, ascending.
std::vector<std::size_t> held_in_frames(const RunFiles& run);

/// The force of a support or a load on the body.
struct ShownForce {
  Vec3 from = Vec3::Zero(), along = Vec3::Zero();  ///< m; `along` is the arrow as drawn
  bool is_load = false;                            ///< else of a support
};

/// The forces of supports and loads on the body, as arrows; the longest at any time is a fifth of
/// the body.
class ShownForces {
 public:
  /// Throws bad input, naming the file, for damaged frames.
  explicit ShownForces(const RunFiles& run);

  /// At a frame of the run; none where it has neither.
  std::vector<ShownForce> at(std::size_t frame) const;
  /// The force that the longest arrow at any time stands for, N.
  double strongest() const { return strongest_; }

 private:
  const RunFiles* run_;
  double strongest_ = 0;
  double scale_ = 0;  ///< m/N
};

/// The part of the obstacles that is drawn: what lies around the body, `body` enlarged (m). Planes
/// have no end, and what is far away would make the body small.
Box obstacle_space(const Box& body);

/// Marks the held particles of a playback, names its materials and adds forces and obstacles to its
/// frames. `frame_of`: the run's frame of a playback's. Throws bad input, naming the file, for
/// damaged frames.
void show_world(Playback& playback, const RunFiles& run,
                const std::function<std::size_t(std::size_t)>& frame_of);

}  // namespace sinew
