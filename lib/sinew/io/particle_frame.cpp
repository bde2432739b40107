// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/particle_frame.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_piece = 4096;

bool in_order(const std::vector<std::int32_t>& ids) {
  return parallel_sum(ids.size(), particles_per_piece, [&](auto begin, auto end) {
           double elsewhere = 0;
           for (std::size_t i = begin; i < end; ++i)
             elsewhere += std::cmp_not_equal(ids[i], i) ? 1 : 0;
           return elsewhere;
         }) == 0;
}

/// A row of the file and its particle.
struct Row {
  std::size_t number, id;
  std::size_t place;  ///< in the order of the particles
};

/// The particle of each row of the file.
class Rows {
 public:
  Rows(const std::vector<std::int32_t>& id_of_place, std::span<const std::int32_t> ids)
      : ids_(ids), all_(id_of_place.size()) {
    if (in_order(id_of_place)) return;
    place_.resize(all_);
    for (std::size_t i = 0; i < all_; ++i)
      place_[static_cast<std::size_t>(id_of_place[i])] = static_cast<std::uint32_t>(i);
  }

  std::size_t size() const { return ids_.empty() ? all_ : ids_.size(); }
  Row operator[](std::size_t row) const {
    const std::size_t id = ids_.empty() ? row : static_cast<std::size_t>(ids_[row]);
    return {row, id, place_.empty() ? id : place_[id]};
  }

 private:
  std::span<const std::int32_t> ids_;
  std::size_t all_;
  std::vector<std::uint32_t> place_;  ///< index: particle id; empty where ids are in order
};

/// The columns of a frame, computed row by row.
class ParticleColumns {
 public:
  ParticleColumns(std::shared_ptr<const Rows> rows, const ParticleSelection& selection)
      : rows_(std::move(rows)), wanted_(selection.arrays) {}

  /// value(row) of each.
  template <class T, class Value>
  void add(const char* name, Value value) {
    if (!wants(name)) return;
    const auto put = [rows = rows_, value](std::size_t begin, std::size_t end, T* to) {
      for (std::size_t row = begin; row < end; ++row) *to++ = value((*rows)[row]);
    };
    columns_.push_back({name, 1, Computed<T>{rows_->size(), put}});
  }

  template <class Value>
  void add_vectors(const char* name, Value value) {
    if (!wants(name)) return;
    const auto put = [rows = rows_, value](std::size_t begin, std::size_t end, double* to) {
      for (std::size_t i = begin; i < end;) {
        const std::size_t row = i / 3;
        const Vec3 vector = value((*rows)[row]);
        for (std::size_t axis = i % 3; axis < 3 && i < end; ++axis, ++i)
          *to++ = vector[static_cast<Eigen::Index>(axis)];
      }
    };
    columns_.push_back({name, 3, Computed<double>{3 * rows_->size(), put}});
  }

  std::vector<ComputedColumn> columns() { return std::move(columns_); }

 private:
  bool wants(std::string_view name) const {
    return wanted_.empty() || std::find(wanted_.begin(), wanted_.end(), name) != wanted_.end();
  }

  std::shared_ptr<const Rows> rows_;
  const std::vector<std::string_view>& wanted_;
  std::vector<ComputedColumn> columns_;
};

std::vector<Column> columns_of(const Energies& energies, const Unbalanced& unbalanced) {
  const auto single = [](const char* name, double value) {
    return column(name, std::vector<double>{value});
  };
  std::vector<Column> columns = {
      single("kinetic_energy", energies.kinetic), single("pair_energy", energies.pair),
      single("bone_energy", energies.bone), single("gravity_energy", energies.gravity),
      single("contact_energy", energies.contact)};
  const Column of_motion[] = {single("work_of_bones", energies.work_of_bones),
                              single("dissipation", energies.dissipation),
                              single("work_of_world", energies.work_of_world)};
  if (!std::isnan(energies.dissipation))
    columns.insert(columns.end(), std::begin(of_motion), std::end(of_motion));
  const Column of_rest[] = {single("unbalanced_force", unbalanced.force),
                            single("unbalanced_moment", unbalanced.moment)};
  if (!std::isnan(unbalanced.force))
    columns.insert(columns.end(), std::begin(of_rest), std::end(of_rest));
  return columns;
}

