// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/joints.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "core/error.h"

namespace sinew {
namespace {

constexpr double least_length = 1e-6;  // of the skeleton's size; directions of less are rounding

struct Children {
  Vec3 sum = Vec3::Zero(), farthest = Vec3::Zero();  // of their offsets from the joint
  int count = 0;
};

std::vector<Children> children_of(const std::vector<Joint>& joints) {
  std::vector<Children> all(joints.size());
  for (const Joint& joint : joints) {
    if (joint.parent == no_bone) continue;
    Children& children = all[joint.parent];
    const Vec3 offset = joint.place - joints[joint.parent].place;
    if (offset.norm() > children.farthest.norm()) children.farthest = offset;
    children.sum += offset;
    ++children.count;
  }
  return all;
}

double size_of(const std::vector<Joint>& joints) {
  Box box;
  for (const Joint& joint : joints) {
    box.extend(joint.place);
    if (joint.end) box.extend(*joint.end);
  }
  return box.diagonal().norm();
}

/// From head to tail; `unknown` where neither the joint nor its children tell.
Vec3 along(const Joint& joint, const Children& children, double least, const Vec3& unknown) {
  if (joint.end && (*joint.end - joint.place).norm() > least) return *joint.end - joint.place;
  if (children.count > 0) {
    const Vec3 mean = children.sum / children.count;
    if (mean.norm() > least) return mean;
  }
  return children.farthest.norm() > least ? children.farthest : unknown;
}

Vec3 unknown_along(const Joint& joint, const Skeleton& earlier, double size) {
  if (joint.parent == no_bone) return Vec3(0, 0, size / 10);
  const Bone& parent = earlier.bones[joint.parent];
  return std::max(parent.length / 10, least_length * size) * parent.axis();
}

/// Gives every joint a name of its own.
class Names {
 public:
  explicit Names(const std::vector<Joint>& joints) {
    for (const Joint& joint : joints) given_.insert(joint.name);
  }

  std::string of(const Joint& joint, std::size_t index) {
    if (!joint.name.empty() && taken_.insert(joint.name).second) return joint.name;
    if (joint.name.empty()) return free_name("joint_" + std::to_string(index));
    int& count = counts_[joint.name];
    count = std::max(count, 1);
    while (true) {
      const std::string name = joint.name + "_" + std::to_string(++count);
      if (!given_.contains(name) && taken_.insert(name).second) return name;
    }
  }

 private:
  std::string free_name(std::string name) {
    while (given_.contains(name) || !taken_.insert(name).second) name += '_';
    return name;
  }

  std::unordered_set<std::string> given_, taken_;
  std::unordered_map<std::string, int> counts_;  // suffixes tried, so that many alike cost little
};

void check(const std::vector<Joint>& joints) {
  if (joints.empty()) throw bad_input("there are no joints", "export the skeleton with the file");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    if (joint.parent < no_bone || joint.parent >= static_cast<int>(i))
      throw bad_input("joint " + std::to_string(i) + " does not come after its parent",
                      "list parents first");
    if (!joint.place.allFinite() || (joint.end && !joint.end->allFinite()))
      throw bad_input("the place of joint " + std::to_string(i) + " is not finite",
                      "export the skeleton again");
  }
}

}  // namespace

Skeleton skeleton_of(const std::vector<Joint>& joints) {
  check(joints);
  const double size = size_of(joints);
  if (!(size > 0))
    throw bad_input("all joints lie in one point", "give them offsets, or an End Site");
  const std::vector<Children> children = children_of(joints);
  Names names(joints);
  Skeleton skeleton;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Vec3 axis = along(joints[i], children[i], least_length * size,
                            unknown_along(joints[i], skeleton, size));
    Bone bone{names.of(joints[i], i), joints[i].parent, axis.norm(), {}};
    bone.rest.origin = joints[i].place;
    bone.rest.rotation = frame_along(axis);
    skeleton.bones.push_back(std::move(bone));
  }
  return skeleton;
}

}  // namespace sinew
