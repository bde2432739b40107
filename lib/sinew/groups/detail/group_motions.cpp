// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/detail/group_motions.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/body/body.h>
#include <sinew/body/grouping.h>
#include <sinew/core/error.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

using kernel::blocks_per_piece;

constexpr std::size_t runs_at_a_time = 2, particles_per_sum = 16384, skins_at_a_time = 16;
constexpr std::size_t runs_per_placing = 16, pieces_per_showing = 16;

Eigen::Map<const Coefficients> of_terms(const kernel::TermSums& sums) {
  return Eigen::Map<const Coefficients>(sums.sum);
}

Coefficients of_terms(const AffineSum& sum) {
  Coefficients all = Coefficients::Zero();
  all.row(0) = sum.f.transpose(), all.middleRows<3>(1) = sum.fX.transpose();
  return all;
}

}  // namespace

template <class Real>
GroupMotions<Real>::GroupMotions(const Body& body, double mass,
                                 const kernel::Functions<Real>& kernel,
                                 const std::vector<GroupShape>& shapes, GroupLayout<Real>& layout)
    : body_(&body),
      mass_(mass),
      kernel_(kernel),
      shapes_(&shapes),
      layout_(&layout),
      motions_(shapes.size()),
      next_(shapes.size()),
      accelerations_(shapes.size()) {
  if (has_affine_forces(body)) affine_.emplace(body);
}

template <class Real>
void GroupMotions<Real>::set_order(const BondLists<Real>& bonds) {
  find_idle_terms();
  find_skins();
  find_sample();
  shown_.assign(layout_->pieces(), -1);
  for (auto& axis : acceleration_) axis.assign((layout_->rows() + 1) * block, 0);
  ++moment_;
  const bool any_cubic = std::any_of(shapes_->begin(), shapes_->end(),
                                     [](const GroupShape& shape) { return shape.cubic; });
  if (!inner_ && any_cubic && !bonds.first.empty())
    inner_.emplace(*body_, *affine_, bonds, layout_->inner_particles());
}

template <class Real>
void GroupMotions<Real>::find_idle_terms() {
  idle_.assign(shapes_->size(), {});
  for (std::size_t b = 0; b < layout_->blocks(); ++b) {
    if (!layout_->may_idle(b)) continue;
    Terms& terms = idle_[static_cast<std::size_t>(layout_->group_of_block(b))].terms;
    for (std::size_t k = b * block; k < (b + 1) * block; ++k)
      terms += terms_at(layout_->places().place(k));
  }
}

template <class Real>
void GroupMotions<Real>::find_skins() {
  skins_.clear();
  skin_at_.assign(layout_->blocks(), -1);
  if (!affine_) return;
  const auto& places = layout_->places();
  const auto has_skin = [&](std::size_t k) {
    return body_->grouping->skin[static_cast<std::size_t>(places.id[k])] != 0;
  };
  for (std::uint32_t b = 0; b < layout_->blocks(); ++b) {
    bool some = false;
    if (!layout_->may_idle(b) || shape_of(layout_->group_of_block(b)).cubic) continue;
    for (std::size_t k = b * block; k < (b + 1) * block; ++k) some = some || has_skin(k);
    if (!some) continue;
    skin_at_[b] = static_cast<std::int32_t>(skins_.size());
    skins_.push_back({b, {}});
  }
  parallel_for(skins_.size(), skins_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      for (std::size_t k = skins_[s].block * block; k < (skins_[s].block + 1) * block; ++k)
        if (has_skin(k))
          skins_[s].moments +=
              affine_->moments_of(static_cast<std::uint32_t>(places.id[k]), places.place(k));
  });
  for (const SkinBlock& one : skins_)
    idle_[static_cast<std::size_t>(layout_->group_of_block(one.block))].skin += one.moments;
}

/// Blocks of one group are of the kind of their first particle's group and bone.
template <class Real>
void GroupMotions<Real>::find_sample() {
  sample_ = {};
  if (body_->skeleton.size() == 0) return;
  const auto& places = layout_->places();
  std::vector<SampledBlock> blocks;
  for (std::size_t b = 0; b < layout_->blocks(); ++b) {
    if (!layout_->is_idle(b)) continue;
    const std::size_t begin = b * block;
    const auto bone = body_->binding.bone(static_cast<std::size_t>(places.id[begin])) + 1;
    blocks.push_back(
        {static_cast<std::uint32_t>(b),
         static_cast<std::uint64_t>(places.group[begin]) << 32 | static_cast<std::uint32_t>(bone)});
  }
  const auto places_of = [&](std::uint32_t b) {
    Points at;
    for (std::size_t k = b * block; k < (b + 1) * block; ++k) at.push_back(places.place(k));
    return at;
  };
  sample_ = PulledSample<Real>(quadrature_over(blocks, places_of), layout_->inner_particles());
}

