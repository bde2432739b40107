// SPDX-License-Identifier: GPL-3.0-or-later
// The skins of groups, and what else is idle as long as nothing else touches it.
#include <algorithm>
#include <utility>

#include <sinew/core/parallel.h>
#include <sinew/groups/groups.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

using kernel::blocks_per_piece;

constexpr std::size_t skins_at_a_time = 16, pieces_at_a_time = 8;
constexpr double beyond_range = 1e-5;  // above rounding: the kernel decides what touches

}  // namespace

/// Their sums. What is idle gets rows after those of the rims when it wakes.
template <class Real>
void Groups<Real>::find_skins(std::int32_t rows) {
  rows_ = rows;
  idle_.resize(role_.size());
  for (std::size_t b = 0; b < role_.size(); ++b) idle_[b] = role_[b] == kernel::idle ? 1 : 0;
  skins_.clear();
  awake_.clear();
  skin_at_.assign(role_.size(), -1);
  watched_.assign(of_piece_.size(), {});
  watching_.clear();
  if (!affine_) return;
  const std::vector<std::uint8_t>& skin = body_->grouping->skin;
  const auto has_skin = [&](std::size_t k) { return skin[static_cast<std::size_t>(id_[k])] != 0; };
  for (std::uint32_t b = 0; b < role_.size(); ++b) {
    bool some = false;
    if (!may_idle(b) || shapes_[static_cast<std::size_t>(group_[b * block])].cubic) continue;
    for (std::size_t k = b * block; k < (b + 1) * block; ++k) some = some || has_skin(k);
    if (!some) continue;
    skin_at_[b] = static_cast<std::int32_t>(skins_.size());
    skins_.push_back({b, {}});
  }
  parallel_for(skins_.size(), skins_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      for (std::size_t k = skins_[s].block * block; k < (skins_[s].block + 1) * block; ++k)
        if (has_skin(k))
          skins_[s].moments += affine_->moments_of(static_cast<std::uint32_t>(id_[k]), place(k));
  });
  for (const SkinBlock& one : skins_)
    idle_sums_[static_cast<std::size_t>(group_[one.block * block])].skin += one.moments;
}

/// What the list has of others.
template <class Real>
void Groups<Real>::watch_piece(const kernel::Lists& lists, std::size_t piece) {
  std::vector<Watched>& watched = watched_[piece];
  watched.clear();
  if (lists.first == nullptr) return;
  const auto size = static_cast<std::ptrdiff_t>(group_.size());
  for (std::size_t n = 0; n < blocks_per_piece; ++n) {
    const std::size_t b = piece * blocks_per_piece + n;
    if (b >= role_.size() || !may_idle(b)) continue;
    const std::int32_t own = group_[b * block];
    for (std::uint32_t at = lists.first[n]; at < lists.first[n + 1]; ++at) {
      const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(b * block) + lists.value[at];
      const std::ptrdiff_t to = std::min(from + static_cast<std::ptrdiff_t>(block), size);
      bool others = false;
      for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(from, 0); j < to; ++j)
        others = others || group_[static_cast<std::size_t>(j)] != own;
      if (others) watched.push_back({static_cast<std::uint32_t>(b), lists.value[at]});
    }
  }
}

/// What the block needs to be able to wake.
template <class Real>
void Groups<Real>::rouse(std::uint32_t b, const BondLists<Real>& bonds) {
  mark_read(static_cast<std::ptrdiff_t>(b * block), static_cast<std::ptrdiff_t>(b * block));
  if (bonds.first.empty()) return;
  mark_read(b, bonds);
  if (!two_deep_) return;
  asleep_[b] = 0;
  for_each_reach(b, bonds, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
    for (const std::ptrdiff_t k : {first, last}) {
      const auto other = static_cast<std::size_t>(k) / block;
      asleep_[other] = 0;
      mark_read(other, bonds);
    }
  });
}

template <class Real>
void Groups<Real>::watch(const kernel::Lists* lists, std::span<const std::uint32_t> pieces,
                         const BondLists<Real>& bonds,
                         const std::function<bool(std::size_t)>& meets) {
  if (!any()) return;
  parallel_for(pieces.size(), pieces_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (meets(pieces[n]))
        watch_piece(lists[pieces[n]], pieces[n]);
      else
        watched_[pieces[n]].clear();
  });
  for (const std::uint32_t piece : pieces) {
    if (lists[piece].first == nullptr) continue;
    std::uint32_t last = UINT32_MAX;
    for (const Watched& one : watched_[piece])
      if (std::exchange(last, one.block) != one.block) rouse(one.block, bonds);
    for (std::size_t n = 0; n < blocks_per_piece; ++n) {
      const std::size_t b = piece * blocks_per_piece + n;
      if (b >= role_.size()) break;
      const bool may_wake = std::any_of(watched_[piece].begin(), watched_[piece].end(),
                                        [&](const Watched& one) { return one.block == b; });
      if (may_wake || role_[b] != kernel::idle) mark_lists(b, lists[piece]);
    }
  }
  watching_.clear();
  for (std::uint32_t piece = 0; piece < watched_.size(); ++piece)
    if (!watched_[piece].empty()) watching_.push_back(piece);
}

