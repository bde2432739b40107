// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/closed_sweep.h>

#include <algorithm>
#include <numeric>

#include <sinew/core/union_find.h>

namespace sinew {

void number_bodies(const std::vector<SweptRows>& found, const Surface& surface,
                   InsideRuns& inside) {
  UnionFind sets(surface.components);
  for (const SweptRows& piece : found)
    for (const auto& [a, b] : piece.overlaps) sets.join(a, b);
  std::vector<bool> filled(surface.components);
  const std::vector<double> volumes = component_volumes(surface);
  for (int i = 0; i < surface.components; ++i) filled[i] = volumes[i] > 0;
  for (const Run& run : inside.runs) filled[run.body] = true;
  inside.body_of.assign(surface.components, -1);
  for (int i = 0; i < surface.components; ++i) {
    if (!filled[i]) continue;
    int& first = inside.body_of[sets.first_of(i)];
    if (first < 0) first = inside.bodies++;
    inside.body_of[i] = first;
  }
  for (Run& run : inside.runs) run.body = inside.body_of[run.body];

  UnionFind blocks(inside.bodies);
  for (const auto& [behind, before] : surface.walls.component)
    if (inside.body_of[behind] >= 0 && inside.body_of[before] >= 0)
      blocks.join(inside.body_of[behind], inside.body_of[before]);
  for (int body = 0; body < inside.bodies; ++body) inside.block_of.push_back(blocks.first_of(body));
}

namespace {

constexpr int unknown = -1;

/// The one component around a point that no cavity excludes, or `unknown`.
int only_one(const Depths& depths) {
  int found = unknown;
  for (const auto& [component, depth] : depths.around()) {
    if (depth <= 0) continue;
    if (found != unknown) return unknown;
    found = component;
  }
  return found;
}

/// Follows a row and finds owners of cavities that have none yet. False where it found none.
bool learn(std::span<const Crossing> row, const Surface& surface, std::vector<int>& owner) {
  Depths depths;
  bool learnt = false, lost = false;
  for (const Crossing& one : row) {
    for_each_component(surface, one, [&](int component, int winding) {
      if (owner[component] == unknown && winding < 0) {
        owner[component] = only_one(depths);
        learnt = learnt || owner[component] != unknown;
      }
      lost = lost || owner[component] == unknown;
      if (!lost) depths.cross(owner[component], winding);
    });
    if (lost) return learnt;
  }
  return learnt;
}

}  // namespace

std::vector<int> owners_of(const Surface& surface, const RowCrossings& crossings) {
  const std::vector<double> volumes = component_volumes(surface);
  std::vector<int> owner(surface.components);
  std::iota(owner.begin(), owner.end(), 0);
  std::size_t missing = 0;
  for (int i = 0; i < surface.components; ++i)
    if (volumes[i] < 0) owner[i] = unknown, ++missing;
  // Nested cavities take more than one round.
  for (bool learnt = missing > 0; learnt && std::count(owner.begin(), owner.end(), unknown) > 0;) {
    learnt = false;
    for (std::size_t row = 0; row + 1 < crossings.first.size(); ++row)
      learnt = learn(crossings.of(row), surface, owner) || learnt;
  }
  for (int i = 0; i < surface.components; ++i)
    if (owner[i] == unknown) owner[i] = i;
  return owner;
}

namespace {

/// Parts that overlap in many rows do so in the same pairs.
void drop_repeated(std::vector<std::array<int, 2>>& overlaps) {
  constexpr std::size_t many = 4096;
  if (overlaps.size() < many) return;
  std::sort(overlaps.begin(), overlaps.end());
  overlaps.erase(std::unique(overlaps.begin(), overlaps.end()), overlaps.end());
}

void take(RowRuns& runs, int first, int last, int sum, Depths& depths, SweptRows& found) {
  if (first >= last) return;
  found.deepest = std::max(found.deepest, sum);
  found.shallowest = std::min(found.shallowest, sum);
  if (sum > 0) runs.add(first, last, depths.body(found.overlaps));
}

}  // namespace

ClosedSweep::ClosedSweep(const Lattice& lattice, const Surface& surface,
                         const RowCrossings& crossings)
    : lattice_(lattice), surface_(surface), crossings_(crossings) {
  if (surface.components > 1) owner_ = owners_of(surface, crossings);
}

void ClosedSweep::add_row(std::size_t row, SweptRows& found) const {
  RowRuns runs(row, crossings_.on_surface, found.runs);
  Depths depths;
  int sum = 0, from = 0;
  for (const Crossing& one : crossings_.of(row)) {
    take(runs, from, one.site, sum, depths, found);
    from = one.site;
    if (one.face < static_cast<int>(surface_.triangles.faces.size())) sum += one.winding;
    if (!owner_.empty())
      for_each_component(surface_, one, [&](int component, int winding) {
        depths.cross(owner_[component], winding);
      });
  }
  take(runs, from, lattice_.rows[row].sites, sum, depths, found);
  drop_repeated(found.overlaps);
}

}  // namespace sinew
