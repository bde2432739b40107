// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/free_motion.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/text.h>
#include <sinew/core/union_find.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

// Translation, then rotation times the component's size.
using Motion6 = Eigen::Matrix<double, 6, 1>;
using Gram = Eigen::Matrix<double, 6, 6>;

constexpr double none = 1e-8;            // fraction of the largest: no motion, or not restrained
constexpr double small_rotation = 1e-3;  // beside a translation

/// Connected components, by particle.
struct ComponentNumbers {
  std::vector<std::size_t> of;
  std::size_t count = 0;
};

ComponentNumbers components_of(const Body& body) {
  const std::size_t n = body.rest.size();
  UnionFind joined(n);
  const SharedNeighbors near = neighbors_of(body);
  for (std::size_t i = 0; i < n; ++i)
    for (const std::uint32_t j : near->all().of(i))
      joined.join(static_cast<int>(i), static_cast<int>(j));
  ComponentNumbers components;
  components.of.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto first = static_cast<std::size_t>(joined.first_of(static_cast<int>(i)));
    components.of[i] = first == i ? components.count++ : components.of[first];
  }
  return components;
}

/// One component of the body: which of its motions move it, and which are restrained.
struct Component {
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

std::vector<Component> components_at_rest(const Body& body, const ComponentNumbers& numbers) {
  std::vector<Component> components(numbers.count);
  const std::vector<std::size_t>& component = numbers.of;
  for (std::size_t i = 0; i < component.size(); ++i) {
    ++components[component[i]].particles;
    components[component[i]].center += body.rest[i];
  }
  for (Component& one : components) one.center /= static_cast<double>(one.particles);
  for (std::size_t i = 0; i < component.size(); ++i)
    components[component[i]].size =
        std::max({components[component[i]].size, body.material.pair.r,
                  (body.rest[i] - components[component[i]].center).norm()});
  for (std::size_t i = 0; i < component.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      components[component[i]].add(body.rest[i], Vec3::Unit(axis), components[component[i]].moved);
  return components;
}

void restrain_by_bone(const Body& body, const Influence& by, const Vec3& place,
                      Component& component) {
  const Bone& bone = body.skeleton.bones[static_cast<std::size_t>(by.bone)];
  const BoneSprings& springs = body.springs[static_cast<std::size_t>(by.bone)];
  const Vec3 across = place - by.foot_on(bone);
  const bool without_arm = across.norm() < 1e-6 * body.material.pair.r;
  if (springs.form == BoneForce::anchor || without_arm) {
    if (springs.radial > 0)
      for (int axis = 0; axis < 3; ++axis)
        component.add(place, Vec3::Unit(axis), component.restrained);
  } else {
    const Vec3 turning = bone.axis().cross(across);
    if (springs.radial > 0) component.add(place, across.normalized(), component.restrained);
    if (springs.twist > 0 && turning.norm() > 1e-6 * body.material.pair.r)
      component.add(place, turning.normalized(), component.restrained);
  }
  if (springs.form != BoneForce::anchor && springs.axial > 0)
    component.add(place, bone.axis(), component.restrained);
}

void add_restraints(const Body& body, const std::vector<std::size_t>& component,
                    std::vector<Component>& components) {
  for (std::size_t i = 0; i < component.size(); ++i)
    for (const Influence& by : body.binding.of(i))
      restrain_by_bone(body, by, body.rest[i], components[component[i]]);
  if (!body.world) return;
  for (const Pinned& pin : body.world->pins)
    if (pin.is_oblique())
      components[component[pin.particle]].add(body.rest[pin.particle], pin.along,
                                              components[component[pin.particle]].restrained);
  for (const Pinned& pin : body.world->pins)
    for (int axis = 0; axis < 3; ++axis)
      if (pin.holds(axis))
        components[component[pin.particle]].add(body.rest[pin.particle], Vec3::Unit(axis),
                                                components[component[pin.particle]].restrained);
}

/// The motion restrained least, of those that move the component; of length 0 where all are.
Motion6 free_of(const Component& component) {
  const Eigendecomposition moved = eigendecomposition(component.moved);
  const double most = moved.values[5];
  int first = 0;
  while (moved.values[first] < none * most) ++first;
  const Eigen::Matrix<double, 6, Eigen::Dynamic> motions =
      moved.vectors.rightCols(6 - first) *
      moved.values.tail(6 - first).cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigendecomposition restrained =
      eigendecomposition(motions.transpose() * component.restrained * motions);
  if (restrained.values[0] > none * restrained.values.tail(1)[0]) return Motion6::Zero();
  return motions * restrained.vectors.col(0);
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
  const ComponentNumbers numbers = components_of(body);
  std::vector<Component> components = components_at_rest(body, numbers);
  add_restraints(body, numbers.of, components);
  for (const Component& one : components) {
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
