// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/strain_lists.h>

#include <Eigen/LU>
#include <algorithm>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/physics/volume_weights.h>

namespace sinew {
namespace {

constexpr std::size_t blocks_per_spread = 64;

/// Fills the lists of one body.
template <class Real>
class StrainMaker {
 public:
  static constexpr std::size_t block = kernel::Traits<Real>::block;

  StrainMaker(const Body& body, double mass, std::span<const std::int32_t> id,
              const BondLists<Real>& bonds, const Units& units, StrainLists<Real>& out)
      : body_(body),
        id_(id),
        bonds_(bonds),
        per_length2_(units.length * units.length),
        per_energy_(units.time * units.time / (mass * per_length2_)),
        volume_(volume_per_particle(body.material.pair.r)),
        out_(out) {}

  void make() {
    const bool volumes = keeps_volume(body_);
    const bool fibers = has_muscles(body_);
    if (!volumes && !fibers) return;
    const std::size_t blocks = bonds_.first.size() - 1, slots = (blocks + 2) * block;
    for (auto& values : out_.inverse) values.assign(slots, 0);
    if (volumes) {
      out_.stiffness.assign(slots, 0);
      out_.growth.assign(slots, 0);
      for (auto& values : out_.volume_thrust) values.assign(slots, 0);
    }
    if (fibers) make_fibers(blocks, slots);
    parallel_for(blocks, blocks_per_spread, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) make_shapes(k);
    });
  }

 private:
  /// A^-1 and the stiffness of volumes.
  void make_shapes(std::size_t k) {
    std::array<Mat3, block> spread;
    spread.fill(Mat3::Zero());
    for (std::uint32_t e = bonds_.first[k]; e < bonds_.second[k]; ++e) {
      const Vec3& X = bonds_.rest[bonds_.entries[e].kind];
      for (std::size_t lane = 0; lane < block; ++lane)
        if ((bonds_.entries[e].lanes >> (lane + kernel::rest_lanes) & 1) != 0)
          spread[lane] += X * X.transpose();
    }
    for (std::size_t lane = 0; lane < block && k * block + lane < id_.size(); ++lane) {
      const std::size_t i = k * block + lane, slot = i + block;
      const std::vector<double>& weights = body_.factors.volume_weight;
      const double weight = weights.empty() ? volume_weight(spread[lane], body_.material.pair.r)
                                            : weights[static_cast<std::size_t>(id_[i])];
      if (!out_.stiffness.empty() && (bonds_.broken.empty() || bonds_.broken[i] == 0))
        out_.stiffness[slot] = static_cast<Real>(stiffness_of(i) * volume_ * weight * per_energy_);
      const bool fibers =
          has_muscles(body_) && body_.world->muscles.rest.defined(static_cast<std::size_t>(id_[i]));
      if (weight == 0 && !fibers) continue;
      const Mat3 inverse = spread[lane].inverse() * per_length2_;
      const double parts[6] = {inverse(0, 0), inverse(1, 1), inverse(2, 2),
                               inverse(1, 2), inverse(2, 0), inverse(0, 1)};
      for (int part = 0; part < 6; ++part)
        out_.inverse[part][slot] = static_cast<Real>(parts[part]);
    }
  }

  double stiffness_of(std::size_t k) const {
    return value_at(body_.local.volume, static_cast<std::size_t>(id_[k]),
                    body_.material.volume_stiffness);
  }

  void make_fibers(std::size_t blocks, std::size_t slots) {
    const Muscles& muscles = body_.world->muscles;
    for (auto& values : out_.fiber_thrust) values.assign(slots, 0);
    for (const Muscle& muscle : muscles.muscles)
      for (int axis = 0; axis < 3; ++axis)
        out_.direction.push_back(static_cast<Real>(muscle.direction[axis]));
    out_.level.assign(muscles.muscles.size(), 0);
    out_.first.push_back(0);
    for (std::size_t k = 0; k < blocks; ++k) {
      const std::size_t begin = out_.muscle.size();
      for (std::size_t lane = 0; lane < block && k * block + lane < id_.size(); ++lane)
        add_fibers(muscles, static_cast<std::size_t>(id_[k * block + lane]), lane, begin);
      out_.first.push_back(static_cast<std::uint32_t>(out_.muscle.size()));
    }
    find_near_fibers(blocks);
  }

