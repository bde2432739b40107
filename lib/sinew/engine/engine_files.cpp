// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/engine/engine_files.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include <sinew/body/solid.h>
#include <sinew/body/volume_weights.h>
#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/engine/detail/serialize.h>
#include <sinew/engine/engine_world.h>
#include <sinew/material/laws.h>
#include <sinew/world/features.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t particles_per_piece = 4096;
constexpr std::uint64_t max_bytes = std::uint64_t{1} << 40;  // 1 TiB: 512 for each id of 31 bits

std::size_t max_in_a_row(const NeighborLists& lists) {
  std::size_t most = 0;
  for (std::size_t i = 0; i < lists.size(); ++i) most = std::max(most, lists.of(i).size());
  return most;
}

/// The rows of all particles, by id.
class Rows {
 public:
  explicit Rows(const Body& body) : body_(body) {
    const SharedNeighbors near = neighbors_of(body);
    if (law_of(body.material).has_memory) {
      std::vector<std::int32_t> ids(body.rest.size());
      for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<std::int32_t>(i);
      bonds_ = make_bonds(body.rest, near->all(), body.material, ids, body.factors);
    }
    if (body.material.volume_stiffness > 0)
      volume_weights_ = body.factors.volume_weight.empty()
                            ? own_volume_weights(body.rest, near->nearest, body.material.pair.r)
                            : body.factors.volume_weight;
    for (std::size_t i = 0; i < body.rest.size(); ++i)
      shape_.bones = std::max(shape_.bones, static_cast<std::int32_t>(body.binding.of(i).size()));
    shape_.nearest = static_cast<std::int32_t>(max_in_a_row(bonds_.nearest.neighbors));
    shape_.second = static_cast<std::int32_t>(max_in_a_row(bonds_.second.neighbors));
  }

  const RowShape& shape() const { return shape_; }

  void put(std::size_t i, double* to) const {
    const auto bones = body_.binding.of(i);
    std::copy_n(body_.rest[i].data(), 3, to);
    to[3] = static_cast<double>(bones.size());
    to[4] = count(bonds_.nearest, i);
    to[5] = count(bonds_.second, i);
    to[6] = volume_weights_.empty() ? 0 : volume_weights_[i];
    double* at = to + RowShape::head;
    for (const Influence& one : bones)
      for (const double number : {static_cast<double>(one.bone), one.weight, one.foot})
        *at++ = number;
    at = to + RowShape::head + RowShape::of_bone * static_cast<std::size_t>(shape_.bones);
    put(bonds_.nearest, i, at);
    put(bonds_.second, i, at);
  }

 private:
  static double count(const Bonds& bonds, std::size_t i) {
    return bonds.neighbors.size() == 0 ? 0 : static_cast<double>(bonds.neighbors.of(i).size());
  }
  static void put(const Bonds& bonds, std::size_t i, double*& at) {
    if (bonds.neighbors.size() == 0) return;
    for (std::uint32_t e = bonds.neighbors.first[i]; e < bonds.neighbors.first[i + 1]; ++e)
      for (const double number : {static_cast<double>(bonds.neighbors.neighbor[e]),
                                  bonds.rest_length[e], bonds.stiffness[e]})
        *at++ = number;
  }

  const Body& body_;
  SolidBonds bonds_;
  std::vector<double> volume_weights_;
  RowShape shape_;
};

/// Finds the place of each particle, by id, in the columns of a state.
std::vector<std::uint32_t> places_of(const SimulationState& state,
                                     std::span<const std::int32_t> ids) {
  std::vector<std::uint32_t> place(ids.size());
  for (std::size_t k = 0; k < place.size(); ++k) {
    const std::size_t in_order = state.order.empty() ? k : state.order[k];
    place[static_cast<std::size_t>(ids[in_order])] = static_cast<std::uint32_t>(k);
  }
  return place;
}

void write_particles(const fs::path& file, const EngineRun& run, const Rows& rows) {
  const auto& moving = std::get<MovingInDouble>(run.state.moving);
  const std::vector<std::uint32_t> place = places_of(run.state, run.ids);
  const std::size_t width = 6 + rows.shape().size();
  NewFile out(file);
  std::vector<double> piece;
  for (std::size_t begin = 0; begin < place.size(); begin += particles_per_piece) {
    const std::size_t end = std::min(begin + particles_per_piece, place.size());
    piece.assign((end - begin) * width, 0);
    for (std::size_t i = begin; i < end; ++i) {
      double* row = piece.data() + (i - begin) * width;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        row[axis] = run.state.fixed_point_units.origin[axis] + moving.x[axis][place[i]];
        row[3 + axis] = moving.v[axis][place[i]];
      }
      rows.put(i, row + 6);
    }
    out.write(piece.data(), piece.size() * sizeof(double));
  }
  out.finish();
}

template <class Value>
Value read_archive(const fs::path& file) {
  try {
    return unarchived<Value>(read_file(file, max_bytes));
  } catch (const Error& error) {
    if (std::string_view(error.what()).starts_with(file.string())) throw;
    throw error.with_context({file.string()});
  }
}

Error not_a_piece(const fs::path& file) {
  return bad_input(Place{file.string()}, "is no complete piece of a state", "start the run again");
}

}  // namespace

