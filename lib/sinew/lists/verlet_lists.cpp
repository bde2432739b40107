// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/verlet_lists.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/core/system.h>
#include <sinew/lists/subpiece_survey.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

// In diameters, by measurement: longer lists cost every step, shorter ones are made more often. The
// inner skin excludes second neighbors of a packed body. Contacts are few: theirs may be longer.
constexpr double outer_skin = 0.9, inner_skin = 0.1;
constexpr double outer_skin_of_contacts = 0.9, inner_skin_of_contacts = 0.3;
// Steps between surveys, by measurement: lists of contacts last longer.
constexpr int survey_steps = 8, survey_steps_of_contacts = 16;
constexpr std::size_t pieces_at_a_time = 4;
constexpr std::size_t pieces_in_sample = 256;
using kernel::blocks_per_piece;

}  // namespace

template <class Real>
VerletLists<Real>::VerletLists(const kernel::Functions<Real>& kernel, const Material& material,
                               double step)
    : kernel_(kernel),
      contacts_(law_of(material).has_memory),
      looks_(material.bond.yield_shear > 0),
      step_(step) {
  const double diameter = 2 * material.pair.r, range = law_of(material).range(material);
  if (contacts_)
    wanted_ = {range, range * (1 + inner_skin_of_contacts), range * (1 + outer_skin_of_contacts),
               survey_steps_of_contacts};
  else
    wanted_ = {range, range + inner_skin * diameter, range + outer_skin * diameter, survey_steps};
}

template <class Real>
VerletLists<Real> VerletLists<Real>::cleared(double step) const {
  VerletLists lists;
  lists.kernel_ = kernel_;
  lists.contacts_ = contacts_;
  lists.passing_ = passing_;
  lists.looks_ = looks_;
  lists.wanted_ = wanted_;
  lists.step_ = step;
  lists.counts_ = counts_;
  return lists;
}

template <class Real>
void VerletLists<Real>::let_pass(const Body& body, std::span<const std::int32_t> id) {
  passing_ = PassingPairs(body, id);
}

template <class Real>
double VerletLists<Real>::mean(const std::vector<OffsetLists>& lists) {
  std::size_t values = 0, blocks = 0;
  for (const OffsetLists& piece : lists)
    if (!piece.first.empty()) values += piece.value.size(), blocks += piece.first.size() - 1;
  return blocks == 0 ? 0 : static_cast<double>(values) / static_cast<double>(blocks);
}

template <class Real>
void VerletLists<Real>::make(BlockState<Real>& state, Subpieces subpieces,
                             const BondLists<Real>& bonds, const Units& units,
                             const GroupedParticles& groups) {
  make_each(1, state, std::move(subpieces), bonds, units, groups);
  ++counts_.rebuilds;
}

template <class Real>
void VerletLists<Real>::make_some(BlockState<Real>& state, Subpieces subpieces,
                                  const BondLists<Real>& bonds, const Units& units) {
  const std::size_t pieces = (state.blocks() + blocks_per_piece - 1) / blocks_per_piece;
  make_each(1 + pieces / pieces_in_sample, state, std::move(subpieces), bonds, units, {});
  if (whole_) ++counts_.rebuilds;
}

