// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/hierarchy/groups.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/text.h>
#include <sinew/physics/stepper.h>

namespace sinew {
namespace {

constexpr std::size_t runs_at_a_time = 16;
constexpr std::size_t numbers_per_motion = 24;

Error unstable_group(const std::string& how, double stretch, const std::string& what) {
  return Error(Exit::unstable,
               "a group of particles was " + how + " to " + three_digits(stretch) +
                   " of its size, where forces between some neighbors would " + what +
                   "; make hierarchy.joint_distance larger, or hierarchy.enabled false");
}

}  // namespace

template <class Real>
Groups<Real>::Groups(std::shared_ptr<const Body> body, double mass)
    : body_(std::move(body)), mass_(mass) {
  if (!body_->grouping || body_->grouping->size() == 0) return;
  motions_.resize(body_->grouping->size());
  next_ = motions_;
  accelerations_.resize(motions_.size());
  stretch_ = stretch_range(*body_);
  if (has_affine_forces(*body_)) affine_.emplace(*body_);
  find_shapes();
}

template <class Real>
void Groups<Real>::find_shapes() {
  const Grouping& grouping = *body_->grouping;
  shapes_.resize(grouping.size());
  for (std::size_t i = 0; i < grouping.group.size(); ++i) {
    if (grouping.group[i] < 0) continue;
    Shape& shape = shapes_[static_cast<std::size_t>(grouping.group[i])];
    shape.size += 1;
    shape.center += body_->rest[i];
  }
  for (Shape& shape : shapes_) shape.center /= shape.size;
  std::vector<Mat3> spread(shapes_.size(), Mat3::Zero());
  for (std::size_t i = 0; i < grouping.group.size(); ++i) {
    if (grouping.group[i] < 0) continue;
    const auto g = static_cast<std::size_t>(grouping.group[i]);
    const Vec3 X = body_->rest[i] - shapes_[g].center;
    spread[g] += X * X.transpose();
  }
  for (std::size_t g = 0; g < shapes_.size(); ++g) {
    shapes_[g].inverse = spread[g].inverse();
    shapes_[g].extent = std::sqrt(spread[g].trace() / shapes_[g].size);
  }
}

template <class Real>
void Groups<Real>::begin(const BlockState<Real>& state, const Units& units) {
  for (std::size_t g = 0; g < motions_.size(); ++g) motions_[g] = {}, motions_[g].F.setZero();
  for (std::size_t k = 0; k < group_.size(); ++k) {
    if (group_[k] < 0) continue;
    Motion& motion = motions_[static_cast<std::size_t>(group_[k])];
    const Vec3 x = state.position(k, units), v = state.velocity(k, units), X = place_at_rest(k);
    motion.c += x, motion.v += v;
    motion.F += (x - shapes_[static_cast<std::size_t>(group_[k])].center) * X.transpose();
    motion.V += v * X.transpose();
  }
  for (std::size_t g = 0; g < motions_.size(); ++g) {
    Motion& motion = motions_[g];
    motion.c /= shapes_[g].size, motion.v /= shapes_[g].size;
    motion.F = (motion.F * shapes_[g].inverse).eval();
    motion.V = (motion.V * shapes_[g].inverse).eval();
  }
  ++moment_;
}

template <class Real>
kernel::Grouped<Real> Groups<Real>::arrays() {
  if (!any()) return {};
  return {role_.data(),
          asleep_.data(),
          whole_.data(),
          {acceleration_[0].data(), acceleration_[1].data(), acceleration_[2].data()}};
}

template <class Real>
void Groups<Real>::Sum::add(const double* moments) {
  f += Vec3(moments[0], moments[1], moments[2]);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) fX(row, column) += moments[3 + 3 * row + column];
}

template <class Real>
auto Groups<Real>::sum_of(const Run& run, const kernel::Functions<Real>& kernel) const -> Sum {
  kernel::MomentInput<Real> input{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    input.force[axis] = acceleration_[axis].data() + run.row;
    input.X[axis] = X_of_kernel_[axis].data() + run.begin;
  }
  input.count = run.end - run.begin;
  double moments[kernel::force_moments];
  kernel.moments(input, moments);
  Sum sum;
  sum.add(moments);
  return sum;
}

template <class Real>
void Groups<Real>::add_bones(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
                             std::vector<Sum>& all, std::vector<Sum>& damping) {
  std::vector<kernel::PullSums> found(sampled_.size());
  parallel_for(sampled_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Run& run = sampled_[k];
      kernel.pull(step,
                  {samples_.block.data() + run.begin,
                   samples_.weight.data() + run.begin,
                   run.end - run.begin,
                   {X_of_kernel_[0].data(), X_of_kernel_[1].data(), X_of_kernel_[2].data()}},
                  found[k]);
    }
  });
  for (std::size_t k = 0; k < found.size(); ++k) {  // in this order, whichever thread made them
    const auto g = static_cast<std::size_t>(sampled_[k].group);
    all[g].add(found[k].force);
    damping[g].add(found[k].damping);
    sums_.power += found[k].power;
    sums_.lost += found[k].lost;
  }
}

