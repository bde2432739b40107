// SPDX-License-Identifier: GPL-3.0-or-later
// Our triangles and poses against those of VTK's own loader and reader, for files made at random.
#include <sinew/io/gltf/geometry.h>
#include <sinew/io/gltf/rig.h>
#include "io/gltf_rigs.h"

namespace sinew::gltf_vtk_test {

using namespace gltf_files;

constexpr double agreed = 1e-5;  // of the body's size: VTK reckons in single precision

/// How a rig is made.
struct Made {
  std::string interpolation = "LINEAR";
  bool posed = false;           ///< nodes stand otherwise than bound
  bool moving_between = false;  ///< a node between two joints moves
  bool scaled = false;          ///< a joint changes its size
  bool mirrored = false;        ///< the node above all mirrors
  bool whole = false;           ///< rotations are normalized 16-bit numbers
  Form form = Form::packed;
};

/// Nodes 0 "up", 1 "hip", 2 "between", 3 "chest", 4 "leg", 5 "head", 6 the mesh; joints 1, 3, 4, 5.
class Maker {
 public:
  explicit Maker(const Made& made) : made_(made) {}

  Gltf gltf() {
    add_nodes();
    add_mesh();
    add_skin();
    for (const int joint : joints_) add_rotations(joint);
    add_vectors(1, "translation", Vec3(0, 90, 0), 10);
    if (made_.moving_between) add_rotations(2);
    if (made_.scaled) add_vectors(3, "scale", Vec3::Constant(1.2), 0);
    return gltf_;
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vec3 vector() { return {unit(), unit(), unit()}; }
  Quat turn(double most) {
    const Vec3 axis = vector().normalized();
    return Quat(Eigen::AngleAxisd(most * unit(), axis));
  }

  void node(const char* name, const Vec3& place, double scale, const std::vector<int>& children) {
    gltf_.node({{"name", name},
                {"translation", numbers(place)},
                {"rotation", numbers(turn(pi))},
                {"scale", {scale, scale, scale}}});
    if (!children.empty()) gltf_.json["nodes"].back()["children"] = children;
  }

  /// Centimeters, below a node that makes them meters.
  void add_nodes() {
    node("up", Vec3(1, 2, 3), 0.01, {1, 6});
    if (made_.mirrored) gltf_.json["nodes"][0]["scale"][0] = -0.01;
    node("hip", Vec3(0, 90, 0), 1, {2, 4});
    node("between", Vec3(0, 20, 5), 2, {3});
    node("chest", Vec3(5, 15, 0), 0.5, {5});
    node("leg", Vec3(10, -40, 0), 1, {});
    node("head", Vec3(0, 30, 0), 1, {});
    gltf_.node({{"name", "body"}, {"mesh", 0}, {"skin", 0}});
    gltf_.scene({0});
  }

  /// Two primitives; the second has its joints and weights in other numbers.
  void add_mesh() {
    Points points;
    for (int i = 0; i < 40; ++i) points.push_back(60 * vector());
    std::vector<Json> primitives;
    for (const bool second : {false, true}) {
      std::vector<std::uint16_t> corners;
      for (std::uint16_t i = 0; i + 2 < 40; ++i)
        for (std::uint16_t k = 0; k < 3; ++k) corners.push_back(static_cast<std::uint16_t>(i + k));
      primitives.push_back({{"attributes",
                             {{"POSITION", gltf_.positions(points)},
                              {"JOINTS_0", joints(second)},
                              {"WEIGHTS_0", weights()}}},
                            {"indices", gltf_.indices(corners)}});
    }
    gltf_.mesh(primitives);
  }

  int joints(bool wide) {
    std::vector<std::uint8_t> narrow;
    for (int i = 0; i < 160; ++i) narrow.push_back(static_cast<std::uint8_t>(random_() % 4));
    if (!wide) return gltf_.accessor(gltf_.view(raw(narrow)), 40, "VEC4", 5121);
    return gltf_.accessor(gltf_.view(raw(std::vector<std::uint16_t>(narrow.begin(), narrow.end()))),
                          40, "VEC4", 5123);
  }

  int weights() {
    std::vector<float> all;
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector4d four(1 + unit(), 1 + unit(), 1 + unit(), 0);
      for (const double x : four / four.sum()) all.push_back(static_cast<float>(x));
    }
    return gltf_.floats(all, "VEC4");
  }

