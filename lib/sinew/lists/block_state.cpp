// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/block_state.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/core/local_origin.h>
#include <sinew/core/parallel.h>

namespace sinew {

namespace {

// Coordinates are 32-bit integers that wrap around. At first a body fills a quarter of their range.
// Units are chosen again when it is larger than 1.25 of that or off center by more than an eighth
// of it; this is checked when it may have traveled 0.36 of it. So no particle is farther out than
// 0.625 + 0.125 + 0.36 of 2^30; padding is beyond.
constexpr double body_range = 1073741824;  // 2^30
constexpr double largest = 1.25, off_the_middle = 0.125, traveled = 0.36;

}  // namespace

template <>
Units units_for<double>(const Box& box, const PairForce&, double) {
  Units units;
  units.origin = local_origin(box);
  return units;
}

template <>
Units units_for<float>(const Box& box, const PairForce& pair, double step) {
  // Large enough that padding particles are out of each other's range as well.
  const double extent = (box.isEmpty() ? 0 : box.sizes().maxCoeff()) + 16 * pair.b;
  Units units;
  units.length = extent / body_range;
  units.time = step;
  units.origin = box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.center());
  return units;
}

template <>
bool covers<double>(const Units&, const Box&) {
  return true;
}

template <>
bool covers<float>(const Units& units, const Box& box) {
  const double usual = body_range * units.length;
  return box.isEmpty() || ((box.center() - units.origin).norm() < off_the_middle * usual &&
                           box.sizes().maxCoeff() < largest * usual);
}

template <>
double free_travel<double>(const Units&) {
  return std::numeric_limits<double>::infinity();
}

template <>
double free_travel<float>(const Units& units) {
  return traveled * body_range * units.length;
}

namespace {

constexpr std::int32_t first_pad = 1342177280;     // 1.25 * 2^30, farther than any particle
constexpr std::uint32_t between_pads = 402653184;  // 0.375 * 2^30: four along each axis

}  // namespace

template <class Real>
BlockState<Real>::BlockState(std::size_t particles) : size_(particles) {
  const std::size_t slots = (blocks() + 2) * block;
  for (auto& axis : x_) axis.resize(slots);
  for (auto& axis : v_) axis.resize(slots);
  for (std::size_t lane = 0; lane < live_.size(); ++lane)
    live_[lane] = (blocks() - 1) * block + lane < size_ ? Real(1) : Real(0);
  pad();
}

template <class Real>
kernel::State<Real> BlockState<Real>::arrays() {
  kernel::State<Real> state{};
  for (int axis = 0; axis < 3; ++axis) {
    state.x[axis] = x_[axis].data() + block;
    state.v[axis] = v_[axis].data() + block;
  }
  return state;
}

template <>
Vec3 BlockState<double>::position(std::size_t k, const Units& units) const {
  const std::size_t slot = k + block;
  const Vec3 local(x_[0][slot], x_[1][slot], x_[2][slot]);
  return units.origin.isZero(0) ? local : Vec3(units.origin + local);  // -0 stays -0
}

template <>
void BlockState<double>::set_position(std::size_t k, int axis, double p, const Units& units) {
  x_[axis][k + block] = p - units.origin[axis];
}

template <>
Vec3 BlockState<float>::position(std::size_t k, const Units& units) const {
  const std::size_t slot = k + block;
  const Vec3 whole(x_[0][slot], x_[1][slot], x_[2][slot]);
  return units.origin + units.length * whole;
}

template <>
void BlockState<float>::set_position(std::size_t k, int axis, double p, const Units& units) {
  const double scaled = (p - units.origin[axis]) / units.length;
  x_[axis][k + block] = static_cast<std::int32_t>(std::llrint(scaled));
}

template <class Real>
void BlockState<Real>::set_position(std::size_t k, const Vec3& p, const Units& units) {
  for (int axis = 0; axis < 3; ++axis) set_position(k, axis, p[axis], units);
}

template <class Real>
Vec3 BlockState<Real>::velocity(std::size_t k, const Units& units) const {
  const std::size_t slot = k + block;
  const double scale = units.length / units.time;
  return scale * Vec3(v_[0][slot], v_[1][slot], v_[2][slot]);
}

