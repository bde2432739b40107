// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/detail/joint_zones.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew {
namespace {

// A head within this fraction of the parent's length from its tail is a joint at the tail.
constexpr double near_tail = 0.25;
constexpr std::size_t max_sharing = 100;  // children of one joint: each is compared with each
constexpr double no_width = 1e-9;         // width of a zone below which only the distances decide

/// Limit of a zone's length, m: both bones have joints at their other end.
double longest_between(const JointZones& zones, const Skeleton& skeleton,
                       const std::vector<bool>& has_child, int child) {
  double longest = std::numeric_limits<double>::infinity();
  const int parent = zones.parent[child];
  if (has_child[child]) longest = skeleton.bones[child].length;
  if (zones.parent[parent] != no_bone) longest = std::min(longest, skeleton.bones[parent].length);
  return longest;
}

JointZone zone_above(const Skeleton& skeleton, int bone, double length) {
  const Bone& child = skeleton.bones[bone];
  const Bone& parent = skeleton.bones[child.parent];
  const Vec3 axis = parent.axis() + child.axis();
  JointZone zone{length, false, child.head(), Vec3::Zero()};
  zone.across_axis =
      (child.head() - parent.tail()).norm() < near_tail * parent.length && axis.norm() > 1e-6;
  if (zone.across_axis) zone.axis = axis.normalized();
  return zone;
}

/// Which of two bones a point belongs to over a zone of `width`: 1 for the one that is nearer by
/// half of it, 0 for the other.
double weight_of_nearer(double distance, double distance_to_other, double width) {
  if (std::isinf(distance)) return 0;
  const double nearer = distance_to_other - distance;
  if (!(width > no_width * (distance + 1e-300))) return nearer > 0 ? 1 : nearer < 0 ? 0 : 0.5;
  return std::clamp(0.5 + nearer / width, 0.0, 1.0);
}

using Distance = std::function<double(int)>;

/// The child's weight against its parent alone: 0 on the parent's side of the zone, 1 beyond it.
double weight_of_child(const JointZones& zones, int child, const Vec3& point,
                       const Distance& distance) {
  const JointZone& zone = zones.above[child];
  if (zone.across_axis)
    return std::clamp(0.5 + (point - zone.place).dot(zone.axis) / zone.length, 0.0, 1.0);
  return weight_of_nearer(distance(child), distance(zones.parent[child]), zone.length);
}

/// How children divide their common weight, by their distances; `width` is a factor on their zones.
std::vector<double> parted(const JointZones& zones, const std::vector<int>& children,
                           const std::vector<double>& distances, double width) {
  std::vector<double> parts(children.size(), 1.0);
  double sum = 0;
  for (std::size_t i = 0; i < children.size(); ++i) {
    for (std::size_t j = 0; j < children.size(); ++j) {
      if (i == j) continue;
      const double length = (zones.above[children[i]].length + zones.above[children[j]].length) / 2;
      parts[i] *= weight_of_nearer(distances[i], distances[j], width * length);
    }
    sum += parts[i];
  }
  for (double& part : parts) part = sum > 0 ? part / sum : 0;
  return parts;
}

/// Children with their distances; of very many the nearest.
std::vector<std::pair<double, int>> sharing(const std::vector<int>& children,
                                            const Distance& distance) {
  std::vector<std::pair<double, int>> all;
  all.reserve(children.size());
  for (const int child : children) all.emplace_back(distance(child), child);
  if (all.size() <= max_sharing) return all;
  std::nth_element(all.begin(), all.begin() + max_sharing, all.end());
  all.resize(max_sharing);
  return all;
}

/// Adds the weights of the children of one bone, which has several; the rest of 1 is the parent's.
void add_children(const JointZones& zones, int parent, const Vec3& point, const Distance& distance,
                  std::vector<BoneWeight>& weights) {
  std::vector<int> children;
  std::vector<double> distances;
  for (const auto& [far, child] : sharing(zones.children[parent], distance)) {
    distances.push_back(far);
    children.push_back(child);
  }
  const std::vector<double> near = parted(zones, children, distances, 1);
  double of_all = 0;
  for (std::size_t i = 0; i < children.size(); ++i)
    if (near[i] > 0) of_all += near[i] * weight_of_child(zones, children[i], point, distance);
  const std::vector<double> parts = parted(zones, children, distances, 1 - of_all);
  for (std::size_t i = 0; i < children.size(); ++i)
    weights.push_back({children[i], of_all * parts[i]});
}

/// Adds the bones that meet at the joints below `parent`; the first one keeps the remaining weight.
void add_family(const JointZones& zones, int parent, const Vec3& point, const Distance& distance,
                std::vector<BoneWeight>& weights) {
  const std::vector<int>& children = zones.children[parent];
  if (children.empty()) return;
  const std::size_t before = weights.size();
  if (children.size() == 1)
    weights.push_back({children[0], weight_of_child(zones, children[0], point, distance)});
  else
    add_children(zones, parent, point, distance, weights);
  double of_children = 0;
  for (std::size_t k = before; k < weights.size(); ++k) of_children += weights[k].weight;
  weights.push_back({parent, std::max(0.0, 1 - of_children)});
  const int lead = weights.front().bone;
  weights.erase(std::remove_if(weights.begin() + static_cast<std::ptrdiff_t>(before), weights.end(),
                               [lead](const BoneWeight& one) { return one.bone == lead; }),
                weights.end());
  double of_others = 0;
  for (std::size_t k = before; k < weights.size(); ++k) of_others += weights[k].weight;
  weights.front().weight *= std::max(0.0, 1 - of_others);
}

}  // namespace

