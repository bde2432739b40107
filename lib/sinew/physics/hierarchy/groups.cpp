// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/hierarchy/groups.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <bit>
#include <cmath>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

using kernel::blocks_per_piece;

constexpr std::size_t runs_at_a_time = 16, pieces_per_showing = 16, samples_at_a_time = 64;
constexpr std::uint32_t longest_run = 512;

/// A whole number of 32 bits, rounded to the nearest; fast, and the same everywhere.
std::int32_t whole_number(double value) {
  constexpr double shift = 6755399441055744.0;  // 1.5 2^52: the last bit is 1
  return static_cast<std::int32_t>(
      static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(value + shift)));
}

template <class Coord>
Coord coordinate(double value) {
  if constexpr (sizeof(Coord) == 4)
    return whole_number(value);
  else
    return value;
}

/// Puts c + F X, in any units, for places [begin, end).
template <class To, class Round>
void put_affine(const std::array<std::vector<double>, 3>& X, std::size_t begin,
                       std::size_t end, const Vec3& c, const Mat3& F, To* const to[3],
                       const Round& round) {
  const double *x = X[0].data(), *y = X[1].data(), *z = X[2].data();
  for (int axis = 0; axis < 3; ++axis) {
    const double at = c[axis], a = F(axis, 0), b = F(axis, 1), d = F(axis, 2);
    To* out = to[axis];
    for (std::size_t k = begin; k < end; ++k) out[k] = round(at + (a * x[k] + b * y[k] + d * z[k]));
  }
}

}  // namespace

template <class Real>
Groups<Real>::Groups(std::shared_ptr<const Body> body, double mass)
    : body_(std::move(body)), mass_(mass) {
  if (!body_->grouping || body_->grouping->size() == 0) return;
  motions_.resize(body_->grouping->size());
  next_ = motions_;
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
template <class Visit>
void Groups<Real>::for_each_run(std::size_t begin, std::size_t end, const Visit& visit) const {
  end = std::min(end, group_.size());
  for (std::size_t k = begin; k < end;) {
    std::size_t last = k + 1;
    while (last < end && group_[last] == group_[k]) ++last;
    if (group_[k] >= 0)
      visit(Run{static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(last), group_[k]});
    k = last;
  }
}

/// Longer runs where they continue.
template <class Real>
void Groups<Real>::append(const Run& run, std::vector<Run>& runs) {
  if (!runs.empty() && runs.back().end == run.begin && runs.back().group == run.group &&
      runs.back().end - runs.back().begin < longest_run)
    runs.back().end = run.end;
  else
    runs.push_back(run);
}

template <class Real>
void Groups<Real>::set_order(std::span<const std::int32_t> id) {
  if (!any()) return;
  const Grouping& grouping = *body_->grouping;
  id_.assign(id.begin(), id.end());
  group_.resize(id.size());
  for (auto& axis : X_) axis.assign(id.size(), 0);
  for (std::size_t k = 0; k < id.size(); ++k) {
    const auto i = static_cast<std::size_t>(id[k]);
    group_[k] = grouping.group[i];
    if (group_[k] < 0) continue;
    const Vec3 X = body_->rest[i] - shapes_[static_cast<std::size_t>(group_[k])].center;
    for (int axis = 0; axis < 3; ++axis) X_[axis][k] = X[axis];
  }
  find_roles();
  find_boxes();
  find_samples();
  ++moment_;
}

template <class Real>
void Groups<Real>::find_roles() {
  const Grouping& grouping = *body_->grouping;
  const std::size_t blocks = (group_.size() + block - 1) / block;
  const std::size_t pieces = (blocks + blocks_per_piece - 1) / blocks_per_piece;
  role_.assign(blocks, kernel::working);
  always_.assign(blocks, 0);
  asleep_.assign(blocks, 0);
  whole_.assign(blocks, 0);
  idle_pieces_.assign(pieces, 1);
  shown_.assign(pieces, -1);
  rim_.clear();
  for (Shape& shape : shapes_) shape.idle = 0, shape.moment.setZero();
  std::int32_t rows = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t begin = b * block, end = std::min(begin + block, group_.size());
    bool some = false, all = true, whole = true;
    for (std::size_t k = begin; k < end; ++k) {
      some = some || group_[k] >= 0;
      whole = whole && group_[k] >= 0;
      all = all && grouping.layer[static_cast<std::size_t>(id_[k])] >= Layer::shell;
    }
    if (!all) idle_pieces_[b / blocks_per_piece] = 0;
    if (!some) continue;
    role_[b] = all ? static_cast<std::int32_t>(kernel::idle) : rows++;
    asleep_[b] = all ? 1 : 0;
    whole_[b] = whole ? 1 : 0;
    for_each_run(begin, end, [&](Run run) {
      if (all) {
        Shape& shape = shapes_[static_cast<std::size_t>(run.group)];
        for (std::size_t k = run.begin; k < run.end; ++k)
          shape.idle += 1, shape.moment += place_at_rest(k);
        return;
      }
      run.row = static_cast<std::int64_t>(role_[b]) * static_cast<std::int64_t>(block) +
                static_cast<std::int64_t>(run.begin - begin);
      append(run, rim_);
    });
  }
  for (auto& axis : acceleration_) axis.assign(static_cast<std::size_t>(rows) * block, 0);
  more_are_read_ = true;
}

