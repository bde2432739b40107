// SPDX-License-Identifier: GPL-3.0-or-later
// Where the particles of groups are: in memory, and in space.
#include <algorithm>
#include <utility>

#include <sinew/body/bond_factors.h>
#include <sinew/core/parallel.h>
#include <sinew/groups/groups.h>
#include <sinew/lists/piece_parts.h>

namespace sinew {
namespace {

using kernel::blocks_per_piece;

constexpr std::size_t runs_per_placing = 16, pieces_per_showing = 16;
constexpr std::uint32_t longest_run = 512;

}  // namespace

template <class Real>
template <class Visit>
void Groups<Real>::for_each_run(std::size_t begin, std::size_t end, const Visit& visit) const {
  end = std::min(end, group_.size());
  for (std::size_t k = begin; k < end;) {
    std::size_t last = k + 1;
    while (last < end && group_[last] == group_[k]) ++last;
    if (group_[k] >= 0)
      visit(Run{static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(last), group_[k]});
    k = last;
  }
}

/// Longer runs where they continue.
template <class Real>
void Groups<Real>::append(const Run& run, std::vector<Run>& runs) {
  if (!runs.empty() && runs.back().end == run.begin && runs.back().group == run.group &&
      runs.back().end - runs.back().begin < longest_run)
    runs.back().end = run.end;
  else
    runs.push_back(run);
}

template <class Real>
void Groups<Real>::set_order(std::span<const std::int32_t> id) {
  if (!any()) return;
  const Grouping& grouping = *body_->grouping;
  id_.assign(id.begin(), id.end());
  group_.resize(id.size());
  for (auto& axis : at_) axis.assign(id.size(), 0);
  for (auto& axis : at_of_kernel_) axis.assign(id.size() + block, 0);
  for (std::size_t k = 0; k < id.size(); ++k) {
    const auto i = static_cast<std::size_t>(id[k]);
    group_[k] = grouping.group[i];
    if (group_[k] < 0) continue;
    const Shape& shape = shapes_[static_cast<std::size_t>(group_[k])];
    const Vec3 at = shape.frame * (body_->rest[i] - shape.center);
    for (int axis = 0; axis < 3; ++axis) {
      at_[axis][k] = at[axis];
      at_of_kernel_[axis][k] = static_cast<Real>(at[axis]);
    }
  }
  find_roles();
  find_boxes();
  find_sample();
  ++moment_;
}

template <class Real>
void Groups<Real>::find_roles() {
  const Grouping& grouping = *body_->grouping;
  const std::size_t blocks = (group_.size() + block - 1) / block;
  const std::size_t pieces = (blocks + blocks_per_piece - 1) / blocks_per_piece;
  role_.assign(blocks, kernel::working);
  always_.assign(blocks, 0);
  asleep_.assign(blocks, 0);
  whole_.assign(blocks, 0);
  shown_.assign(pieces, -1);
  find_pieces(pieces);
  strains_.assign(pieces, 0);
  strained_until_.assign(pieces, -1);
  working_.assign(pieces, 0);
  rim_.clear();
  idle_sums_.assign(shapes_.size(), {});
  std::int32_t rows = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t begin = b * block, end = std::min(begin + block, group_.size());
    bool some = false, all = end == begin + block, whole = true;  // padding is nobody's
    for (std::size_t k = begin; k < end; ++k) {
      some = some || group_[k] >= 0;
      whole = whole && group_[k] >= 0;
      all = all && group_[k] == group_[begin] &&
            grouping.layer[static_cast<std::size_t>(id_[k])] >= Layer::shell;
    }
    if (!some) continue;
    role_[b] = all ? static_cast<std::int32_t>(kernel::idle) : rows++;
    if (!all) working_[b / blocks_per_piece] = 1;
    asleep_[b] = all ? 1 : 0;
    whole_[b] = whole ? 1 : 0;
    for_each_run(begin, end, [&](Run run) {
      if (all) {
        Terms& terms = idle_sums_[static_cast<std::size_t>(run.group)].terms;
        for (std::size_t k = run.begin; k < run.end; ++k) terms += terms_at(place(k));
        return;
      }
      run.row = static_cast<std::int64_t>(role_[b]) * static_cast<std::int64_t>(block) +
                static_cast<std::int64_t>(run.begin - begin);
      append(run, rim_);
    });
  }
  find_skins(rows);
  for (auto& axis : acceleration_) axis.assign((static_cast<std::size_t>(rows) + 1) * block, 0);
  more_are_read_ = true;
}

