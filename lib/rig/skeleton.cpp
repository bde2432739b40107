// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/skeleton.h"

#include <cmath>

namespace sinew {
namespace {

std::string path_of(std::size_t bone, const char* key) {
  return "skeleton.bones[" + std::to_string(bone) + "]." + key;
}

int index_of(const Skeleton& skeleton, const std::string& name) {
  for (std::size_t i = 0; i < skeleton.size(); ++i)
    if (skeleton.bones[i].name == name) return static_cast<int>(i);
  return no_bone;
}

int parent_of(const Settings& settings, std::size_t bone, const Skeleton& earlier) {
  const std::string& name = settings.bones[bone].parent;
  if (name.empty()) return no_bone;
  const int parent = index_of(earlier, name);
  if (parent == no_bone)
    throw bad_input(settings.place(path_of(bone, "parent")),
                    "no bone before this one is named '" + name + "'",
                    "name the parent first, or correct the name");
  return parent;
}

Vec3 head_of(const Settings& settings, std::size_t bone, const Skeleton& earlier, int parent) {
  if (settings.bones[bone].head) return *settings.bones[bone].head;
  if (parent == no_bone)
    throw bad_input(settings.place(path_of(bone, "name")),
                    "bone '" + settings.bones[bone].name + "' has neither a parent nor a head",
                    "give it a head: [x, y, z]");
  return earlier.bones[parent].tail();
}

Bone make_bone(const Settings& settings, std::size_t index, const Skeleton& earlier) {
  const BoneSettings& given = settings.bones[index];
  if (index_of(earlier, given.name) != no_bone)
    throw bad_input(settings.place(path_of(index, "name")),
                    "two bones are named '" + given.name + "'", "give each bone a name of its own");
  Bone bone;
  bone.name = given.name;
  bone.parent = parent_of(settings, index, earlier);
  bone.rest.origin = head_of(settings, index, earlier, bone.parent);
  const Vec3 along = given.tail - bone.rest.origin;
  bone.length = along.norm();
  if (!(bone.length > 0))
    throw bad_input(settings.place(path_of(index, "tail")),
                    "bone '" + given.name + "' has no length", "move its tail away from its head");
  bone.rest.rotation = frame_along(along);
  return bone;
}

}  // namespace

Skeleton make_skeleton(const Settings& settings) {
  if (settings.bones.empty())
    throw bad_input(settings.place("skeleton.bones"), "the skeleton has no bones",
                    "list at least one below skeleton: bones:");
  Skeleton skeleton;
  for (std::size_t i = 0; i < settings.bones.size(); ++i)
    skeleton.bones.push_back(make_bone(settings, i, skeleton));
  return skeleton;
}

Mat3 frame_along(const Vec3& axis) {
  Mat3 frame;
  frame.col(0) = axis.normalized();
  int flattest = 0;
  frame.col(0).cwiseAbs().minCoeff(&flattest);
  frame.col(1) = frame.col(0).cross(Vec3::Unit(flattest)).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

}  // namespace sinew