template <class Real>
void Groups<Real>::find_boxes() {
  boxes_.clear();
  constexpr std::size_t size = blocks_per_piece * block;
  for (std::size_t piece = 0; piece < idle_pieces_.size(); ++piece) {
    const std::size_t first = boxes_.size();
    for_each_run(piece * size, (piece + 1) * size, [&](const Run& run) {
      std::size_t at = first;
      while (at < boxes_.size() && boxes_[at].group != run.group) ++at;
      if (at == boxes_.size())
        boxes_.push_back({static_cast<std::uint32_t>(piece), run.group, Box()});
      for (std::size_t k = run.begin; k < run.end; ++k) boxes_[at].box.extend(place_at_rest(k));
    });
  }
}

/// Blocks of one group are of the kind of their first particle's group and bone.
template <class Real>
void Groups<Real>::find_samples() {
  samples_ = {};
  if (body_->skeleton.size() == 0) return;
  std::vector<SampledBlock> blocks;
  for (std::size_t b = 0; b < role_.size(); ++b) {
    if (role_[b] != kernel::idle) continue;
    const std::size_t begin = b * block, end = std::min(begin + block, group_.size());
    const auto bone = body_->binding.bone(static_cast<std::size_t>(id_[begin])) + 1;
    SampledBlock one{static_cast<std::uint32_t>(b),
                     static_cast<std::uint64_t>(group_[begin]) << 32 |
                         static_cast<std::uint32_t>(bone),
                     {}};
    if (group_[begin] != group_[end - 1])
      one.kind = std::uint64_t{1} << 63 | b;  // by itself
    const double extent = shapes_[static_cast<std::size_t>(group_[begin])].extent;
    for (std::size_t k = begin; k < end; ++k) add_moments(place_at_rest(k) / extent, one.moments);
    blocks.push_back(one);
  }
  samples_ = quadrature_over(blocks);
  for (const std::uint32_t b : samples_.block) always_[b] = 1;
  for (auto& values : pulled_) values.assign(samples_.block.size() * block, 0);
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
void Groups<Real>::put(const Run& run, BlockState<Real>& state, const Units& units) const {
  const Motion& motion = motions_[static_cast<std::size_t>(run.group)];
  const auto arrays = state.arrays();
  using Coord = typename BlockState<Real>::Coord;
  put_affine(X_, run.begin, run.end, Vec3((motion.c - units.origin) / units.length),
             Mat3(motion.F / units.length), arrays.x,
             [](double value) { return coordinate<Coord>(value); });
  const double speed = units.time / units.length;
  put_affine(X_, run.begin, run.end, Vec3(speed * motion.v), Mat3(speed * motion.V), arrays.v,
             [](double value) { return static_cast<Real>(value); });
}

/// The rim, and what a step reads of idle blocks.
template <class Real>
void Groups<Real>::find_steady() {
  steady_ = rim_;
  for (std::size_t b = 0; b < role_.size(); ++b) {
    if (role_[b] != kernel::idle || always_[b] == 0) continue;
    for_each_run(b * block, (b + 1) * block, [&](const Run& run) {
      append(run, steady_);
    });
  }
  more_are_read_ = false;
}

template <class Real>
void Groups<Real>::place(BlockState<Real>& state, const Units& units) {
  if (!any()) return;
  if (more_are_read_) find_steady();
  parallel_for(steady_.size(), runs_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) put(steady_[k], state, units);
  });
}

