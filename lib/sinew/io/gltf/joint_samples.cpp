// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/joint_samples.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>

namespace sinew {
namespace {

constexpr double most_places = 2e7;  // some 10 s

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// All keys, and even samples from the first to the last.
std::vector<double> sample_times(const GltfNodeMotion& nodes, double rate) {
  if (nodes.times.empty()) return {0};
  std::vector<double> times = nodes.times;
  const double first = times.front(), span = times.back() - first;
  const double samples = std::ceil(span * rate);
  if ((samples + static_cast<double>(times.size())) * static_cast<double>(nodes.places.size()) >
      most_places)
    throw bad_input("it changes the size of joints, or moves nodes between them, for " +
                        std::to_string(span) + " s: too long to sample",
                    "export it without scale, or in parts");
  for (double i = 1; i < samples; ++i) times.push_back(first + span * (i / samples));
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// How a joint has moved since it was bound.
struct Moved {
  Mat3 turn = Mat3::Identity();
  Vec3 head = Vec3::Zero();
};

Moved moved(const GltfBindPose& bind, int index, const std::vector<Affine>& global) {
  if (index < 0) return {};
  const GltfJoint& joint = bind.joints[at(index)];
  const Affine& place = global[at(joint.node)];
  return {nearest_rotation(place.linear() * joint.bind.linear().inverse()), place.translation()};
}

void put_sample(const GltfBindPose& bind, int index, double time, const std::vector<Affine>& global,
                Track& track) {
  const int parent = bind.joints[at(index)].parent;
  const Moved self = moved(bind, index, global), above = moved(bind, parent, global);
  track.rotation.times.push_back(time);
  track.rotation.values.emplace_back(Mat3(above.turn.transpose() * self.turn));
  track.translation.times.push_back(time);
  track.translation.values.push_back(above.turn.transpose() * (self.head - above.head) -
                                     (bound_head(bind, index) - bound_head(bind, parent)));
}

}  // namespace

void put_samples(const GltfBindPose& bind, const GltfTree& tree, const GltfNodeMotion& nodes,
                 const std::vector<GltfLink>& links, double rate, std::vector<Track>& tracks) {
  std::vector<Affine> local(nodes.places.size());
  for (const double time : sample_times(nodes, rate)) {
    for (const int node : tree.order) local[at(node)] = nodes.at(node, time);
    const std::vector<Affine> global = global_places(tree, local);
    for (std::size_t i = 0; i < links.size(); ++i)
      if (!links[i].exact) put_sample(bind, static_cast<int>(i), time, global, tracks[i]);
  }
}

}  // namespace sinew
