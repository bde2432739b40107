// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/near_pieces.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t pieces_per_task = 16;
constexpr std::size_t branches = 4;  // of the tree of boxes
// Pieces this much farther apart than lists reach are candidates: they are found again when
// particles may have come that much nearer. In outer ranges, and in steps of the fastest one.
constexpr double least_margin = 0.5, margin_in_steps = 48;
// Candidates are near if their velocity fields may bring them within reach before the next survey,
// or particles that drift by half of this, in outer ranges.
constexpr double drift_margin = 0.5;
// What a step may take particles without warning, in outer ranges: bonds that snap.
constexpr double jump = 0.06;
// Surveys serve when particles have drifted by this share of the inner skin, but not every few
// steps.
constexpr double drift_share = 0.1;
constexpr int least_steps = 8;
constexpr double unknown = std::numeric_limits<double>::infinity();

Box expanded(Box box, double by) {
  box.min().array() -= by;
  box.max().array() += by;
  return box;
}

/// Of two velocity fields in a box: it is convex, so one of the corners has the largest.
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

/// Between two pieces along the shortest side of the first.
double gap_across(const PieceNow& one, const PieceNow& other) {
  const Vec3 across = one.axes.col(one.shortest);
  const double reach = (other.axes.transpose() * across).cwiseAbs().dot(other.along.sizes()) / 2;
  return std::abs((other.middle() - one.middle()).dot(across)) -
         one.along.sizes()[one.shortest] / 2 - reach;
}

/// That piece among those near one, which ascend, or null.
const NearPieces::Near* found(std::span<const NearPieces::Near> near, std::uint32_t piece) {
  const auto at = std::lower_bound(
      near.begin(), near.end(), piece,
      [](const NearPieces::Near& one, std::uint32_t number) { return one.piece < number; });
  return at != near.end() && at->piece == piece ? &*at : nullptr;
}

/// Boxes of the pieces, around several of them, around several of those, and so on up to one.
std::vector<std::vector<Box>> tree_of(const std::vector<PieceNow>& pieces) {
  std::vector<std::vector<Box>> levels(1);
  for (const PieceNow& piece : pieces) levels[0].push_back(piece.box);
  while (levels.back().size() > 1) {
    const std::vector<Box>& below = levels.back();
    std::vector<Box> level((below.size() + branches - 1) / branches);
    for (std::size_t k = 0; k < below.size(); ++k) level[k / branches].extend(below[k]);
    levels.push_back(std::move(level));
  }
  return levels;
}

/// Calls visit(leaf) for the leaves below a node with a box within `reach` of `box`, ascending.
template <class Visit>
void for_each_near(const std::vector<std::vector<Box>>& levels, std::size_t level, std::size_t node,
                   const Box& box, double reach, Visit& visit) {
  if (levels[level][node].squaredExteriorDistance(box) >= reach * reach) return;
  if (level == 0) return visit(node);
  const std::size_t end = std::min((node + 1) * branches, levels[level - 1].size());
  for (std::size_t child = node * branches; child < end; ++child)
    for_each_near(levels, level - 1, child, box, reach, visit);
}

}  // namespace

double gap_between(const PieceNow& one, const PieceNow& other) {
  const Mat3 turned = one.axes.transpose() * other.axes, both = turned.cwiseAbs();
  const Vec3 half = one.along.sizes() / 2, others = other.along.sizes() / 2;
  const Vec3 apart = other.middle() - one.middle();
  const Vec3 in_one = one.axes.transpose() * apart, in_other = other.axes.transpose() * apart;
  const auto length = [](const Vec3& gap) { return gap.cwiseMax(0).squaredNorm(); };
  return std::sqrt(std::max({one.box.squaredExteriorDistance(other.box),
                             length(in_one.cwiseAbs() - half - both * others),
                             length(in_other.cwiseAbs() - others - both.transpose() * half)}));
}

/// Relative to the common velocity, of its fastest point as a rigid body, wherever it has traveled
/// before the next survey.
double NearPieces::speed_of(const PieceNow& piece) const {
  const double radius = piece.box.diagonal().norm() / 2 + margin_ / 4;
  return (piece.velocity_at(piece.box.center()) - common_).norm() + piece.spin.norm() * radius;
}

