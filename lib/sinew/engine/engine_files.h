// SPDX-License-Identifier: GPL-3.0-or-later
// The files through which sinew and an engine in another program talk: what is to be stepped, and
// the states that come back.
//
//     FOLDER/setup         the run but for its particles (EngineSetup)
//     FOLDER/particles     of each particle by id: position, velocity, and its row, as doubles
//     FOLDER/poses         of obstacles and supports, see engine_world.h; without them none
//     FOLDER/state_N       after N steps (EngineMoment)
//     FOLDER/state_N.R     the particles of rank R there, as doubles: id, position, velocity
//     FOLDER/forces_N.R    the forces on them, where the setup requests it: id, pair, damping,
//     bone,
//                          world, count of neighbors
//
// A state is complete once FOLDER/state_N is there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/body/ledger.h>
#include <sinew/body/step_plan.h>
#include <sinew/core/simulation_state.h>
#include <sinew/engine/particle_rows.h>
#include <sinew/rig/motion.h>
#include <sinew/world/world.h>

namespace sinew {

struct EngineFolder {
  std::filesystem::path path;

  std::filesystem::path setup() const { return path / "setup"; }
  std::filesystem::path particles() const { return path / "particles"; }
  std::filesystem::path poses() const { return path / "poses"; }
  std::filesystem::path state(std::int64_t steps) const {
    return path / ("state_" + std::to_string(steps));
  }
  std::filesystem::path piece(const char* kind, std::int64_t steps, int rank) const {
    return path / (std::string(kind) + '_' + std::to_string(steps) + '.' + std::to_string(rank));
  }
  std::filesystem::path log() const { return path / "log.lammps"; }
};

/// Frames in whose files each rank writes its part of the particles, as a piece.
struct EnginePieces {
  std::string folder;  ///< folder of the run
  Encoding encoding = Encoding::zlib;
  bool double_precision = false;
  std::vector<std::string> arrays;  ///< empty: all
  std::int32_t every = 1;           ///< number of frames of which one is written
};

/// A moment of a run, without its particles.
struct EngineMoment {
  std::int64_t steps = 0;
  bool kicked = false;  ///< velocities are half a step behind positions (velocity Verlet)
  Ledgers ledgers;
  std::vector<std::uint64_t> particles;  ///< on each rank
  bool in_frame = false;                 ///< they are written in the file of this moment's frame
  std::string engine;                    ///< which version of which
};

struct EngineSetup {
  std::uint64_t particles = 0;
  RowShape shape;
  Material material;
  Skeleton skeleton;
  Motion motion;
  std::vector<BoneSprings> springs;
  Stepping stepping;  ///< with the whole step of the plan
  int steps_per_frame = 0, frames = 0;
  std::vector<int> parts;  ///< parts of each frame's steps, see StepPlan
  std::optional<WholeSteps> last;
  EngineMoment start;
  bool with_forces = false;
  std::optional<EnginePieces> pieces;
  std::optional<World> world;  ///< without motions

  StepPlan plan() const { return StepPlan(stepping.step, steps_per_frame, parts, last); }
};

/// A run that is to be stepped elsewhere.
struct EngineRun {
  const Body& body;
  const Motion& motion;
  const Stepping& stepping;
  const StepPlan& plan;
  int steps_per_frame, frames;
  double mass;                        ///< mass of a particle, kg
  const SimulationState& state;       ///< where it begins, in double precision
  std::span<const std::int32_t> ids;  ///< ids of the particles in the caller's order
  bool with_forces = false;
  std::optional<EnginePieces> pieces = {};  ///< none: frames are written by whoever reads states
};

/// Writes setup and particles into the folder, which is created. Throws not written, and bad input
/// for surroundings and materials that engines do not know.
void write_engine_run(const EngineFolder& folder, const EngineRun& run);

EngineSetup read_engine_setup(const EngineFolder& folder);

/// A particle as it comes from the file; the row is valid during the call.
struct EngineParticle {
  std::int32_t id;
  Vec3 position, velocity;
  const double* row;
};

/// Calls visit for every particle, by id, a piece of the file at a time.
void for_each_engine_particle(const EngineFolder& folder, const EngineSetup& setup,
                              const std::function<void(const EngineParticle&)>& visit);

/// One rank's part of a state or of its forces: rows of `width` numbers, the id first.
void write_engine_piece(const std::filesystem::path& file, const std::vector<double>& numbers);
std::vector<double> read_engine_piece(const std::filesystem::path& file);
inline constexpr std::size_t state_width = 7, forces_width = 14;

void write_engine_moment(const EngineFolder& folder, const EngineMoment& moment);
EngineMoment read_engine_moment(const EngineFolder& folder, std::int64_t steps);

/// The state after so many steps: `like` (of the same simulation) at that moment. Throws bad input
/// where a particle is missing.
SimulationState read_engine_state(const EngineFolder& folder, std::int64_t steps,
                                  const SimulationState& like, std::span<const std::int32_t> ids);

/// Removes the files of a state.
void remove_engine_state(const EngineFolder& folder, std::int64_t steps, int ranks);

}  // namespace sinew
