// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the files of a run, for measuring and drawing.
//
//     const RunFiles run = open_run({"out/bend"});
//     const RunFrame last = read_frame(run, run.frames() - 1);
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <sinew/body/bond_factors.h>
#include <sinew/body/pass_through.h>
#include <sinew/core/simulation_state.h>
#include <sinew/core/triangles.h>
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
  Material material;              ///< of the whole body
  BodyFile body;                  ///< the particles in the frames at rest, with their bones
  std::vector<std::int32_t> ids;  ///< of these particles in the body; empty: all of them
  Triangles surface;              ///< at rest
  std::vector<std::int32_t> surface_bone;  ///< that moves each point most, -1 for none
  std::vector<PvdRow> particle_rows, surface_rows, frame_rows;  ///< equally many of each
  std::vector<PvdRow> lbs_rows, dqs_rows;  ///< of the skinned surfaces; none if not written
  std::vector<PvdRow> obstacle_rows;       ///< none without obstacles
  std::vector<PvdRow> support_rows;        ///< of supports and loads; none without
  std::vector<PvdRow> bond_rows;           ///< none if not written

  std::size_t frames_named = 0;  ///< by the longest series

  std::size_t frames() const { return particle_rows.size(); }
};

/// Opens a run. Throws bad input, naming the file, for a folder that is not a run, and for series
/// of different times. Frames that some of the series lack (of a run in progress or interrupted, or
/// by output.every) are left out, and so are particles that frames do not contain (output.region).
RunFiles open_run(const RunFolder& folder);

/// Which particles, by id, exert nothing on each other; empty: all do. Of copies of what it is
/// given.
std::function<bool(std::uint32_t, std::uint32_t)> passing_by(const PassThrough& pairs,
                                                             std::vector<int> bone, Points rest,
                                                             double near_at_rest);

/// All data of one frame, in the written order.
struct RunFrame {
  double time = 0;                   ///< s
  Points positions, surface_points;  ///< m
  Points velocities;                 ///< m/s; empty: not written
  std::vector<double> displacement;  ///< its size per particle, m
  std::vector<RigidFrame> bones;     ///< heads and axes
  std::vector<double> bone_lengths;  ///< head to tail, m: bones may stretch
  Energies energies;
  std::vector<std::int32_t> broken_bonds;  ///< of each particle; empty: it has no bonds
  std::vector<double> von_mises;           ///< Pa; empty: not written
  std::vector<std::int32_t> group;         ///< of each particle, -1: free; empty: there are none
  Points world_force;                      ///< force_world, N; empty: not written
  Unbalanced unbalanced;
};

/// Where the figure looks in the first frame, by its bones; see front_of().
std::optional<Vec3> front_in(const RunFiles& run);

/// Throws bad input, naming the file, where it is damaged or of another body.
RunFrame read_frame(const RunFiles& run, std::size_t frame);

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
  RunFrame next();

 private:
  void begin();

  const RunFiles& run_;
  bool ahead_;
  std::size_t index_ = 0;
  std::deque<std::future<RunFrame>> coming_;
};

// The input of metrics: the body and the forces in it.

/// The material's forces between particles, the same throughout.
ForcesOfPairs pair_law(const Material& material);
/// The stiffness around each particle; `modulus` as LocalStiffness::modulus.
LocalStiffness stiffness_by(std::shared_ptr<const BondFactors> factors,
                            std::vector<double> modulus);

/// Faces with longer sides, in radii, are divided where volumes, areas and sections are measured.
inline constexpr double longest_measured_side = 4;

/// Radius, range, mass and forces from the material; the bones from the skeleton. The caller adds
/// positions, surface and the bones of particles.
RestInput measured_body(const Material& material, const Skeleton& skeleton);

/// The same from a run's files, with its body at rest. The run must outlive what is made of it.
RestInput measured_body(const RunFiles& run);

/// A frame as input of the metrics.
FrameState measured_frame(RunFrame frame);

}  // namespace sinew