double NearPieces::fastest_of(std::span<const PieceNow> pieces) const {
  double most = 0;
  for (const PieceNow& piece : pieces) most = std::max(most, speed_of(piece));
  return most;
}

void NearPieces::survey(std::vector<PieceNow> pieces, double time) {
  parallel_for(near_.size(), pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) settle(piece);
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
  const double wanted =
      std::max(least_margin * ranges_.outer, margin_in_steps * fastest_of(pieces_) * time);
  // Until the next survey, particles may come nearer by another half of the margin.
  if (wanted > margin_ || 4 * since_found_ > margin_) {
    margin_ = wanted;
    find_candidates();
  }
  fastest_point_ = fastest_of(pieces_);
  const double horizon = fastest_point_ > 0 ? margin_ / (4 * fastest_point_) : 0;
  near_.resize(pieces_.size());
  spare_.assign(pieces_.size(), {});
  meets_others_.resize(pieces_.size());
  parallel_for(pieces_.size(), pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      find_near(piece, horizon);
      find_rates(piece);
    }
  });
  parallel_for(pieces_.size(), pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) copy_rates(piece);
    for (std::size_t piece = begin; piece < end; ++piece) find_spare(piece);
  });
}

void NearPieces::find_candidates() {
  since_found_ = 0;
  candidates_.assign(pieces_.size(), {});
  if (pieces_.empty()) return;
  const auto levels = tree_of(pieces_);
  parallel_for(pieces_.size(), pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      auto add = [&](std::size_t other) {
        candidates_[piece].push_back(static_cast<std::uint32_t>(other));
      };
      for_each_near(levels, levels.size() - 1, 0, pieces_[piece].box, ranges_.outer + margin_, add);
    }
  });
}

/// How fast particles of two pieces may approach: as anywhere in the first box, wherever they have
/// traveled.
double NearPieces::fastest_approach(const PieceNow& one, const PieceNow& other) const {
  const Vec3 middle = one.box.center();
  const double radius = one.box.diagonal().norm() / 2 + std::sqrt(3.0) * margin_ / 4;
  return (one.velocity_at(middle) - other.velocity_at(middle)).norm() +
         (one.spin - other.spin).norm() * radius;
}

/// The gap between two pieces, if particles of both may come within the outer range of each other
/// until the horizon; else something larger than that range.
double NearPieces::gap_within(const PieceNow& one, const PieceNow& other, double horizon) const {
  const double near = (1 + drift_margin) * ranges_.outer;
  double reach = 0;  // found where something is not near
  const auto may_come_near = [&](double gap) {
    if (gap < near) return true;
    if (reach == 0) reach = near + fastest_approach(one, other) * (1 + 1e-6) * horizon;
    return gap < reach;
  };
  // Most pieces are apart along a short side of one of them; the gap itself takes much longer.
  if (!may_come_near(std::sqrt(one.box.squaredExteriorDistance(other.box))) ||
      !may_come_near(std::max(gap_across(one, other), gap_across(other, one))))
    return unknown;
  const double gap = gap_between(one, other);
  return may_come_near(gap) ? gap : unknown;
}

void NearPieces::find_near(std::size_t piece, double horizon) {
  const std::vector<Near> before = std::move(near_[piece]);
  near_[piece].clear();
  meets_others_[piece] = 0;
  for (const std::uint32_t other : candidates_[piece]) {
    const double gap = gap_within(pieces_[piece], pieces_[other], horizon);
    if (gap == unknown) continue;
    add_near(piece, other, before);
    near_[piece].back().gap = gap;
    if (!are_bound(piece, other)) meets_others_[piece] = 1;
  }
}

/// A piece that was not near has come no nearer than the outer range.
void NearPieces::add_near(std::size_t piece, std::uint32_t other, std::span<const Near> before) {
  if (const Near* known = found(before, other); known != nullptr) {
    near_[piece].push_back(*known);
    return;
  }
  const double apart = ranges_.outer - ranges_.force;
  near_[piece].push_back({other, 0, 0, apart, apart, looks_ ? 0 : unknown});
}

/// Of approach of two pieces, in the region where particles of both may be within the outer range
/// of each other before the next survey.
float NearPieces::rate_between(const PieceNow& one, const PieceNow& other) const {
  const double travel = margin_ / 4, reach = ranges_.outer;
  const Box here = expanded(one.box, travel), there = expanded(other.box, travel);
  const double rate =
      std::min(largest_difference(one, other, here.intersection(expanded(there, reach))),
               largest_difference(one, other, there.intersection(expanded(here, reach))));
  return static_cast<float>(rate * (1 + 1e-6));
}

