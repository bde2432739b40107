// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/groups.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/core/simulation_state.h>

namespace sinew {
namespace {

constexpr std::size_t runs_at_a_time = 2, particles_per_matrix = 16384;

/// Of the terms that a group has, those of the place.
int terms_of(bool cubic) { return cubic ? cubic_terms : affine_terms; }

}  // namespace

template <class Real>
Groups<Real>::Groups(std::shared_ptr<const Body> body, double mass,
                     const kernel::Functions<Real>& kernel)
    : body_(std::move(body)), mass_(mass), kernel_(kernel) {
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
  for (std::size_t g = 0; g < shapes_.size(); ++g) shapes_[g].cubic = grouping.cubic[g] != 0;
  find_frames();
  find_inverses();
  find_far_sites();
}

/// From mean places, and the square roots of mean squares along all directions.
template <class Real>
void Groups<Real>::find_frames() {
  const std::vector<std::int32_t>& group = body_->grouping->group;
  const auto for_each = [&](const auto& visit) {
    for (std::size_t i = 0; i < group.size(); ++i)
      if (group[i] >= 0) visit(static_cast<std::size_t>(group[i]), body_->rest[i]);
  };
  for_each([&](std::size_t g, const Vec3& X) { shapes_[g].size += 1, shapes_[g].center += X; });
  for (Shape& shape : shapes_) shape.center /= shape.size;
  std::vector<Mat3> spread(shapes_.size(), Mat3::Zero());
  for_each([&](std::size_t g, const Vec3& X) {
    spread[g] += (X - shapes_[g].center) * (X - shapes_[g].center).transpose();
  });
  for (std::size_t g = 0; g < shapes_.size(); ++g)
    shapes_[g].frame =
        Eigen::SelfAdjointEigenSolver<Mat3>(spread[g] / shapes_[g].size).operatorInverseSqrt();
  for_each([&](std::size_t g, const Vec3& X) {
    const Vec3 at = shapes_[g].frame * (X - shapes_[g].center);
    shapes_[g].reach = shapes_[g].reach.cwiseMax(at.cwiseAbs());
  });
}

template <class Real>
void Groups<Real>::find_inverses() {
  const std::vector<std::int32_t>& group = body_->grouping->group;
  std::vector<std::vector<Inverse>> parts((group.size() + particles_per_matrix - 1) /
                                          particles_per_matrix);
  const bool any_cubic =
      std::any_of(shapes_.begin(), shapes_.end(), [](const Shape& shape) { return shape.cubic; });
  parallel_for(group.size(), particles_per_matrix, [&](std::size_t begin, std::size_t end) {
    if (!any_cubic) return;
    auto& sums = parts[begin / particles_per_matrix];
    sums.assign(shapes_.size(), Inverse::Zero());
    for (std::size_t i = begin; i < end; ++i) {
      if (group[i] < 0 || !shapes_[static_cast<std::size_t>(group[i])].cubic) continue;
      const Shape& shape = shapes_[static_cast<std::size_t>(group[i])];
      const Terms terms = terms_at(shape.frame * (body_->rest[i] - shape.center));
      sums[static_cast<std::size_t>(group[i])] += terms * terms.transpose();
    }
  });
  for (std::size_t g = 0; g < shapes_.size(); ++g) {
    Shape& shape = shapes_[g];
    if (shape.cubic) {
      Inverse products = Inverse::Zero();
      for (const auto& sums : parts) products += sums[g];
      shape.inverse = products.inverse();
    } else {
      shape.inverse.diagonal().template head<affine_terms>().setConstant(1 / shape.size);
    }
  }
}

/// By least squares, of displacements, which are smaller than places.
template <class Real>
void Groups<Real>::begin(const BlockState<Real>& state, const Units& units) {
  motions_.assign(motions_.size(), {});
  for (std::size_t k = 0; k < group_.size(); ++k) {
    if (group_[k] < 0) continue;
    GroupMotion& motion = motions_[static_cast<std::size_t>(group_[k])];
    const Vec3& X = body_->rest[static_cast<std::size_t>(id_[k])];
    const Terms terms = terms_at(place(k));
    motion.x += terms * (state.position(k, units) - X).transpose();
    motion.v += terms * state.velocity(k, units).transpose();
  }
  for (std::size_t g = 0; g < motions_.size(); ++g) {
    const Shape& shape = shapes_[g];
    GroupMotion& motion = motions_[g];
    motion.x = (shape.inverse * motion.x).eval();
    motion.v = (shape.inverse * motion.v).eval();
    motion.x.row(0) += shape.center.transpose();
    motion.x.middleRows<3>(1) += shape.frame.inverse().transpose();
  }
  strained_until_.assign(strained_until_.size(), -1);
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

namespace {

Eigen::Map<const Coefficients> of_terms(const kernel::TermSums& sums) {
  return Eigen::Map<const Coefficients>(sums.sum);
}

}  // namespace

template <class Real>
Coefficients Groups<Real>::sum_of(const Run& run) const {
  kernel::MomentInput<Real> input{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    input.force[axis] = acceleration_[axis].data() + run.row;
    input.at[axis] = at_of_kernel_[axis].data() + run.begin;
  }
  input.count = run.end - run.begin;
  kernel::TermSums sums;
  kernel_.moments[motions_of(static_cast<std::size_t>(run.group))](input, sums);
  return of_terms(sums);
}

template <class Real>
void Groups<Real>::add_pulls(const kernel::PullSums& pulls, std::size_t group, Sums& all,
                             Sums& damping) {
  all[group] += of_terms(pulls.force);
  damping[group] += of_terms(pulls.damping);
  sums_.power += pulls.power;
  sums_.lost += pulls.lost;
}

template <class Real>
void Groups<Real>::add_bones(const kernel::Step<Real>& step, const Units& units, Sums& all,
                             Sums& damping) {
  if (!sample_.is_held()) sample_.hold(step.holds);
  const std::vector<PulledRun>& runs = sample_.runs();
  std::vector<kernel::PullSums> found(runs.size());
  parallel_for(runs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto g = static_cast<std::size_t>(runs[k].group);
      found[k] = sample_.pull(runs[k], motions_of(g), kernel_, step, in_kernel(g, units));
    }
  });
  for (std::size_t k = 0; k < found.size(); ++k)  // in this order, whichever thread made them
    add_pulls(found[k], static_cast<std::size_t>(runs[k].group), all, damping);
}

