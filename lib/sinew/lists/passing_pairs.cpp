// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/passing_pairs.h>

#include <algorithm>

namespace sinew {

PassingPairs::PassingPairs(const Body& body, std::span<const std::int32_t> id) {
  if (!body.pass_through.any()) return;
  body_ = &body;
  near2_ = near_at_rest(body.material) * near_at_rest(body.material);
  id_.assign(id.begin(), id.end());
  bone_.reserve(id.size());
  for (const std::int32_t one : id) {
    const int bone = body.binding.bone(static_cast<std::size_t>(one));
    bone_.push_back(body.pass_through.has(bone) ? bone : no_bone);
  }
}

bool PassingPairs::pass(std::size_t i, std::size_t j) const {
  if (!body_->pass_through.between(bone_[i], bone_[j])) return false;
  const auto a = static_cast<std::size_t>(id_[i]), b = static_cast<std::size_t>(id_[j]);
  return (body_->rest[a] - body_->rest[b]).squaredNorm() >= near2_;
}

template <class Real>
void PassingPairs::remove(std::size_t piece, OffsetLists& lists) const {
  constexpr std::size_t size = BlockState<Real>::block;
  constexpr auto all = static_cast<std::uint16_t>((std::uint32_t{1} << size) - 1);
  if (lists.lanes.empty()) lists.lanes.assign(lists.value.size() + 1, all);
  for (std::size_t k = 0; k + 1 < lists.first.size(); ++k) {
    const std::size_t first = (piece * kernel::blocks_per_piece + k) * size;
    const std::size_t lanes = first < bone_.size() ? std::min(size, bone_.size() - first) : 0;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (bone_[first + lane] == no_bone) continue;
      for (std::uint32_t n = lists.first[k]; n < lists.first[k + 1]; ++n) {
        const std::int64_t other = static_cast<std::int64_t>(first + lane) + lists.value[n];
        if (other < 0 || static_cast<std::size_t>(other) >= bone_.size()) continue;
        if (pass(first + lane, static_cast<std::size_t>(other)))
          lists.lanes[n] &= static_cast<std::uint16_t>(~(1U << lane));
      }
    }
  }
}

template void PassingPairs::remove<double>(std::size_t, OffsetLists&) const;
template void PassingPairs::remove<float>(std::size_t, OffsetLists&) const;

}  // namespace sinew
