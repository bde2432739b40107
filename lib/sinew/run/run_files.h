// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the files of a run, for measuring and drawing.
//
//     const RunFiles run = open_run({"out/bend"});
//     const FrameState last = read_frame(run, run.frames() - 1);
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <sinew/core/energies.h>
#include <sinew/core/triangles.h>
#include <sinew/core/value_range.h>
#include <sinew/io/series.h>
#include <sinew/io/single_files.h>
#include <sinew/material/material.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/rest_body.h>
#include <sinew/rig/skeleton.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/machine.h>
#include <sinew/settings/settings.h>
#include <sinew/world/world.h>

namespace sinew {

struct RunFiles {
  RunFolder folder;
  std::string scene_text;
  Settings settings;
  Skeleton skeleton;
  Material material;              ///< material of the whole body
  BodyFile body;                  ///< the particles in the frames at rest, with their bones
  std::vector<std::int32_t> ids;  ///< ids of these particles in the body; empty: all of them
  Triangles surface;              ///< at rest
  std::vector<std::int32_t> surface_bone;  ///< bone that moves each point most, -1 for none
  std::vector<PvdRow> particle_rows, surface_rows, frame_rows;  ///< equally many of each
  std::vector<PvdRow> lbs_rows, dqs_rows;  ///< rows of the skinned surfaces; none if not written
  std::vector<PvdRow> obstacle_rows;       ///< none without obstacles
  std::vector<PvdRow> support_rows;        ///< support rows of supports and loads; none without
  std::vector<PvdRow> bond_rows;           ///< none if not written

  ValueRanges ranges;  ///< ranges of quantities that have been found, by run.json

  std::size_t frames_named = 0;  ///< frames of the longest series
  /// Frames of the run, also those that output.every leaves out; 0 if some series lack frames.
  std::size_t frames_run = 0;

  std::size_t frames() const { return particle_rows.size(); }
};

/// Opens a run. Throws bad input, naming the file, for a folder that is not a run, and for series
/// of different times. Frames that some of the series lack (of a run in progress or interrupted, or
/// by output.every) are left out, and so are particles that frames do not contain (output.region).
RunFiles open_run(const RunFolder& folder);

/// Where the figure looks in a frame, by its bones; see front_of().
std::optional<Vec3> front_in(const RunFiles& run, const FrameState& frame);

/// All data of one frame, but for lengths of bonds and stress of muscles, which runs do not write.
/// Throws bad input, naming the file, where it is damaged or of another body.
FrameState read_frame(const RunFiles& run, std::size_t frame);

/// Distance of each particle from its place at rest, m.
std::vector<double> displacements(const RunFiles& run, const FrameState& frame);

/// All obstacles of a frame in the scene; empty where none are written. Throws as read_frame does.
Triangles read_obstacles(const RunFiles& run, std::size_t frame);

/// The held particles and the muscles of a run's body, by id; null for a run without them. Its
/// obstacles are in the frames.
std::shared_ptr<const World> world_of_run(const RunFiles& run);

/// The probes of a run's scene. Throws bad input for a run that has not written all particles.
std::vector<Probe> probes_of_run(const RunFiles& run);

/// The frames of a run in order; the next ones are read while the caller works on the present one.
class FramesInOrder {
 public:
  /// Not `ahead`: next() reads each frame in the caller's thread.
  FramesInOrder(const RunFiles& run, bool ahead);

  /// May be called once per frame. Throws what read_frame() does.
  FrameState next();

 private:
  void begin();

  const RunFiles& run_;
  bool ahead_;
  std::size_t index_ = 0;
  std::deque<std::future<FrameState>> coming_;
};

/// Faces with longer sides, in radii, are divided where volumes, areas and sections are measured.
inline constexpr double longest_measured_side = 4;

/// The input of metrics: the body of a run at rest, but for the energies of its start. The run
/// must outlive what is made of it.
RestInput measured_body(const RunFiles& run);

}  // namespace sinew
