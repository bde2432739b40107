// SPDX-License-Identifier: GPL-3.0-or-later
// How much groups may yet strain before forces act within them that they do not know of.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include <sinew/body/solid.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/groups/groups.h>

namespace sinew {
namespace {

constexpr double most_margin = 0.2;       // of strain, between looks at stretches
constexpr double enough = 1.05;           // times what a length must keep
constexpr double least_looked_at = 0.35;  // stretch that ends a run in any case
constexpr double least_change = 0.02;     // of stretches within a box, which is not cut further

Error unstable_group(const std::string& how, double stretch, const std::string& what) {
  return Error(Exit::unstable,
               "a group of particles was " + how + " to " + three_digits(stretch) +
                   " of its size, where forces between some neighbors would " + what +
                   "; make hierarchy.joint_distance larger, or hierarchy.enabled false");
}

/// Of the principal stretches, ascending.
Vec3 squared_stretches(const Mat3& F) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(F.transpose() * F, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

}  // namespace

/// Where particles beyond second neighbors are, as far as squeezes matter.
template <class Real>
void Groups<Real>::find_far_sites() {
  const double r = body_->material.pair.r;
  constexpr int most_planes = 8;
  for (int x = -most_planes; x <= most_planes; ++x)
    for (int y = -most_planes; y <= most_planes; ++y)
      for (int z = 0; z <= most_planes; ++z) {
        const Vec3 site = half_plane_spacing(r) * (body_->lattice * Vec3(x, y, z));
        const double distance = site.norm();
        if ((x + y + z) % 2 == 0 && distance > second_neighbor_range * r &&
            distance * least_looked_at < 2 * r)
          far_sites_.push_back(site);
      }
}

/// Looks at what strains may have changed by enough.
template <class Real>
void Groups<Real>::check_stretch() {
  for (std::size_t k = 0; k < boxes_.size();) {
    const std::uint32_t piece = boxes_[k].piece;
    const bool due = !(strains_[piece] < strained_until_[piece]);
    double spare = std::exp(most_margin);
    for (; k < boxes_.size() && boxes_[k].piece == piece; ++k)
      if (due) spare = std::min(spare, spare_in(boxes_[k]));
    if (due) strained_until_[piece] = strains_[piece] + std::log(spare) * (1 - 1e-6);
  }
}

/// The factor by which lengths may yet change before forces act that groups do not know, or more
/// than the most that matters. In boxes small enough to tell.
template <class Real>
double Groups<Real>::spare_in(const PieceBox& one) const {
  const auto g = static_cast<std::size_t>(one.group);
  const Shape& shape = shapes_[g];
  const Mat3 curvature = curvature_of(shape, motions_[g]).x;
  const Vec3 weight = shape.frame.rowwise().norm();
  std::vector<Box> boxes{one.box};
  double least = std::exp(most_margin);
  while (!boxes.empty()) {
    Box box = boxes.back();
    boxes.pop_back();
    const Vec3 half = box.sizes() / 2;
    const double changes = (curvature * half).dot(weight);
    const Mat3 F = motion_at(shape, motions_[g], box.center()).dx * shape.frame;
    const double of_box = shape.cubic ? spare_of_cubic(F, changes) : spare_of(F);
    if (of_box > enough || changes < least_change) {
      if (!(of_box > 1))
        throw unstable_group("squeezed", std::sqrt(std::max(0.0, squared_stretches(F)[0])),
                             "begin");
      least = std::min(least, of_box);
      continue;
    }
    int axis = 0;
    (curvature.transpose() * weight).cwiseProduct(half).maxCoeff(&axis);
    Box other = box;
    other.min()[axis] = box.max()[axis] = box.center()[axis];
    boxes.push_back(box), boxes.push_back(other);
  }
  return least;
}

template <class Real>
double Groups<Real>::spare_of(const Mat3& F) const {
  const Vec3 squares = squared_stretches(F);
  const double most = std::sqrt(squares[2]);
  if (most > stretch_.most) throw unstable_group("stretched", most, "end");
  return std::min(std::sqrt(std::max(0.0, squares[0])) / stretch_.least, stretch_.most / most);
}

/// Of particles that are no neighbors at rest, none may touch.
template <class Real>
double Groups<Real>::spare_of_cubic(const Mat3& F, double changes) const {
  if (F.determinant() <= 0) return 0;
  const double least = std::sqrt(std::max(0.0, squared_stretches(F)[0])) - changes;
  double spare = least / stretch_.least_cubic;
  if (spare > 1) return spare;
  spare = least / least_looked_at;
  for (const Vec3& site : far_sites_)
    spare =
        std::min(spare, ((F * site).norm() - changes * site.norm()) / (2 * body_->material.pair.r));
  return spare;
}

template void Groups<double>::find_far_sites();
template void Groups<double>::check_stretch();
template void Groups<float>::find_far_sites();
template void Groups<float>::check_stretch();

}  // namespace sinew