template <class Real>
void VerletLists<Real>::make_each(std::size_t nth, BlockState<Real>& state, Subpieces subpieces,
                                  const BondLists<Real>& bonds, const Units& units,
                                  const GroupedParticles& groups) {
  whole_ = nth == 1;
  of_ = std::move(subpieces);
  ranges_ = {wanted_.force / units.length, wanted_.inner / units.length,
             wanted_.outer / units.length, wanted_.steps};
  time_ = step_ / units.time;
  const std::size_t pieces = (state.blocks() + blocks_per_piece - 1) / blocks_per_piece;
  motions_.assign(of_.size(), {});
  speed_.assign(of_.size(), 0);
  centers_.assign(of_.size(), Vec3::Zero());
  axes_.assign(of_.size(), Mat3::Identity());
  fastest_.assign(of_.size(), 0);
  outer_.assign(pieces, {});
  inner_.assign(pieces, {});
  arrays_.assign(pieces, {});
  boxes_.resize(pieces);
  boxed_.assign(pieces, -1);
  listed_at_.assign(pieces, 0);
  pruned_at_.assign(pieces, 0);
  looked_.assign(pieces, 0);
  near_ = NearPieces(ranges_, groups_of_subpieces(groups), looks_);
  grouped_.assign(pieces, 0);
  for (std::size_t piece = 0; piece < groups.of_piece.size(); ++piece)
    grouped_[piece] = groups.of_piece[piece] >= 0 ? 1 : 0;
  survey(state, groups);
  std::vector<std::uint32_t> some;
  for (std::size_t piece = 0; piece < pieces; piece += nth)
    some.push_back(static_cast<std::uint32_t>(piece));
  list(state, bonds, some, groups);
}

/// Returns the only group of the piece of each subpiece, or -1; empty without groups.
template <class Real>
std::vector<std::int32_t> VerletLists<Real>::groups_of_subpieces(
    const GroupedParticles& groups) const {
  std::vector<std::int32_t> of_subpieces;
  for (const std::uint32_t piece : of_.piece)
    if (!groups.of_piece.empty()) of_subpieces.push_back(groups.of_piece[piece]);
  return of_subpieces;
}

/// What lists of these pieces are made from.
template <class Real>
void VerletLists<Real>::show_around(const std::vector<std::uint32_t>& pieces,
                                    const GroupedParticles& groups) const {
  std::vector<std::uint32_t> around;
  for (const std::uint32_t piece : pieces)
    for (const std::uint32_t near : pieces_near(piece)) around.push_back(near);
  groups.show(around);
}

/// Adds pieces of groups that have shrunk so much that particles of theirs may have come within
/// range of each other; those that only touch never do (stretch_range).
template <class Real>
void VerletLists<Real>::add_strained(const GroupedParticles& groups,
                                     std::vector<std::uint32_t>& to_list,
                                     std::vector<std::uint32_t>& to_prune) const {
  const double force = ranges_.force * (1 + 1e-5);  // above rounding
  const double to_outer = std::log(ranges_.outer / force),
               to_inner = std::log(ranges_.inner / force);
  for (std::uint32_t piece = 0; piece < groups.of_piece.size(); ++piece) {
    if (groups.of_piece[piece] < 0) continue;
    if (groups.working[piece] == 0 && !meets_others(piece)) continue;
    const double strain = groups.strain[piece];
    if (!(strain - listed_at_[piece] < to_outer))
      to_list.push_back(piece);
    else if (!(strain - pruned_at_[piece] < to_inner))
      to_prune.push_back(piece);
  }
}

template <class Real>
kernel::Subpieces<Real> VerletLists<Real>::subpieces() {
  return {of_.first.data(), of_.of_block.data(), static_cast<std::uint32_t>(of_.size()),
          motions_.data(), fastest_.data()};
}

template <class Real>
void VerletLists<Real>::add_moved(std::size_t piece, double moved) {
  for_each_subpiece(piece, [&](std::uint32_t subpiece) {
    const double speed = std::sqrt(static_cast<double>(fastest_[subpiece])) + moved / time_;
    fastest_[subpiece] = static_cast<Real>(speed * speed);
  });
}

template <class Real>
bool VerletLists<Real>::meets_others(std::size_t piece) const {
  bool any = false;
  for_each_subpiece(piece,
                    [&](std::uint32_t subpiece) { any = any || !near_.others(subpiece).empty(); });
  return any;
}

namespace {

void sort_once(std::vector<std::uint32_t>& pieces) {
  std::sort(pieces.begin(), pieces.end());
  pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
}

}  // namespace

template <class Real>
std::vector<std::uint32_t> VerletLists<Real>::pieces_of(
    const std::vector<std::uint32_t>& subpieces) const {
  std::vector<std::uint32_t> pieces;
  pieces.reserve(subpieces.size());
  for (const std::uint32_t subpiece : subpieces) pieces.push_back(of_.piece[subpiece]);
  return pieces;
}

