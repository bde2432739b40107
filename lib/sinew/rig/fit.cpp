// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/fit.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <sinew/core/decompositions.h>
#include <sinew/core/error.h>

namespace sinew {
namespace {

/// Points of the mesh, each for the same area, with the outward normals there.
struct Target {
  Points points, normals;
  double size = 0;  ///< the diagonal of the mesh's box, m
};

/// Points along the bones, each for the same length, and the bones as segments.
struct Sticks {
  Points heads, tails, along;
};

double fraction(double value) { return value - std::floor(value); }

/// `count` points, spread evenly over the area: always the same.
Target target_of(const Triangles& surface, std::size_t count) {
  std::vector<double> until;
  double total = 0;
  for (const auto& [a, b, c] : surface.faces) {
    const Vec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    until.push_back(total += (q - p).cross(r - p).norm() / 2);
  }
  Target target;
  target.size = bounds(surface.points).diagonal().norm();
  if (!(total > 0)) return target;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = total * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const auto face = std::lower_bound(until.begin(), until.end(), place) - until.begin();
    const auto& [a, b, c] = surface.faces[face];
    const Vec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
    // Steps by the golden ratio and the square root of 2 fill the unit square evenly.
    double u = fraction(0.6180339887498949 * static_cast<double>(i + 1));
    double v = fraction(1.4142135623730951 * static_cast<double>(i + 1));
    if (u + v > 1) u = 1 - u, v = 1 - v;
    target.points.push_back(p + u * (q - p) + v * (r - p));
    target.normals.push_back((q - p).cross(r - p).normalized());
  }
  return target;
}

Sticks sticks_of(const Skeleton& skeleton) {
  Sticks sticks;
  double total = 0;
  for (const Bone& bone : skeleton.bones) total += bone.length;
  for (const Bone& bone : skeleton.bones) {
    sticks.heads.push_back(bone.head());
    sticks.tails.push_back(bone.tail());
    const int parts = 1 + static_cast<int>(100 * bone.length / total);
    for (int part = 0; part < parts; ++part)
      sticks.along.push_back(bone.head() + (part + 0.5) / parts * (bone.tail() - bone.head()));
  }
  return sticks;
}

Box box_of(const Sticks& sticks) {
  Box box = bounds(sticks.heads);
  box.extend(bounds(sticks.tails));
  return box;
}

Sticks moved(const Sticks& sticks, const Placement& placement) {
  const auto each = [&](Points points) {
    for (Vec3& point : points) point = placement(point);
    return points;
  };
  return {each(sticks.heads), each(sticks.tails), each(sticks.along)};
}

double squared_distance(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0;
  return (point - from - t * along).squaredNorm();
}

// A bone that lies outside is worse than a part of the mesh that is far from its bone; but one far
// away, as a root on the ground, must not draw the others after it.
constexpr double weight_outside = 4, farthest_outside = 0.05;  // fraction of the mesh's size

double outside(const Target& target, const Vec3& point) {
  double least = target.size * target.size, side = 0;
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    const double squared = (point - target.points[i]).squaredNorm();
    if (squared < least) least = squared, side = target.normals[i].dot(point - target.points[i]);
  }
  const double most = farthest_outside * target.size;
  return side > 0 ? std::min(least, most * most) : 0;
}

/// Per squared size of the mesh.
double misfit(const Target& target, const Sticks& sticks) {
  double away = 0, out = 0;
  for (const Vec3& point : target.points) {
    double least = target.size * target.size;
    for (std::size_t b = 0; b < sticks.heads.size(); ++b)
      least = std::min(least, squared_distance(point, sticks.heads[b], sticks.tails[b]));
    away += least;
  }
  for (const Vec3& point : sticks.along) out += outside(target, point);
  return (away / static_cast<double>(target.points.size()) +
          weight_outside * out / static_cast<double>(sticks.along.size())) /
         (target.size * target.size);
}

struct Candidate {
  Placement placement;
  double misfit = 0;
};

/// Proper rotations that bring axes to axes, the identity first, then by growing angle.
std::vector<Mat3> cube_turns() {
  std::vector<Mat3> turns;
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 turn = Mat3::Zero();
      for (int row = 0; row < 3; ++row) turn(row, axes[row]) = (signs >> row & 1) ? -1 : 1;
      if (turn.determinant() > 0) turns.push_back(turn);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  std::stable_sort(turns.begin(), turns.end(),
                   [](const Mat3& a, const Mat3& b) { return a.trace() > b.trace(); });
  return turns;
}

/// The main axes of points as columns, right-handed.
Mat3 main_axes(const Points& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& point : points) mean += point / static_cast<double>(points.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& point : points) spread += (point - mean) * (point - mean).transpose();
  Mat3 axes = principal_axes(spread).axes;
  if (axes.determinant() < 0) axes.col(0) *= -1;
  return axes;
}