/// Fits displacements, which are smaller than places.
template <class Real>
void GroupMotions<Real>::begin(const BlockState<Real>& state, const Units& units) {
  const auto& places = layout_->places();
  motions_.assign(motions_.size(), {});
  for (std::size_t k = 0; k < places.group.size(); ++k) {
    if (places.group[k] < 0) continue;
    GroupMotion& motion = motions_[static_cast<std::size_t>(places.group[k])];
    const Vec3& X = body_->rest[static_cast<std::size_t>(places.id[k])];
    const Terms terms = terms_at(places.place(k));
    motion.x += terms * (state.position(k, units) - X).transpose();
    motion.v += terms * state.velocity(k, units).transpose();
  }
  for (std::size_t g = 0; g < motions_.size(); ++g) {
    const GroupShape& shape = (*shapes_)[g];
    GroupMotion& motion = motions_[g];
    motion.x = (shape.inverse * motion.x).eval();
    motion.v = (shape.inverse * motion.v).eval();
    motion.x.row(0) += shape.center.transpose();
    motion.x.template middleRows<3>(1) += shape.frame.inverse().transpose();
  }
  ++moment_;
}

/// The motion in the kernel's units.
template <class Real>
GroupMotion GroupMotions<Real>::in_kernel(std::size_t g, const Units& units) const {
  const double inverse = 1 / units.length;
  GroupMotion motion{inverse * motions_[g].x, units.time * inverse * motions_[g].v};
  motion.x.row(0) -= inverse * units.origin.transpose();
  return motion;
}

template <class Real>
void GroupMotions<Real>::put(const GroupRun& run, BlockState<Real>& state,
                             const Units& units) const {
  const GroupMotion motion = in_kernel(static_cast<std::size_t>(run.group), units);
  const auto& at = layout_->places().at;
  kernel_.put[shape_of(run.group).motions()]({state.arrays(),
                                              run.begin,
                                              run.end,
                                              {at[0].data(), at[1].data(), at[2].data()},
                                              motion.x.data(),
                                              motion.v.data()});
}

template <class Real>
void GroupMotions<Real>::place(BlockState<Real>& state, const Units& units) {
  const std::vector<GroupRun>& runs = layout_->read_in_steps();
  parallel_for(runs.size(), runs_per_placing, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) put(runs[k], state, units);
  });
}

template <class Real>
void GroupMotions<Real>::show(BlockState<Real>& state, const Units& units,
                              std::span<const std::uint32_t> pieces) {
  constexpr std::size_t size = blocks_per_piece * block;
  std::vector<std::uint32_t> hidden;
  for (const std::uint32_t piece : pieces)
    if (std::exchange(shown_[piece], moment_) != moment_) hidden.push_back(piece);
  parallel_for(hidden.size(), pieces_per_showing, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      layout_->for_each_run(hidden[n] * size, (hidden[n] + 1) * size,
                            [&](const GroupRun& run) { put(run, state, units); });
  });
}

template <class Real>
void GroupMotions<Real>::put_into(kernel::Grouped<Real>& grouped) {
  const std::size_t size = (layout_->rows() + 1) * block;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (acceleration_[axis].size() < size) acceleration_[axis].resize(size, 0);
    grouped.acceleration[axis] = acceleration_[axis].data();
  }
}

template <class Real>
Coefficients GroupMotions<Real>::sum_of(const GroupRun& run) const {
  kernel::MomentInput<Real> input{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    input.force[axis] = acceleration_[axis].data() + run.row;
    input.at[axis] = layout_->places().at_of_kernel[axis].data() + run.begin;
  }
  input.count = run.end - run.begin;
  kernel::TermSums sums;
  kernel_.moments[shape_of(run.group).motions()](input, sums);
  return of_terms(sums);
}

template <class Real>
void GroupMotions<Real>::add(const kernel::PullSums& found, std::size_t group, Pulls& pulls) {
  pulls.all[group] += of_terms(found.force);
  pulls.damping[group] += of_terms(found.damping);
  sums_.power += found.power;
  sums_.lost += found.lost;
}

template <class Real>
void GroupMotions<Real>::add_rims(Pulls& pulls) const {
  const std::vector<GroupRun>& rim = layout_->rim();
  std::vector<Coefficients> of_runs(rim.size());
  parallel_for(rim.size(), runs_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) of_runs[k] = sum_of(rim[k]);
  });
  for (std::size_t k = 0; k < rim.size(); ++k)  // in this order, whichever thread made them
    pulls.all[static_cast<std::size_t>(rim[k].group)] += of_runs[k];
}

