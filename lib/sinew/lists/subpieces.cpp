// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/subpieces.h>

#include <algorithm>
#include <utility>

#include <sinew/body/grouping.h>
#include <sinew/kernel/kernel.h>

namespace sinew {
namespace {

// Fewer move with the subpiece before them.
constexpr std::size_t min_size = 4;

/// What a particle moves with: its group, or else its bone.
std::int32_t leader_of(const Body& body, std::size_t i) {
  if (body.grouping && body.grouping->group[i] >= 0)
    return static_cast<std::int32_t>(body.skeleton.size()) + body.grouping->group[i];
  return body.binding.first.empty() ? no_bone : body.binding.bone(i);
}

/// Where particles with another leader begin.
std::vector<std::size_t> begins_of_leaders(const Body& body, std::span<const std::int32_t> id) {
  std::vector<std::size_t> begins;
  std::int32_t before = 0;
  for (std::size_t k = 0; k < id.size(); ++k) {
    const std::int32_t leader = leader_of(body, static_cast<std::size_t>(id[k]));
    if (k == 0 || leader != before) begins.push_back(k);
    before = leader;
  }
  return begins;
}

/// Into pieces, and these where something begins.
Subpieces divided(std::size_t count, std::size_t size, std::vector<std::size_t> begins) {
  begins.push_back(count);
  Subpieces subpieces;
  std::size_t next = 0;
  for (std::size_t first = 0; first < count; first += size) {
    const std::size_t end = std::min(first + size, count);
    subpieces.of_piece.push_back(static_cast<std::uint32_t>(subpieces.first.size()));
    subpieces.first.push_back(static_cast<std::uint32_t>(first));
    for (; begins[next] < end; ++next)
      if (begins[next] >= subpieces.first.back() + min_size && begins[next] + min_size <= end)
        subpieces.first.push_back(static_cast<std::uint32_t>(begins[next]));
    subpieces.piece.resize(subpieces.first.size(), static_cast<std::uint32_t>(first / size));
  }
  subpieces.of_piece.push_back(static_cast<std::uint32_t>(subpieces.first.size()));
  subpieces.first.push_back(static_cast<std::uint32_t>(count));
  return subpieces;
}

}  // namespace

Subpieces subpieces_of(const Body& body, std::span<const std::int32_t> id, std::size_t block) {
  const std::size_t size = block * kernel::blocks_per_piece, pieces = (id.size() + size - 1) / size;
  const std::size_t groups = body.grouping ? body.grouping->size() : 0;
  std::vector<std::size_t> begins = begins_of_leaders(body, id);
  // Where bones alternate, as in a body that has been sorted into columns, subpieces would be many.
  if (begins.size() > pieces + 2 * (body.skeleton.size() + groups)) begins.clear();
  Subpieces subpieces = divided(id.size(), size, std::move(begins));
  for (std::size_t k = 0, subpiece = 0; k < id.size(); k += block) {
    while (subpieces.first[subpiece + 1] <= k) ++subpiece;
    subpieces.of_block.push_back(static_cast<std::uint32_t>(subpiece));
  }
  return subpieces;
}

}  // namespace sinew