template <class Real>
void Groups<Real>::show(BlockState<Real>& state, const Units& units,
                        std::span<const std::uint32_t> pieces) {
  std::vector<std::uint32_t> hidden;
  for (const std::uint32_t piece : pieces)
    if (std::exchange(shown_[piece], moment_) != moment_) hidden.push_back(piece);
  parallel_for(hidden.size(), pieces_per_showing, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for_each_run(hidden[n] * blocks_per_piece * block, (hidden[n] + 1) * blocks_per_piece * block,
                   [&](const Run& run) { put(run, state, units); });
  });
}

template <class Real>
void Groups<Real>::show_all(BlockState<Real>& state, const Units& units) {
  if (!any()) return;
  std::vector<std::uint32_t> all(shown_.size());
  for (std::uint32_t piece = 0; piece < all.size(); ++piece) all[piece] = piece;
  show(state, units, all);
}

template <class Real>
void Groups<Real>::mark_read(std::ptrdiff_t first, std::ptrdiff_t last) {
  const auto size = static_cast<std::ptrdiff_t>(block);
  for (std::ptrdiff_t b = std::max<std::ptrdiff_t>(0, first / size);
       b <= last / size && b < static_cast<std::ptrdiff_t>(role_.size()); ++b) {
    const auto at = static_cast<std::size_t>(b);
    if (role_[at] == kernel::idle && always_[at] == 0) always_[at] = 1, more_are_read_ = true;
  }
}

template <class Real>
void Groups<Real>::read_through(const BondLists<Real>& bonds, bool two_deep) {
  if (!any() || bonds.first.empty()) return;
  for (int depth = 0; depth < (two_deep ? 2 : 1); ++depth) {
    std::vector<std::uint32_t> readers;
    for (std::uint32_t b = 0; b < role_.size(); ++b)
      if (asleep_[b] == 0) readers.push_back(b);
    std::vector<std::uint8_t> known = std::exchange(always_, std::vector<std::uint8_t>(role_.size(), 0));
    for (const std::uint32_t b : readers)
      for (std::uint32_t e = bonds.first[b]; e < bonds.first[b + 1]; ++e) {
        const std::uint32_t lanes = bonds.entries[e].lanes >> kernel::rest_lanes;
        if (lanes == 0) continue;
        const std::ptrdiff_t from =
            static_cast<std::ptrdiff_t>(b * block) + bonds.entries[e].difference;
        mark_read(from + std::countr_zero(lanes), from + 31 - std::countl_zero(lanes));
      }
    for (std::size_t b = 0; b < role_.size(); ++b) {
      if (always_[b] != 0 && two_deep && depth == 0) asleep_[b] = 0;
      if (known[b] != 0) always_[b] = 1;
    }
  }
}