  /// Bound as the nodes stand, in a space that lies in the scene as node 0 does.
  void add_skin() {
    std::vector<Affine> global(6, Affine::Identity()), inverses;
    const int parents[] = {-1, 0, 1, 2, 1, 3};
    for (std::size_t i = 0; i < 6; ++i) {
      const Json& node = gltf_.json["nodes"][i];
      const auto t = node["translation"].get<std::vector<double>>();
      const auto q = node["rotation"].get<std::vector<double>>();
      const auto s = node["scale"].get<std::vector<double>>();
      Affine local = Eigen::Translation3d(Vec3(t.data())) * Quat(q[3], q[0], q[1], q[2]) *
                     Eigen::Scaling(Vec3(s.data()));
      if (made_.posed && i > 1) local = local * turn(1);
      global[i] = parents[i] < 0 ? local : global[static_cast<std::size_t>(parents[i])] * local;
    }
    for (const int joint : joints_)
      inverses.push_back(global[static_cast<std::size_t>(joint)].inverse() * global[0]);
    gltf_.add("skins", {{"joints", joints_}, {"inverseBindMatrices", gltf_.matrices(inverses)}});
  }

  bool cubic() const { return made_.interpolation == "CUBICSPLINE"; }

  std::vector<float> times() {
    std::vector<float> times = {0.25F * static_cast<float>(1 + unit())};
    for (int i = 0; i < 4; ++i)
      times.push_back(times.back() + static_cast<float>(0.5 + 0.4 * unit()));
    return times;
  }

  void add_rotations(int node) {
    const auto tangent = [&] { return Quat(unit(), unit(), unit(), unit()); };
    std::vector<Quat> values;
    for (int i = 0; i < 5; ++i) {
      if (cubic()) values.push_back(tangent());
      values.push_back(turn(1.5));
      if (!cubic() && unit() < 0) values.back().coeffs() *= -1;  // the same rotation
      if (cubic()) values.push_back(tangent());
    }
    if (made_.whole) return add_whole_rotations(node, values);
    add_keys(gltf_, node, "rotation", made_.interpolation, times(), values);
  }

  void add_whole_rotations(int node, const std::vector<Quat>& values) {
    std::vector<std::int16_t> parts;
    for (const float x : floats(values))
      parts.push_back(static_cast<std::int16_t>(std::lround(32767 * x)));
    const int output = gltf_.accessor(gltf_.view(raw(parts)), values.size(), "VEC4", 5122);
    gltf_.json["accessors"][output]["normalized"] = true;
    add_channel(gltf_, 0, node, "rotation", made_.interpolation, gltf_.floats(times(), "SCALAR"),
                output);
  }

  void add_vectors(int node, const char* path, const Vec3& about, double most) {
    std::vector<Vec3> values;
    for (int i = 0; i < 5; ++i) {
      const Vec3 uneven = most * vector(),
                 even = most > 0 ? Vec3::Zero() : Vec3::Constant(0.2 * unit());
      if (cubic()) values.push_back(most * vector());
      values.push_back(about + uneven + even);
      if (cubic()) values.push_back(most * vector());
    }
    add_keys(gltf_, node, path, made_.interpolation, times(), values);
  }

  Made made_;
  std::mt19937 random_{11};
  Gltf gltf_;
  const std::vector<int> joints_ = {1, 3, 4, 5};
};

class GltfRigAndVtk : public Scratch {
 protected:
  void make(const Made& made) {
    path = write(folder, Maker(made).gltf(), made.form);
    rig = read_gltf_rig(path);
    at_bind = vtk_pose(path, -1, 0).joints.at(0);
    for (const Vec3& point : rig.mesh.points) box.extend(point);
  }