/// Finds the pieces that any of its subpieces is near, itself included, ascending. Particles of a
/// group never touch each other: contacts are with others alone, and without any, nothing is near.
template <class Real>
std::vector<std::uint32_t> VerletLists<Real>::pieces_near(std::size_t piece) const {
  std::vector<std::uint32_t> pieces;
  const bool with_others = contacts_ && grouped_[piece] != 0;
  if (with_others && meets_others(piece)) pieces.push_back(static_cast<std::uint32_t>(piece));
  for_each_subpiece(piece, [&](std::uint32_t subpiece) {
    if (with_others)
      for (const auto& near : near_.others(subpiece)) pieces.push_back(of_.piece[near.piece]);
    else
      for (const std::uint32_t near : near_.of(subpiece)) pieces.push_back(of_.piece[near]);
  });
  sort_once(pieces);
  return pieces;
}

namespace {

/// Where a bond broke: its particles now touch like others.
void add_broken(std::span<const kernel::Totals> totals, std::vector<std::uint32_t>& to_list) {
  for (std::uint32_t piece = 0; piece < totals.size(); ++piece)
    if (totals[piece].broke) to_list.push_back(piece);
}

}  // namespace

template <class Real>
void VerletLists<Real>::follow(BlockState<Real>& state, const BondLists<Real>& bonds,
                               const Units& units, std::span<const kernel::Totals> totals,
                               const GroupedParticles& groups) {
  Stopwatch watch;
  ++moment_;
  if (!near_.advance(fastest_of_subpieces(), time_)) return make(state, of_, bonds, units, groups);
  if (near_.survey_due())
    survey(state, groups);
  else
    move_fields();
  std::vector<std::uint32_t> listed = pieces_of(near_.to_list()),
                             pieces = pieces_of(near_.to_prune());
  if (!contacts_) add_strained(groups, listed, pieces);
  add_broken(totals, listed);
  for (std::uint32_t piece = 0; piece < totals.size() && looks_; ++piece)
    if (totals[piece].broke)
      for (const std::uint32_t near : pieces_near(piece)) looked_[near] = 0;
  counts_.checking += watch.lap();
  sort_once(listed), sort_once(pieces);
  list(state, bonds, listed, groups);
  watch.lap();
  std::erase_if(pieces, [&](std::uint32_t piece) {
    return std::binary_search(listed.begin(), listed.end(), piece);
  });
  show_around(pieces, groups);
  changed_.insert(changed_.end(), pieces.begin(), pieces.end());
  parallel_for(pieces.size(), pieces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) prune(state, pieces[k], groups);
  });
  counts_.pruned += static_cast<std::int64_t>(pieces.size());
  counts_.pruning += watch.lap();
}

template <class Real>
std::vector<std::uint32_t> VerletLists<Real>::to_look_at(
    const std::function<bool(std::size_t)>& flows) const {
  std::vector<std::uint32_t> pieces = pieces_of(near_.to_look_at());
  for (std::uint32_t piece = 0; piece < looked_.size(); ++piece) {
    if (looked_[piece] == 0) pieces.push_back(piece);
    if (looked_[piece] == 0 || !flows(piece)) continue;
    const std::vector<std::uint32_t> near = pieces_near(piece);
    pieces.insert(pieces.end(), near.begin(), near.end());
  }
  sort_once(pieces);
  return pieces;
}

template <class Real>
void VerletLists<Real>::looked_at(std::size_t piece, double still) {
  looked_[piece] = 1;
  for_each_subpiece(piece, [&](std::uint32_t subpiece) { near_.looked_at(subpiece, still); });
}