template <class Real>
void Groups<Real>::read_through(const kernel::Lists* lists,
                                std::span<const std::uint32_t> pieces) {
  if (!any()) return;
  for (const std::uint32_t piece : pieces) {
    if (lists[piece].first == nullptr) continue;
    for (std::size_t k = 0; k < blocks_per_piece; ++k) {
      const std::size_t b = piece * blocks_per_piece + k;
      if (b >= role_.size()) break;
      if (role_[b] == kernel::idle) continue;
      for (std::uint32_t n = lists[piece].first[k]; n < lists[piece].first[k + 1]; ++n) {
        const std::ptrdiff_t from =
            static_cast<std::ptrdiff_t>(b * block) + lists[piece].value[n];
        mark_read(from, from + static_cast<std::ptrdiff_t>(block) - 1);
      }
    }
  }
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
auto Groups<Real>::sum_of(const Run& run) const -> Sum {
  Sum sum;
  const auto* const x = acceleration_[0].data() + run.row;
  const auto* const y = acceleration_[1].data() + run.row;
  const auto* const z = acceleration_[2].data() + run.row;
  for (std::size_t k = run.begin; k < run.end; ++k) {
    const std::size_t at = k - run.begin;
    const Vec3 f(static_cast<double>(x[at]), static_cast<double>(y[at]),
                 static_cast<double>(z[at]));
    sum.add(f, place_at_rest(k));
  }
  return sum;
}

template <class Real>
static Vec3 speed_of(const kernel::Step<Real>& step, std::size_t k) {
  return {static_cast<double>(step.before.v[0][k]), static_cast<double>(step.before.v[1][k]),
          static_cast<double>(step.before.v[2][k])};
}

/// Of the samples [begin, end), in units of the kernel.
template <class Real>
void Groups<Real>::add_samples(std::size_t begin, std::size_t end, const kernel::Step<Real>& step,
                               std::vector<Sum>& pulls, std::vector<Sum>& damping,
                               GroupSums& sums) const {
  const auto vector = [&](std::size_t part, std::size_t at) {
    return Vec3(static_cast<double>(pulled_[part][at]), static_cast<double>(pulled_[part + 1][at]),
                static_cast<double>(pulled_[part + 2][at]));
  };
  for (std::size_t s = begin; s < end; ++s) {
    const std::size_t first = samples_.block[s] * block;
    for_each_run(first, first + block, [&](const Run& run) {
      Sum pull, loss;
      double power = 0, lost = 0;
      for (std::size_t k = run.begin; k < run.end; ++k) {
        const std::size_t at = s * block + k - first;
        const Vec3 d = vector(3, at);
        pull.add(vector(0, at), place_at_rest(k)), loss.add(d, place_at_rest(k));
        power += static_cast<double>(pulled_[6][at]);
        lost += static_cast<double>(pulled_[7][at]) - d.dot(speed_of(step, k));
      }
      const auto g = static_cast<std::size_t>(run.group);
      const double weight = samples_.weight[s];
      pulls[g].add(weight, pull), damping[g].add(weight, loss);
      sums.power += weight * power, sums.lost += weight * lost;
    });
  }
}

template <class Real>
void Groups<Real>::add_bones(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
                             std::vector<Sum>& all, std::vector<Sum>& damping) {
  const std::size_t count = samples_.block.size();
  const std::size_t parts = (count + samples_at_a_time - 1) / samples_at_a_time;
  struct Part {
    std::vector<Sum> pulls, damping;
    GroupSums sums;
  };
  std::vector<Part> found(parts);
  parallel_for(count, samples_at_a_time, [&](std::size_t begin, std::size_t end) {
    kernel::Pulls<Real> to{};
    for (std::size_t k = 0; k < 3; ++k) {
      to.force[k] = pulled_[k].data() + begin * block;
      to.damping[k] = pulled_[3 + k].data() + begin * block;
    }
    to.power = pulled_[6].data() + begin * block;
    to.damping_power = pulled_[7].data() + begin * block;
    kernel.pull(step, samples_.block.data() + begin, end - begin, to);
    Part& part = found[begin / samples_at_a_time];
    part.pulls.resize(shapes_.size());
    part.damping.resize(shapes_.size());
    add_samples(begin, end, step, part.pulls, part.damping, part.sums);
  });
  for (const Part& part : found) {  // in this order, whichever thread made them
    for (std::size_t g = 0; g < shapes_.size(); ++g) {
      all[g].f += part.pulls[g].f, all[g].fX += part.pulls[g].fX;
      damping[g].f += part.damping[g].f, damping[g].fX += part.damping[g].fX;
    }
    sums_.power += part.sums.power;
    sums_.lost += part.sums.lost;
  }
}

template <class Real>
void Groups<Real>::sum(const kernel::Functions<Real>& kernel, const kernel::Step<Real>& step,
                       const Units& units, const GroupStep& by) {
  if (!any()) return;
  std::vector<Sum> of_runs(rim_.size()), all(shapes_.size()), damping(shapes_.size());
  parallel_for(rim_.size(), runs_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) of_runs[k] = sum_of(rim_[k]);
  });
  for (std::size_t k = 0; k < rim_.size(); ++k) {  // in this order, whichever thread made them
    Sum& sum = all[static_cast<std::size_t>(rim_[k].group)];
    sum.f += of_runs[k].f, sum.fX += of_runs[k].fX;
  }
  sums_ = {};
  add_bones(kernel, step, all, damping);
  const double force = units.length / (units.time * units.time);
  const double watts = mass_ * force * units.length / units.time;
  sums_.power *= watts, sums_.lost *= watts;
  for (std::size_t g = 0; g < shapes_.size(); ++g) {
    const Shape& shape = shapes_[g];
    const Vec3 a = (force * all[g].f + shape.idle * by.gravity) / shape.size;
    const Mat3 A =
        (force * all[g].fX + by.gravity * shape.moment.transpose()) * shape.inverse;
    sums_.lost -= mass_ * force * by.middle *
                  (damping[g].f.dot(a) + damping[g].fX.cwiseProduct(A).sum());
    const Motion& now = motions_[g];
    Motion& next = next_[g];
    next.v = now.v + by.kick * a;
    next.V = now.V + by.kick * A;
    next.c = now.c + by.drift * (by.drift_first ? now.v : next.v);
    next.F = now.F + by.drift * (by.drift_first ? now.V : next.V);
  }
}

