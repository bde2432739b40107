// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/free_motion.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/core/text.h>
#include <sinew/core/union_find.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

using Motion6 = Eigen::Matrix<double, 6, 1>;  // translation, then rotation times the part's size
using Gram = Eigen::Matrix<double, 6, 6>;

constexpr double none = 1e-8;  // of the largest: what counts as no motion, and as not restrained
constexpr double small_rotation = 1e-3;  // beside a translation

/// Connected parts, by particle.
struct PartNumbers {
  std::vector<std::size_t> of;
  std::size_t count = 0;
};

PartNumbers parts_of(const Body& body) {
  const std::size_t n = body.rest.size();
  UnionFind joined(n);
  const Material& material = body.material;
  const double range = material.bond.second > 0 ? second_neighbor_range * material.pair.r
                                                : rest_neighbor_range(material.pair.r);
  const NeighborLists near = neighbors_within(body.rest, range);
  for (std::size_t i = 0; i < n; ++i)
    for (const std::uint32_t j : near.of(i)) joined.join(static_cast<int>(i), static_cast<int>(j));
  PartNumbers parts;
  parts.of.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto first = static_cast<std::size_t>(joined.first_of(static_cast<int>(i)));
    parts.of[i] = first == i ? parts.count++ : parts.of[first];
  }
  return parts;
}

/// One part of the body: which of its motions move it, and which are restrained.
struct Part {
  Vec3 center = Vec3::Zero();
  double size = 0;
  std::size_t particles = 0;
  Gram moved = Gram::Zero(), restrained = Gram::Zero();

  void add(const Vec3& place, const Vec3& direction, Gram& to) const {
    Motion6 row;
    row << direction, ((place - center) / size).cross(direction);
    to += row * row.transpose();
  }
};

std::vector<Part> parts_at_rest(const Body& body, const PartNumbers& numbers) {
  std::vector<Part> parts(numbers.count);
  const std::vector<std::size_t>& part = numbers.of;
  for (std::size_t i = 0; i < part.size(); ++i) {
    ++parts[part[i]].particles;
    parts[part[i]].center += body.rest[i];
  }
  for (Part& one : parts) one.center /= static_cast<double>(one.particles);
  for (std::size_t i = 0; i < part.size(); ++i)
    parts[part[i]].size = std::max(
        {parts[part[i]].size, body.material.pair.r, (body.rest[i] - parts[part[i]].center).norm()});
  for (std::size_t i = 0; i < part.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      parts[part[i]].add(body.rest[i], Vec3::Unit(axis), parts[part[i]].moved);
  return parts;
}

void restrain_by_bone(const Body& body, const Influence& by, const Vec3& place, Part& part) {
  const Bone& bone = body.skeleton.bones[static_cast<std::size_t>(by.bone)];
  const BoneSprings& springs = body.springs[static_cast<std::size_t>(by.bone)];
  const Vec3 across = place - by.foot_on(bone);
  const bool without_arm = across.norm() < 1e-6 * body.material.pair.r;
  if (springs.form == BoneForce::anchor || without_arm) {
    if (springs.radial > 0)
      for (int axis = 0; axis < 3; ++axis) part.add(place, Vec3::Unit(axis), part.restrained);
  } else {
    const Vec3 turning = bone.axis().cross(across);
    if (springs.radial > 0) part.add(place, across.normalized(), part.restrained);
    if (springs.twist > 0 && turning.norm() > 1e-6 * body.material.pair.r)
      part.add(place, turning.normalized(), part.restrained);
  }
  if (springs.form != BoneForce::anchor && springs.axial > 0)
    part.add(place, bone.axis(), part.restrained);
}

void add_restraints(const Body& body, const std::vector<std::size_t>& part,
                    std::vector<Part>& parts) {
  for (std::size_t i = 0; i < part.size(); ++i)
    for (const Influence& by : body.binding.of(i))
      restrain_by_bone(body, by, body.rest[i], parts[part[i]]);
  if (!body.world) return;
  for (const Pinned& pin : body.world->pins)
    if (pin.is_oblique())
      parts[part[pin.particle]].add(body.rest[pin.particle], pin.along,
                                    parts[part[pin.particle]].restrained);
  for (const Pinned& pin : body.world->pins)
    for (int axis = 0; axis < 3; ++axis)
      if (pin.holds(axis))
        parts[part[pin.particle]].add(body.rest[pin.particle], Vec3::Unit(axis),
                                      parts[part[pin.particle]].restrained);
}

/// The motion that is restrained least, of those that move the part; of length 0 where all are.
Motion6 free_of(const Part& part) {
  const Eigen::SelfAdjointEigenSolver<Gram> moved(part.moved);
  const double most = moved.eigenvalues()[5];
  int first = 0;
  while (moved.eigenvalues()[first] < none * most) ++first;
  const Eigen::Matrix<double, 6, Eigen::Dynamic> motions =
      moved.eigenvectors().rightCols(6 - first) *
      moved.eigenvalues().tail(6 - first).cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> restrained(
      Eigen::MatrixXd(motions.transpose() * part.restrained * motions));
  if (restrained.eigenvalues()[0] > none * restrained.eigenvalues().tail(1)[0])
    return Motion6::Zero();
  return motions * restrained.eigenvectors().col(0);
}

/// Scales to length 1, with the largest component positive.
Vec3 direction_of(const Vec3& v) {
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  return v[largest] < 0 ? Vec3(-v.normalized()) : Vec3(v.normalized());
}

std::string vector_text(const Vec3& v) {
  const auto cell = [](double x) { return three_digits(std::abs(x) < 1e-3 ? 0 : x); };
  return '[' + cell(v.x()) + ", " + cell(v.y()) + ", " + cell(v.z()) + ']';
}

}  // namespace

std::string FreeMotion::text() const {
  const std::string what =
      whole ? "the body"
            : "a part of " + std::to_string(particles) + " particles around " + vector_text(center);
  return what + " can " +
         (axis.isZero(0) ? "move along " + vector_text(translation)
                         : "turn about " + vector_text(axis));
}

std::optional<FreeMotion> free_motion(const Body& body) {
  const PartNumbers numbers = parts_of(body);
  std::vector<Part> parts = parts_at_rest(body, numbers);
  add_restraints(body, numbers.of, parts);
  for (const Part& one : parts) {
    const Motion6 free = free_of(one);
    if (free.isZero(0)) continue;
    FreeMotion motion;
    const Vec3 translation = free.head<3>(), rotation = free.tail<3>();
    if (rotation.norm() > small_rotation * translation.norm())
      motion.axis = direction_of(rotation);
    else
      motion.translation = direction_of(translation);
    motion.center = one.center;
    motion.particles = one.particles;
    motion.whole = one.particles == body.rest.size();
    return motion;
  }
  return std::nullopt;
}

}  // namespace sinew
