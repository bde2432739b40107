// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/detail/group_layout.h>

#include <algorithm>
#include <utility>

#include <sinew/body/body.h>
#include <sinew/body/grouping.h>
#include <sinew/core/parallel.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

using kernel::blocks_per_piece;

constexpr std::size_t pieces_at_a_time = 8;
constexpr std::uint32_t longest_run = 512;
constexpr double beyond_range = 1e-5;  // above rounding: the kernel decides what touches

/// Longer runs where they continue.
void append(const GroupRun& run, std::vector<GroupRun>& runs) {
  if (!runs.empty() && runs.back().end == run.begin && runs.back().group == run.group &&
      runs.back().end - runs.back().begin < longest_run)
    runs.back().end = run.end;
  else
    runs.push_back(run);
}

/// Calls visit(first, last) for the particles that the block's bonds read.
template <class Real, class Visit>
void for_each_reach(std::size_t b, const BondLists<Real>& bonds, const Visit& visit) {
  for (std::uint32_t e = bonds.first[b]; e < bonds.first[b + 1]; ++e) {
    const std::uint32_t lanes = bonds.entries[e].lanes >> kernel::rest_lanes;
    if (lanes == 0) continue;
    const std::ptrdiff_t from =
        static_cast<std::ptrdiff_t>(b * BlockState<Real>::block) + bonds.entries[e].difference;
    visit(from + std::countr_zero(lanes), from + 31 - std::countl_zero(lanes));
  }
}

}  // namespace

template <class Real>
void GroupLayout<Real>::set_order(std::span<const std::int32_t> id, const BondLists<Real>& bonds,
                                  bool two_deep) {
  two_deep_ = two_deep;
  find_places(id);
  find_roles();
  read_through(bonds);
}

template <class Real>
void GroupLayout<Real>::find_places(std::span<const std::int32_t> id) {
  auto& [ids, group, at, at_of_kernel] = places_;
  ids.assign(id.begin(), id.end());
  group.resize(id.size());
  for (auto& axis : at) axis.assign(id.size(), 0);
  for (auto& axis : at_of_kernel) axis.assign(id.size() + block, 0);
  for (std::size_t k = 0; k < id.size(); ++k) {
    const auto i = static_cast<std::size_t>(id[k]);
    group[k] = body_->grouping->group[i];
    if (group[k] < 0) continue;
    const Vec3 place = (*shapes_)[static_cast<std::size_t>(group[k])].place_of(body_->rest[i]);
    for (int axis = 0; axis < 3; ++axis) {
      at[axis][k] = place[axis];
      at_of_kernel[axis][k] = static_cast<Real>(place[axis]);
    }
  }
}

template <class Real>
void GroupLayout<Real>::find_roles() {
  const std::size_t blocks = (places_.group.size() + block - 1) / block;
  const std::size_t pieces = (blocks + blocks_per_piece - 1) / blocks_per_piece;
  role_.assign(blocks, kernel::working);
  for (auto* flags : {&always_, &inactive_, &whole_, &idle_}) flags->assign(blocks, 0);
  of_piece_.assign(pieces, -1);
  working_.assign(pieces, 0);
  watched_.assign(pieces, {});
  watching_.clear();
  active_.clear();
  rim_.clear();
  rows_ = 0;
  find_pieces();
  for (std::size_t b = 0; b < blocks; ++b) find_role(b);
  more_are_read_ = true;
}

template <class Real>
void GroupLayout<Real>::find_role(std::size_t b) {
  const std::vector<std::int32_t>& group = places_.group;
  const std::size_t begin = b * block, end = std::min(begin + block, group.size());
  bool some = false, all = end == begin + block, whole = true;  // padding is nobody's
  for (std::size_t k = begin; k < end; ++k) {
    some = some || group[k] >= 0;
    whole = whole && group[k] >= 0;
    all = all && group[k] == group[begin] &&
          body_->grouping->layer[static_cast<std::size_t>(places_.id[k])] >= Layer::shell;
  }
  if (!some) return;
  role_[b] = all ? static_cast<std::int32_t>(kernel::idle) : rows_++;
  if (!all) working_[b / blocks_per_piece] = 1;
  inactive_[b] = idle_[b] = all ? 1 : 0;
  whole_[b] = whole ? 1 : 0;
  if (all) return;
  for_each_run(begin, end, [&](GroupRun run) {
    run.row = static_cast<std::int64_t>(role_[b]) * static_cast<std::int64_t>(block) +
              static_cast<std::int64_t>(run.begin - begin);
    append(run, rim_);
  });
}

