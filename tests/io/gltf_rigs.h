// SPDX-License-Identifier: GPL-3.0-or-later
// glTF files of rigs, made piece by piece, and what VTK's own loader makes of them.
#pragma once

#include <random>

#include <sinew/core/vector.h>
#include <sinew/io/gltf/rig.h>
#include <sinew/rig/motion.h>
#include "io/gltf_files.h"

namespace sinew::gltf_files {

using Affine = Eigen::Affine3d;

inline std::vector<double> numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline std::vector<double> numbers(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

/// Values for a sampler, number by number.
template <class Value>
std::vector<float> floats(const std::vector<Value>& values) {
  std::vector<float> all;
  for (const Value& value : values)
    for (const double x : numbers(value)) all.push_back(static_cast<float>(x));
  return all;
}

/// A channel of animation `animation`, which is made when it is not there yet.
inline void add_channel(Gltf& gltf, std::size_t animation, int node, const std::string& path,
                        const std::string& interpolation, int times, int values) {
  Json& animations = gltf.json["animations"];
  if (animations.size() <= animation) animations.push_back({{"name", "clip"}});
  Json& it = animations[animation];
  it["channels"].push_back(
      {{"sampler", it["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  it["samplers"].push_back(
      {{"input", times}, {"output", values}, {"interpolation", interpolation}});
}

template <class Value>
void add_keys(Gltf& gltf, int node, const std::string& path, const std::string& interpolation,
              const std::vector<float>& times, const std::vector<Value>& values,
              std::size_t animation = 0) {
  const int input = gltf.floats(times, "SCALAR");
  const int output = gltf.floats(floats(values), path == "rotation" ? "VEC4" : "VEC3");
  add_channel(gltf, animation, node, path, interpolation, input, output);
}

/// A bar along z, from 0 to 2 m, bound to two joints: nodes 0 "lower" and, at 1 m, 1 "upper", which
/// ends at node 2; node 3 shows the mesh.
inline Gltf bar() {
  Gltf gltf;
  PolygonSoup soup;
  for (const double z : {0.0, 0.5, 1.0, 1.5, 2.0})
    for (const Vec3& corner : {Vec3(0.1, 0, z), Vec3(-0.1, 0.1, z), Vec3(-0.1, -0.1, z)})
      soup.points.push_back(corner);
  for (int i = 0; i + 5 < 15; ++i) soup.polygons.push_back({i, i + 1, i + 3});
  const int mesh = gltf.mesh(soup);
  std::vector<std::uint8_t> joints;
  std::vector<float> weights;
  for (const Vec3& point : soup.points) {
    joints.insert(joints.end(), {0, 1, 0, 0});
    const float upper = static_cast<float>(point.z() / 2);
    weights.insert(weights.end(), {1 - upper, upper, 0, 0});
  }
  Json& attributes = gltf.json["meshes"][mesh]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = gltf.accessor(gltf.view(raw(joints)), 15, "VEC4", 5121);
  attributes["WEIGHTS_0"] = gltf.floats(weights, "VEC4");
  gltf.node({{"name", "lower"}, {"children", {1}}});
  gltf.node({{"name", "upper"}, {"children", {2}}, {"translation", {0, 0, 1}}});
  gltf.node({{"name", "end"}, {"translation", {0, 0, 1}}});
  gltf.node({{"name", "body"}, {"mesh", 0}, {"skin", 0}});
  gltf.scene({0, 3});
  const Affine upper(Eigen::Translation3d(0, 0, -1));
  gltf.add("skins", {{"joints", {0, 1}},
                     {"inverseBindMatrices", gltf.matrices({Affine::Identity(), upper})}});
  return gltf;
}

/// The bar, whose upper half turns about y by 90 degrees in one second.
inline Gltf bending_bar(const std::string& interpolation = "LINEAR") {
  Gltf gltf = bar();
  const Quat bent(Eigen::AngleAxisd(pi / 2, Vec3::UnitY())), none(0, 0, 0, 0);
  std::vector<Quat> values = {Quat::Identity(), bent};
  if (interpolation == "CUBICSPLINE") values = {none, Quat::Identity(), none, none, bent, none};
  add_keys(gltf, 1, "rotation", interpolation, {0, 1}, values);
  return gltf;
}

/// Where VTK's own loader and reader put joints and corners.
struct VtkPose {
  std::vector<Affine> joints;  ///< G I of each joint of skin 0
  Points corners;              ///< of the deformed triangles that vtkGLTFReader shows
};

VtkPose vtk_pose(const std::filesystem::path& path, int animation, double time);
Points vtk_corners(const std::filesystem::path& path, int animation, double time);

/// Where our rig puts the corners of its mesh, each carried by its bones as they are weighted.
Points skinned_corners(const SkinnedRig& rig, const Pose& pose);

}  // namespace sinew::gltf_files
