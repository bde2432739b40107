// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/near_pieces.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t pieces_per_task = 16;
// Until the next survey, velocity fields may carry particles so far: in outer ranges, and in steps
// of the fastest one.
constexpr double min_travel = 0.125, travel_in_steps = 16;
// And particles of a piece may leave its field by so much: in outer ranges, and times what they did
// in the last step.
constexpr double min_drift = 0.06, drift_in_steps = 1.5;
// What a step may take particles without warning, in outer ranges: bonds that snap.
constexpr double jump = 0.06;
// Surveys serve after a drift by this fraction of the inner skin, but not every few steps.
constexpr double drift_fraction = 0.1;
constexpr double unknown = std::numeric_limits<double>::infinity();

Box expanded(Box box, double by) {
  box.min().array() -= by;
  box.max().array() += by;
  return box;
}

/// Finds the largest difference of two velocity fields in a box: it is convex, so a corner has it.
double largest_difference(const PieceNow& a, const PieceNow& b, const Box& box) {
  const Vec3 first = a.velocity_at(box.min()) - b.velocity_at(box.min());
  const Vec3 spin = a.spin - b.spin, sizes = box.sizes();
  const Vec3 along_x(0, spin.z() * sizes.x(), -spin.y() * sizes.x());
  const Vec3 along_y(-spin.z() * sizes.y(), 0, spin.x() * sizes.y());
  const Vec3 along_z(spin.y() * sizes.z(), -spin.x() * sizes.z(), 0);
  double most = 0;
  for (const Vec3& x : {first, Vec3(first + along_x)})
    for (const Vec3& y : {x, Vec3(x + along_y)})
      most = std::max({most, y.squaredNorm(), (y + along_z).squaredNorm()});
  return std::sqrt(most);
}

/// Finds that piece among those near one, which ascend, or null.
const NearPieces::Near* found(std::span<const NearPieces::Near> near, std::uint32_t piece) {
  const auto at = std::lower_bound(
      near.begin(), near.end(), piece,
      [](const NearPieces::Near& one, std::uint32_t number) { return one.piece < number; });
  return at != near.end() && at->piece == piece ? &*at : nullptr;
}

}  // namespace

NearPieces::Field NearPieces::field_of(std::size_t piece) const {
  const PieceNow& now = pieces_[piece];
  const Vec3 middle = now.box.center(), velocity = now.velocity_at(middle);
  const double radius = now.box.diagonal().norm() / 2 + std::sqrt(3.0) * (travel_ + drift_[piece]);
  return {middle, velocity, radius, (velocity - common_).norm() + now.spin.norm() * radius};
}

/// Relative to the common velocity, of any piece.
double NearPieces::find_fields() {
  double fastest = 0;
  fields_.clear();
  for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
    fields_.push_back(field_of(piece));
    fastest = std::max(fastest, fields_.back().speed);
  }
  return fastest;
}

/// How far particles may go until the next survey.
void NearPieces::find_limits(double time) {
  last_.resize(pieces_.size());
  drift_.clear();
  for (const double gone : last_)
    drift_.push_back(jump * ranges_.outer +
                     std::max(min_drift * ranges_.outer, drift_in_steps * ranges_.steps * gone));
  travel_ = min_travel * ranges_.outer;
  travel_ = std::max(travel_, travel_in_steps * find_fields() * time);
  fastest_point_ = find_fields();
  horizon_ = fastest_point_ > 0 ? travel_ / fastest_point_ : 0;
}

void NearPieces::survey(std::vector<PieceNow> pieces, double time) {
  parallel_for(near_.size(), pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) rebase_margins(piece);
  });
  pieces_ = std::move(pieces);
  for (PieceNow& piece : pieces_) {
    if (piece.along.isEmpty()) {
      piece.axes.setIdentity();
      piece.along = Box(Vec3(piece.box.min() - piece.center), Vec3(piece.box.max() - piece.center));
    }
    piece.along.sizes().minCoeff(&piece.shortest);
  }
  gone_.assign(pieces_.size(), 0);
  elapsed_ = 0;
  common_.setZero();
  for (const PieceNow& piece : pieces_)
    common_ += piece.velocity_at(piece.box.center()) / static_cast<double>(pieces_.size());
  traveled_ = drifted_ = 0;
  steps_ = 0;
  find_limits(time);
  tree_ = PieceTree(pieces_, drift_, bound_to_);
  near_.resize(pieces_.size());
  spare_.assign(pieces_.size(), {});
  parallel_for(pieces_.size(), pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      find_near(piece);
      find_rates(piece);
    }
  });
  parallel_for(pieces_.size(), pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) copy_rates(piece);
    for (std::size_t piece = begin; piece < end; ++piece) find_spare(piece);
  });
}

