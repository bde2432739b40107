// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_scene.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <sinew/core/text.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/winding.h>
#include <sinew/rig/figure/figure.h>
#include <sinew/rig/rest_at.h>
#include <sinew/scene/new/capsules.h>
#include <sinew/scene/scene_files.h>

namespace sinew {
namespace {

constexpr double longest_rig_in_m = 20;                      // length of a rig that is no figure
constexpr double shortest_human = 1.5, tallest_human = 1.9;  // m
constexpr double clearly_up = 1.3;        // times as far along one axis as along y
constexpr double side = 0.014;            // side of the skin's faces, over the height
constexpr double min_bones_inside = 0.9;  // fraction of the bones, in the skin of a figure
constexpr int poses_for_up = 60;

struct CaptureUnit {
  double meters;
  const char* name;
};

/// Units of the files of motion capture, the usual ones first.
constexpr std::array<CaptureUnit, 6> capture_units = {
    {{1, "meters"},
     {0.01, "centimeters"},
     {0.1, "decimeters"},
     {0.0254, "inches"},
     {0.0254 / 0.45, "units of 1/0.45 inch, as CMU's"},
     {0.001, "millimeters"}}};

double misfit(double height) {
  return height < shortest_human  ? std::log(shortest_human / height)
         : height > tallest_human ? std::log(height / tallest_human)
                                  : 0;
}

/// The unit in which a figure is as tall as a human, or as nearly as possible.
void choose_unit(double height, RigBody& body) {
  const CaptureUnit* best = &capture_units[0];
  for (const CaptureUnit& unit : capture_units)
    if (misfit(height * unit.meters) < misfit(height * best->meters) - 1e-9) best = &unit;
  body.skeleton.scale = best->meters;
  body.unit = "the figure is " + three_digits(height) + " tall: in " + best->name + ' ' +
              three_digits(height * best->meters) + " m";
}

void choose_size(double size, RigBody& body) {
  const bool is_long = size > longest_rig_in_m;
  body.skeleton.scale = is_long ? 0.01 : 1;
  body.unit = "the rig is " + three_digits(size) +
              " long: " + (is_long ? "centimeters" : "meters") + " fit";
}

/// A direction as an axis of a file.
Axis nearest_axis(const Vec3& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return static_cast<Axis>(axis + (direction[axis] < 0 ? 3 : 0));
}

/// y, as is usual, unless the figure stands along another axis.
Axis up_of(const Anatomy& anatomy, const Rig& rig) {
  std::vector<Pose> poses;
  if (rig.clips.empty())
    poses.push_back(rest_pose(rig.skeleton));
  else
    for (const double time : times_in(rig.clips.front().motion, poses_for_up))
      poses.push_back(pose_at(rig.skeleton, rig.clips.front().motion, time));
  const Vec3 up = up_in(anatomy, rig.skeleton, poses);
  const double usual = std::max(up.y(), 0.0);
  return up.cwiseAbs().maxCoeff() > clearly_up * usual ? nearest_axis(up) : Axis::y;
}

Vec3 direction_of(Axis axis) {
  const int index = static_cast<int>(axis) % 3;
  return axis < Axis::minus_x ? Vec3::Unit(index) : Vec3(-Vec3::Unit(index));
}

void choose_axes(Axis up, RigBody& body) {
  constexpr std::array<const char*, 6> names = {"x", "y", "z", "-x", "-y", "-z"};
  body.skeleton.up = up;
  if (up == Axis::y) body.skeleton.forward = Axis::z;
  body.axes = std::string(names[static_cast<std::size_t>(up)]) + " of the rig";
}

/// One skin around all parts.
Triangles skin_of(const std::vector<FigurePart>& parts, double height) {
  std::vector<Capsule> capsules;
  for (const FigurePart& part : parts)
    if (part.radius >= 1e-3 * height) capsules.push_back({part.from, part.to, part.radius});
  return skin_around(capsules, side * height);
}

/// The fraction of the middles of bones that lie in a skin.
double fraction_inside(const Skeleton& skeleton, const Triangles& skin) {
  const Winding winding = winding_of(clean(soup_of(skin)));
  const auto inside =
      std::count_if(skeleton.bones.begin(), skeleton.bones.end(), [&](const Bone& bone) {
        return winding.around((bone.head() + bone.tail()) / 2).value_or(0) > 0;
      });
  return static_cast<double>(inside) / static_cast<double>(skeleton.size());
}

}  // namespace

RigBody body_of_rig(const std::string& path) {
  Rig rig = read_rig(path, {}).rig;
  RigBody body;
  body.skeleton.file = path;
  Anatomy anatomy = anatomy_of(rig.skeleton);
  const Axis up = up_of(anatomy, rig);
  choose_axes(up, body);
  body.skeleton.rest_at = best_pose(rig, anatomy, direction_of(up));
  if (body.skeleton.rest_at) {
    rig = with_rest_at(rig, rig.clips.front().motion, *body.skeleton.rest_at);
    anatomy = anatomy_of(rig.skeleton);
    body.pose = "At rest the rig is no figure: the skin is that of " +
                three_digits(*body.skeleton.rest_at) + " s of the clip";
  }
  if (anatomy.is_figure())
    choose_unit(anatomy.height, body), body.axes += ": the head is above the feet";
  else
    choose_size(bounds(rig.skeleton).sizes().maxCoeff(), body), body.axes += ", as is usual";
  const Skeleton there = placed(std::move(rig.skeleton), placement_of(body.skeleton));
  anatomy = anatomy_of(there);
  body.skin = skin_of(figure_of(there, anatomy), anatomy.height);
  if (anatomy.is_figure() && fraction_inside(there, body.skin) < min_bones_inside) {
    Anatomy none;  // an animal, or what else has two pairs of limbs: capsules along all bones
    none.height = anatomy.height;
    body.skin = skin_of(figure_of(there, none), none.height);
  }
  return body;
}

}  // namespace sinew