/// To each piece near one, of those with lower numbers in the end. Where there is no region,
/// nothing was used up.
void NearPieces::find_rates(std::size_t piece) {
  const PieceNow& one = pieces_[piece];
  if (!meets_others(piece)) return;
  for (Near& near : near_[piece]) {
    if (are_bound(piece, near.piece)) continue;
    const PieceNow& other = pieces_[near.piece];
    near.rate = 0;
    if (near.piece == piece) continue;
    const double apart = std::min(near.gap, ranges_.outer) - ranges_.force;
    near.outer = std::max(near.outer, apart);
    near.inner = std::max(near.inner, apart);
    if (near.piece > piece && may_touch(near)) near.rate = rate_between(one, other);
  }
}

/// The same both ways.
void NearPieces::copy_rates(std::size_t piece) {
  if (!meets_others(piece)) return;
  for (Near& near : near_[piece]) {
    if (near.piece >= piece) break;
    if (are_bound(piece, near.piece) || !may_touch(near)) continue;
    const Near* known = found(near_[near.piece], static_cast<std::uint32_t>(piece));
    near.rate = known != nullptr && meets_others(near.piece)
                    ? known->rate
                    : rate_between(pieces_[near.piece], pieces_[piece]);
  }
}

bool NearPieces::advance(std::span<const double> fastest, double time) {
  double most = 0;
  for (const double one : fastest) most = std::max(most, one);
  drifted_ += most * time;
  traveled_ += (fastest_point_ + most) * time;
  since_found_ += (fastest_point_ + most) * time;
  ++steps_;
  if (4 * traveled_ > margin_ * (1 + 1e-9) || 2 * drifted_ > drift_margin * ranges_.outer)
    return false;
  elapsed_ += time;
  for (std::size_t piece = 0; piece < gone_.size(); ++piece) gone_[piece] += fastest[piece] * time;
  parallel_for(pieces_.size(), 8 * pieces_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      Spare& spare = spare_[piece];
      spare.used += (fastest[piece] + most + spare.rate) * time;
      if (!(spare.used < std::min({spare.outer, spare.inner, spare.still}))) find_spare(piece);
    }
  });
  sort_out();
  return true;
}

/// What the pieces near one have left at present.
void NearPieces::find_spare(std::size_t piece) {
  Spare& spare = spare_[piece] = {};
  if (!meets_others(piece)) return;
  for (const Near& near : near_[piece]) {
    if (are_bound(piece, near.piece)) continue;
    const double used = used_of(piece, near);
    spare.outer = std::min(spare.outer, near.outer - used);
    spare.inner = std::min(spare.inner, near.inner - used);
    spare.still = std::min(spare.still, near.still - used);
    spare.rate = std::max(spare.rate, static_cast<double>(near.rate));
  }
}

/// Before the next survey: from now on, nothing has been used of what is left.
void NearPieces::settle(std::size_t piece) {
  if (!meets_others(piece)) return;
  for (Near& near : near_[piece]) {
    if (are_bound(piece, near.piece)) continue;
    const double used = used_of(piece, near);
    near.outer -= used;
    near.inner -= used;
    near.still -= used;
  }
}

/// Whose lists are due: outer lists also where too little is left for inner lists to last.
void NearPieces::sort_out() {
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
  return expanded(pieces_[piece].box, traveled_).translate(displacement);
}

bool NearPieces::survey_due() const {
  // A step may take particles as far again as the last one did, or farther.
  const auto soon = [&](double gone) {
    return gone + std::max(steps_ > 0 ? gone / steps_ : 0, jump * ranges_.outer);
  };
  return 4 * soon(traveled_) > margin_ || 2 * soon(drifted_) > drift_margin * ranges_.outer ||
         (steps_ >= least_steps && drifted_ > drift_share * (ranges_.inner - ranges_.force));
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
    const double apart = std::min(near.gap - 2 * traveled_, ranges_.outer) - ranges_.force;
    const double used = used_of(piece, near);
    near.inner = used + std::max(apart, std::min(ranges_.inner - ranges_.force, near.outer - used));
  }
  spare_[piece].used = unknown;
}

}  // namespace sinew