/// How fast particles of two pieces may approach: as anywhere around the first one's.
double NearPieces::fastest_approach(std::size_t piece, std::size_t other) const {
  const Field &one = fields_[piece], &two = fields_[other];
  const Vec3& spin = pieces_[other].spin;
  const Vec3 there = two.velocity + spin.cross(one.middle - two.middle);
  return std::min(one.speed + two.speed,
                  (one.velocity - there).norm() + (pieces_[piece].spin - spin).norm() * one.radius);
}

/// The gap between two pieces, if particles of both may come within the outer range of each other
/// before the next survey; else something larger than that range.
double NearPieces::gap_within(std::size_t piece, std::size_t other) const {
  const PieceNow &one = pieces_[piece], &two = pieces_[other];
  const double near = ranges_.outer + drift_[piece] + drift_[other];
  double reach = 0;  // found where something is not near
  const auto may_come_near = [&](double gap) {
    if (gap < near) return true;
    if (reach == 0) reach = near + fastest_approach(piece, other) * (1 + 1e-6) * horizon_;
    return gap < reach;
  };
  // Most pieces are apart along a short side of one of them; the gap itself takes much longer.
  if (!may_come_near(std::max(gap_across(one, two), gap_across(two, one)))) return unknown;
  const double gap = gap_between(one, two);
  return may_come_near(gap) ? gap : unknown;
}

/// Calls visit(other, gap) for what is near a piece, but for what is bound to `group`.
template <class Visit>
void NearPieces::for_each_near(std::size_t piece, std::int32_t group, const Visit& visit) const {
  const double reach = (ranges_.outer + drift_[piece] + 2 * travel_) * (1 + 1e-6);
  tree_.for_each_near(pieces_[piece], reach, group, [&](std::uint32_t other) {
    if (const double gap = gap_within(piece, other); gap != unknown) visit(other, gap);
  });
}

std::vector<std::uint32_t> NearPieces::of(std::size_t piece) const {
  std::vector<std::uint32_t> near;
  if (group_of(piece) == unbound)
    for (const Near& one : near_[piece]) near.push_back(one.piece);
  else
    for_each_near(piece, unbound, [&](std::uint32_t other, double) { near.push_back(other); });
  return near;
}

/// What was not near has come no nearer than the outer range.
void NearPieces::find_near(std::size_t piece) {
  const std::vector<Near> before = std::move(near_[piece]);
  const double apart = ranges_.outer - ranges_.force;
  std::vector<Near>& near = near_[piece];
  near.clear();
  near.reserve(before.size() + before.size() / 8);
  auto known = before.begin();
  for_each_near(piece, group_of(piece), [&](std::uint32_t other, double gap) {
    while (known != before.end() && known->piece < other) ++known;
    if (known != before.end() && known->piece == other)
      near.push_back(*known);
    else
      near.push_back({other, 0, 0, apart, apart, looks_ ? 0 : unknown});
    near.back().gap = gap;
  });
}

/// Bounds the rate of approach of two pieces where particles of both may be within the outer range
/// of each other before the next survey.
float NearPieces::rate_between(std::size_t piece, std::size_t near) const {
  const PieceNow &one = pieces_[piece], &other = pieces_[near];
  const double reach = ranges_.outer;
  const Box here = expanded(one.box, travel_ + drift_[piece]);
  const Box there = expanded(other.box, travel_ + drift_[near]);
  const double rate =
      std::min(largest_difference(one, other, here.intersection(expanded(there, reach))),
               largest_difference(one, other, there.intersection(expanded(here, reach))));
  return static_cast<float>(rate * (1 + 1e-6));
}

/// To each piece near one, of those with lower numbers in the end. Where there is no region,
/// nothing was used up.
void NearPieces::find_rates(std::size_t piece) {
  for (Near& near : near_[piece]) {
    near.rate = 0;
    if (near.piece == piece) continue;
    const double apart = std::min(near.gap, ranges_.outer) - ranges_.force;
    near.outer = std::max(near.outer, apart);
    near.inner = std::max(near.inner, apart);
    if (near.piece > piece) near.rate = rate_between(piece, near.piece);
  }
}