template <class Real>
void Groups<Real>::add_skins(const std::vector<Idle>& idle, std::vector<GroupForces>& inner) const {
  if (!affine_) return;
  const auto terms = [](const AffineSum& sum) {
    Coefficients all = Coefficients::Zero();
    all.row(0) = sum.f.transpose(), all.middleRows<3>(1) = sum.fX.transpose();
    return all;
  };
  for (std::size_t g = 0; g < shapes_.size(); ++g) {
    if (shapes_[g].cubic) continue;
    const auto rate_of = [&](const Coefficients& motion) -> Mat3 {
      return motion.middleRows<3>(1).transpose() * shapes_[g].frame;
    };
    const Coefficients drag = terms(affine_->damping(idle[g].skin, rate_of(motions_[g].v)));
    inner[g].drag += drag;
    inner[g].force += drag + terms(affine_->at(idle[g].skin, rate_of(motions_[g].x)));
  }
}

template <class Real>
void Groups<Real>::sum(const BondLists<Real>& bonds, const kernel::Step<Real>& step,
                       const Units& units, const GroupStep& by) {
  if (!any()) return;
  std::vector<Coefficients> of_runs(rim_.size());
  parallel_for(rim_.size(), runs_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) of_runs[k] = sum_of(rim_[k]);
  });
  Sums all(shapes_.size(), Coefficients::Zero()), damping = all;
  for (std::size_t k = 0; k < rim_.size(); ++k)  // in this order, whichever thread made them
    all[static_cast<std::size_t>(rim_[k].group)] += of_runs[k];
  sums_ = {};
  add_bones(step, units, all, damping);
  std::vector<Idle> idle = idle_sums_;  // but for what is awake
  std::vector<GroupForces> inner(shapes_.size());
  if (inner_) inner_->add(kernel_, motions_, inner);
  add_awake(bonds, step, all, damping, idle, inner);
  add_skins(idle, inner);
  const double force = units.length / (units.time * units.time);
  const double watts = mass_ * force * units.length / units.time;
  sums_.power *= watts, sums_.lost *= watts;
  for (std::size_t g = 0; g < shapes_.size(); ++g) {
    const Coefficients sum =
        force * all[g] + inner[g].force / mass_ + idle[g].terms * by.gravity.transpose();
    const Coefficients a = shapes_[g].inverse * sum;
    const auto& v = motions_[g].v;
    sums_.lost -= mass_ * force * by.middle * damping[g].cwiseProduct(a).sum() +
                  inner[g].drag.cwiseProduct(v + by.middle * a).sum();
    move(g, a, by);
  }
}

