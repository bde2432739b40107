// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/body.h>

#include <algorithm>
#include <functional>

#include <sinew/core/parallel.h>
#include <sinew/material/laws.h>

namespace sinew {
namespace {

/// A hash of the hashes of pieces of [0, count), in parallel.
void add_pieces(std::size_t count, Hash& hash,
                const std::function<void(std::size_t i, Hash& piece)>& add_one) {
  constexpr std::size_t grain = 1 << 16;
  std::vector<std::uint64_t> pieces((count + grain - 1) / grain);
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    Hash piece;
    for (std::size_t i = begin; i < end; ++i) add_one(i, piece);
    pieces[begin / grain] = piece.value();
  });
  hash.add(pieces.data(), pieces.size() * sizeof pieces[0]);
}

}  // namespace

double near_at_rest(const Material& material) {
  return std::max(rest_neighbor_range(material.pair.r), law_of(material).range(material));
}

bool pass_through(const Body& body, std::size_t a, std::size_t b) {
  const double near = near_at_rest(body.material);
  return body.pass_through.any() &&
         body.pass_through.between(body.binding.bone(a), body.binding.bone(b)) &&
         (body.rest[a] - body.rest[b]).squaredNorm() >= near * near;
}

SharedNeighbors neighbors_of(const Body& body) {
  if (body.neighbors) return body.neighbors;
  const Material& material = body.material;
  return std::make_shared<const RestNeighbors>(
      rest_neighbors(body.rest, material.pair.r, material.bond.second > 0));
}

double total_mass(const Body& body, double common) {
  if (body.density.empty()) return static_cast<double>(body.rest.size()) * common;
  double sum = 0;
  for (const double density : body.density) sum += density;
  return sum * common;
}

Material lightest(const Body& body) {
  Material material = body.material;
  if (!body.density.empty())
    material.mass *= *std::min_element(body.density.begin(), body.density.end());
  return material;
}

Hash hash_at_rest(const Body& body) {
  Hash hash;
  add_pieces(body.rest.size(), hash, [&](std::size_t i, Hash& piece) {
    piece.add(body.rest[i].data(), 3 * sizeof(double));
    for (const Influence& influence : body.binding.of(i)) {
      piece.add(&influence.bone, sizeof influence.bone);
      piece.add(&influence.weight, sizeof influence.weight);
    }
  });
  const auto& numbers = body.material_number;  // the meshes of parts may have changed
  hash.add(numbers.data(), numbers.size() * sizeof(std::int32_t));
  return hash;
}

Hash hash_of(const Body& body) {
  Hash hash = hash_at_rest(body);
  hash.add(&body.material.pair.r, sizeof body.material.pair.r);
  for (const Bone& bone : body.skeleton.bones) {
    hash.add(bone.name + '\n');
    hash.add(bone.rest.origin.data(), 3 * sizeof(double));
    hash.add(bone.rest.rotation.data(), 9 * sizeof(double));
  }
  return hash;
}

}  // namespace sinew
