// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/strain_lists.h>

#include <Eigen/LU>
#include <algorithm>

#include <sinew/body/volume_weights.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

constexpr std::size_t blocks_per_spread = 64;

/// Fills the lists of volumes of one body.
template <class Real>
class VolumeMaker {
 public:
  static constexpr std::size_t block = kernel::Traits<Real>::block;

  VolumeMaker(const Body& body, double mass, std::span<const std::int32_t> id,
              const BondLists<Real>& bonds, const Units& units, StrainLists<Real>& out)
      : body_(body),
        id_(id),
        bonds_(bonds),
        per_length2_(units.length * units.length),
        per_energy_(units.time * units.time / (mass * per_length2_)),
        volume_(volume_per_particle(body.material.pair.r)),
        out_(out) {}

  void make() {
    if (!keeps_volume(body_)) return;
    const std::size_t blocks = bonds_.first.size() - 1, slots = (blocks + 2) * block;
    for (auto& values : out_.inverse) values.assign(slots, 0);
    for (auto& values : out_.thrust) values.assign(slots, 0);
    out_.stiffness.assign(slots, 0);
    out_.growth.assign(slots, 0);
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
      if (bonds_.broken.empty() || bonds_.broken[i] == 0)
        out_.stiffness[slot] = static_cast<Real>(stiffness_of(i) * volume_ * weight * per_energy_);
      if (weight == 0) continue;
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

  const Body& body_;
  std::span<const std::int32_t> id_;
  const BondLists<Real>& bonds_;
  double per_length2_, per_energy_;  ///< to the kernel's units
  double volume_;                    ///< V0, m^3
  StrainLists<Real>& out_;
};

}  // namespace

template <class Real>
void StrainLists<Real>::put_into(kernel::Step<Real>& step) {
  constexpr std::size_t block = kernel::Traits<Real>::block;
  step.fibers = fibers.arrays();
  if (stiffness.empty()) return;
  for (int part = 0; part < 6; ++part) step.inverse[part] = inverse[part].data() + block;
  step.volumes.stiffness = stiffness.data() + block;
  step.volumes.growth = growth.data() + block;
  for (int k = 0; k < 9; ++k) step.volumes.thrust[k] = thrust[k].data() + block;
}

template <class Real>
StrainLists<Real> strain_lists(const Body& body, double mass, std::span<const std::int32_t> id,
                               const BondLists<Real>& bonds, const Units& units) {
  StrainLists<Real> lists;
  VolumeMaker<Real>(body, mass, id, bonds, units, lists).make();
  if (has_muscles(body)) lists.fibers = fiber_lists(body, mass, id, bonds, units);
  return lists;
}

template struct StrainLists<double>;
template struct StrainLists<float>;
template StrainLists<double> strain_lists(const Body&, double, std::span<const std::int32_t>,
                                          const BondLists<double>&, const Units&);
template StrainLists<float> strain_lists(const Body&, double, std::span<const std::int32_t>,
                                         const BondLists<float>&, const Units&);

}  // namespace sinew