double JointZones::longest() const {
  double length = 0;
  for (const JointZone& zone : above) length = std::max(length, zone.length);
  return length;
}

JointZones joint_zones(const Skeleton& skeleton, const std::vector<double>& section,
                       double joint_zone) {
  const std::size_t bones = skeleton.size();
  JointZones zones;
  std::vector<bool> has_child(bones);
  for (const Bone& bone : skeleton.bones) {
    zones.parent.push_back(bone.parent);
    if (bone.parent != no_bone) has_child[bone.parent] = true;
  }
  zones.above.resize(bones);
  zones.children.resize(bones);
  zones.before.assign(bones, 0.0);
  zones.beyond.assign(bones, 0.0);
  for (std::size_t b = 0; b < bones; ++b) {
    const int child = static_cast<int>(b), parent = zones.parent[b];
    if (parent == no_bone) continue;
    const double length = std::min(joint_zone * std::sqrt((section[b] + section[parent]) / 2),
                                   longest_between(zones, skeleton, has_child, child));
    if (!(length > 0)) continue;
    zones.above[b] = zone_above(skeleton, child, length);
    zones.children[parent].push_back(child);
    if (!zones.above[b].across_axis) continue;
    zones.before[b] = std::max(zones.before[b], length / 2);
    zones.beyond[parent] = std::max(zones.beyond[parent], length / 2);
  }
  return zones;
}

std::vector<BoneWeight> weights_in_zones(const JointZones& zones, int lead, const Vec3& point,
                                         const Distance& distance) {
  std::vector<BoneWeight> weights;
  weights.reserve(5);  // one allocation for chains of bones
  weights.push_back({lead, 1});
  if (zones.parent[lead] != no_bone && zones.above[lead].length > 0)
    add_family(zones, zones.parent[lead], point, distance, weights);
  add_family(zones, lead, point, distance, weights);
  std::erase_if(weights, [](const BoneWeight& one) { return one.weight <= 0; });
  double sum = 0;
  for (const BoneWeight& one : weights) sum += one.weight;
  for (BoneWeight& one : weights) one.weight /= sum;
  std::stable_sort(weights.begin(), weights.end(),
                   [](const BoneWeight& a, const BoneWeight& b) { return a.weight > b.weight; });
  return weights;
}

}  // namespace sinew
