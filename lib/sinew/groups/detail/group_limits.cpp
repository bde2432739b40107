// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/detail/group_limits.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include <sinew/body/body.h>
#include <sinew/body/bond_factors.h>
#include <sinew/body/solid.h>
#include <sinew/core/decompositions.h>
#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/text.h>
#include <sinew/lists/subpieces.h>

namespace sinew {
namespace {

constexpr std::size_t boxes_at_a_time = 64;
// Rates of strain are found once in so many steps; until then they grow by less than this factor.
constexpr int steps_between_rates = 8;
constexpr double rates_ahead = 1.25;
constexpr double max_margin = 0.2;      // strain between looks at stretches
constexpr double enough = 1.05;         // times what a length must keep
constexpr double min_looked_at = 0.35;  // stretch that ends a run in any case
constexpr double min_change = 0.02;  // change of stretches within a box, which is not cut further

/// Largest sizes of second derivatives within a group.
struct Curvature {
  Mat3 x = Mat3::Zero(), v = Mat3::Zero();
};

/// Largest sizes of second derivatives within `reach` of the middle.
Mat3 curvature_within(const Coefficients& of, const Vec3& reach) {
  Mat3 all = Mat3::Zero();
  for (int k = affine_terms; k < cubic_terms; ++k) {
    const auto& factors = factors_of_terms[static_cast<std::size_t>(k)];
    const double size = of.row(k).norm();
    for (std::size_t one = 0; one < 3; ++one)
      for (std::size_t other = 0; other < 3; ++other) {
        if (one == other || factors[one] == 3 || factors[other] == 3) continue;
        const int left = factors[3 - one - other];
        all(factors[one], factors[other]) += size * (left == 3 ? 1 : reach[left]);
      }
  }
  return all;
}

/// How much a field whose second derivatives are at most these leaves its tangent in a box.
double beyond_tangent(const Mat3& curvature, const Vec3& half) {
  return half.dot(curvature * half) / 2;
}

/// How much its derivatives change there, times a matrix.
double change_of_slope(const Mat3& curvature, const Vec3& half, const Mat3& times) {
  return (curvature * half).dot(times.rowwise().norm());
}

/// How much the tangent grows.
double along_tangent(const Mat3& slopes, const Vec3& half) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += half[axis] * slopes.col(axis).norm();
  return sum;
}

/// v + w x (x - c) = (v - w x c) + w x x.
struct Field {
  Vec3 velocity, spin;  ///< at the origin
};

template <class Real>
Field field_of(const kernel::RigidMotion<Real>& motion) {
  Vec3 center, velocity, spin;
  for (int axis = 0; axis < 3; ++axis) {
    center[axis] = static_cast<double>(motion.center[axis]);
    velocity[axis] = static_cast<double>(motion.velocity[axis]);
    spin[axis] = static_cast<double>(motion.spin[axis]);
  }
  return {velocity - spin.cross(center), spin};
}

Curvature curvature_of(const GroupShape& shape, const GroupMotion& motion) {
  if (!shape.cubic) return {};
  return {curvature_within(motion.x, shape.reach), curvature_within(motion.v, shape.reach)};
}

/// Largest speed relative to the field anywhere in the box, squared.
double fastest_in(const Box& box, const Units& units, const TangentMotion& local,
                  const Curvature& curvature, const Field& field) {
  const double speed = units.time / units.length;
  const Vec3 half = box.sizes() / 2;
  const Vec3 at = (local.x - units.origin) / units.length;
  Mat3 slopes = speed * local.dv;
  for (int axis = 0; axis < 3; ++axis)
    slopes.col(axis) -= field.spin.cross(local.dx.col(axis)) / units.length;
  const Mat3 bends = speed * curvature.v + field.spin.norm() / units.length * curvature.x;
  const double fastest = (speed * local.v - field.velocity - field.spin.cross(at)).norm() +
                         along_tangent(slopes, half) + beyond_tangent(bends, half);
  return fastest * fastest;
}

/// Largest rate of strain in a box of this half size, 1/s.
double strain_rate(const Vec3& half, const TangentMotion& local, const Curvature& curvature) {
  const Mat3 back = local.dx.inverse(), L = local.dv * back;
  const double turned = change_of_slope(curvature.x, half, back);
  const double changes = change_of_slope(curvature.v, half, back) + L.norm() * turned;
  return (L + L.transpose()).norm() / 2 + changes / std::max(1 - turned, 0.1);
}

Error unstable_group(const std::string& how, double stretch, const std::string& what) {
  return Error(Exit::unstable,
               "a group of particles was " + how + " to " + three_digits(stretch) +
                   " of its size, where forces between some neighbors would " + what +
                   "; make hierarchy.joint_distance larger, or hierarchy.enabled false");
}

/// Returns the squares of the principal stretches, ascending.
Vec3 squared_stretches(const Mat3& F) { return eigenvalues(F.transpose() * F); }

}  // namespace