  Pose pose(double time) const {
    return pose_at(rig.rig.skeleton, rig.rig.clips.at(0).motion, time);
  }

  /// The largest distance between where the bone and VTK's joint take the corners of the body's
  /// box.
  double joint_error(const Pose& pose, const VtkPose& vtk) const {
    const char* names[] = {"hip", "chest", "leg", "head"};
    double most = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < rig.rig.skeleton.size(); ++k)
        for (int corner = 0; corner < 8; ++corner) {
          const Bone& bone = rig.rig.skeleton.bones[k];
          if (bone.name != names[i]) continue;
          const Vec3 x = box.corner(static_cast<Box::CornerType>(corner));
          const Vec3 expected = vtk.joints.at(i) * (at_bind.inverse() * x);
          most = std::max(most, (carried(x, bone.rest, pose[k].frame) - expected).norm());
        }
    return most / box.diagonal().norm();
  }

  /// Allows for the triangles of a mirrored body, which we turn and VTK does not.
  double corner_error(const Pose& pose, const VtkPose& vtk) const {
    const bool mirrored = at_bind.linear().determinant() < 0;
    const Points corners = skinned_corners(rig, pose);
    EXPECT_EQ(corners.size(), vtk.corners.size());
    double most = 0;
    for (std::size_t i = 0; i < std::min(corners.size(), vtk.corners.size()); ++i) {
      const std::size_t same = mirrored && i % 3 > 0 ? i + 3 - 2 * (i % 3) : i;
      most = std::max(most, (corners[i] - vtk.corners[same]).norm());
    }
    return most / box.diagonal().norm();
  }

  void expect_agreement(const std::vector<double>& times) {
    double joints = 0, corners = 0;
    for (const double time : times) {
      const VtkPose vtk = vtk_pose(path, 0, time);
      joints = std::max(joints, joint_error(pose(time), vtk));
      corners = std::max(corners, corner_error(pose(time), vtk));
    }
    EXPECT_LT(joints, agreed);
    EXPECT_LT(corners, agreed);
  }

  std::vector<double> ten_times() const {
    std::vector<double> times;
    for (int i = 0; i < 10; ++i) times.push_back(rig.rig.clips.at(0).duration * (i + 0.5) / 9);
    return times;
  }

  /// Returns the times of one bone's samples.
  std::vector<double> sample_times(const char* bone) const {
    for (const Track& track : rig.rig.clips.at(0).motion.tracks)
      if (rig.rig.skeleton.bones[static_cast<std::size_t>(track.bone)].name == bone)
        return track.rotation.times;
    return {};
  }

  std::filesystem::path path;
  SkinnedRig rig;
  Affine at_bind;
  Box box;
};

TEST_F(GltfRigAndVtk, AgreeOnEveryKindOfKeys) {
  for (const char* interpolation : {"STEP", "LINEAR", "CUBICSPLINE"})
    for (const bool posed : {false, true}) {
      SCOPED_TRACE(std::string(interpolation) + (posed ? ", posed" : ""));
      make({interpolation, posed});
      expect_agreement(ten_times());
    }
}

TEST_F(GltfRigAndVtk, AgreeOnAFileOfText) {
  make({.form = Form::embedded});
  expect_agreement(ten_times());
}

TEST_F(GltfRigAndVtk, AgreeOnRotationsInWholeNumbers) {
  make({.whole = true});
  expect_agreement(ten_times());
}

TEST_F(GltfRigAndVtk, AgreeOnSamplesWhereANodeBetweenJointsMoves) {
  make({.moving_between = true});
  EXPECT_EQ(sample_times("hip").size(), 5u) << "above that node keys stay keys";
  const std::vector<double> times = sample_times("chest");
  EXPECT_GT(times.size(), 60u);
  expect_agreement(times);
}

