// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_scene.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/text.h>
#include <sinew/io/gltf/converted.h>

namespace sinew {
namespace {

// Sizes of bodies, in the unit of their files. Parts for printers are in mm, figures of animators
// in m or cm; few bodies that bend are longer than a whale.
constexpr double longest_in_m = 20, longest_stl_in_m = 2, shortest_figure_in_cm = 50,
                 longest_figure_in_cm = 300, longest_gltf_in_cm = 2000;
constexpr double on_ground = 0.02;  // fraction of the height
constexpr double clearly = 2;       // times the size of another footprint

std::string format_of(const std::filesystem::path& mesh) {
  return lower(mesh.extension().string());
}

std::string long_text(double longest) { return "the mesh is " + three_digits(longest) + " long"; }

/// Whether the body stands on 0 along an axis, and lies on both sides of it along the others.
bool stands(const Box& box, int axis) {
  const Vec3 size = box.sizes();
  bool on_zero = std::abs(box.min()[axis]) <= on_ground * size[axis];
  for (int other = 0; other < 3; ++other)
    if (other != axis)
      on_zero =
          on_zero && box.min()[other] < -0.2 * size[other] && box.max()[other] > 0.2 * size[other];
  return on_zero;
}

/// The share of the box's base on which the body stands along an axis: that of the box around its
/// lowest points; 0 where its middle is not above them.
double footprint(const Points& points, const Box& box, int axis) {
  const double lowest = box.min()[axis] + on_ground * box.sizes()[axis];
  Box foot;
  for (const Vec3& point : points)
    if (point[axis] <= lowest) foot.extend(point);
  double share = 1;
  for (int other = 0; other < 3; ++other) {
    if (other == axis) continue;
    const double middle = box.center()[other];
    if (middle < foot.min()[other] || middle > foot.max()[other]) return 0;
    share *= foot.sizes()[other] / box.sizes()[other];
  }
  return share;
}

}  // namespace

UnitGuess guess_unit(const std::filesystem::path& mesh, double longest) {
  const std::string format = format_of(mesh);
  const bool like_figure = longest >= shortest_figure_in_cm &&
                           longest <= (is_gltf(mesh) ? longest_gltf_in_cm : longest_figure_in_cm);
  if (is_gltf(mesh) && !like_figure)
    return {LengthUnit::m,
            needs_blender(mesh) ? "Blender converts it to meters" : "glTF is in meters"};
  if (format == ".stl" && longest > longest_stl_in_m)
    return {LengthUnit::mm, long_text(longest) + ", and STL is mostly in millimeters"};
  if (longest <= longest_in_m) return {LengthUnit::m, long_text(longest) + ": meters fit"};
  if (format != ".stl" && like_figure)
    return {LengthUnit::cm, long_text(longest) + ": a figure in centimeters, or another unit"};
  return {LengthUnit::mm, long_text(longest) + ": too long for meters, millimeters are usual"};
}

UpGuess guess_up(const std::filesystem::path& mesh, const Points& points) {
  const std::string format = format_of(mesh);
  const Box box = bounds(points);
  if (is_gltf(mesh))
    return {Axis::y, needs_blender(mesh) ? "Blender converts it so" : "y is up in glTF"};
  if (stands(box, 2)) return {Axis::z, "the body stands on z = 0"};
  if (stands(box, 1)) return {Axis::y, "the body stands on y = 0"};
  const double by_y = footprint(points, box, 1), by_z = footprint(points, box, 2);
  if (by_z > clearly * by_y) return {Axis::z, "the body stands along z on its lowest points"};
  if (by_y > clearly * by_z) return {Axis::y, "the body stands along y on its lowest points"};
  if (format == ".obj") return {Axis::y, "y is up in most OBJ files (--up z: z)"};
  return {Axis::z, "nothing in the file says otherwise (--up y: y)"};
}

}  // namespace sinew
