// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/figure/anatomy.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

constexpr double alike = 0.1;          // difference of the lengths of two limbs, of the longer
constexpr double shortest_pair = 0.2;  // fraction of the skeleton's size: limbs, not fingers
constexpr double long_link = 0.6;    // fraction of the limb's longest: an upper arm, no collar bone
constexpr double above_head = 0.06;  // fraction of the height, above a head joint without an end
constexpr double below_ankle = 0.04;  // fraction of the height, below the ankle

/// The skeleton as a tree of lengths.
struct Tree {
  std::vector<std::vector<int>> children;
  std::vector<double> link;   // to the parent's head
  std::vector<double> reach;  // the longest way from the head to an end below
  std::vector<int> longest;   // child on that way
};

Tree tree_of(const Skeleton& skeleton) {
  const std::size_t n = skeleton.size();
  Tree tree{std::vector<std::vector<int>>(n), links_of(skeleton), std::vector<double>(n, 0.0),
            std::vector<int>(n, no_bone)};
  for (std::size_t b = n; b-- > 0;) {
    if (tree.longest[b] == no_bone) tree.reach[b] = skeleton.bones[b].length;
    const int parent = skeleton.bones[b].parent;
    if (parent == no_bone) continue;
    tree.children[parent].insert(tree.children[parent].begin(), static_cast<int>(b));
    const double far = tree.link[b] + tree.reach[b];
    if (tree.longest[parent] == no_bone || far >= tree.reach[parent])
      tree.reach[parent] = far, tree.longest[parent] = static_cast<int>(b);
  }
  return tree;
}

/// The longest way between two ends.
double size_of(const Tree& tree) {
  double size = 0;
  for (std::size_t b = 0; b < tree.reach.size(); ++b) {
    double first = 0, second = 0;
    for (const int c : tree.children[b]) {
      const double far = tree.link[c] + tree.reach[c];
      if (far > first)
        second = first, first = far;
      else
        second = std::max(second, far);
    }
    size = std::max({size, first + second, tree.reach[b]});
  }
  return size;
}

/// The bones on the longest way from `bone` to an end.
std::vector<int> longest_way(const Tree& tree, int bone) {
  std::vector<int> way;
  for (; bone != no_bone; bone = tree.longest[bone]) way.push_back(bone);
  return way;
}

/// The bones of two limbs with the first link that is long in both: sides alike are never cut at
/// different joints.
std::array<int, 2> first_long(const Tree& tree, const std::array<int, 2>& limbs) {
  const std::array<std::vector<int>, 2> ways = {longest_way(tree, limbs[0]),
                                                longest_way(tree, limbs[1])};
  const auto link = [&](std::size_t k) {
    return (tree.link[ways[0][k]] + tree.link[ways[1][k]]) / 2;
  };
  const std::size_t size = std::min(ways[0].size(), ways[1].size());
  double most = 0;
  for (std::size_t k = 1; k < size; ++k) most = std::max(most, link(k));
  std::size_t k = 1;
  while (k < size && link(k) < long_link * most) ++k;
  return k < size ? std::array{ways[0][k - 1], ways[1][k - 1]} : limbs;
}

/// The two children of a bone that are most alike in length, if any are.
LimbPair pair_at(const Tree& tree, int fork, double size) {
  LimbPair found;
  double least = alike;
  const std::vector<int>& children = tree.children[fork];
  for (std::size_t i = 0; i < children.size(); ++i)
    for (std::size_t k = i + 1; k < children.size(); ++k) {
      const std::array<int, 2> two = {children[i], children[k]};
      const double a = tree.link[two[0]] + tree.reach[two[0]];
      const double b = tree.link[two[1]] + tree.reach[two[1]];
      if (std::min(a, b) < shortest_pair * size) continue;
      const double apart =
          (std::abs(a - b) + std::abs(tree.link[two[0]] - tree.link[two[1]])) / std::max(a, b);
      if (apart >= least) continue;
      least = apart;
      found.fork = fork, found.first = two, found.length = {a, b};
    }
  if (found.fork == no_bone) return found;
  found.joint = first_long(tree, found.first);
  for (std::size_t side = 0; side < 2; ++side)
    found.tip[side] = longest_way(tree, found.first[side]).back();
  return found;
}

std::vector<int> way_to_root(const Skeleton& skeleton, int bone) {
  std::vector<int> way;
  for (; bone != no_bone; bone = skeleton.bones[bone].parent) way.push_back(bone);
  return way;
}

/// The bones from one to another, both included.
std::vector<int> way_between(const Skeleton& skeleton, int from, int to) {
  std::vector<int> up = way_to_root(skeleton, from), down = way_to_root(skeleton, to);
  int top = no_bone;
  while (!up.empty() && !down.empty() && up.back() == down.back())
    top = up.back(), up.pop_back(), down.pop_back();
  if (top == no_bone) return {};
  up.push_back(top);
  up.insert(up.end(), down.rbegin(), down.rend());
  return up;
}

bool holds(const LimbPair& pair, int bone) {
  return pair.first[0] == bone || pair.first[1] == bone;
}