template <class Real>
void BlockState<Real>::set_velocity(std::size_t k, const Vec3& v, const Units& units) {
  for (int axis = 0; axis < 3; ++axis) set_velocity(k, axis, v[axis], units);
}

template <class Real>
void BlockState<Real>::set_velocity(std::size_t k, int axis, double v, const Units& units) {
  v_[axis][k + block] = static_cast<Real>(units.velocity(v));
}

template <class Real>
auto BlockState<Real>::columns() const -> MovingColumns<Coord, Real> {
  const auto part = [&](const auto& axis) {
    const auto first = axis.begin() + block;
    return std::vector(first, first + static_cast<std::ptrdiff_t>(size_));
  };
  MovingColumns<Coord, Real> columns;
  for (int axis = 0; axis < 3; ++axis)
    columns.x[axis] = part(x_[axis]), columns.v[axis] = part(v_[axis]);
  return columns;
}

template <class Real>
void BlockState<Real>::set_columns(const MovingColumns<Coord, Real>& columns) {
  for (int axis = 0; axis < 3; ++axis) {
    std::copy(columns.x[axis].begin(), columns.x[axis].end(), x_[axis].begin() + block);
    std::copy(columns.v[axis].begin(), columns.v[axis].end(), v_[axis].begin() + block);
  }
  pad();
}

template <>
void BlockState<double>::pad(std::size_t slot, int number) {
  for (auto& axis : x_) axis[slot] = 1e30 * (1 + number);  // a float holds it
  for (auto& axis : v_) axis[slot] = 0;
}

template <>
void BlockState<float>::pad(std::size_t slot, int number) {
  const std::uint32_t place[3] = {static_cast<std::uint32_t>(number % 4),
                                  static_cast<std::uint32_t>(number / 4 % 4),
                                  static_cast<std::uint32_t>(number / 16)};
  for (int axis = 0; axis < 3; ++axis)
    x_[axis][slot] = static_cast<std::int32_t>(first_pad + place[axis] * between_pads);
  for (auto& axis : v_) axis[slot] = 0;
}

template <class Real>
void BlockState<Real>::pad() {
  int number = 0;
  for (std::size_t slot = 0; slot < block; ++slot) pad(slot, number++);
  for (std::size_t slot = block + size_; slot < x_[0].size(); ++slot) pad(slot, number++);
}

template <class Real>
void BlockState<Real>::pad_last_block() {
  for (std::size_t k = size_; k < blocks() * block; ++k)
    pad(k + block, static_cast<int>(block + k - size_));
}

template <class Real>
void BlockState<Real>::halt() {
  for (auto& axis : v_) std::fill(axis.begin(), axis.end(), Real(0));
}

template <class Real>
Box BlockState<Real>::box(const Units& units, std::size_t grain) const {
  std::vector<Box> boxes(size_ / grain + 1);
  parallel_for(size_, grain, [&](std::size_t begin, std::size_t end) {
    Box& box = boxes[begin / grain];
    for (std::size_t k = begin; k < end; ++k) box.extend(position(k, units));
  });
  Box all;
  for (const Box& box : boxes)
    if (!box.isEmpty()) all.extend(box);
  return all;
}

template class BlockState<double>;
template class BlockState<float>;

bool is_sound(const FixedPointUnits& saved) {
  return saved.length > 0 && std::isfinite(saved.length) && saved.origin.allFinite() &&
         saved.box.min().allFinite() && saved.box.max().allFinite() && saved.traveled >= 0 &&
         std::isfinite(saved.traveled);
}

template <class Real>
kernel::Law<Real> law_in(const Units& units, const PairForce& pair, double damping, double mass) {
  const double L = units.length, T = units.time, per_mass = pair.r * T * T / mass;
  const auto real = [](double value) { return static_cast<Real>(value); };
  return {real(pair.r / L),         real(pair.a / L),
          real(pair.b / L),         real(pair.b / L * pair.b / L),
          real(pair.k1 * per_mass), real(pair.k2 * per_mass),
          real(damping * T / mass)};
}

template kernel::Law<double> law_in(const Units&, const PairForce&, double, double);
template kernel::Law<float> law_in(const Units&, const PairForce&, double, double);

}  // namespace sinew