TEST_F(GltfRigAndVtk, AgreeOnSamplesOfMirroredRigs) {
  make({.mirrored = true});
  expect_agreement(sample_times("chest"));
}

TEST_F(GltfRigAndVtk, AgreeOnWhereHeadsAreWhenJointsChangeTheirSize) {
  make({.scaled = true});
  const std::vector<double> times = sample_times("head");
  EXPECT_GT(times.size(), 60u);
  for (const double time : times) {
    const Pose now = pose(time);
    const VtkPose vtk = vtk_pose(path, 0, time);
    for (std::size_t bone = 0; bone < 4; ++bone) {  // hip, chest, head, leg: depth first
      const std::size_t joint = bone < 2 ? bone : 5 - bone;
      const Vec3 head = rig.rig.skeleton.bones[bone].head();
      EXPECT_LT((now[bone].frame.origin - vtk.joints[joint] * (at_bind.inverse() * head)).norm(),
                agreed * box.diagonal().norm());
    }
  }
}

/// Interleaved positions, some of them sparse, and corners in these numbers, below two places.
template <class Number>
Gltf scattered(int mode, unsigned seed) {
  std::mt19937 random(seed);
  const auto unit = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
  Gltf gltf;
  std::vector<float> mixed(2 + 5 * 20), over(3 * 3);
  for (auto* all : {&mixed, &over}) std::generate(all->begin(), all->end(), unit);
  const int points = gltf.accessor(gltf.view(raw(mixed), 20), 20, "VEC3", 5126);
  gltf.json["accessors"][points]["byteOffset"] = 8;
  const int at = gltf.view(raw(std::vector<Number>{2, 7, 19}));
  gltf.json["accessors"][points]["sparse"] = {
      // VTK wants all offsets
      {"count", 3},
      {"indices",
       {{"bufferView", at}, {"byteOffset", 0}, {"componentType", component_type<Number>()}}},
      {"values", {{"bufferView", gltf.view(raw(over))}, {"byteOffset", 0}}}};
  std::vector<Number> corners(30);
  for (Number& corner : corners) corner = static_cast<Number>(random() % 20);
  gltf.mesh({{{"attributes", {{"POSITION", points}}},
              {"indices", gltf.indices(corners)},
              {"mode", mode}}});
  const Quat turn = Quat(unit(), unit(), unit(), unit()).normalized();
  const int child = gltf.node({{"mesh", 0}, {"translation", {unit(), unit(), unit()}}});
  const int above = gltf.node({{"rotation", numbers(turn)},
                               {"scale", {2 + unit(), 2 + unit(), 2 + unit()}},
                               {"children", {child}}});
  const int beside = gltf.node(
      {{"mesh", 0}, {"matrix", {1, 0.5, 0, 0, -0.5, 2, 0, 0, 0, 0.25, 3, 0, unit(), 4, 5, 1}}});
  gltf.scene({beside, above});
  return gltf;
}

class GltfTrianglesAndVtk : public Scratch {
 protected:
  void expect_agreement(const Gltf& gltf) {
    const auto path = write(folder, gltf, Form::packed);
    const PolygonSoup soup = read_gltf(path);
    const Points expected = vtk_corners(path, -1, 0);
    ASSERT_EQ(3 * soup.polygons.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_LT((soup.points.at(soup.polygons[i / 3][i % 3]) - expected[i]).norm(), 10 * agreed);
  }
};

TEST_F(GltfTrianglesAndVtk, AgreeOnEveryLayoutOfNumbers) {
  for (const int mode : {4, 6})  // triangles, fans
    for (unsigned seed = 0; seed < 5; ++seed) {
      expect_agreement(scattered<std::uint8_t>(mode, seed));
      expect_agreement(scattered<std::uint16_t>(mode, seed));
      expect_agreement(scattered<std::uint32_t>(mode, seed));
    }
}

}  // namespace sinew::gltf_vtk_test