template <class Real>
GroupLimits<Real>::GroupLimits(const Body& body, const kernel::Functions<Real>& kernel,
                               const std::vector<GroupShape>& shapes,
                               const GroupLayout<Real>& layout, const GroupMotions<Real>& motions)
    : body_(&body),
      kernel_(kernel),
      shapes_(&shapes),
      layout_(&layout),
      motions_(&motions),
      stretch_(stretch_range(body)) {
  find_far_sites();
}

template <class Real>
void GroupLimits<Real>::set_order() {
  boxes_.clear();
  box_of_.assign(layout_->pieces(), 0);
  strains_.assign(layout_->pieces(), 0);
  strained_until_.assign(layout_->pieces(), -1);
  const auto& places = layout_->places();
  const Subpieces subpieces = subpieces_of(*body_, places.id, BlockState<Real>::block);
  for (std::uint32_t subpiece = 0; subpiece < subpieces.size(); ++subpiece) {
    const std::size_t first = boxes_.size();
    const std::uint32_t piece = subpieces.piece[subpiece];
    if (subpieces.of_piece[piece] == subpiece) box_of_[piece] = static_cast<std::uint32_t>(first);
    layout_->for_each_run(
        subpieces.first[subpiece], subpieces.first[subpiece + 1], [&](const GroupRun& run) {
          std::size_t at = first;
          while (at < boxes_.size() && boxes_[at].group != run.group) ++at;
          if (at == boxes_.size())
            boxes_.push_back({piece, subpiece, run.group, run.begin, run.end, Box(), Vec3::Zero()});
          boxes_[at].end = run.end;
          for (std::size_t k = run.begin; k < run.end; ++k) boxes_[at].box.extend(places.place(k));
        });
  }
  const double range = second_neighbor_range * body_->material.pair.r;
  for (PieceBox& one : boxes_)
    one.around = one.box.sizes() / 2 + range * shape_of(one).frame.rowwise().norm();
}

template <class Real>
void GroupLimits<Real>::look_again() {
  strained_until_.assign(strained_until_.size(), -1);
}

/// Largest squared speed relative to the field of its particles and what lies between in memory.
template <class Real>
double GroupLimits<Real>::fastest_of(const PieceBox& one, const Units& units,
                                     const GroupMotion& motion,
                                     const kernel::RigidMotion<Real>& rigid) const {
  const Field field = field_of(rigid);
  Mat3 turning;
  const Vec3& spin = field.spin;
  turning << 0, -spin[2], spin[1], spin[2], 0, -spin[0], -spin[1], spin[0], 0;
  Coefficients relative =
      units.time / units.length * motion.v - motion.x * (turning.transpose() / units.length);
  relative.row(0) -= (field.velocity - turning * units.origin / units.length).transpose();
  const auto& at = layout_->places().at;
  return kernel_.largest[shape_of(one).motions()]({one.begin,
                                                   one.end,
                                                   {at[0].data(), at[1].data(), at[2].data()},
                                                   relative.data(),
                                                   at[0].size()});
}

