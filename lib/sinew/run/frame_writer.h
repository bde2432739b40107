// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the present state of a simulation as one frame of each series, by a separate thread while
// the simulation continues. Also writes bones.csv, supports.csv, probes.csv, checksums.sfv
// and, where the scene
// requests them, the surface by skinning alone and its export for animators.
//
//     FrameWriter writer(folder, output, body, surface, obstacles);
//     writer.add(simulation, time);
//     writer.close();
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <sinew/core/background.h>
#include <sinew/core/triangles.h>
#include <sinew/io/bone_table.h>
#include <sinew/io/checksums.h>
#include <sinew/io/frames.h>
#include <sinew/io/particle_frame.h>
#include <sinew/io/point_cache.h>
#include <sinew/io/series.h>
#include <sinew/rig/skin.h>
#include <sinew/rig/skinning.h>
#include <sinew/run/particle_meter.h>
#include <sinew/run/probe_table.h>
#include <sinew/run/support_table.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/simulation.h>
#include <sinew/world/world.h>

namespace sinew {

/// Whether frames contain strain_eq without being asked to: several writers of a frame cannot find
/// it.
enum class StrainInFrames { by_default, on_request };

/// What frames contain beside the body.
struct FrameScene {
  Triangles surface = {};                 ///< the body's skin at rest
  std::vector<Triangles> obstacles = {};  ///< of its world, each in its own frame
  SurfaceLook look = {};                  ///< of the exported surface
  std::vector<Probe> probes = {};         ///< for probes.csv
  SharedNeighbors neighbors = {};         ///< of the body at rest; none: its own, or searched
};

class FrameWriter {
 public:
  /// `kept`: times (s) of frames already written. The body must outlive the writer. Throws not
  /// written, and bad input when one of those frames is missing.
  FrameWriter(const std::filesystem::path& folder, const OutputSettings& output, const Body& body,
              FrameScene scene, std::span<const double> kept = {},
              StrainInFrames strain = StrainInFrames::by_default);
  /// The same of a scene that begins.
  FrameWriter(const std::filesystem::path& folder, const OutputSettings& output,
              const Prepared& prepared);

  /// Takes the frame at `time` (s) from the simulation; waits until the frame before is written.
  /// `begun`: others have written its particles, see Series::finish(). Throws not
  /// written, also for an earlier frame: then nothing more is written.
  void add(Simulation& simulation, double time, bool begun = false);
  /// Whether others may write the particles of frames, each a piece of them.
  bool can_be_begun() const {
    return arrays_.empty() && selection_.ids.empty() && body_.material_number.empty() &&
           !body_.grouping;
  }
  /// Runs the job that make() returns once all earlier frames are written, unless that fails.
  void then(const std::function<Background::Job()>& make) { writer_.hand(make); }
  /// Waits until all frames are written and named by the PVDs. Throws not written.
  void close();

  /// Nothing where the scene has no probes.
  const ProbeTable* probes() const { return probe_table_ ? &*probe_table_ : nullptr; }

  /// How long add() has waited for earlier frames to be written, s.
  double waited() const { return writer_.waited(); }

  /// Frames that are written.
  int written() const { return written_; }

 private:
  /// The content of a frame, in the order of the particles.
  struct Moved {
    Moment moment;
    bool with_particles = false;  ///< else without forces and counts
    bool begun = false;           ///< the particles are written already
    Points positions;             ///< by id
    Particles particles;          ///< without positions
    Forces forces;
    std::shared_ptr<const Grouping> grouping;
    std::vector<std::int32_t> broken_bonds;
    FrameState measured;  ///< what arrays and probes are measured of
    Energies energies;
    Pose pose;
    BoneReactions reactions;
    std::vector<ObstaclePose> obstacles;
    std::vector<Reaction> on_obstacles;
    std::vector<ObstaclePose> supports;
    std::vector<Reaction> support_reactions, load_reactions;
  };

  /// The surface moved by skinning alone, in a series of its own.
  struct Skinned {
    Points (*method)(const Points&, const BoneWeights&, const Skeleton&, const Pose&);
    std::unique_ptr<Series> series;
  };

  void begin_skinned(const OutputSettings& output, std::span<const double> kept);
  void begin_export(std::size_t kept, SurfaceLook look);
  void begin_arrays(const OutputSettings& output, SharedNeighbors near,
                    std::span<const double> kept, StrainInFrames strain);
  Moved take(Simulation& simulation, double time);
  void write(Moved& frame);
  void write_particles(Moved& frame, const FrameState& state);
  void write_surfaces(const Moved& frame);
  void write_supports(const Moved& frame);
  void write_probes(const Moved& frame, const FrameState& state);
  std::vector<Series*> all_series();
  void begin_checksums();
  void list_new_frames();

  std::filesystem::path folder_;
  const Body& body_;
  ParticleSelection selection_;  ///< what the frames of particles contain
  std::size_t every_;            ///< of so many frames, one contains particles
  std::size_t taken_;            ///< frames so far
  Skin skin_;
  Triangles surface_;  ///< its points as they are in the frame being written
  std::vector<std::int32_t> surface_bone_;
  std::vector<Triangles> obstacles_;
  Series particles_, skins_, bones_, frames_;
  std::optional<Series> obstacle_series_, support_series_;  ///< where the scene has some
  BoneTable bone_table_;
  std::optional<SupportTable> support_table_;  ///< where the scene has some, or loads
  std::optional<ProbeTable> probe_table_;      ///< where the scene has some
  BoneWeights vertex_weights_;  ///< for skinning alone; empty where it is not requested
  std::vector<Skinned> skinned_;
  std::unique_ptr<PointCache> export_;
  SurfaceLook look_;                       ///< of the exported surface
  std::vector<std::string_view> arrays_;   ///< additional ones
  std::optional<ParticleMeter> measured_;  ///< which these and bonds are computed from, if any
  std::optional<Series> bond_series_;      ///< where the scene requests it
  std::optional<Checksums> checksums_;
  std::vector<std::size_t> listed_;  ///< frames of each series whose checksums are
  std::atomic<int> written_ = 0;
  Moved spare_;           ///< the last frame, whose memory is reused
  Background writer_{1};  ///< the last member: destroyed before the data it uses
};

}  // namespace sinew