template <class Real>
void Groups<Real>::sum(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
                       const Units& units, const GroupStep& by) {
  if (!any()) return;
  std::vector<Sum> of_runs(rim_.size()), all(shapes_.size()), damping(shapes_.size());
  parallel_for(rim_.size(), runs_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) of_runs[k] = sum_of(rim_[k], kernel);
  });
  for (std::size_t k = 0; k < rim_.size(); ++k) {  // in this order, whichever thread made them
    Sum& sum = all[static_cast<std::size_t>(rim_[k].group)];
    sum.f += of_runs[k].f, sum.fX += of_runs[k].fX;
  }
  sums_ = {};
  add_bones(kernel, step, all, damping);
  std::vector<Shape> shapes = shapes_;  // but for what is awake
  add_awake(kernel, step, all, damping, shapes);
  const double force = units.length / (units.time * units.time);
  const double watts = mass_ * force * units.length / units.time;
  sums_.power *= watts, sums_.lost *= watts;
  for (std::size_t g = 0; g < shapes.size(); ++g) {
    const Shape& shape = shapes[g];
    const AffineSum skin = skin_of(shape, motions_[g]), drag = drag_of(shape, motions_[g]);
    const Vec3 f = force * all[g].f + (skin.f + drag.f) / mass_ + shape.idle * by.gravity;
    const Mat3 fX =
        force * all[g].fX + (skin.fX + drag.fX) / mass_ + by.gravity * shape.moment.transpose();
    const Vec3 a = f / shape.size;
    const Mat3 A = fX * shape.inverse;
    accelerations_[g] = {a, A};
    sums_.lost -=
        mass_ * force * by.middle * (damping[g].f.dot(a) + damping[g].fX.cwiseProduct(A).sum());
    const Motion& now = motions_[g];
    sums_.lost -=
        drag.f.dot(now.v + by.middle * a) + drag.fX.cwiseProduct(now.V + by.middle * A).sum();
    Motion& next = next_[g];
    next.v = now.v + by.kick * a;
    next.V = now.V + by.kick * A;
    next.c = now.c + by.drift * (by.drift_first ? now.v : next.v);
    next.F = now.F + by.drift * (by.drift_first ? now.V : next.V);
  }
}

template <class Real>
void Groups<Real>::add_held(std::span<const std::int32_t> cell, const Units& units,
                            std::span<HeldCell> held) const {
  const double force = units.length / (units.time * units.time);
  for (const Run& run : rim_) {
    const Sum& moved = accelerations_[static_cast<std::size_t>(run.group)];
    for (std::uint32_t k = run.begin; k < run.end; ++k) {
      const auto row = static_cast<std::size_t>(run.row) + k - run.begin;
      const Vec3 own(static_cast<double>(acceleration_[0][row]),
                     static_cast<double>(acceleration_[1][row]),
                     static_cast<double>(acceleration_[2][row]));
      HeldCell& there = held[static_cast<std::size_t>(cell[static_cast<std::size_t>(id_[k])])];
      there.squares += (force * own - moved.f - moved.fX * place_at_rest(k)).squaredNorm();
      there.count += 1;
    }
  }
}

template <class Real>
AffineSum Groups<Real>::skin_of(const Shape& shape, const Motion& motion) const {
  return affine_ ? affine_->at(shape.skin, motion.F) : AffineSum{};
}

template <class Real>
AffineSum Groups<Real>::drag_of(const Shape& shape, const Motion& motion) const {
  return affine_ ? affine_->damping(shape.skin, motion.V) : AffineSum{};
}

/// From the middle of each box, and how much faster than there its corners are at most.
template <class Real>
void Groups<Real>::bound(const Units& units, bool drift_first, const kernel::Parts<Real>& parts,
                         std::span<kernel::Totals> totals) const {
  const double speed = units.time / units.length;
  for (const PieceBox& one : boxes_) {
    const auto g = static_cast<std::size_t>(one.group);
    const Motion &now = motions_[g], &moving = drift_first ? now : next_[g];
    const auto& field = parts.motions[one.part];
    Vec3 center, velocity;
    Mat3 turning;
    const auto spin = [&](int axis) { return static_cast<double>(field.spin[axis]); };
    turning << 0, -spin(2), spin(1), spin(2), 0, -spin(0), -spin(1), spin(0), 0;
    for (int axis = 0; axis < 3; ++axis) {
      center[axis] = static_cast<double>(field.center[axis]);
      velocity[axis] = static_cast<double>(field.velocity[axis]);
    }
    const Vec3 X = one.box.center();
    const double reach = one.box.diagonal().norm() / 2;
    const Vec3 at = (now.c + now.F * X - units.origin) / units.length;
    const Vec3 drifting = speed * (moving.v + moving.V * X);
    const double relative = (drifting - velocity - turning * (at - center)).norm() +
                            reach * (speed * moving.V - turning * now.F / units.length).norm();
    const double absolute = drifting.norm() + reach * speed * moving.V.norm();
    kernel::Totals& piece = totals[one.piece];
    Real& fastest = parts.fastest[one.part];
    fastest = std::max(fastest, static_cast<Real>(relative * relative * (1 + 1e-6)));
    piece.speed2 = std::max(piece.speed2, absolute * absolute);
  }
}

