// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/check/warnings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include <sinew/core/cell_grid.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/material/laws.h>
#include <sinew/mesh/winding.h>
#include <sinew/rig/motion.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

using Warnings = std::vector<std::string>;
using Particle = std::uint32_t;

// A few may touch where two limbs part: what a person sees is more.
constexpr std::size_t max_that_touch = 12;

/// Pairs of bones, and the particles of theirs that touch.
class TouchedParts {
 public:
  /// Each particle that is added stands for so many.
  explicit TouchedParts(std::size_t each = 1) : each_(each) {}

  void add(int a, int b, Particle i, Particle j) {
    std::vector<Particle>& all = pairs_[std::minmax(a, b)];
    all.push_back(i), all.push_back(j);
  }

  /// Adds a warning about the pair of bones with most; nothing where those are few.
  void warn(const Skeleton& skeleton, const std::string& what, Warnings& warnings) {
    std::size_t largest = max_that_touch, count = 0;
    std::pair<int, int> worst;
    for (auto& [bones, particles] : pairs_) {
      std::sort(particles.begin(), particles.end());
      particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
      const std::size_t size = each_ * particles.size();
      count += size > max_that_touch ? 1 : 0;
      if (size > largest) largest = size, worst = bones;
    }
    if (count == 0) return;
    warnings.push_back((each_ > 1 ? "about " : std::string()) + std::to_string(largest) +
                       " particles of bones " + shown(skeleton.bones[worst.first].name) + " and " +
                       shown(skeleton.bones[worst.second].name) +
                       (count > 1 ? " (and some of " + std::to_string(count - 1) + " more pairs)"
                                  : std::string()) +
                       what);
  }

 private:
  std::size_t each_;
  std::map<std::pair<int, int>, std::vector<Particle>> pairs_;
};

// At rest.

constexpr std::size_t complete_neighbors = 12;

/// Bones around which nearly every particle lies at the surface.
void warn_of_few_layers(const Body& body, const NeighborLists& lists, Warnings& warnings) {
  constexpr double few = 0.03, tips = 0.05;  // the tips of limbs are thin
  std::vector<std::size_t> all(body.skeleton.size()), inner(body.skeleton.size());
  for (Particle i = 0; i < body.rest.size(); ++i) {
    const int bone = body.binding.bone(i);
    if (bone == no_bone) continue;
    ++all[bone];
    if (lists.of(i).size() >= complete_neighbors) ++inner[bone];
  }
  std::vector<std::string_view> thin;
  std::size_t particles = 0;
  for (std::size_t b = 0; b < all.size(); ++b)
    if (static_cast<double>(inner[b]) < few * static_cast<double>(all[b]))
      thin.emplace_back(body.skeleton.bones[b].name), particles += all[b];
  if (static_cast<double>(particles) <= tips * static_cast<double>(body.rest.size())) return;
  std::string names = shown(thin.front());
  if (thin.size() > 1) names += " and " + std::to_string(thin.size() - 1) + " more";
  warnings.push_back("the body is only one or two layers of particles thick at " +
                     std::to_string(thin.size()) + " of " + std::to_string(all.size()) +
                     " bones (" + names +
                     "): it bends too easily there, and its strain is not known; make body.radius "
                     "smaller");
}

/// Whether a path from one particle to another leaves the body, and both are in it.
bool crosses_gap(const Winding& winding, const Vec3& from, const Vec3& to) {
  constexpr int places = 8;
  const auto inside = [&](const Vec3& place) { return winding.around(place).value_or(1) > 0; };
  bool crosses = false;
  for (int k = 1; k < places; ++k) crosses = crosses || !inside(from + k * (to - from) / places);
  return crosses && inside(from) && inside(to);
}

/// The bodies' contacts without those that cross gaps.
class Contacts {
 public:
  Contacts(const Points& rest, const NeighborLists& lists, const Winding& winding)
      : rest_(rest), lists_(lists), winding_(winding) {}

  std::span<const Particle> of(Particle i) const { return lists_.of(i); }
  bool across(Particle i, Particle j) const { return crosses_gap(winding_, rest_[i], rest_[j]); }

  /// Whether a few contacts within the body lead from one to the other, as where two limbs part.
  bool linked(Particle i, Particle j) const {
    constexpr int contacts = 5;
    std::vector<Particle> reached{i};
    std::size_t begin = 0;
    for (int step = 0; step < contacts; ++step) {
      const std::size_t end = reached.size();
      for (; begin < end; ++begin)
        for (const Particle next : of(reached[begin])) {
          if (std::find(reached.begin(), reached.end(), next) != reached.end()) continue;
          if (across(reached[begin], next)) continue;
          if (next == j) return true;
          reached.push_back(next);
        }
    }
    return false;
  }

 private:
  const Points& rest_;
  const NeighborLists& lists_;
  const Winding& winding_;
};

bool is_parent(const Skeleton& skeleton, int a, int b) {
  return skeleton.bones[a].parent == b || skeleton.bones[b].parent == a;
}

using Pairs = std::vector<std::pair<Particle, Particle>>;

/// Every so many of them, evenly, at most so many.
std::size_t thin_out(Pairs& pairs, std::size_t limit) {
  const std::size_t stride = 1 + pairs.size() / limit;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs.size(); k += stride) pairs[kept++] = pairs[k];
  pairs.resize(kept);
  return stride;
}

