// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/analysis/spin.h>

#include <limits>

#include <sinew/core/decompositions.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

/// Share of the velocity between i and j that acts on i.
double share_of(DampingForm form, std::size_t neighbors_of_i, std::size_t neighbors_of_j) {
  const double own = 1 / static_cast<double>(neighbors_of_i);
  if (form == DampingForm::paper) return own;
  return (own + 1 / static_cast<double>(neighbors_of_j)) / 2;
}

Vec3 center_of_mass(const Body& body) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    const double own = mass_of(body, i, body.material.mass);
    sum += own * body.rest[i];
    mass += own;
  }
  return sum / mass;
}

}  // namespace

double spin_time(const Body& body) {
  const Material& material = body.material;
  constexpr double never = std::numeric_limits<double>::infinity();
  if (acts_along_pairs(material.damping_form) || !(material.damping > 0)) return never;
  const SharedNeighbors shared = neighbors_of(body);
  const NeighborLists& near = shared->nearest;  // second ones do not count in eq. 2
  const Vec3 center = center_of_mass(body);
  // Moment -C braking w, moment of inertia: of a rigid rotation w about the center.
  Mat3 braking = Mat3::Zero(), inertia = Mat3::Zero();
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Vec3 at = body.rest[i] - center;
    Vec3 inward = Vec3::Zero();
    for (const std::uint32_t j : near.of(i))
      inward += share_of(material.damping_form, near.of(i).size(), near.of(j).size()) *
                (body.rest[i] - body.rest[j]);
    braking += at.dot(inward) * Mat3::Identity() - inward * at.transpose();
    inertia += mass_of(body, i, material.mass) *
               (at.squaredNorm() * Mat3::Identity() - at * at.transpose());
  }
  if (!(inertia.determinant() > 0)) return never;
  const Mat3 even = (braking + braking.transpose()) / 2;
  const Mat3 root = inverse_root(inertia);
  const double rate = material.damping * eigenvalues(root * even * root)[2];
  return rate > 0 ? 1 / rate : never;
}

}  // namespace sinew
