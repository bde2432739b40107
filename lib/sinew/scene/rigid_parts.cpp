// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/rigid_parts.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/cell_grid.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/parallel.h>
#include <sinew/core/text.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr double range_around = 6, range_near = 5;  // radii
constexpr double layer_distance = 1.633;  // distance of two layers of closest packing, radii
constexpr std::size_t per_piece = 1024;   // particles
constexpr std::size_t max_named = 6;      // bones in a line

/// Whether two bones are one, or have a joint in common.
bool share_joint(const Skeleton& skeleton, int a, int b) {
  return a == b || a == no_bone || b == no_bone || skeleton.bones[a].parent == b ||
         skeleton.bones[b].parent == a;
}

/// The layers that vary as much as the particles around one, across the body.
double layers_around(const Body& body, const CellGrid& grid, std::size_t i) {
  const double r = body.material.pair.r, range = range_around * r;
  Mat3 squares = Mat3::Zero();
  Vec3 sum = Vec3::Zero();
  double count = 0;
  grid.for_each_near(body.rest[i], [&](std::uint32_t j) {
    const Vec3 apart = body.rest[j] - body.rest[i];
    if (apart.squaredNorm() > range * range ||
        !share_joint(body.skeleton, body.binding.bone(i), body.binding.bone(j)))
      return;
    squares += apart * apart.transpose();
    sum += apart;
    ++count;
  });
  const Mat3 spread = squares / count - sum * sum.transpose() / (count * count);
  const double least = eigenvalues(spread)[0];
  return std::sqrt(12 * std::max(least, 0.0) / (layer_distance * layer_distance * r * r) + 1);
}

using BoneCounts = std::vector<std::pair<std::size_t, std::size_t>>;  // bone, count

/// "'a' (12), 'b' (5) and 3 others", the largest counts first.
std::string list_of(const Skeleton& skeleton, BoneCounts bones) {
  std::stable_sort(bones.begin(), bones.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (std::size_t k = 0; k < std::min(max_named, bones.size()); ++k)
    text += (k > 0 ? ", " : "") + shown(skeleton.bones[bones[k].first].name) + " (" +
            std::to_string(bones[k].second) + ")";
  if (bones.size() > max_named)
    text += " and " + std::to_string(bones.size() - max_named) + " others";
  return text;
}

BoneCounts without_zeros(const std::vector<std::size_t>& counts) {
  BoneCounts bones;
  for (std::size_t b = 0; b < counts.size(); ++b)
    if (counts[b] > 0) bones.emplace_back(b, counts[b]);
  return bones;
}

std::string rigid_note(const BindingOptions& binding, const Body& body) {
  std::vector<std::size_t> counts(body.skeleton.size());
  if (body.world)
    for (const Pinned& pin : body.world->pins)
      if (pin.is_pin() && pin.bone != no_bone) ++counts[pin.bone];
  const BoneCounts bones = without_zeros(counts);
  if (bones.empty()) return "";
  return "parts under " + three_digits(binding.rigid_below) +
         " particles thick follow their bones rigidly: " + list_of(body.skeleton, bones) +
         " particles; a smaller body.radius lets them bend";
}

std::string softened_note(const BindingOptions& binding, const Body& body, double time_step) {
  const double r = body.material.pair.r;
  std::vector<std::size_t> counts(body.skeleton.size());
  double most = 1;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    const double section = body.binding.cross_section[b];
    const Bone& bone = body.skeleton.bones[b];
    const double factor = softening(binding, body.material, section, bone);
    if (factor <= 1 || body.springs[b].stiffest() == 0) continue;
    most = std::max(most, factor);
    counts[b] = static_cast<std::size_t>(
        std::max(std::lround(section * bone.length / volume_per_particle(r)), 1L));
  }
  const BoneCounts bones = without_zeros(counts);
  if (bones.empty()) return "";
  return "bones of under " + three_digits(binding.soften_below) +
         " particles pull them less than others, up to " + three_digits(most) +
         " times: " + list_of(body.skeleton, bones) +
         " particles; these lag behind, and the time step stays at " + three_digits(time_step) +
         " s";
}

}  // namespace

std::vector<double> particles_across(const Body& body) {
  const double r = body.material.pair.r;
  std::vector<double> around(body.rest.size()), across(body.rest.size());
  const CellGrid grid(body.rest, range_around * r);
  parallel_for(around.size(), per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) around[i] = layers_around(body, grid, i);
  });
  parallel_for(around.size(), per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      grid.for_each_near(body.rest[i], [&](std::uint32_t j) {
        if ((body.rest[j] - body.rest[i]).norm() <= range_near * r &&
            share_joint(body.skeleton, body.binding.bone(i), body.binding.bone(j)))
          across[i] = std::max(across[i], around[j]);
      });
  });
  return across;
}

void hold_rigid_parts(const BindingOptions& binding, Body& body) {
  if (!(binding.rigid_below > 0) || body.skeleton.size() == 0) return;
  const std::vector<double> across = particles_across(body);
  World world = body.world ? *body.world : World{};
  std::vector<bool> held(body.rest.size());
  for (const Pinned& pin : world.pins) held[pin.particle] = true;
  for (std::size_t i = 0; i < across.size(); ++i) {
    const int bone = body.binding.bone(i);
    if (held[i] || bone == no_bone || across[i] >= binding.rigid_below) continue;
    world.pins.push_back({static_cast<std::uint32_t>(i), bone});
    held[i] = true;
  }
  if (!body.world && world.pins.empty()) return;
  std::sort(world.pins.begin(), world.pins.end(),
            [](const Pinned& a, const Pinned& b) { return a.particle < b.particle; });
  std::vector<bool> pulls(body.skeleton.size());
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i])
      for (const Influence& influence : body.binding.of(i)) pulls[influence.bone] = true;
  for (std::size_t b = 0; b < pulls.size(); ++b)
    if (!pulls[b])
      body.springs[b].radial = body.springs[b].twist = body.springs[b].axial = 0,
      body.springs[b].damping = 0;
  body.world = std::make_shared<const World>(std::move(world));
}

std::vector<std::string> thin_part_notes(const BindingOptions& binding, const Body& body,
                                         double time_step) {
  std::vector<std::string> notes;
  if (binding.rigid_below > 0) notes.push_back(rigid_note(binding, body));
  if (binding.soften_below > 0) notes.push_back(softened_note(binding, body, time_step));
  std::erase(notes, "");
  return notes;
}

}  // namespace sinew