/// The same both ways.
void NearPieces::copy_rates(std::size_t piece) {
  for (Near& near : near_[piece]) {
    if (near.piece >= piece) break;
    const Near* known = found(near_[near.piece], static_cast<std::uint32_t>(piece));
    near.rate = known != nullptr ? known->rate : rate_between(near.piece, piece);
  }
}

bool NearPieces::advance(std::span<const double> fastest, double time) {
  double most = 0;
  for (const double one : fastest) most = std::max(most, one);
  drifted_ += most * time;
  traveled_ += fastest_point_ * time;
  elapsed_ += time;
  ++steps_;
  bool within = traveled_ <= travel_ * (1 + 1e-9);
  for (std::size_t piece = 0; piece < gone_.size(); ++piece) {
    last_[piece] = fastest[piece] * time;
    gone_[piece] += last_[piece];
    within = within && gone_[piece] <= drift_[piece];
  }
  if (!within) return false;
  parallel_for(pieces_.size(), 8 * pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      Spare& spare = spare_[piece];
      spare.used += (fastest[piece] + most + spare.rate) * time;
      if (!(spare.used < std::min({spare.outer, spare.inner, spare.still}))) find_spare(piece);
    }
  });
  collect_due_pieces();
  return true;
}

/// What the pieces near one have left at present.
void NearPieces::find_spare(std::size_t piece) {
  Spare& spare = spare_[piece] = {};
  for (const Near& near : near_[piece]) {
    const double used = used_of(piece, near);
    spare.outer = std::min(spare.outer, near.outer - used);
    spare.inner = std::min(spare.inner, near.inner - used);
    spare.still = std::min(spare.still, near.still - used);
    spare.rate = std::max(spare.rate, static_cast<double>(near.rate));
  }
}

/// Before the next survey: from now on, nothing has been used of what is left.
void NearPieces::rebase_margins(std::size_t piece) {
  for (Near& near : near_[piece]) {
    const double used = used_of(piece, near);
    near.outer -= used;
    near.inner -= used;
    near.still -= used;
  }
}

/// Whose lists are due: outer lists also where too little is left for inner lists to last.
void NearPieces::collect_due_pieces() {
  to_list_.clear();
  to_prune_.clear();
  to_look_at_.clear();
  const double little = (ranges_.inner - ranges_.force) / 4;
  for (std::uint32_t piece = 0; piece < spare_.size(); ++piece) {
    const Spare& least = spare_[piece];
    if (least.still <= 0) to_look_at_.push_back(piece);
    if (least.outer < 0 || (least.inner < 0 && least.outer < little))
      to_list_.push_back(piece);
    else if (least.inner < 0)
      to_prune_.push_back(piece);
  }
}

Box NearPieces::box_of(std::size_t piece, double elapsed) const {
  const Vec3 displacement = elapsed * common_;
  return expanded(pieces_[piece].box, traveled_ + gone_[piece]).translate(displacement);
}

bool NearPieces::survey_due() const {
  // A step may take particles as far again as the last one did, or farther.
  for (std::size_t piece = 0; piece < gone_.size(); ++piece)
    if (gone_[piece] + std::max(last_[piece], jump * ranges_.outer) > drift_[piece]) return true;
  const double per_step = steps_ > 0 ? traveled_ / steps_ : 0;
  return traveled_ + per_step > travel_ ||
         (steps_ >= ranges_.steps && drifted_ > drift_fraction * (ranges_.inner - ranges_.force));
}

void NearPieces::looked_at(std::size_t piece, double still) {
  for (Near& near : near_[piece]) near.still = still + used_of(piece, near);
  spare_[piece].used = unknown;
}

void NearPieces::listed(std::size_t piece) {
  for (Near& near : near_[piece]) near.outer = ranges_.outer - ranges_.force + used_of(piece, near);
  spare_[piece].used = unknown;
}

void NearPieces::pruned(std::size_t piece) {
  for (Near& near : near_[piece]) {
    const double nearer = 2 * traveled_ + gone_[piece] + gone_[near.piece];
    const double apart = std::min(near.gap - nearer, ranges_.outer) - ranges_.force;
    const double used = used_of(piece, near);
    near.inner = used + std::max(apart, std::min(ranges_.inner - ranges_.force, near.outer - used));
  }
  spare_[piece].used = unknown;
}

}  // namespace sinew
