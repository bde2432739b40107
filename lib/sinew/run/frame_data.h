// SPDX-License-Identifier: GPL-3.0-or-later
// The datasets of a frame: what a run writes, of the present moment of a simulation.
//
//     FrameData frame(prepared);
//     frame.take(simulation);
//     const Dataset skin = frame.surface(), bones = frame.bones();
//
// FrameWriter writes them as files; the room vtk makes data sets of VTK from them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <sinew/core/arrays.h>
#include <sinew/core/dataset.h>
#include <sinew/core/rest_neighbors.h>
#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>
#include <sinew/io/frames.h>
#include <sinew/io/particle_frame.h>
#include <sinew/rig/skin.h>
#include <sinew/rig/skinning.h>
#include <sinew/run/contact_pressure.h>
#include <sinew/run/particle_meter.h>
#include <sinew/run/support_table.h>
#include <sinew/run/volume_frames.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/simulation.h>
#include <sinew/world/world.h>

namespace sinew {

/// Whether particles have strain_eq in frames without being asked to: several writers of a frame
/// cannot find it.
enum class StrainInFrames { by_default, on_request };

/// Moves the surface by skinning alone: linear_blend_skinned or dual_quaternion_skinned.
using SkinningMethod = Points (*)(const Points&, const BoneWeights&, const Skeleton&, const Pose&);

/// One moment of a simulation, in the order of the particles.
struct FrameMoment {
  Moment moment;
  bool with_particles = false;  ///< else without forces and counts
  Points positions;             ///< index: particle id
  Particles particles;          ///< without positions
  Forces forces;
  std::shared_ptr<const Grouping> grouping;
  std::vector<std::int32_t> broken_bonds, limited;
  FrameState measured;  ///< what arrays and probes are measured of
  Energies energies;
  Unbalanced unbalanced;
  Pose pose;
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
  BoneReactions reactions;
  std::vector<ObstaclePose> obstacles;
  std::vector<Reaction> on_obstacles;
  std::vector<ObstaclePose> supports;
  std::vector<Reaction> support_reactions, load_reactions;
};

/// What frames contain beside the body.
struct FrameScene {
  Triangles surface = {};                  ///< the body's skin at rest
  std::vector<Triangles> obstacles = {};   ///< obstacles of its world, each in its own frame
  SurfaceLook look = {};                   ///< look of the exported surface
  std::vector<Probe> probes = {};          ///< for probes.csv; none: measured() is not asked for
  SharedNeighbors neighbors = {};          ///< neighbors at rest; none: the body's own, or searched
  std::optional<VolumeCells> volume = {};  ///< cells between its particles, where they are written
};

class FrameData {
 public:
  /// `output`: which particles and arrays there are. The body must outlive it. Throws bad input for
  /// an array that the body has not, a region without particles, and a surface without area where
  /// arrays are measured.
  FrameData(const OutputSettings& output, const Body& body, const FrameScene& scene,
            StrainInFrames strain = StrainInFrames::by_default);
  /// The same of a scene, which must outlive it.
  explicit FrameData(const Prepared& prepared);

  /// Takes the present moment, which is that of the frame at `time` (s). Forces and particles of
  /// the simulation are found anew when they are asked for again.
  void take(Simulation& simulation, double time, bool with_particles = true);
  void take(Simulation& simulation) { take(simulation, simulation.time()); }
  /// What was taken.
  const FrameMoment& now() const { return now_; }
  /// Frees the memory of what was taken.
  void forget() {
    now_ = {};
    skin_columns_.clear();
  }

  /// Names of the series that these frames have, in the order of the table.
  const std::vector<std::string_view>& series() const { return series_; }
  /// What a file of that series holds; of particles, see particles(). Throws bad input for a series
  /// that these frames lack, with the names there are.
  Dataset dataset(std::string_view series);
  /// Hands the same to `use`, particles without a copy of their positions.
  void lend(std::string_view series, const std::function<void(const Dataset&)>& use);

  /// A vertex for each particle, with their arrays and the energies, where they were taken. It
  /// refers to this object, until the next take(): evaluated() makes it independent.
  Dataset particles();
  /// The skin, as the particles move it, with those of their arrays that it has.
  Dataset surface();
  /// The skin by skinning alone.
  Dataset skinned(SkinningMethod method);
  /// Four lines per bone.
  Dataset bones() const;
  /// A vertex for each bone's head, with its axes and the reaction of the body on it.
  Dataset frames() const;
  /// The surfaces of all obstacles.
  Dataset obstacles() const;
  /// A vertex for every support and load.
  Dataset supports() const;
  /// Bonds as lines, where output.bonds asks for them.
  Dataset bonds() const;
  /// Cells between the particles, where there are some: the same numbers as made of a file of the
  /// particles. They must have been taken.
  Dataset volume();

  /// Supports and loads at this moment, which refers to this object.
  MachineMoment machine() const;
  /// The named arrays of all particles, by id, where it was to be probed.
  std::vector<Column> measured(std::span<const std::string_view> names) const;
  /// Whether there are the arrays alone that each body has, of all particles.
  bool is_plain() const;

 private:
  void begin_arrays(const OutputSettings& output, const FrameScene& scene, StrainInFrames strain);
  Dataset particles_at(Points positions);
  std::vector<char> pairs_apart(const Points& positions) const;
  Dataset frame_of(Points positions, const ParticleSelection& selection);
  std::vector<Column> measure(std::vector<std::string_view> names);
  void add_stepped(std::span<const std::string_view> names, const Points& positions,
                   std::vector<Column>& columns) const;
  std::vector<Column> columns_of_skin();
  std::vector<Column> columns_of_contact() const;

  const Body& body_;
  std::vector<std::string_view> series_;
  ParticleSelection selection_;  ///< what the frames of particles contain
  bool probed_;
  Skin skin_;
  Triangles surface_;  ///< its points as they are at the moment that was last drawn
  std::vector<std::int32_t> surface_bone_;
  std::vector<Triangles> obstacles_;
  BoneWeights vertex_weights_;                    ///< for skinning alone, once it is asked for
  RequestedArrays arrays_;                        ///< additional ones
  ParticleSelection on_skin_;                     ///< the arrays that the surface has of particles
  RequestedArrays on_skin_too_;                   ///< and these
  std::vector<std::string_view> contact_arrays_;  ///< contact arrays of the surface
  std::optional<ContactPressure> contacts_;       ///< which these are found by, if any
  std::vector<Column> skin_columns_;       ///< measured ones of the moment, once they are found
  std::optional<ParticleMeter> measured_;  ///< which these and bonds are computed from, if any
  FrameMoment now_;
  std::optional<VolumeFrames> volume_;
  bool single_;                              ///< files have Float32
  std::vector<std::int32_t> group_, level_;  ///< groups and levels of particles last asked for
};

}  // namespace sinew