template <class Real>
void Groups<Real>::bound(const Units& units, bool drift_first,
                         const kernel::PieceMotion<Real>* motions,
                         std::span<kernel::Totals> totals) const {
  const double speed = units.time / units.length;
  for (const PieceBox& one : boxes_) {
    const auto g = static_cast<std::size_t>(one.group);
    const Motion &now = motions_[g], &moving = drift_first ? now : next_[g];
    const auto& field = motions[one.piece];
    Vec3 center, velocity, spin;
    for (int axis = 0; axis < 3; ++axis) {
      center[axis] = static_cast<double>(field.center[axis]);
      velocity[axis] = static_cast<double>(field.velocity[axis]);
      spin[axis] = static_cast<double>(field.spin[axis]);
    }
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 X = one.box.corner(static_cast<Box::CornerType>(corner));
      const Vec3 at = (now.c + now.F * X - units.origin) / units.length;
      const Vec3 drifting = speed * (moving.v + moving.V * X);
      const double relative = (drifting - velocity - spin.cross(at - center)).squaredNorm();
      totals[one.piece].fastest = std::max(totals[one.piece].fastest, relative);
      totals[one.piece].speed2 = std::max(totals[one.piece].speed2, drifting.squaredNorm());
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
double Groups<Real>::smallest_stretch() const {
  double least = 1;
  for (const Motion& motion : motions_)
    least = std::min(least, Eigen::JacobiSVD<Mat3>(motion.F).singularValues()[2]);
  return least;
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