/// Those of one group alone.
template <class Real>
void Groups<Real>::find_pieces(std::size_t pieces) {
  constexpr std::size_t size = blocks_per_piece * block;
  of_piece_.assign(pieces, -1);
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const auto begin = group_.begin() + static_cast<std::ptrdiff_t>(piece * size);
    const auto end =
        group_.begin() + static_cast<std::ptrdiff_t>(std::min((piece + 1) * size, group_.size()));
    if (std::all_of(begin, end, [&](std::int32_t group) { return group == *begin; }))
      of_piece_[piece] = *begin;
  }
}

template <class Real>
void Groups<Real>::find_boxes() {
  boxes_.clear();
  box_of_.assign(of_piece_.size(), 0);
  const PieceParts parts = piece_parts(*body_, id_, block);
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    const std::size_t first = boxes_.size();
    const std::uint32_t piece = parts.piece[part];
    if (parts.of_piece[piece] == part) box_of_[piece] = static_cast<std::uint32_t>(first);
    for_each_run(parts.first[part], parts.first[part + 1], [&](const Run& run) {
      std::size_t at = first;
      while (at < boxes_.size() && boxes_[at].group != run.group) ++at;
      if (at == boxes_.size())
        boxes_.push_back({piece, part, run.group, run.begin, run.end, Box(), Vec3::Zero()});
      boxes_[at].end = run.end;
      for (std::size_t k = run.begin; k < run.end; ++k) boxes_[at].box.extend(place(k));
    });
  }
  const double range = second_neighbor_range * body_->material.pair.r;
  for (PieceBox& one : boxes_) {
    const Mat3& frame = shapes_[static_cast<std::size_t>(one.group)].frame;
    one.around = one.box.sizes() / 2 + range * frame.rowwise().norm();
  }
}

/// Blocks of one group are of the kind of their first particle's group and bone.
template <class Real>
void Groups<Real>::find_sample() {
  sample_ = {};
  if (body_->skeleton.size() == 0) return;
  std::vector<SampledBlock> blocks;
  for (std::size_t b = 0; b < role_.size(); ++b) {
    if (role_[b] != kernel::idle) continue;
    const std::size_t begin = b * block;
    const auto bone = body_->binding.bone(static_cast<std::size_t>(id_[begin])) + 1;
    blocks.push_back(
        {static_cast<std::uint32_t>(b),
         static_cast<std::uint64_t>(group_[begin]) << 32 | static_cast<std::uint32_t>(bone)});
  }
  const auto places_of = [&](std::uint32_t b) {
    Points places;
    for (std::size_t k = b * block; k < (b + 1) * block; ++k) places.push_back(place(k));
    return places;
  };
  sample_ = PulledSample<Real>(quadrature_over(blocks, places_of), inner_particles());
}

/// Its motion in the kernel's units.
template <class Real>
GroupMotion Groups<Real>::in_kernel(std::size_t g, const Units& units) const {
  const double inverse = 1 / units.length;
  GroupMotion motion{inverse * motions_[g].x, units.time * inverse * motions_[g].v};
  motion.x.row(0) -= inverse * units.origin.transpose();
  return motion;
}

template <class Real>
void Groups<Real>::put(const Run& run, BlockState<Real>& state, const Units& units) const {
  const auto g = static_cast<std::size_t>(run.group);
  const GroupMotion motion = in_kernel(g, units);
  kernel_.put[motions_of(g)]({state.arrays(),
                              run.begin,
                              run.end,
                              {at_[0].data(), at_[1].data(), at_[2].data()},
                              motion.x.data(),
                              motion.v.data()});
}

/// The rim, and what a step reads of idle blocks.
template <class Real>
void Groups<Real>::find_steady() {
  steady_ = rim_;
  for (std::size_t b = 0; b < role_.size(); ++b) {
    if (!may_idle(b) || always_[b] == 0) continue;
    for_each_run(b * block, (b + 1) * block, [&](const Run& run) { append(run, steady_); });
  }
  more_are_read_ = false;
}

template <class Real>
void Groups<Real>::place(BlockState<Real>& state, const Units& units) {
  if (!any()) return;
  if (more_are_read_) find_steady();
  parallel_for(steady_.size(), runs_per_placing, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) put(steady_[k], state, units);
  });
}