/// `positions`: of the rows; where they are in memory must stay the same.
std::vector<ComputedColumn> columns_of(const ParticleFrame& frame, const Points& positions,
                                       ParticleColumns columns) {
  const auto add_forces = [&columns](const char* name, std::span<const Vec3> forces) {
    if (!forces.empty())
      columns.add_vectors(name, [forces](const Row& row) { return forces[row.place]; });
  };
  const auto add_counts = [&columns](const char* name, std::span<const std::int32_t> counts) {
    if (!counts.empty())
      columns.add<std::int32_t>(name, [counts](const Row& row) { return counts[row.place]; });
  };
  const Binding& binding = frame.binding;
  columns.add<std::int32_t>("id", [ids = frame.ids](const Row& row) {
    return ids.empty() ? static_cast<std::int32_t>(row.id) : ids[row.id];
  });
  columns.add<std::int32_t>("bone", [&binding](const Row& row) { return binding.bone(row.id); });
  if (!frame.material.empty())
    columns.add<std::int32_t>(
        "material", [material = frame.material](const Row& row) { return material[row.id]; });
  if (!frame.group.empty()) {
    columns.add<std::int32_t>("group",
                              [group = frame.group](const Row& row) { return group[row.id]; });
    columns.add<std::int32_t>("level",
                              [level = frame.level](const Row& row) { return level[row.id]; });
  }
  columns.add<double>("weight", [&binding](const Row& row) { return binding.weight(row.id); });
  columns.add<double>("radius", [radius = frame.now.radius](const Row&) { return radius; });
  columns.add_vectors("displacement",
                      [now = positions.data(), &rest = frame.rest](const Row& row) -> Vec3 {
                        return now[row.number] - rest[row.id];
                      });
  columns.add_vectors("velocity",
                      [&now = frame.now](const Row& row) { return now.velocity(row.place); });
  columns.add_vectors(
      "force",
      [pair = frame.force_pair, damping = frame.force_damping, bone = frame.force_bone,
       world = frame.force_world, group = frame.force_group](const Row& row) -> Vec3 {
        Vec3 sum = pair[row.place] + damping[row.place] + bone[row.place];
        if (!world.empty()) sum += world[row.place];
        if (!group.empty()) sum += group[row.place];
        return sum;
      });
  add_forces("force_pair", frame.force_pair);
  add_forces("force_damping", frame.force_damping);
  add_forces("force_bone", frame.force_bone);
  add_counts("neighbors", frame.neighbors);
  add_forces("force_world", frame.force_world);
  add_counts("broken_bonds", frame.broken_bonds);
  add_counts("limited", frame.limited);
  return columns.columns();
}

}  // namespace

Dataset particles_dataset(const ParticleFrame& frame, Points positions, Moment moment,
                          const ParticleSelection& selection) {
  assert(frame.now.id.size() == positions.size() && frame.rest.size() == positions.size());
  const auto rows = std::make_shared<const Rows>(frame.now.id, selection.ids);
  Dataset data;
  data.time = moment.time;
  data.cycle = moment.cycle;
  if (selection.ids.empty()) data.points = std::move(positions);
  for (const std::int32_t id : selection.ids)
    data.points.push_back(positions[static_cast<std::size_t>(id)]);
  data.connectivity = vertex_cells(rows->size());
  data.computed = columns_of(frame, data.points, ParticleColumns(rows, selection));
  data.field_columns = columns_of(frame.energies, frame.unbalanced);
  return data;
}

}  // namespace sinew