/// Finds the pieces of one group alone.
template <class Real>
void GroupLayout<Real>::find_pieces() {
  constexpr std::size_t size = blocks_per_piece * block;
  const std::vector<std::int32_t>& group = places_.group;
  for (std::size_t piece = 0; piece < of_piece_.size(); ++piece) {
    const auto begin = group.begin() + static_cast<std::ptrdiff_t>(piece * size);
    const auto end =
        group.begin() + static_cast<std::ptrdiff_t>(std::min((piece + 1) * size, group.size()));
    if (std::all_of(begin, end, [&](std::int32_t one) { return one == *begin; }))
      of_piece_[piece] = *begin;
  }
}

template <class Real>
void GroupLayout<Real>::put_into(kernel::Grouped<Real>& grouped) const {
  grouped.role = role_.data();
  grouped.inactive = inactive_.data();
  grouped.whole = whole_.data();
}

template <class Real>
InnerParticles GroupLayout<Real>::inner_particles() const {
  const auto& at = places_.at;
  InnerParticles all{places_.id, places_.group, {at[0], at[1], at[2]}, idle_, {}, {}};
  for (const GroupShape& shape : *shapes_) {
    all.frames.push_back(shape.frame);
    all.cubic.push_back(shape.cubic ? 1 : 0);
  }
  return all;
}

template <class Real>
const std::vector<GroupRun>& GroupLayout<Real>::read_in_steps() {
  if (!std::exchange(more_are_read_, false)) return steady_;
  steady_ = rim_;
  for (std::size_t b = 0; b < role_.size(); ++b) {
    if (!may_idle(b) || always_[b] == 0) continue;
    for_each_run(b * block, (b + 1) * block, [&](const GroupRun& run) { append(run, steady_); });
  }
  return steady_;
}

template <class Real>
void GroupLayout<Real>::mark_read(std::ptrdiff_t first, std::ptrdiff_t last) {
  const auto size = static_cast<std::ptrdiff_t>(block);
  for (std::ptrdiff_t b = std::max<std::ptrdiff_t>(0, first / size);
       b <= last / size && b < static_cast<std::ptrdiff_t>(role_.size()); ++b) {
    const auto at = static_cast<std::size_t>(b);
    if (may_idle(at) && always_[at] == 0) always_[at] = 1, more_are_read_ = true;
  }
}

template <class Real>
void GroupLayout<Real>::mark_bonds(std::size_t b, const BondLists<Real>& bonds) {
  for_each_reach(b, bonds, [&](auto first, auto last) { mark_read(first, last); });
}

/// What the block's list reads.
template <class Real>
void GroupLayout<Real>::mark_lists(std::size_t b, const kernel::Lists& lists) {
  const std::size_t n = b % blocks_per_piece;
  for (std::uint32_t at = lists.first[n]; at < lists.first[n + 1]; ++at) {
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(b * block) + lists.value[at];
    mark_read(from, from + static_cast<std::ptrdiff_t>(block) - 1);
  }
}

template <class Real>
void GroupLayout<Real>::read_through(const BondLists<Real>& bonds) {
  if (bonds.first.empty()) return;
  for (int depth = 0; depth < (two_deep_ ? 2 : 1); ++depth) {
    std::vector<std::uint32_t> readers;
    for (std::uint32_t b = 0; b < role_.size(); ++b)
      if (inactive_[b] == 0) readers.push_back(b);
    std::vector<std::uint8_t> known =
        std::exchange(always_, std::vector<std::uint8_t>(role_.size(), 0));
    for (const std::uint32_t b : readers) mark_bonds(b, bonds);
    for (std::size_t b = 0; b < role_.size(); ++b) {
      if (always_[b] != 0 && two_deep_ && depth == 0) inactive_[b] = 0;
      if (known[b] != 0) always_[b] = 1;
    }
  }
}