/// Finds pairs that touch, of bones of which neither holds the other.
Pairs pairs_of_limbs(const Body& body, const NeighborLists& lists) {
  Pairs pairs;
  for (Particle i = 0; i < body.rest.size(); ++i)
    for (const Particle j : lists.of(i)) {
      const int a = body.binding.bone(i), b = body.binding.bone(j);
      if (i < j && a != b && a != no_bone && b != no_bone && !is_parent(body.skeleton, a, b))
        pairs.emplace_back(i, j);
    }
  return pairs;
}

/// Limbs with a gap between them that is thinner than the particles.
void warn_of_gaps(const Body& body, const Surface& surface, const NeighborLists& lists,
                  Warnings& warnings) {
  constexpr std::size_t examined = 5000, followed = 200;  // pairs: seconds at most
  Pairs pairs = pairs_of_limbs(body, lists);
  if (pairs.empty()) return;
  const Winding winding = winding_of(surface);
  const Contacts contacts(body.rest, lists, winding);
  std::size_t each = thin_out(pairs, examined);
  std::erase_if(pairs, [&](const auto& pair) { return !contacts.across(pair.first, pair.second); });
  each *= thin_out(pairs, followed);
  TouchedParts touching(each);
  for (const auto& [i, j] : pairs)
    if (!contacts.linked(i, j)) touching.add(body.binding.bone(i), body.binding.bone(j), i, j);
  touching.warn(body.skeleton,
                " touch across a gap of the mesh that is thinner than they are, and stick to each "
                "other; make body.radius smaller, or set body.clearance to half of it",
                warnings);
}

// In the motion.

/// Whether the lower bone holds the other, over some generations: a bend folds the body there.
bool holds(const Skeleton& skeleton, int bone, int other) {
  constexpr int generations = 3;
  for (int k = 0; k <= generations && other != no_bone; ++k) {
    if (other == bone) return true;
    other = skeleton.bones[other].parent;
  }
  return false;
}

/// Particles at the body's surface, every so many of them.
std::vector<Particle> outer_particles(const Body& body, const NeighborLists& lists) {
  constexpr std::size_t enough = 60'000;
  std::vector<Particle> outer;
  for (Particle i = 0; i < body.rest.size(); ++i)
    if (lists.of(i).size() < complete_neighbors && body.binding.bone(i) != no_bone)
      outer.push_back(i);
  const std::size_t stride = 1 + outer.size() / enough;
  std::vector<Particle> some;
  for (std::size_t k = 0; k < outer.size(); k += stride) some.push_back(outer[k]);
  return some;
}

Vec3 carried_by_bones(const Body& body, const Pose& pose, Particle i) {
  Vec3 place = Vec3::Zero();
  for (const Influence& one : body.binding.of(i))
    place += one.weight * pose[one.bone].carried(body.rest[i], body.skeleton.bones[one.bone]);
  return place;
}

/// Limbs that meet as the bones carry them.
TouchedParts meeting(const Body& body, const Pose& pose, const std::vector<Particle>& outer) {
  constexpr double apart = 1.5;  // ranges of the attraction, at rest
  const double range = body.material.pair.b;
  Points now;
  for (const Particle i : outer) now.push_back(carried_by_bones(body, pose, i));
  const NeighborLists near = neighbors_within(now, range);
  TouchedParts touching;
  for (std::size_t k = 0; k < outer.size(); ++k)
    for (const Particle other : near.of(k)) {
      const Particle i = outer[k], j = outer[other];
      const int a = body.binding.bone(i), b = body.binding.bone(j);
      if (other > k && !body.pass_through.between(a, b) && !holds(body.skeleton, a, b) &&
          !holds(body.skeleton, b, a) && (body.rest[i] - body.rest[j]).norm() > apart * range)
        touching.add(a, b, i, j);
    }
  return touching;
}

void warn_of_meeting_limbs(const Prepared& prepared, const NeighborLists& lists,
                           Warnings& warnings) {
  constexpr int moments = 16;
  const std::vector<Particle> outer = outer_particles(prepared.body, lists);
  const double end = prepared.plan.time(prepared.plan.steps_until(prepared.frames.count));
  PoseCursor poses(prepared.body.skeleton, prepared.motion);
  for (int k = 0; k <= moments; ++k) {
    const double time = end * k / moments;
    const std::size_t before = warnings.size();
    meeting(prepared.body, poses.at(time), outer)
        .warn(prepared.body.skeleton,
              " meet at " + three_digits(time) +
                  " s and stick to each other; set material.cohesion to initial_neighbors, or "
                  "material.model to bonded",
              warnings);
    if (warnings.size() > before) return;
  }
}

}  // namespace

void warn_of_contacts(const Prepared& prepared, Warnings& warnings) {
  const Body& body = prepared.body;
  const SharedNeighbors shared = neighbors_of(body);
  const NeighborLists& lists = shared->nearest;
  warn_of_few_layers(body, lists, warnings);
  warn_of_gaps(body, prepared.surface, lists, warnings);
  const bool sticks = !law_of(body.material).has_memory;
  if (sticks && !prepared.motion.tracks.empty()) warn_of_meeting_limbs(prepared, lists, warnings);
}

}  // namespace sinew