template <class Real>
std::vector<Mat3> Groups<Real>::stretches() const {
  std::vector<Mat3> all;
  for (const Motion& motion : motions_) all.push_back(motion.F);
  return all;
}

/// The box around the moved box; the rotation of V F^-1.
template <class Real>
PieceNow Groups<Real>::piece_now(std::size_t piece, const Units& units) const {
  const PieceBox& one = boxes_[box_of_[piece]];
  const Motion& motion = motions_[static_cast<std::size_t>(one.group)];
  const Vec3 X = one.box.center();
  PieceNow now;
  now.center = (motion.c + motion.F * X - units.origin) / units.length;
  const Vec3 half = motion.F.cwiseAbs() * one.box.sizes() / (2 * units.length);
  const Vec3 more = half + Vec3::Constant(1e-6 * half.maxCoeff() + (sizeof(Real) == 4 ? 1 : 0));
  now.box = Box(Vec3(now.center - more), Vec3(now.center + more));
  now.axes = Eigen::HouseholderQR<Mat3>(motion.F).householderQ();
  const Vec3 own =
      (now.axes.transpose() * motion.F).cwiseAbs() * one.box.sizes() / (2 * units.length) +
      (more - half);
  now.along = Box(Vec3(-own), own);
  now.velocity = units.time / units.length * (motion.v + motion.V * X);
  const Mat3 L = units.time * motion.V * motion.F.inverse();
  now.spin = Vec3(L(2, 1) - L(1, 2), L(0, 2) - L(2, 0), L(1, 0) - L(0, 1)) / 2;
  return now;
}

template <class Real>
void Groups<Real>::advance() {
  if (!any()) return;
  motions_ = next_;
  ++moment_;
}

template <class Real>
void Groups<Real>::check_stretch() const {
  for (const Motion& motion : motions_) {
    const Mat3 C = motion.F.transpose() * motion.F;
    // No eigenvalue of C is farther from 1 than the norm of C - 1.
    const double off = (C - Mat3::Identity()).norm();
    if (1 - off > stretch_.least * stretch_.least && 1 + off < stretch_.most * stretch_.most)
      continue;
    const Vec3 squares = Eigen::SelfAdjointEigenSolver<Mat3>(C).eigenvalues();
    const double least = std::sqrt(std::max(0.0, squares[0])), most = std::sqrt(squares[2]);
    if (!(least >= stretch_.least)) throw unstable_group("squeezed", least, "begin");
    if (most > stretch_.most) throw unstable_group("stretched", most, "end");
  }
}

template <class Real>
void Groups<Real>::constrain(Forces& forces, const std::vector<std::uint32_t>& caller,
                             const Vec3& gravity) const {
  if (!any()) return;
  const Vec3 weight = mass_ * gravity;
  std::vector<Sum> sums(shapes_.size());
  forces.group.clear();
  for (std::size_t k = 0; k < group_.size(); ++k) {
    if (group_[k] < 0) continue;
    const Vec3 f = forces.total(caller[k]) + weight;
    Sum& sum = sums[static_cast<std::size_t>(group_[k])];
    sum.f += f, sum.fX += f * place_at_rest(k).transpose();
  }
  for (std::size_t g = 0; g < sums.size(); ++g)
    sums[g].f /= shapes_[g].size, sums[g].fX = (sums[g].fX * shapes_[g].inverse).eval();
  Points group(group_.size(), Vec3::Zero());
  for (std::size_t k = 0; k < group_.size(); ++k) {
    if (group_[k] < 0) continue;
    const Sum& sum = sums[static_cast<std::size_t>(group_[k])];
    group[caller[k]] = sum.f + sum.fX * place_at_rest(k) - (forces.total(caller[k]) + weight);
  }
  forces.group = std::move(group);
}

template <class Real>
void Groups<Real>::save(SimulationState& state) const {
  state.groups.clear();
  for (const Motion& motion : motions_) {
    const auto put = [&](const auto& values) {
      state.groups.insert(state.groups.end(), values.data(), values.data() + values.size());
    };
    put(motion.c), put(motion.v), put(motion.F), put(motion.V);
  }
}

template <class Real>
void Groups<Real>::restore(const SimulationState& state) {
  if (state.groups.size() != motions_.size() * numbers_per_motion)
    throw not_a_state("it has other groups");
  for (const double number : state.groups)
    if (!std::isfinite(number)) throw not_a_state("the motion of a group is not finite");
  const double* from = state.groups.data();
  for (Motion& motion : motions_) {
    const auto take = [&](auto& values) {
      std::copy_n(from, values.size(), values.data());
      from += values.size();
    };
    take(motion.c), take(motion.v), take(motion.F), take(motion.V);
  }
  ++moment_;
}

template class Groups<double>;
template class Groups<float>;

}  // namespace sinew
