// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/skeleton.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {

namespace {

using Bones = std::span<const BoneDefinition>;

std::string path_in_bones(std::size_t bone, const std::string& key = "") {
  const std::string path = "bones[" + std::to_string(bone) + "]";
  return key.empty() ? path : path + '.' + key;
}

int index_of(const Skeleton& skeleton, const std::string& name) {
  for (std::size_t i = 0; i < skeleton.size(); ++i)
    if (skeleton.bones[i].name == name) return static_cast<int>(i);
  return no_bone;
}

int parent_of(Bones bones, std::size_t bone, const Skeleton& earlier) {
  const std::string& name = bones[bone].parent;
  if (name.empty()) return no_bone;
  const int parent = index_of(earlier, name);
  if (parent == no_bone)
    throw bad_value(path_in_bones(bone, "parent"),
                    "no bone before this one is named '" + name + "'",
                    "name the parent first, or correct the name");
  return parent;
}

void check_connected(Bones bones, std::size_t bone, int parent) {
  const BoneDefinition& given = bones[bone];
  if (!given.connected.value_or(false)) return;
  const std::string key = path_in_bones(bone, "connected");
  if (given.head)
    throw bad_value(key, "bone '" + given.name + "' is connected and has a head of its own",
                    "take out one of them");
  if (parent == no_bone)
    throw bad_value(key, "bone '" + given.name + "' is connected and has no parent",
                    "name its parent, or give it a head: [x, y, z]");
}

Vec3 head_of(Bones bones, std::size_t bone, const Skeleton& earlier, int parent) {
  const BoneDefinition& given = bones[bone];
  check_connected(bones, bone, parent);
  if (given.head) return *given.head;
  if (parent == no_bone)
    throw bad_value(path_in_bones(bone, "name"),
                    "bone '" + given.name + "' has neither a parent nor a head",
                    "give it a head: [x, y, z]");
  if (!given.connected.value_or(true))
    throw bad_value(path_in_bones(bone, "connected"),
                    "bone '" + given.name + "' is not connected and has no head",
                    "give it a head: [x, y, z]");
  return earlier.bones[static_cast<std::size_t>(parent)].tail();
}

/// Finds the direction of a bone with a length and no tail.
Vec3 direction_of(Bones bones, std::size_t bone, const Skeleton& earlier, int parent) {
  const BoneDefinition& given = bones[bone];
  if (given.direction && given.direction->norm() > 0) return given.direction->normalized();
  if (given.direction)
    throw bad_value(path_in_bones(bone, "direction"),
                    "bone '" + given.name + "' has a direction of no length",
                    "give direction: [x, y, z], not all zero");
  if (parent == no_bone)
    throw bad_value(path_in_bones(bone, "length"),
                    "bone '" + given.name + "' has a length and no direction",
                    "give direction: [x, y, z], or a tail");
  return earlier.bones[static_cast<std::size_t>(parent)].axis();
}

Vec3 tail_of(Bones bones, std::size_t bone, const Skeleton& earlier, int parent, const Vec3& head) {
  const BoneDefinition& given = bones[bone];
  if (given.tail && (given.length || given.direction))
    throw bad_value(path_in_bones(bone, given.length ? "length" : "direction"),
                    "bone '" + given.name + "' has a tail already",
                    "keep either tail or length and direction");
  if (given.tail) return *given.tail;
  if (!given.length)
    throw bad_value(path_in_bones(bone), path_in_bones(bone, "tail") + " is missing",
                    "add tail: [x, y, z], or length: and direction:");
  return head + *given.length * direction_of(bones, bone, earlier, parent);
}

JointLimits limits_of(Bones bones, std::size_t bone) {
  const LimitDefinition& given = bones[bone].limits;
  JointLimits limits;
  if (given.swing) limits.swing = radians(*given.swing);
  if (!given.twist) return limits;
  const auto [least, most] = *given.twist;
  if (!(least <= most))
    throw bad_value(path_in_bones(bone, "limits.twist"),
                    "the twist of bone '" + bones[bone].name + "' could be no number from " +
                        number_text(least) + " to " + number_text(most),
                    "give the smaller limit first");
  limits.min_twist = radians(least);
  limits.max_twist = radians(most);
  return limits;
}

Mat3 frame_of(const Vec3& axis, double roll) {
  Mat3 frame = frame_along(axis);
  if (roll == 0) return frame;
  return Eigen::AngleAxisd(roll, frame.col(0)).toRotationMatrix() * frame;
}

Bone make_bone(Bones bones, std::size_t index, const Skeleton& earlier) {
  const BoneDefinition& given = bones[index];
  if (index_of(earlier, given.name) != no_bone)
    throw bad_value(path_in_bones(index, "name"), "two bones are named '" + given.name + "'",
                    "give each bone a name of its own");
  Bone bone;
  bone.name = given.name;
  bone.parent = parent_of(bones, index, earlier);
  bone.rest.origin = head_of(bones, index, earlier, bone.parent);
  const Vec3 along =
      tail_of(bones, index, earlier, bone.parent, bone.rest.origin) - bone.rest.origin;
  bone.length = along.norm();
  if (!(bone.length > 0))
    throw bad_value(path_in_bones(index, "tail"), "bone '" + given.name + "' has no length",
                    "move its tail away from its head");
  bone.rest.rotation = frame_of(along, radians(given.roll));
  bone.limits = limits_of(bones, index);
  bone.strength = {given.stiffness, given.twist_stiffness, given.axial_stiffness};
  return bone;
}

/// The one of x, y, z along which a unit vector is least. Rounding must not choose between equals:
/// their cross products with it are far apart.
int min_along(const Vec3& unit) {
  constexpr double equal = 1e-6;
  const Vec3 sizes = unit.cwiseAbs();
  int first = 0;
  while (sizes[first] > sizes.minCoeff() + equal) ++first;
  return first;
}

}  // namespace