template <class Real>
void GroupMotions<Real>::add_bones(const kernel::Step<Real>& step, const Units& units,
                                   Pulls& pulls) {
  if (!sample_.is_bound()) sample_.bind(step.bindings);
  const std::vector<PulledRun>& runs = sample_.runs();
  std::vector<kernel::PullSums> found(runs.size());
  parallel_for(runs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto g = static_cast<std::size_t>(runs[k].group);
      found[k] = sample_.pull(runs[k], (*shapes_)[g].motions(), kernel_, step, in_kernel(g, units));
    }
  });
  for (std::size_t k = 0; k < found.size(); ++k)  // in this order, whichever thread made them
    add(found[k], static_cast<std::size_t>(runs[k].group), pulls);
}

/// What the kernel gathered on those awake takes the place of what follows from the motion.
template <class Real>
void GroupMotions<Real>::add_active(const BondLists<Real>& bonds, const kernel::Step<Real>& step,
                                    Pulls& pulls) {
  if (layout_->active().empty()) return;
  const auto& places = layout_->places();
  const InnerParticles particles = layout_->inner_particles();
  const auto& at = places.at_of_kernel;
  const double minus = -1;
  for (const std::uint32_t b : layout_->active()) {
    GroupRun run{static_cast<std::uint32_t>(b * block), static_cast<std::uint32_t>((b + 1) * block),
                 layout_->group_of_block(b)};
    const auto g = static_cast<std::size_t>(run.group);
    const GroupShape& shape = (*shapes_)[g];
    run.row = layout_->row(b) * static_cast<std::int64_t>(block);
    pulls.all[g] += sum_of(run);
    kernel::PullSums pull;
    kernel_.pull[shape.motions()](step, {&b, &minus, 1, {at[0].data(), at[1].data(), at[2].data()}},
                                  pull);
    add(pull, g, pulls);
    if (skin_at_[b] >= 0)
      pulls.idle[g].skin -= skins_[static_cast<std::size_t>(skin_at_[b])].moments;
    for (std::size_t k = run.begin; k < run.end; ++k)
      pulls.idle[g].terms -= terms_at(places.place(k));
    if (!shape.cubic) continue;
    const GroupForces own = inner_->on(bonds, particles, b, motions_[g]);
    pulls.inner[g].force -= own.force, pulls.inner[g].drag -= own.drag;
  }
}

template <class Real>
void GroupMotions<Real>::add_skins(Pulls& pulls) const {
  if (!affine_) return;
  for (std::size_t g = 0; g < shapes_->size(); ++g) {
    const GroupShape& shape = (*shapes_)[g];
    if (shape.cubic) continue;
    const auto rate_of = [&](const Coefficients& motion) -> Mat3 {
      return motion.middleRows<3>(1).transpose() * shape.frame;
    };
    const AffineMoments& skin = pulls.idle[g].skin;
    const Coefficients drag = of_terms(affine_->damping(skin, rate_of(motions_[g].v)));
    pulls.inner[g].drag += drag;
    pulls.inner[g].force += drag + of_terms(affine_->at(skin, rate_of(motions_[g].x)));
  }
}

template <class Real>
void GroupMotions<Real>::sum(const BondLists<Real>& bonds, const kernel::Step<Real>& step,
                             const Units& units, const GroupStep& by) {
  const std::vector<Coefficients> none(shapes_->size(), Coefficients::Zero());
  Pulls pulls{none, none, idle_, std::vector<GroupForces>(shapes_->size())};
  sums_ = {};
  add_rims(pulls);
  add_bones(step, units, pulls);
  if (inner_) inner_->add(kernel_, motions_, pulls.inner);
  add_active(bonds, step, pulls);
  add_skins(pulls);
  const double force = units.length / (units.time * units.time);
  const double watts = mass_ * force * units.length / units.time;
  sums_.power *= watts, sums_.lost *= watts;
  for (std::size_t g = 0; g < shapes_->size(); ++g) {
    const Coefficients sum = force * pulls.all[g] + pulls.inner[g].force / mass_ +
                             pulls.idle[g].terms * by.gravity.transpose();
    const Coefficients a = (*shapes_)[g].inverse * sum;
    const auto& v = motions_[g].v;
    sums_.lost -= mass_ * force * by.middle * pulls.damping[g].cwiseProduct(a).sum() +
                  pulls.inner[g].drag.cwiseProduct(v + by.middle * a).sum();
    move(g, a, by);
  }
}