/// The bones of the longest way from the fork of the arms that is neither an arm nor the trunk.
std::vector<int> head_of(const Tree& tree, const Anatomy& anatomy) {
  const LimbPair& arms = anatomy.arms();
  int first = no_bone;
  for (const int child : tree.children[arms.fork]) {
    const bool in_trunk =
        std::find(anatomy.trunk.begin(), anatomy.trunk.end(), child) != anatomy.trunk.end();
    if (holds(arms, child) || holds(anatomy.legs(), child) || in_trunk) continue;
    if (first == no_bone ||
        tree.link[child] + tree.reach[child] > tree.link[first] + tree.reach[first])
      first = child;
  }
  return longest_way(tree, first);
}

double length_along(const Tree& tree, const std::vector<int>& bones) {
  double length = 0;
  for (const int bone : bones) length += tree.link[bone];
  return length;
}

/// The distance of the soles from the top of the head.
double height_of(const Tree& tree, const Skeleton& skeleton, const Anatomy& anatomy) {
  double leg = 0;  // two links: thigh and shin; the foot lies on the ground
  int b = anatomy.legs().joint[0];
  for (int k = 0; k < 2 && tree.longest[b] != no_bone; ++k) leg += tree.link[b = tree.longest[b]];
  double trunk = 0;
  for (std::size_t k = 1; k < anatomy.trunk.size(); ++k) {
    const int from = anatomy.trunk[k - 1], to = anatomy.trunk[k];
    trunk += skeleton.bones[to].parent == from ? tree.link[to] : tree.link[from];
  }
  double head = length_along(tree, anatomy.head);
  if (!anatomy.head.empty()) head += skeleton.bones[anatomy.head.back()].length;
  const double joints = leg + trunk + head;
  return joints * (1 + below_ankle) + (anatomy.head.size() < 2 ? above_head * joints : 0);
}

/// The two longest pairs; of legs and arms the legs leave nearer to the root.
std::vector<LimbPair> pairs_in(const Tree& tree, const Skeleton& skeleton, double size) {
  std::vector<LimbPair> all;
  for (std::size_t b = 0; b < tree.children.size(); ++b)
    if (LimbPair pair = pair_at(tree, static_cast<int>(b), size); pair.fork != no_bone)
      all.push_back(pair);
  if (all.size() < 2) return {};
  const auto longer = [](const LimbPair& a, const LimbPair& b) { return a.length > b.length; };
  std::stable_sort(all.begin(), all.end(), longer);
  all.resize(2);
  const auto depth = [&](const LimbPair& pair) { return way_to_root(skeleton, pair.fork).size(); };
  if (depth(all[1]) < depth(all[0])) std::swap(all[0], all[1]);
  return all;
}

}  // namespace

std::vector<double> links_of(const Skeleton& skeleton) {
  std::vector<double> links;
  for (const Bone& bone : skeleton.bones)
    links.push_back(
        bone.parent == no_bone ? 0 : (bone.head() - skeleton.bones[bone.parent].head()).norm());
  return links;
}

std::vector<int> longest_children(const Skeleton& skeleton) { return tree_of(skeleton).longest; }

Anatomy anatomy_of(const Skeleton& skeleton) {
  const Tree tree = tree_of(skeleton);
  Anatomy anatomy;
  anatomy.size = anatomy.height = size_of(tree);
  std::vector<LimbPair> pairs = pairs_in(tree, skeleton, anatomy.size);
  if (pairs.empty()) return anatomy;
  anatomy.trunk = way_between(skeleton, pairs[0].fork, pairs[1].fork);
  if (anatomy.trunk.size() < 2) return anatomy;  // both on one bone, or on different roots
  anatomy.pairs = std::move(pairs);
  anatomy.head = head_of(tree, anatomy);
  anatomy.height = height_of(tree, skeleton, anatomy);
  return anatomy;
}

namespace {

Vec3 tail_at(const Skeleton& skeleton, const Pose& pose, int bone) {
  return pose[bone].carried(skeleton.bones[bone].tail(), skeleton.bones[bone]);
}

Vec3 tips_of(const LimbPair& pair, const Skeleton& skeleton, const Pose& pose) {
  return (tail_at(skeleton, pose, pair.tip[0]) + tail_at(skeleton, pose, pair.tip[1])) / 2;
}

}  // namespace

Vec3 up_in(const Anatomy& anatomy, const Skeleton& skeleton, const std::vector<Pose>& poses) {
  Vec3 up = Vec3::Zero();
  if (!anatomy.is_figure()) return up;
  const LimbPair &legs = anatomy.legs(), &arms = anatomy.arms();
  for (const Pose& pose : poses) {
    const Vec3 hips = pose[legs.fork].frame.origin, chest = pose[arms.fork].frame.origin;
    const Vec3 top = anatomy.head.empty() ? chest : tail_at(skeleton, pose, anatomy.head.back());
    up += hips - tips_of(legs, skeleton, pose) + (chest - tips_of(arms, skeleton, pose)) / 2 +
          (top - hips) / 2;
  }
  return up / static_cast<double>(std::max<std::size_t>(poses.size(), 1));
}

std::vector<double> times_in(const Motion& motion, int count) {
  const double last = last_key(motion);
  if (!(last > 0)) return {0};
  std::vector<double> times;
  for (int k = 0; k < count; ++k) times.push_back(last * k / (count - 1));
  return times;
}

}  // namespace sinew