template <class Real>
void Groups<Real>::move(std::size_t g, const Coefficients& acceleration, const GroupStep& by) {
  const GroupMotion& now = motions_[g];
  accelerations_[g] = acceleration;
  next_[g].v = now.v + by.kick * acceleration;
  next_[g].x = now.x + by.drift * (by.drift_first ? now.v : next_[g].v);
}

template <class Real>
void Groups<Real>::add_held(std::span<const std::int32_t> cell, const Units& units,
                            std::span<HeldCell> held) const {
  const double force = units.length / (units.time * units.time);
  for (const Run& run : rim_) {
    const Coefficients& moved = accelerations_[static_cast<std::size_t>(run.group)];
    for (std::uint32_t k = run.begin; k < run.end; ++k) {
      const auto row = static_cast<std::size_t>(run.row) + k - run.begin;
      const Vec3 own(static_cast<double>(acceleration_[0][row]),
                     static_cast<double>(acceleration_[1][row]),
                     static_cast<double>(acceleration_[2][row]));
      HeldCell& there = held[static_cast<std::size_t>(cell[static_cast<std::size_t>(id_[k])])];
      there.squares += (force * own - value_at(moved, place(k))).squaredNorm();
      there.count += 1;
    }
  }
}

template <class Real>
void Groups<Real>::advance() {
  if (!any()) return;
  motions_ = next_;
  ++moment_;
}

template <class Real>
void Groups<Real>::constrain(Forces& forces, const std::vector<std::uint32_t>& caller,
                             const Vec3& gravity) const {
  if (!any()) return;
  const Vec3 weight = mass_ * gravity;
  std::vector<Sums> parts((group_.size() + particles_per_matrix - 1) / particles_per_matrix);
  forces.group.clear();
  parallel_for(group_.size(), particles_per_matrix, [&](std::size_t begin, std::size_t end) {
    Sums& sums = parts[begin / particles_per_matrix];
    sums.assign(shapes_.size(), Coefficients::Zero());
    for (std::size_t k = begin; k < end; ++k)
      if (group_[k] >= 0)
        sums[static_cast<std::size_t>(group_[k])] +=
            terms_at(place(k)) * (forces.total(caller[k]) + weight).transpose();
  });
  Sums sums(shapes_.size(), Coefficients::Zero());
  for (std::size_t g = 0; g < sums.size(); ++g) {
    for (const Sums& part : parts) sums[g] += part[g];
    sums[g] = (shapes_[g].inverse * sums[g]).eval();
  }
  Points group(group_.size(), Vec3::Zero());
  parallel_for(group_.size(), particles_per_matrix, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (group_[k] >= 0)
        group[caller[k]] = value_at(sums[static_cast<std::size_t>(group_[k])], place(k)) -
                           (forces.total(caller[k]) + weight);
  });
  forces.group = std::move(group);
}

/// Of each group how many terms it has, and their coefficients.
template <class Real>
void Groups<Real>::save(SimulationState& state) const {
  state.groups.clear();
  for (std::size_t g = 0; g < motions_.size(); ++g) {
    const int terms = terms_of(shapes_[g].cubic);
    state.groups.push_back(terms);
    for (const Coefficients* all : {&motions_[g].x, &motions_[g].v})
      for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < terms; ++k) state.groups.push_back((*all)(k, axis));
  }
}

template <class Real>
void Groups<Real>::restore(const SimulationState& state) {
  std::size_t at = 0;
  const auto next = [&] {
    if (at == state.groups.size()) throw not_a_state("it has other groups");
    if (!std::isfinite(state.groups[at])) throw not_a_state("the motion of a group is not finite");
    return state.groups[at++];
  };
  for (std::size_t g = 0; g < motions_.size(); ++g) {
    const int terms = terms_of(shapes_[g].cubic);
    if (next() != terms) throw not_a_state("it has other groups");
    for (Coefficients* all : {&motions_[g].x, &motions_[g].v})
      for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < terms; ++k) (*all)(k, axis) = next();
  }
  if (at != state.groups.size()) throw not_a_state("it has other groups");
  strained_until_.assign(strained_until_.size(), -1);
  ++moment_;
}

template class Groups<double>;
template class Groups<float>;

}  // namespace sinew