template <class Real>
void GroupMotions<Real>::move(std::size_t g, const Coefficients& acceleration,
                              const GroupStep& by) {
  const GroupMotion& now = motions_[g];
  accelerations_[g] = acceleration;
  next_[g].v = now.v + by.kick * acceleration;
  next_[g].x = now.x + by.drift * (by.drift_first ? now.v : next_[g].v);
}

template <class Real>
void GroupMotions<Real>::advance() {
  motions_ = next_;
  ++moment_;
}

template <class Real>
void GroupMotions<Real>::add_constrained(std::span<const std::int32_t> cell, const Units& units,
                                         std::span<ConstrainedCell> constrained) const {
  const double force = units.length / (units.time * units.time);
  const auto& places = layout_->places();
  for (const GroupRun& run : layout_->rim()) {
    const Coefficients& moved = accelerations_[static_cast<std::size_t>(run.group)];
    for (std::uint32_t k = run.begin; k < run.end; ++k) {
      const auto row = static_cast<std::size_t>(run.row) + k - run.begin;
      const Vec3 own(static_cast<double>(acceleration_[0][row]),
                     static_cast<double>(acceleration_[1][row]),
                     static_cast<double>(acceleration_[2][row]));
      ConstrainedCell& there =
          constrained[static_cast<std::size_t>(cell[static_cast<std::size_t>(places.id[k])])];
      there.squares += (force * own - value_at(moved, places.place(k))).squaredNorm();
      there.count += 1;
    }
  }
}

template <class Real>
void GroupMotions<Real>::constrain(Forces& forces, const std::vector<std::uint32_t>& caller,
                                   const Vec3& gravity) const {
  using Sums = std::vector<Coefficients>;
  const auto& places = layout_->places();
  const std::vector<std::int32_t>& group = places.group;
  const Vec3 weight = mass_ * gravity;
  std::vector<Sums> parts((group.size() + particles_per_sum - 1) / particles_per_sum);
  parallel_for(group.size(), particles_per_sum, [&](std::size_t begin, std::size_t end) {
    Sums& sums = parts[begin / particles_per_sum];
    sums.assign(shapes_->size(), Coefficients::Zero());
    for (std::size_t k = begin; k < end; ++k)
      if (group[k] >= 0)
        sums[static_cast<std::size_t>(group[k])] +=
            terms_at(places.place(k)) * (forces.total(caller[k]) + weight).transpose();
  });
  Sums sums(shapes_->size(), Coefficients::Zero());
  for (std::size_t g = 0; g < sums.size(); ++g) {
    for (const Sums& part : parts) sums[g] += part[g];
    sums[g] = ((*shapes_)[g].inverse * sums[g]).eval();
  }
  Points constraint(group.size(), Vec3::Zero());
  parallel_for(group.size(), particles_per_sum, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (group[k] >= 0)
        constraint[caller[k]] =
            value_at(sums[static_cast<std::size_t>(group[k])], places.place(k)) -
            (forces.total(caller[k]) + weight);
  });
  forces.group = std::move(constraint);
}

template <class Real>
void GroupMotions<Real>::save(SimulationState& state) const {
  // Number of terms of each group, then those of places, m, and velocities.
  std::vector<double> saved;
  for (std::size_t g = 0; g < motions_.size(); ++g) {
    const int terms = (*shapes_)[g].terms();
    saved.push_back(terms);
    for (const Coefficients* all : {&motions_[g].x, &motions_[g].v})
      for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < terms; ++k) saved.push_back((*all)(k, axis));
  }
  put_column(state, "groups", "terms", std::move(saved));
}

template <class Real>
void GroupMotions<Real>::restore(const SimulationState& state) {
  const std::vector<double> saved = column_of<double>(state, "groups", "terms");
  std::size_t at = 0;
  const auto next = [&] {
    if (at == saved.size()) throw not_a_state("it has other groups");
    if (!std::isfinite(saved[at])) throw not_a_state("the motion of a group is not finite");
    return saved[at++];
  };
  for (std::size_t g = 0; g < motions_.size(); ++g) {
    const int terms = (*shapes_)[g].terms();
    if (next() != terms) throw not_a_state("it has other groups");
    for (Coefficients* all : {&motions_[g].x, &motions_[g].v})
      for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < terms; ++k) (*all)(k, axis) = next();
  }
  if (at != saved.size()) throw not_a_state("it has other groups");
  ++moment_;
}

template class GroupMotions<double>;
template class GroupMotions<float>;

}  // namespace sinew