/// Boxes of a piece follow each other. Where no lists depend on strains, and they change
/// slowly, their rates are found now and then.
template <class Real>
void GroupLimits<Real>::bound(const Units& units, const GroupStep& by,
                              const std::function<bool(std::size_t)>& meets,
                              const kernel::Subpieces<Real>& subpieces,
                              std::span<kernel::Totals> totals) {
  std::vector<GroupMotion> moving = motions_->now();
  std::vector<Curvature> curvature(moving.size());
  std::vector<double> speed2(moving.size());
  for (std::size_t g = 0; g < moving.size(); ++g) {
    const GroupShape& shape = (*shapes_)[g];
    if (!by.drift_first) moving[g].v = motions_->next()[g].v;
    curvature[g] = curvature_of(shape, moving[g]);
    const TangentMotion middle = motion_at(shape, moving[g], Vec3::Zero());
    const double speed = middle.v.norm() + along_tangent(middle.dv, shape.reach) +
                         beyond_tangent(curvature[g].v, shape.reach);
    speed2[g] = std::pow(speed * units.time / units.length, 2);
  }
  const std::vector<std::uint8_t>& working = layout_->working_pieces();
  const bool everywhere = steps_++ % steps_between_rates == 0;
  rates_.resize(boxes_.size());
  std::vector<double> fastest(boxes_.size());
  parallel_for(boxes_.size(), boxes_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const PieceBox& one = boxes_[k];
      const auto g = static_cast<std::size_t>(one.group);
      const bool near = working[one.piece] != 0 || meets(one.piece);
      const TangentMotion local = motion_at((*shapes_)[g], moving[g], one.box.center());
      const auto& field = subpieces.motions[one.subpiece];
      fastest[k] = near ? fastest_of(one, units, moving[g], field)
                        : fastest_in(one.box, units, local, curvature[g], field_of(field));
      rates_[k] = near || everywhere ? strain_rate(one.around, local, curvature[g]) : 0;
    }
  });
  for (std::size_t k = 0; k < boxes_.size();) {
    const std::uint32_t piece = boxes_[k].piece;
    const bool near = working[piece] != 0 || meets(piece);
    double rate = 0;
    for (; k < boxes_.size() && boxes_[k].piece == piece; ++k) {
      rate = std::max(rate, rates_[k]);
      Real& of_subpiece = subpieces.fastest[boxes_[k].subpiece];
      of_subpiece = std::max(of_subpiece, static_cast<Real>(fastest[k] * (1 + 1e-6)));
      totals[piece].speed2 =
          std::max(totals[piece].speed2, speed2[static_cast<std::size_t>(boxes_[k].group)]);
    }
    strains_[piece] +=
        (near ? 1 : rates_ahead * steps_between_rates) * by.drift * rate * (1 + by.drift * rate);
  }
}

/// Gives the box around the moved box, and the rotation of the rate of its deformation.
template <class Real>
PieceNow GroupLimits<Real>::piece_now(std::size_t piece, const Units& units) const {
  const PieceBox& one = boxes_[box_of_[piece]];
  const TangentMotion local = motion_at(shape_of(one), motion_of(one), one.box.center());
  const Vec3 size = one.box.sizes();
  const double bends =
      beyond_tangent(curvature_of(shape_of(one), motion_of(one)).x, size / 2) / units.length;
  PieceNow now;
  now.center = (local.x - units.origin) / units.length;
  const Vec3 half = (local.dx.cwiseAbs() * size / (2 * units.length)).array() + bends;
  const Vec3 more = half + Vec3::Constant(1e-6 * half.maxCoeff() + (sizeof(Real) == 4 ? 1 : 0));
  now.box = Box(Vec3(now.center - more), Vec3(now.center + more));
  now.axes = orthogonal_factor(local.dx);
  const Vec3 along =
      ((now.axes.transpose() * local.dx).cwiseAbs() * size / (2 * units.length)).array() + bends;
  const Vec3 own = along + (more - half);
  now.along = Box(Vec3(-own), own);
  now.velocity = units.time / units.length * local.v;
  const Mat3 L = units.time * local.dv * local.dx.inverse();
  now.spin = Vec3(L(2, 1) - L(1, 2), L(0, 2) - L(2, 0), L(1, 0) - L(0, 1)) / 2;
  return now;
}