int bone_named(const Skeleton& skeleton, const std::string& name, const std::string& key) {
  const int bone = index_of(skeleton, name);
  if (bone != no_bone) return bone;
  std::vector<std::string_view> names;
  names.reserve(skeleton.size());
  for (const Bone& one : skeleton.bones) names.emplace_back(one.name);
  const std::string near = nearest(name, names);  // a list of all might be of thousands
  throw bad_value(key, "there is no bone " + shown(name),
                  near.empty() ? "use the name of a bone of the skeleton"
                               : "did you mean " + shown(near) + '?');
}

Skeleton make_skeleton(std::span<const BoneDefinition> bones) {
  if (bones.empty())
    throw bad_value("bones", "the skeleton has no bones",
                    "list at least one below skeleton: bones:");
  Skeleton skeleton;
  for (std::size_t i = 0; i < bones.size(); ++i)
    skeleton.bones.push_back(make_bone(bones, i, skeleton));
  return skeleton;
}

Box bounds(const Skeleton& skeleton) {
  Box box;
  for (const Bone& bone : skeleton.bones) box.extend(bone.head()), box.extend(bone.tail());
  return box;
}

Skeleton placed(Skeleton skeleton, const Placement& placement) {
  const Mat3& turn = placement.turn;
  for (Bone& bone : skeleton.bones) {
    const Mat3 roll = frame_along(bone.axis()).transpose() * bone.rest.rotation;
    bone.length *= placement.scale;
    bone.rest.origin = placement(bone.rest.origin);
    if (turn != Mat3::Identity()) bone.rest.rotation = frame_along(turn * bone.axis()) * roll;
  }
  return skeleton;
}

Mat3 frame_along(const Vec3& axis) {
  Mat3 frame;
  frame.col(0) = axis.normalized();
  frame.col(1) = frame.col(0).cross(Vec3::Unit(min_along(frame.col(0)))).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

namespace {

constexpr double min_length = 1e-6;  // fraction of the skeleton's size: shorter ones are rounding

struct Children {
  Vec3 sum = Vec3::Zero(), farthest = Vec3::Zero();  // offsets from the joint
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

/// Points from head to tail; `unknown` where neither the joint nor its children give it.
Vec3 along(const Joint& joint, const Children& children, double least, const Vec3& unknown) {
  if (joint.end && (*joint.end - joint.place).norm() > least) return *joint.end - joint.place;
  if (children.count > 0) {
    Vec3 mean = children.sum / children.count;
    if (mean.norm() > least) return mean;
  }
  return children.farthest.norm() > least ? children.farthest : unknown;
}

Vec3 unknown_along(const Joint& joint, const Skeleton& earlier, double size) {
  if (joint.parent == no_bone) return Vec3(0, 0, size / 10);
  const Bone& parent = earlier.bones[joint.parent];
  return std::max(parent.length / 10, min_length * size) * parent.axis();
}

/// Gives every joint a unique name.
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
      std::string name = joint.name + "_" + std::to_string(++count);
      if (!given_.contains(name) && taken_.insert(name).second) return name;
    }
  }

 private:
  std::string free_name(std::string name) {
    while (given_.contains(name) || !taken_.insert(name).second) name += '_';
    return name;
  }

  std::unordered_set<std::string> given_, taken_;
  std::unordered_map<std::string, int> counts_;  // suffixes tried: many equal names cost little
};

void check(const std::vector<Joint>& joints) {
  if (joints.empty()) throw bad_input("there are no joints", "export the skeleton with the file");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    if (joint.parent < no_bone || joint.parent >= static_cast<int>(i))
      throw bad_input("joint " + std::to_string(i) + " does not come after its parent",
                      "list parents first");
    if (!is_computable(joint.place) || (joint.end && !is_computable(*joint.end)))
      throw bad_input("the place of joint " + std::to_string(i) + " is too large or not finite",
                      "export the skeleton again");
  }
}

}  // namespace

Skeleton skeleton_of(const std::vector<Joint>& joints, const char* cure) {
  check(joints);
  const double size = size_of(joints);
  if (!(size > 0)) throw bad_input("all joints lie in one point", cure);
  const std::vector<Children> children = children_of(joints);
  Names names(joints);
  Skeleton skeleton;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Vec3 axis =
        along(joints[i], children[i], min_length * size, unknown_along(joints[i], skeleton, size));
    Bone bone{names.of(joints[i], i), joints[i].parent, axis.norm(), {}};
    bone.rest.origin = joints[i].place;
    bone.rest.rotation = frame_along(axis);
    skeleton.bones.push_back(std::move(bone));
  }
  return skeleton;
}

}  // namespace sinew