/// The turned skeleton with its box as that of the mesh, as far as one scale can do it.
Placement boxed(const Sticks& sticks, const Box& mesh, const Mat3& turn) {
  const Box box = box_of(moved(sticks, {1, turn}));
  const double scale = mesh.sizes().dot(box.sizes()) / box.sizes().squaredNorm();
  return {scale, turn, mesh.center() - scale * box.center()};
}

/// Moved by three parts of the mesh's size, and scaled about the middle of the bones by the fourth.
Placement varied(Placement placement, const Vec3& middle, double size, const Eigen::Vector4d& by) {
  const Vec3 there = placement(middle);
  placement.scale *= 1 + by[3];
  placement.offset += there - placement(middle) + size * by.head<3>();
  return placement;
}

/// Goes along scale and offset, in steps that are halved where none of them helps.
Candidate improved(const Target& target, const Sticks& sticks, Candidate best) {
  const Vec3 middle = box_of(sticks).center();
  for (double step = 0.05; step > 2e-4;) {
    Candidate next = best;
    for (int way = 0; way < 8; ++way) {
      const Eigen::Vector4d by = (way < 4 ? step : -step) * Eigen::Vector4d::Unit(way % 4);
      Candidate tried = {varied(best.placement, middle, target.size, by)};
      tried.misfit = misfit(target, moved(sticks, tried.placement));
      if (tried.misfit < next.misfit) next = tried;
    }
    if (next.misfit < best.misfit)
      best = next;
    else
      step /= 2;
  }
  return best;
}

constexpr std::size_t few = 150, many = 800;  // points of the mesh
constexpr std::size_t improved_ones = 8;
// Among rotations that fit as well as each other, as by the symmetry of a body, the smaller one;
// and main axes, which lie obliquely, only where they are needed.
constexpr double as_good = 1.03, clearly_better = 0.8;

Candidate best_of(const Target& coarse, const Target& fine, const Sticks& sticks, const Box& mesh,
                  const std::vector<Mat3>& turns) {
  std::vector<Candidate> all;
  for (const Mat3& turn : turns) {
    const Placement placement = boxed(sticks, mesh, turn);
    all.push_back({placement, misfit(coarse, moved(sticks, placement))});
  }
  std::vector<double> order;
  order.reserve(all.size());
  for (const Candidate& one : all) order.push_back(one.misfit);
  std::sort(order.begin(), order.end());
  const double last = order[std::min(improved_ones, order.size()) - 1];
  std::erase_if(all, [&](const Candidate& one) { return one.misfit > last; });
  for (Candidate& one : all) {
    one = improved(coarse, sticks, one);
    one.misfit = misfit(fine, moved(sticks, one.placement));
  }
  double least = all.front().misfit;
  for (const Candidate& one : all) least = std::min(least, one.misfit);
  const auto first = std::find_if(
      all.begin(), all.end(), [&](const Candidate& one) { return one.misfit <= as_good * least; });
  Candidate best = *first;
  best.misfit = misfit(fine, moved(sticks, best.placement));
  return improved(fine, sticks, best);
}

}  // namespace

Placement fit_to(const Triangles& surface, const Skeleton& skeleton) {
  if (skeleton.bones.empty())
    throw bad_input("there is no rig to fit",
                    "name one in skeleton.file, give skeleton.bones, or leave skeleton.fit out");
  const Target coarse = target_of(surface, few), fine = target_of(surface, many);
  const Sticks sticks = sticks_of(skeleton);
  const Box mesh = bounds(surface.points);
  if (fine.points.empty() || !(box_of(sticks).diagonal().norm() > 0))
    throw bad_input("the mesh or the rig has no size", "give both an extent in space");
  const std::vector<Mat3> upright = cube_turns();
  const Candidate best = best_of(coarse, fine, sticks, mesh, upright);
  const Mat3 to = main_axes(fine.points), from = main_axes(sticks.along);
  std::vector<Mat3> oblique;
  oblique.reserve(upright.size());
  for (const Mat3& turn : upright) oblique.push_back(to * turn * from.transpose());
  std::stable_sort(oblique.begin(), oblique.end(),
                   [](const Mat3& a, const Mat3& b) { return a.trace() > b.trace(); });
  const Candidate other = best_of(coarse, fine, sticks, mesh, oblique);
  return (other.misfit < clearly_better * best.misfit ? other : best).placement;
}

SkeletonOptions placed_again(SkeletonOptions before, const Placement& then) {
  before.rotation = angles_of(then.turn * rotation_of(before.rotation));
  before.offset = then(before.offset);
  before.scale *= then.scale;
  return before;
}

}  // namespace sinew