template <class Real>
void Groups<Real>::show(BlockState<Real>& state, const Units& units,
                        std::span<const std::uint32_t> pieces) {
  std::vector<std::uint32_t> hidden;
  for (const std::uint32_t piece : pieces)
    if (std::exchange(shown_[piece], moment_) != moment_) hidden.push_back(piece);
  parallel_for(hidden.size(), pieces_per_showing, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for_each_run(hidden[n] * blocks_per_piece * block, (hidden[n] + 1) * blocks_per_piece * block,
                   [&](const Run& run) { put(run, state, units); });
  });
}

template <class Real>
void Groups<Real>::show_all(BlockState<Real>& state, const Units& units) {
  if (!any()) return;
  std::vector<std::uint32_t> all(shown_.size());
  for (std::uint32_t piece = 0; piece < all.size(); ++piece) all[piece] = piece;
  show(state, units, all);
}

template <class Real>
void Groups<Real>::mark_read(std::ptrdiff_t first, std::ptrdiff_t last) {
  const auto size = static_cast<std::ptrdiff_t>(block);
  for (std::ptrdiff_t b = std::max<std::ptrdiff_t>(0, first / size);
       b <= last / size && b < static_cast<std::ptrdiff_t>(role_.size()); ++b) {
    const auto at = static_cast<std::size_t>(b);
    if (may_idle(at) && always_[at] == 0) always_[at] = 1, more_are_read_ = true;
  }
}

template <class Real>
void Groups<Real>::read_through(const BondLists<Real>& bonds, bool two_deep) {
  two_deep_ = two_deep;
  if (!any() || bonds.first.empty()) return;
  for (int depth = 0; depth < (two_deep ? 2 : 1); ++depth) {
    std::vector<std::uint32_t> readers;
    for (std::uint32_t b = 0; b < role_.size(); ++b)
      if (asleep_[b] == 0) readers.push_back(b);
    std::vector<std::uint8_t> known =
        std::exchange(always_, std::vector<std::uint8_t>(role_.size(), 0));
    for (const std::uint32_t b : readers) mark_read(b, bonds);
    for (std::size_t b = 0; b < role_.size(); ++b) {
      if (always_[b] != 0 && two_deep && depth == 0) asleep_[b] = 0;
      if (known[b] != 0) always_[b] = 1;
    }
  }
  const InnerParticles inner = inner_particles();
  if (!inner_ && std::find(inner.cubic.begin(), inner.cubic.end(), 1) != inner.cubic.end())
    inner_.emplace(*body_, *affine_, bonds, inner);
}

template <class Real>
InnerParticles Groups<Real>::inner_particles() const {
  InnerParticles all{id_, group_, {at_[0], at_[1], at_[2]}, idle_, {}, {}};
  for (const Shape& shape : shapes_) {
    all.frames.push_back(shape.frame);
    all.cubic.push_back(shape.cubic ? 1 : 0);
  }
  return all;
}

/// What the block's list reads.
template <class Real>
void Groups<Real>::mark_lists(std::size_t b, const kernel::Lists& lists) {
  const std::size_t n = b % blocks_per_piece;
  for (std::uint32_t at = lists.first[n]; at < lists.first[n + 1]; ++at) {
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(b * block) + lists.value[at];
    mark_read(from, from + static_cast<std::ptrdiff_t>(block) - 1);
  }
}

template void Groups<double>::set_order(std::span<const std::int32_t>);
template GroupMotion Groups<double>::in_kernel(std::size_t, const Units&) const;
template void Groups<double>::place(BlockState<double>&, const Units&);
template void Groups<double>::show(BlockState<double>&, const Units&,
                                   std::span<const std::uint32_t>);
template void Groups<double>::show_all(BlockState<double>&, const Units&);
template void Groups<double>::read_through(const BondLists<double>&, bool);
template void Groups<double>::mark_lists(std::size_t, const kernel::Lists&);
template void Groups<double>::mark_read(std::ptrdiff_t, std::ptrdiff_t);
template void Groups<float>::set_order(std::span<const std::int32_t>);
template GroupMotion Groups<float>::in_kernel(std::size_t, const Units&) const;
template void Groups<float>::place(BlockState<float>&, const Units&);
template void Groups<float>::show(BlockState<float>&, const Units&, std::span<const std::uint32_t>);
template void Groups<float>::show_all(BlockState<float>&, const Units&);
template void Groups<float>::read_through(const BondLists<float>&, bool);
template void Groups<float>::mark_lists(std::size_t, const kernel::Lists&);
template void Groups<float>::mark_read(std::ptrdiff_t, std::ptrdiff_t);

}  // namespace sinew