/// What the list has of others.
template <class Real>
void GroupLayout<Real>::watch_piece(const kernel::Lists& lists, std::size_t piece) {
  std::vector<Watched>& watched = watched_[piece];
  watched.clear();
  if (lists.first == nullptr) return;
  const std::vector<std::int32_t>& group = places_.group;
  const auto size = static_cast<std::ptrdiff_t>(group.size());
  for (std::size_t n = 0; n < blocks_per_piece; ++n) {
    const std::size_t b = piece * blocks_per_piece + n;
    if (b >= role_.size() || !may_idle(b)) continue;
    const std::int32_t own = group[b * block];
    for (std::uint32_t at = lists.first[n]; at < lists.first[n + 1]; ++at) {
      const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(b * block) + lists.value[at];
      const std::ptrdiff_t to = std::min(from + static_cast<std::ptrdiff_t>(block), size);
      bool others = false;
      for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(from, 0); j < to; ++j)
        others = others || group[static_cast<std::size_t>(j)] != own;
      if (others) watched.push_back({static_cast<std::uint32_t>(b), lists.value[at]});
    }
  }
}

/// Marks what the block reads when it wakes.
template <class Real>
void GroupLayout<Real>::prepare_to_activate(std::uint32_t b, const BondLists<Real>& bonds) {
  mark_read(static_cast<std::ptrdiff_t>(b * block), static_cast<std::ptrdiff_t>(b * block));
  if (bonds.first.empty()) return;
  mark_bonds(b, bonds);
  if (!two_deep_) return;
  inactive_[b] = 0;
  for_each_reach(b, bonds, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
    for (const std::ptrdiff_t k : {first, last}) {
      const auto other = static_cast<std::size_t>(k) / block;
      inactive_[other] = 0;
      mark_bonds(other, bonds);
    }
  });
}

template <class Real>
void GroupLayout<Real>::watch(const kernel::Lists* lists, std::span<const std::uint32_t> pieces,
                              const BondLists<Real>& bonds,
                              const std::function<bool(std::size_t)>& meets) {
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
      if (std::exchange(last, one.block) != one.block) prepare_to_activate(one.block, bonds);
    for (std::size_t n = 0; n < blocks_per_piece; ++n) {
      const std::size_t b = piece * blocks_per_piece + n;
      if (b >= role_.size()) break;
      const bool may_become_active =
          std::any_of(watched_[piece].begin(), watched_[piece].end(),
                      [&](const Watched& one) { return one.block == b; });
      if (may_become_active || role_[b] != kernel::idle) mark_lists(b, lists[piece]);
    }
  }
  watching_.clear();
  for (std::uint32_t piece = 0; piece < watched_.size(); ++piece)
    if (!watched_[piece].empty()) watching_.push_back(piece);
}

template <class Real>
bool GroupLayout<Real>::touches(const Watched& watched, BlockState<Real>& state,
                                double range2) const {
  const auto arrays = state.arrays();
  const std::vector<std::int32_t>& group = places_.group;
  const std::int32_t own = group[watched.block * block];
  for (std::size_t i = watched.block * block; i < (watched.block + 1) * block; ++i) {
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(i) + watched.difference;
    if (to < 0 || to >= static_cast<std::ptrdiff_t>(group.size())) continue;
    const auto j = static_cast<std::size_t>(to);
    if (group[j] == own) continue;
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
void GroupLayout<Real>::activate(BlockState<Real>& state, const Units& units) {
  for (const std::uint32_t b : active_) role_[b] = kernel::idle;
  active_.clear();
  const Material& material = body_->material;
  const double range = law_of(material).range(material) / units.length * (1 + beyond_range);
  for (const std::uint32_t piece : watching_)
    for (const Watched& one : watched_[piece]) {
      if (!active_.empty() && active_.back() == one.block) continue;
      if (touches(one, state, range * range)) active_.push_back(one.block);
    }
  for (std::size_t k = 0; k < active_.size(); ++k)
    role_[active_[k]] = rows_ + static_cast<std::int32_t>(k);
}

template class GroupLayout<double>;
template class GroupLayout<float>;

}  // namespace sinew