template <class Real>
void VerletLists<Real>::find_boxes_around(BlockState<Real>& state,
                                          const std::vector<std::uint32_t>& pieces) {
  std::vector<std::uint32_t> old;
  for (const std::uint32_t piece : pieces)
    for (const std::uint32_t near : pieces_near(piece))
      if (std::exchange(boxed_[near], moment_) != moment_) old.push_back(near);
  parallel_for(old.size(), pieces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) find_boxes(kernel_, state, old[k], boxes_);
  });
}

template <class Real>
void VerletLists<Real>::list(BlockState<Real>& state, const BondLists<Real>& bonds,
                             const std::vector<std::uint32_t>& pieces,
                             const GroupedParticles& groups) {
  if (pieces.empty()) return;
  Stopwatch watch;
  show_around(pieces, groups);
  changed_.insert(changed_.end(), pieces.begin(), pieces.end());
  find_boxes_around(state, pieces);
  parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t piece = pieces[k];
      const std::vector<std::uint32_t> near = pieces_near(piece);
      outer_[piece] = near.empty()
                          ? OffsetLists{std::vector<std::uint32_t>(blocks_per_piece + 1, 0), {}, {}}
                          : find_offsets(kernel_, state, piece, near, boxes_, ranges_.outer);
      if (contacts_) remove_bonded(bonds, piece, outer_[piece]);
      if (passing_.any()) passing_.remove<Real>(piece, outer_[piece]);
      if (contacts_ || passing_.any()) {
        outer_[piece] = prune_offsets(kernel_, state, piece, outer_[piece], ranges_.outer);
      }
      for_each_subpiece(piece, [&](std::uint32_t subpiece) { near_.listed(subpiece); });
      if (!groups.of_piece.empty() && groups.of_piece[piece] >= 0)
        listed_at_[piece] = groups.strain[piece];
      prune(state, piece, groups);
    }
  });
  counts_.listed += static_cast<std::int64_t>(pieces.size());
  counts_.rebuilding += watch.lap();
}

template <class Real>
void VerletLists<Real>::prune(BlockState<Real>& state, std::size_t piece,
                              const GroupedParticles& groups) {
  inner_[piece] = prune_offsets(kernel_, state, piece, outer_[piece], ranges_.inner);
  arrays_[piece] = inner_[piece].arrays();
  for_each_subpiece(piece, [&](std::uint32_t subpiece) { near_.pruned(subpiece); });
  if (!groups.of_piece.empty() && groups.of_piece[piece] >= 0)
    pruned_at_[piece] = groups.strain[piece];
}

template <class Real>
Box VerletLists<Real>::box_of(std::size_t piece, const Units& units) const {
  Box box;
  for_each_subpiece(piece,
                    [&](std::uint32_t subpiece) { box.extend(near_.box_of(subpiece, elapsed_)); });
  box.min() = units.origin + units.length * box.min();
  box.max() = units.origin + units.length * box.max();
  return box;
}

template <class Real>
ListCounts VerletLists<Real>::counts() const {
  ListCounts counts = counts_;
  counts.outer = mean(outer_);
  counts.inner = mean(inner_);
  return counts;
}

// The velocity fields of the subpieces of neighbor lists: found now and then, and how far particles
// of each may have moved from them in a step.

namespace {

constexpr std::size_t subpieces_at_a_time = 4;

/// Rounding of the kernel's velocity fields, as a fraction of their speed.
template <class Real>
constexpr double rounding = sizeof(Real) == 4 ? 1e-6 : 1e-14;

}  // namespace

/// Surveys a subpiece, at its places.
template <class Real>
PieceNow VerletLists<Real>::survey(std::size_t subpiece, BlockState<Real>& state) {
  const auto arrays = state.arrays();
  const std::size_t begin = of_.first[subpiece], end = of_.first[subpiece + 1];
  kernel::SurveyInput<Real> input{arrays, begin, end, {}};
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis)
      input.axes[k][axis] = static_cast<Real>(axes_[subpiece](axis, k));
  auto& center = motions_[subpiece].center;
  for (int axis = 0; axis < 3; ++axis) center[axis] = arrays.x[axis][(begin + end) / 2];
  const Vec3 middle(static_cast<double>(center[0]), static_cast<double>(center[1]),
                    static_cast<double>(center[2]));
  const kernel::Survey found = kernel_.survey(input, center);
  return motion_of(found, end - begin, middle,
                   std::exchange(axes_[subpiece], axes_of(found, end - begin)), rounding<Real>);
}

