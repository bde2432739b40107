// SPDX-License-Identifier: GPL-3.0-or-later
// The sources and filters of the state that shows a run, each under a name of its own in ParaView's
// pipeline.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <sinew/io/paraview/shown_run.h>
#include <sinew/io/paraview/state_file.h>

namespace sinew {

/// nullptr where the run has no such part.
struct ViewPipeline {
  std::map<std::string, StateProxy*> series;  ///< readers, by the names of the series
  StateProxy* particles = nullptr;            ///< cut open
  StateProxy* body = nullptr;                 ///< the surface of the cells, cut open
  StateProxy* edges = nullptr;                ///< edges of the skin
  StateProxy* bones = nullptr;                ///< tubes from head to tail
  StateProxy* axes = nullptr;                 ///< tubes along the axes of the bones
  StateProxy* forces = nullptr;               ///< arrows at some of the particles
  std::array<StateProxy*, 2> machine{};       ///< arrows of supports, and of loads
  StateProxy* time = nullptr;                 ///< time as text
  StateProxy* note = nullptr;                 ///< length of the arrows, where forces are asked for
  std::vector<const StateProxy*> all;
};

/// Radius of the tubes of bones, m.
double bone_radius(const ShownRun& run);

/// Adds them to the state.
ViewPipeline view_pipeline(StateFile& state, const ShownRun& run, const ViewOptions& options);

}  // namespace sinew