template <class Real>
bool Groups<Real>::touches(const Watched& watched, BlockState<Real>& state, double range2) const {
  const auto arrays = state.arrays();
  const std::int32_t own = group_[watched.block * block];
  for (std::size_t i = watched.block * block; i < (watched.block + 1) * block; ++i) {
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(i) + watched.difference;
    if (to < 0 || to >= static_cast<std::ptrdiff_t>(group_.size())) continue;
    const auto j = static_cast<std::size_t>(to);
    if (group_[j] == own) continue;
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double apart =
          static_cast<double>(arrays.x[axis][i]) - static_cast<double>(arrays.x[axis][j]);
      squared += apart * apart;
    }
    if (squared < range2) return true;
  }
  return false;
}

template <class Real>
void Groups<Real>::wake(BlockState<Real>& state, const Units& units) {
  if (!any()) return;
  for (const std::uint32_t b : awake_) role_[b] = kernel::idle;
  awake_.clear();
  const Material& material = body_->material;
  const double range = (law_of(material).has_memory ? 2 * material.pair.r : material.pair.b) /
                       units.length * (1 + beyond_range);
  for (const std::uint32_t piece : watching_)
    for (const Watched& one : watched_[piece]) {
      if (!awake_.empty() && awake_.back() == one.block) continue;
      if (touches(one, state, range * range)) awake_.push_back(one.block);
    }
  for (std::size_t k = 0; k < awake_.size(); ++k)
    role_[awake_[k]] = rows_ + static_cast<std::int32_t>(k);
  const std::size_t rows = static_cast<std::size_t>(rows_) + awake_.size() + 1;
  if (acceleration_[0].size() < rows * block)
    for (auto& axis : acceleration_) axis.resize(rows * block, 0);
}

/// What the kernel gathered on those that are awake takes the place of what follows from the
/// motion.
template <class Real>
void Groups<Real>::add_awake(const BondLists<Real>& bonds, const kernel::Step<Real>& step,
                             Sums& all, Sums& damping, std::vector<Idle>& idle,
                             std::vector<GroupForces>& inner) {
  if (awake_.empty()) return;
  const InnerParticles particles = inner_particles();
  const double minus = -1;
  for (const std::uint32_t b : awake_) {
    const auto g = static_cast<std::size_t>(group_[b * block]);
    Run run{static_cast<std::uint32_t>(b * block), static_cast<std::uint32_t>((b + 1) * block),
            group_[b * block]};
    run.row = static_cast<std::int64_t>(role_[b]) * static_cast<std::int64_t>(block);
    all[g] += sum_of(run);
    kernel::PullSums pull;
    kernel_.pull[motions_of(g)](
        step,
        {&b,
         &minus,
         1,
         {at_of_kernel_[0].data(), at_of_kernel_[1].data(), at_of_kernel_[2].data()}},
        pull);
    add_pulls(pull, g, all, damping);
    if (skin_at_[b] >= 0) idle[g].skin -= skins_[static_cast<std::size_t>(skin_at_[b])].moments;
    for (std::size_t k = run.begin; k < run.end; ++k) idle[g].terms -= terms_at(place(k));
    if (!shapes_[g].cubic) continue;
    const GroupForces own = inner_->on(bonds, particles, b, motions_[g]);
    inner[g].force -= own.force, inner[g].drag -= own.drag;
  }
}

template void Groups<double>::find_skins(std::int32_t);
template void Groups<double>::watch(const kernel::Lists*, std::span<const std::uint32_t>,
                                    const BondLists<double>&,
                                    const std::function<bool(std::size_t)>&);
template void Groups<double>::wake(BlockState<double>&, const Units&);
template void Groups<double>::add_awake(const BondLists<double>&, const kernel::Step<double>&,
                                        Sums&, Sums&, std::vector<Idle>&,
                                        std::vector<GroupForces>&);
template void Groups<float>::find_skins(std::int32_t);
template void Groups<float>::watch(const kernel::Lists*, std::span<const std::uint32_t>,
                                   const BondLists<float>&,
                                   const std::function<bool(std::size_t)>&);
template void Groups<float>::wake(BlockState<float>&, const Units&);
template void Groups<float>::add_awake(const BondLists<float>&, const kernel::Step<float>&, Sums&,
                                       Sums&, std::vector<Idle>&, std::vector<GroupForces>&);

}  // namespace sinew