/// Finds out how all subpieces move.
template <class Real>
void VerletLists<Real>::survey(BlockState<Real>& state, const GroupedParticles& groups) {
  std::vector<PieceNow> subpieces(of_.size());
  const auto is_of_group = [&](std::size_t subpiece) {
    return !groups.of_piece.empty() && groups.of_piece[of_.piece[subpiece]] >= 0;
  };
  std::vector<std::uint32_t> others;
  for (std::uint32_t subpiece = 0; subpiece < subpieces.size(); ++subpiece)
    if (!is_of_group(subpiece)) others.push_back(of_.piece[subpiece]);
  groups.show(others);
  parallel_for(subpieces.size(), subpieces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t subpiece = begin; subpiece < end; ++subpiece) {
      auto& motion = motions_[subpiece];
      PieceNow& now = subpieces[subpiece];
      now = is_of_group(subpiece) ? groups.piece_now(of_.piece[subpiece]) : survey(subpiece, state);
      for (int axis = 0; axis < 3; ++axis) {
        motion.velocity[axis] = static_cast<Real>(now.velocity[axis]);
        motion.spin[axis] = static_cast<Real>(now.spin[axis]);
        now.velocity[axis] = static_cast<double>(motion.velocity[axis]);
        now.spin[axis] = static_cast<double>(motion.spin[axis]);
      }
      centers_[subpiece] = now.center;
      place_field(subpiece, now.center);
      speed_[subpiece] = now.velocity.norm() + now.spin.norm() * now.box.diagonal().norm();
    }
  });
  near_.survey(std::move(subpieces), time_);
  elapsed_ = 0;
  ++counts_.surveys;
}

template <class Real>
void VerletLists<Real>::place_field(std::size_t subpiece, const Vec3& at) {
  for (int axis = 0; axis < 3; ++axis)
    if constexpr (sizeof(Real) == 4)
      motions_[subpiece].center[axis] =
          static_cast<std::int32_t>(static_cast<std::int64_t>(std::nearbyint(at[axis])));
    else
      motions_[subpiece].center[axis] = at[axis];
}

/// The velocity fields travel with the common velocity.
template <class Real>
void VerletLists<Real>::move_fields() {
  elapsed_ += time_;
  for (std::size_t subpiece = 0; subpiece < motions_.size(); ++subpiece)
    place_field(subpiece, centers_[subpiece] + elapsed_ * near_.common_velocity());
}

/// How much faster than by a rigid motion particles within reach of each other may part, since a
/// step takes them along straight lines.
template <class Real>
double VerletLists<Real>::lengthening(std::size_t subpiece) const {
  const Eigen::Map<const Eigen::Matrix<Real, 3, 1>> spin(motions_[subpiece].spin);
  return spin.template cast<double>().squaredNorm() * time_ / 2 * ranges_.outer;
}

/// In the last step, relative to their fields, at most.
template <class Real>
std::vector<double> VerletLists<Real>::fastest_of_subpieces() const {
  // Fixed-point coordinates are rounded to the nearest unit along each axis, and so are the centers
  // of the velocity fields.
  const double unit = sizeof(Real) == 4 ? 2 / time_ : 0;
  std::vector<double> fastest(of_.size());
  for (std::size_t subpiece = 0; subpiece < fastest.size(); ++subpiece)
    fastest[subpiece] = std::sqrt(static_cast<double>(fastest_[subpiece])) * (1 + 1e-5) + unit +
                        rounding<Real> * speed_[subpiece] + (looks_ ? lengthening(subpiece) : 0);
  return fastest;
}

template class VerletLists<double>;
template class VerletLists<float>;

}  // namespace sinew