/// Where particles beyond second neighbors are, as far as squeezes matter.
template <class Real>
void GroupLimits<Real>::find_far_sites() {
  const double r = body_->material.pair.r;
  constexpr int max_planes = 8;
  for (int x = -max_planes; x <= max_planes; ++x)
    for (int y = -max_planes; y <= max_planes; ++y)
      for (int z = 0; z <= max_planes; ++z) {
        const Vec3 site = half_plane_spacing(r) * (body_->lattice * Vec3(x, y, z));
        const double distance = site.norm();
        if ((x + y + z) % 2 == 0 && distance > second_neighbor_range * r &&
            distance * min_looked_at < 2 * r)
          far_sites_.push_back(site);
      }
}

/// Looks at what strains may have changed by enough.
template <class Real>
void GroupLimits<Real>::check_stretch() {
  for (std::size_t k = 0; k < boxes_.size();) {
    const std::uint32_t piece = boxes_[k].piece;
    const bool due = !(strains_[piece] < strained_until_[piece]);
    double spare = std::exp(max_margin);
    for (; k < boxes_.size() && boxes_[k].piece == piece; ++k)
      if (due) spare = std::min(spare, spare_in(boxes_[k]));
    if (due) strained_until_[piece] = strains_[piece] + std::log(spare) * (1 - 1e-6);
  }
}

/// The factor by which lengths may yet change before forces act that groups do not know, or more
/// than the most that matters. In boxes small enough to tell.
template <class Real>
double GroupLimits<Real>::spare_in(const PieceBox& one) const {
  const GroupShape& shape = shape_of(one);
  const Mat3 curvature = curvature_of(shape, motion_of(one)).x;
  const Vec3 weight = shape.frame.rowwise().norm();
  std::vector<Box> boxes{one.box};
  double least = std::exp(max_margin);
  while (!boxes.empty()) {
    Box box = boxes.back();
    boxes.pop_back();
    const Vec3 half = box.sizes() / 2;
    const double changes = (curvature * half).dot(weight);
    const Mat3 F = motion_at(shape, motion_of(one), box.center()).dx * shape.frame;
    const double of_box = shape.cubic ? spare_of_cubic(F, changes) : spare_of(F);
    if (of_box > enough || changes < min_change) {
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
double GroupLimits<Real>::spare_of(const Mat3& F) const {
  const Vec3 squares = squared_stretches(F);
  const double most = std::sqrt(squares[2]);
  if (most > stretch_.max) throw unstable_group("stretched", most, "end");
  return std::min(std::sqrt(std::max(0.0, squares[0])) / stretch_.min, stretch_.max / most);
}

/// Lets no particles touch that are no neighbors at rest.
template <class Real>
double GroupLimits<Real>::spare_of_cubic(const Mat3& F, double changes) const {
  if (F.determinant() <= 0) return 0;
  const double least = std::sqrt(std::max(0.0, squared_stretches(F)[0])) - changes;
  double spare = least / stretch_.min_cubic;
  if (spare > 1) return spare;
  spare = least / min_looked_at;
  for (const Vec3& site : far_sites_)
    spare =
        std::min(spare, ((F * site).norm() - changes * site.norm()) / (2 * body_->material.pair.r));
  return spare;
}

template class GroupLimits<double>;
template class GroupLimits<float>;

}  // namespace sinew