void write_engine_run(const EngineFolder& folder, const EngineRun& run) {
  refuse_conflicts(Feature::lammps, features_of(run.body));
  create_inner_folder(folder.path);
  const Rows rows(run.body);
  EngineSetup setup;
  setup.particles = run.body.rest.size();
  setup.shape = rows.shape();
  setup.material = run.body.material;
  setup.material.mass = run.mass;
  setup.skeleton = run.body.skeleton;
  setup.motion = run.motion;
  setup.springs = run.body.springs;
  setup.stepping = run.stepping;
  setup.steps_per_frame = run.steps_per_frame;
  setup.frames = run.frames;
  for (int frame = 0; frame < run.frames; ++frame) setup.parts.push_back(run.plan.parts(frame));
  setup.last = run.plan.last();
  setup.start.steps = run.state.steps;
  setup.start.kicked = run.state.kicked;
  setup.start.ledgers = part_of<Ledgers>(run.state, ledgers_part);
  setup.with_forces = run.with_forces;
  setup.pieces = run.pieces;
  write_particles(folder.particles(), run, rows);
  if (run.body.world) {
    const World& world = *run.body.world;
    setup.world = engine_world(world);
    const StepPlan plan = setup.plan();
    const std::int64_t first = run.state.steps;
    const std::int64_t last = run.frames > 0 ? plan.steps_until(run.frames) : first;
    if (!world.obstacles.empty() || !world.supports.empty())
      write_engine_poses(folder.poses(), world, setup.skeleton, setup.motion, plan, first, last);
  }
  write_file(folder.setup(), archived(setup));
}

EngineSetup read_engine_setup(const EngineFolder& folder) {
  return read_archive<EngineSetup>(folder.setup());
}

void for_each_engine_particle(const EngineFolder& folder, const EngineSetup& setup,
                              const std::function<void(const EngineParticle&)>& visit) {
  const std::size_t width = 6 + setup.shape.size();
  std::ifstream file(folder.particles(), std::ios::binary);
  std::vector<double> piece;
  for (std::size_t begin = 0; begin < setup.particles; begin += particles_per_piece) {
    const std::size_t end = std::min<std::size_t>(begin + particles_per_piece, setup.particles);
    piece.resize((end - begin) * width);
    const auto bytes = static_cast<std::streamsize>(piece.size() * sizeof(double));
    if (!file.read(reinterpret_cast<char*>(piece.data()), bytes))
      throw bad_input(Place{folder.particles().string()}, "is truncated or missing",
                      "start the run again");
    for (std::size_t i = begin; i < end; ++i) {
      const double* row = piece.data() + (i - begin) * width;
      visit({static_cast<std::int32_t>(i),
             {row[0], row[1], row[2]},
             {row[3], row[4], row[5]},
             row + 6});
    }
  }
}

void write_engine_piece(const fs::path& file, const std::vector<double>& numbers) {
  write_file(file,
             {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)});
}

std::vector<double> read_engine_piece(const fs::path& file) {
  const std::string bytes = read_file(file, max_bytes);
  if (bytes.size() % sizeof(double) != 0) throw not_a_piece(file);
  std::vector<double> numbers(bytes.size() / sizeof(double));
  if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

void write_engine_moment(const EngineFolder& folder, const EngineMoment& moment) {
  write_file(folder.state(moment.steps), archived(moment));
}

EngineMoment read_engine_moment(const EngineFolder& folder, std::int64_t steps) {
  return read_archive<EngineMoment>(folder.state(steps));
}

SimulationState read_engine_state(const EngineFolder& folder, std::int64_t steps,
                                  const SimulationState& like, std::span<const std::int32_t> ids) {
  const EngineMoment moment = read_engine_moment(folder, steps);
  SimulationState state = like;
  state.steps = moment.steps;
  state.kicked = moment.kicked;
  put_part(state, ledgers_part, moment.ledgers);
  auto& moving = std::get<MovingInDouble>(state.moving);
  const std::vector<std::uint32_t> place = places_of(state, ids);
  std::size_t found = 0;
  for (std::size_t rank = 0; rank < moment.particles.size(); ++rank) {
    const fs::path file = folder.piece("state", steps, static_cast<int>(rank));
    const std::vector<double> piece = read_engine_piece(file);
    if (piece.size() != moment.particles[rank] * state_width) throw not_a_piece(file);
    for (std::size_t k = 0; k < piece.size(); k += state_width, ++found) {
      if (!(piece[k] >= 0 && piece[k] < static_cast<double>(place.size()))) throw not_a_piece(file);
      const std::uint32_t at = place[static_cast<std::size_t>(piece[k])];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        moving.x[axis][at] = piece[k + 1 + axis] - state.fixed_point_units.origin[axis];
        moving.v[axis][at] = piece[k + 4 + axis];
      }
    }
  }
  if (found != place.size())
    throw bad_input(
        Place{folder.state(steps).string()},
        "has " + std::to_string(found) + " of " + std::to_string(place.size()) + " particles",
        "start the run again");
  return state;
}

void remove_engine_state(const EngineFolder& folder, std::int64_t steps, int ranks) {
  std::error_code missing;
  fs::remove(folder.state(steps), missing);
  for (int rank = 0; rank < ranks; ++rank)
    for (const char* kind : {"state", "forces"})
      fs::remove(folder.piece(kind, steps, rank), missing);
}

}  // namespace sinew
