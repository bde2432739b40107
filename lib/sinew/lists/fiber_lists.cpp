// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/fiber_lists.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <sinew/core/hash.h>
#include <sinew/core/particles.h>

namespace sinew {
namespace {

/// What a fiber of a particle was at rest.
struct RestFiber {
  std::int32_t muscle = -1;   ///< none
  double strength = 0;        ///< S w V0, in the kernel's units
  Vec3 per_X = Vec3::Zero();  ///< A^-1 t, 1/m
};

/// The rows of a layer, each once.
template <class Real>
class Rows {
 public:
  static constexpr std::size_t block = kernel::Traits<Real>::block;
  using Row = std::array<Real, block>;

  Rows() { add({}); }  // number 0: of entries without fibers

  std::uint32_t add(const Row& row) {
    const auto [at, is_new] = number_.try_emplace(row, static_cast<std::uint32_t>(number_.size()));
    if (is_new) values_.insert(values_.end(), row.begin(), row.end());
    return at->second;
  }
  Lines<Real> take() { return std::move(values_); }

 private:
  struct HashOf {
    std::size_t operator()(const Row& row) const {
      Hash hash;
      hash.add(row.data(), sizeof row);
      return hash.value();
    }
  };

  std::unordered_map<Row, std::uint32_t, HashOf> number_;
  Lines<Real> values_;
};

/// Makes one layer after the other.
template <class Real>
class LayerMaker {
 public:
  static constexpr std::size_t block = kernel::Traits<Real>::block;
  using Layer = typename FiberLists<Real>::Layer;
  using Row = typename Rows<Real>::Row;

  LayerMaker(const Body& body, double mass, std::span<const std::int32_t> id,
             const BondLists<Real>& bonds, const Units& units)
      : muscles_(body.world->muscles),
        id_(id),
        bonds_(bonds),
        length_(units.length),
        strength_(volume_per_particle(body.material.pair.r) * units.time * units.time /
                  (mass * units.length * units.length)) {}

  /// Lists the nth fiber of each particle; without slots where no particle has so many.
  Layer make(std::size_t nth) {
    const std::size_t blocks = bonds_.first.size() - 1;
    fibers_.assign(id_.size(), {});
    for (std::size_t i = 0; i < id_.size(); ++i) fibers_[i] = fiber_of(i, nth);
    Layer layer;
    add_slots(blocks, layer);
    if (layer.muscle.empty()) return layer;
    for (auto& values : layer.pull) values.assign((blocks + 2) * block, 0);
    layer.own.assign(blocks * block, 0);
    layer.near.assign(blocks, 0);
    layer.rows.assign(bonds_.entries.size(), {0, 0});
    Rows<Real> rows;
    for (std::size_t k = 0; k < blocks; ++k) add_rows(k, rows, layer);
    layer.coefficients = rows.take();
    return layer;
  }

 private:
  RestFiber fiber_of(std::size_t i, std::size_t nth) const {
    const auto particle = static_cast<std::size_t>(id_[i]);
    const std::int32_t row = muscles_.row[particle];
    if (row < 0) return {};
    const std::uint32_t* first = muscles_.first.data() + row;
    if (nth >= first[1] - first[0]) return {};
    const Muscles::Fiber& fiber = muscles_.fibers[first[0] + nth];
    const Muscle& muscle = muscles_.muscles[fiber.muscle];
    return {static_cast<std::int32_t>(fiber.muscle), muscle.strength * fiber.weight * strength_,
            muscles_.rest.inverse[particle] * muscle.direction};
  }

  std::size_t particles_of(std::size_t k) const { return std::min(block, id_.size() - k * block); }

  void add_slots(std::size_t blocks, Layer& layer) const {
    layer.first.push_back(0);
    for (std::size_t k = 0; k < blocks; ++k) {
      const std::size_t begin = layer.muscle.size();
      for (std::size_t lane = 0; lane < particles_of(k); ++lane) {
        const RestFiber& fiber = fibers_[k * block + lane];
        if (fiber.muscle < 0) continue;
        const std::size_t slot = slot_of(fiber.muscle, begin, layer);
        layer.strength[slot * block + lane] = static_cast<Real>(fiber.strength);
      }
      layer.first.push_back(static_cast<std::uint32_t>(layer.muscle.size()));
    }
  }

