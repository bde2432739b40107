// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/affine/affine_forces.h>

#include <Eigen/LU>
#include <cmath>

#include <sinew/body/body.h>
#include <sinew/body/bond_factors.h>
#include <sinew/body/solid.h>
#include <sinew/body/volume_weights.h>
#include <sinew/core/particles.h>
#include <sinew/material/laws.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr double off_site = 1e-6;  // in radii: above rounding of files' coordinates
constexpr int max_planes = 2;      // to a second neighbor

bool holds_seconds(const Material& material) { return material.bond.second > 0; }

/// Returns the cell of whole coordinates, or -1 where they are too large.
int cell_of(const Vec3& site) {
  if (!(site.cwiseAbs().maxCoeff() < max_planes + 0.5)) return -1;
  const auto at = [&](int axis) { return static_cast<int>(std::lround(site[axis])) + max_planes; };
  return (at(0) * 5 + at(1)) * 5 + at(2);
}

}  // namespace

bool has_affine_forces(const Body& body) {
  const Material& material = body.material;
  const bool to_the_mean = material.damping_form == DampingForm::paper || material.damping == 0;
  // What else touches surfaces is looked for among particles alone.
  return to_the_mean && material.friction == 0 && (!body.world || body.world->obstacles.empty());
}

AffineMoments& AffineMoments::add(const AffineMoments& other, double times) {
  for (std::size_t k = 0; k < near_sites; ++k) {
    bonds[k] += times * other.bonds[k];
    bonds_X[k] += times * other.bonds_X[k];
  }
  behind += times * other.behind, behind_X += times * other.behind_X;
  swell += times * other.swell, swell_X += times * other.swell_X;
  return *this;
}

AffineForces::AffineForces(const Body& body)
    : body_(&body),
      keeps_volume_(keeps_volume(body)),
      range_(holds_seconds(body.material) ? second_neighbor_range * body.material.pair.r
                                          : rest_neighbor_range(body.material.pair.r)),
      grid_(body.rest, range_) {
  at_.fill(-1);
  const double spacing = half_plane_spacing(body.material.pair.r);
  for (const int squares : {2, 4})
    for (int cell = 0; cell < 125; ++cell) {
      const int x = cell / 25 - max_planes, y = cell / 5 % 5 - max_planes;
      const Vec3 site(x, y, cell % 5 - max_planes);
      if (site.squaredNorm() != squares) continue;
      at_[static_cast<std::size_t>(cell)] = static_cast<int>(site_.size());
      site_.push_back(spacing * (body.lattice * site));
    }
}

int AffineForces::site_of(const Vec3& from_to) const {
  const double r = body_->material.pair.r;
  const int cell = cell_of(body_->lattice.transpose() * from_to / half_plane_spacing(r));
  if (cell < 0) return -1;
  const int site = at_[static_cast<std::size_t>(cell)];
  if (site < 0 || !((from_to - site_[static_cast<std::size_t>(site)]).norm() < off_site * r))
    return -1;
  return site;
}

void AffineForces::append_near(std::uint32_t i, std::vector<std::uint32_t>& near) const {
  near.clear();
  append_neighbors(grid_, body_->rest, i, range_, near);
}

/// K_v V0 w A^-1.
Mat3 AffineForces::swell_of(std::uint32_t i) const {
  const Material& material = body_->material;
  std::vector<std::uint32_t> near;
  append_near(i, near);
  Mat3 A = Mat3::Zero();
  for (const std::uint32_t j : near) {
    const Vec3 X = body_->rest[j] - body_->rest[i];
    if (X.norm() < rest_neighbor_range(material.pair.r)) A += X * X.transpose();
  }
  const std::vector<double>& weights = body_->factors.volume_weight;
  const double weight = weights.empty() ? volume_weight(A, material.pair.r) : weights[i];
  if (weight == 0) return Mat3::Zero();
  return value_at(body_->local.volume, i, material.volume_stiffness) *
         volume_per_particle(material.pair.r) * weight * A.inverse();
}

AffineMoments AffineForces::moments_of(std::uint32_t i, const Vec3& X) const {
  AffineMoments moments;
  std::vector<std::uint32_t> near;
  append_near(i, near);
  const BondFactors::Row factors = body_->factors.of(i);
  const bool swells = keeps_volume_;
  const Mat3 own = swells ? swell_of(i) : Mat3::Zero();
  double nearest = 0;
  for (const std::uint32_t j : near) {
    const Vec3 to = body_->rest[j] - body_->rest[i];
    const int site = site_of(to);
    if (site < 0) continue;
    const double factor = factors.empty() ? 1 : factors.at(j);
    const auto k = static_cast<std::size_t>(site);
    moments.bonds[k] += factor, moments.bonds_X[k] += factor * X;
    if (site >= nearest_sites) continue;
    moments.behind += to, nearest += 1;
    if (swells) moments.swell += (own + swell_of(j)) * to;
  }
  if (nearest > 0) moments.behind /= nearest;
  moments.behind_X = moments.behind * X.transpose();
  moments.swell_X = moments.swell * X.transpose();
  return moments;
}

AffineSum AffineForces::at(const AffineMoments& moments, const Mat3& F) const {
  const Material& material = body_->material;
  const ForceLaw& law = law_of(material);
  AffineSum sum;
  const std::size_t sites = holds_seconds(material) ? near_sites : nearest_sites;
  for (std::size_t k = 0; k < sites; ++k) {
    const bool nearest = k < nearest_sites;
    const BondSpring spring{site_[k].norm(),
                            nearest ? material.bond.stiffness : material.bond.second};
    const Vec3 to = F * site_[k];
    const double d = to.norm();
    const Vec3 force = -law.bond_force(material, spring, d) / d * to;
    sum.f += moments.bonds[k] * force;
    sum.fX += force * moments.bonds_X[k].transpose();
  }
  if (keeps_volume_) {
    Mat3 cofactors;
    cofactors << F.row(1).cross(F.row(2)), F.row(2).cross(F.row(0)), F.row(0).cross(F.row(1));
    const Mat3 pressure = (F.row(0).dot(cofactors.row(0)) - 1) * cofactors;
    sum.f += pressure * moments.swell;
    sum.fX += pressure * moments.swell_X;
  }
  return sum;
}

AffineSum AffineForces::damping(const AffineMoments& moments, const Mat3& rate) const {
  const double C = body_->material.damping;
  return {C * rate * moments.behind, C * rate * moments.behind_X};
}

}  // namespace sinew
