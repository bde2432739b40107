// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/piece_parts.h>

#include <algorithm>
#include <utility>

#include <sinew/kernel/kernel.h>

namespace sinew {
namespace {

// Fewer move with the part before them.
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
PieceParts divided(std::size_t count, std::size_t size, std::vector<std::size_t> begins) {
  begins.push_back(count);
  PieceParts parts;
  std::size_t next = 0;
  for (std::size_t first = 0; first < count; first += size) {
    const std::size_t end = std::min(first + size, count);
    parts.of_piece.push_back(static_cast<std::uint32_t>(parts.first.size()));
    parts.first.push_back(static_cast<std::uint32_t>(first));
    for (; begins[next] < end; ++next)
      if (begins[next] >= parts.first.back() + min_size && begins[next] + min_size <= end)
        parts.first.push_back(static_cast<std::uint32_t>(begins[next]));
    parts.piece.resize(parts.first.size(), static_cast<std::uint32_t>(first / size));
  }
  parts.of_piece.push_back(static_cast<std::uint32_t>(parts.first.size()));
  parts.first.push_back(static_cast<std::uint32_t>(count));
  return parts;
}

}  // namespace

PieceParts piece_parts(const Body& body, std::span<const std::int32_t> id, std::size_t block) {
  const std::size_t size = block * kernel::blocks_per_piece, pieces = (id.size() + size - 1) / size;
  const std::size_t groups = body.grouping ? body.grouping->size() : 0;
  std::vector<std::size_t> begins = begins_of_leaders(body, id);
  // Where bones alternate, as in a body that has been sorted into columns, parts would be many.
  if (begins.size() > pieces + 2 * (body.skeleton.size() + groups)) begins.clear();
  PieceParts parts = divided(id.size(), size, std::move(begins));
  for (std::size_t k = 0, part = 0; k < id.size(); k += block) {
    while (parts.first[part + 1] <= k) ++part;
    parts.of_block.push_back(static_cast<std::uint32_t>(part));
  }
  return parts;
}

}  // namespace sinew