  /// Blocks that feel fibers: their own, and those of neighbors at rest.
  void find_near_fibers(std::size_t blocks) {
    const auto some = [&](std::size_t k) { return out_.first[k] != out_.first[k + 1]; };
    out_.near_fibers.assign(blocks, 0);
    for (std::size_t k = 0; k < blocks; ++k) {
      bool near = some(k);
      for (std::uint32_t e = bonds_.first[k]; e < bonds_.second[k] && !near; ++e) {
        const auto begin = static_cast<std::int64_t>(k * block) + bonds_.entries[e].difference;
        const auto size = static_cast<std::int64_t>(block);
        for (const std::int64_t at : {begin, begin + size - 1})
          near = near || (at >= 0 && at / size < static_cast<std::int64_t>(blocks) &&
                          some(static_cast<std::size_t>(at / size)));
      }
      out_.near_fibers[k] = near ? 1 : 0;
    }
  }

  void add_fibers(const Muscles& muscles, std::size_t particle, std::size_t lane,
                  std::size_t begin) {
    const std::int32_t row = muscles.row[particle];
    if (row < 0) return;
    const auto of = static_cast<std::size_t>(row);
    for (std::uint32_t f = muscles.first[of]; f < muscles.first[of + 1]; ++f) {
      const Muscles::Fiber& fiber = muscles.fibers[f];
      const std::size_t slot = slot_of(static_cast<std::int32_t>(fiber.muscle), begin);
      out_.strength[slot * block + lane] = static_cast<Real>(
          muscles.muscles[fiber.muscle].strength * fiber.weight * volume_ * per_energy_);
    }
  }

  std::size_t slot_of(std::int32_t muscle, std::size_t begin) {
    for (std::size_t slot = begin; slot < out_.muscle.size(); ++slot)
      if (out_.muscle[slot] == muscle) return slot;
    out_.muscle.push_back(muscle);
    out_.strength.resize(out_.strength.size() + block, 0);
    return out_.muscle.size() - 1;
  }

  const Body& body_;
  std::span<const std::int32_t> id_;
  const BondLists<Real>& bonds_;
  double per_length2_, per_energy_;  ///< to the kernel's units
  double volume_;                    ///< V0, m^3
  StrainLists<Real>& out_;
};

template <class Real>
void put(std::array<Lines<Real>, 9>& values, kernel::Thrust<Real>& thrust) {
  for (int k = 0; k < 9; ++k)
    thrust[k] = values[k].empty() ? nullptr : values[k].data() + kernel::Traits<Real>::block;
}

}  // namespace

template <class Real>
void StrainLists<Real>::set_activations(const Activations& now) {
  for (std::size_t m = 0; m < level.size(); ++m) level[m] = static_cast<Real>(now.level[m]);
}

template <class Real>
void StrainLists<Real>::put_into(kernel::Step<Real>& step) {
  constexpr std::size_t block = kernel::Traits<Real>::block;
  if (empty()) return;
  for (int part = 0; part < 6; ++part) step.inverse[part] = inverse[part].data() + block;
  if (!stiffness.empty()) {
    step.volumes.stiffness = stiffness.data() + block;
    step.volumes.growth = growth.data() + block;
    put(volume_thrust, step.volumes.thrust);
  }
  if (first.empty()) return;
  step.fibers.first = first.data();
  step.fibers.near = near_fibers.data();
  step.fibers.muscle = muscle.data();
  step.fibers.strength = strength.data();
  step.fibers.direction = direction.data();
  step.fibers.level = level.data();
  put(fiber_thrust, step.fibers.thrust);
}

template <class Real>
StrainLists<Real> strain_lists(const Body& body, double mass, std::span<const std::int32_t> id,
                               const BondLists<Real>& bonds, const Units& units) {
  StrainLists<Real> lists;
  StrainMaker<Real>(body, mass, id, bonds, units, lists).make();
  return lists;
}

template struct StrainLists<double>;
template struct StrainLists<float>;
template StrainLists<double> strain_lists(const Body&, double, std::span<const std::int32_t>,
                                          const BondLists<double>&, const Units&);
template StrainLists<float> strain_lists(const Body&, double, std::span<const std::int32_t>,
                                         const BondLists<float>&, const Units&);

}  // namespace sinew