  std::size_t slot_of(std::int32_t muscle, std::size_t begin, Layer& layer) const {
    for (std::size_t slot = begin; slot < layer.muscle.size(); ++slot)
      if (layer.muscle[slot] == muscle) return slot;
    layer.muscle.push_back(muscle);
    layer.strength.resize(layer.strength.size() + block, 0);
    return layer.muscle.size() - 1;
  }

  void add_rows(std::size_t k, Rows<Real>& rows, Layer& layer) const {
    std::array<double, block> sums{};
    for (std::uint32_t e = bonds_.first[k]; e < bonds_.second[k]; ++e) {
      const kernel::BondEntry& entry = bonds_.entries[e];
      const Vec3 X = bonds_.rest[entry.kind] * length_;
      Row own{}, others{};
      for (std::size_t lane = 0; lane < particles_of(k); ++lane) {
        if ((entry.lanes >> (lane + kernel::rest_lanes) & 1) == 0) continue;
        const std::size_t i = k * block + lane;
        const auto j = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + entry.difference);
        own[lane] = static_cast<Real>(fibers_[i].per_X.dot(X));
        others[lane] = static_cast<Real>(fibers_[j].per_X.dot(X));
        sums[lane] += static_cast<double>(own[lane]);
        if (fibers_[i].muscle >= 0 || fibers_[j].muscle >= 0) layer.near[k] = 1;
      }
      layer.rows[e] = {rows.add(own), rows.add(others)};
    }
    for (std::size_t lane = 0; lane < block; ++lane)
      layer.own[k * block + lane] = static_cast<Real>(sums[lane]);
  }

  const Muscles& muscles_;
  std::span<const std::int32_t> id_;
  const BondLists<Real>& bonds_;
  double length_;    ///< the kernel's, m
  double strength_;  ///< V0, to the kernel's units of energy
  std::vector<RestFiber> fibers_;
};

}  // namespace

template <class Real>
void FiberLists<Real>::set_activations(const Activations& now) {
  for (std::size_t m = 0; m < level_.size(); ++m) level_[m] = static_cast<Real>(now.level[m]);
}

template <class Real>
kernel::Fibers<Real> FiberLists<Real>::arrays() {
  constexpr std::size_t block = kernel::Traits<Real>::block;
  arrays_.clear();
  for (Layer& layer : layers_) {
    auto& pull = layer.pull;
    arrays_.push_back({layer.first.data(),
                       layer.muscle.data(),
                       layer.strength.data(),
                       layer.near.data(),
                       layer.rows.data(),
                       layer.coefficients.data(),
                       layer.own.data(),
                       {pull[0].data() + block, pull[1].data() + block, pull[2].data() + block}});
  }
  return {arrays_.data(), static_cast<int>(arrays_.size()), level_.data()};
}

template <class Real>
FiberLists<Real> fiber_lists(const Body& body, double mass, std::span<const std::int32_t> id,
                             const BondLists<Real>& bonds, const Units& units) {
  LayerMaker<Real> maker(body, mass, id, bonds, units);
  std::vector<typename FiberLists<Real>::Layer> layers;
  for (auto layer = maker.make(0); !layer.muscle.empty(); layer = maker.make(layers.size()))
    layers.push_back(std::move(layer));
  return {std::move(layers), body.world->muscles.muscles.size()};
}

template class FiberLists<double>;
template class FiberLists<float>;
template FiberLists<double> fiber_lists(const Body&, double, std::span<const std::int32_t>,
                                        const BondLists<double>&, const Units&);
template FiberLists<float> fiber_lists(const Body&, double, std::span<const std::int32_t>,
                                       const BondLists<float>&, const Units&);

}  // namespace sinew
