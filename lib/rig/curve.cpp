// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/curve.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rig/rotation_vector.h"

namespace sinew {
namespace {

/// A place between two keys.
struct Span {
  std::size_t key;  ///< the earlier one; the later is key + 1
  double s;         ///< share of the way, 0 to 1
  double duration;  ///< s
};

/// The last key not after `time`, which lies between the first and the last. Most clips have even
/// times: the guess then is right.
std::size_t key_before(const std::vector<double>& times, double time) {
  const std::size_t last = times.size() - 2;
  const double share = (time - times.front()) / (times.back() - times.front());
  const auto guess =
      std::min(static_cast<std::size_t>(share * static_cast<double>(last + 1)), last);
  if (times[guess] <= time && time < times[guess + 1]) return guess;
  return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) -
                                  times.begin()) -
         1;
}

Span span_at(const std::vector<double>& times, double time) {
  const std::size_t key = key_before(times, time);
  const double duration = times[key + 1] - times[key];
  return {key, (time - times[key]) / duration, duration};
}

struct Eased {
  double value, rate;  // of the way from one key to the next, 0 to 1, and per second
};

Eased ease(Interpolation interpolation, const Span& span) {
  const double s = span.s;
  switch (interpolation) {
    case Interpolation::step:
      return {0, 0};
    case Interpolation::smooth:
      return {s * s * (3 - 2 * s), 6 * s * (1 - s) / span.duration};
    case Interpolation::linear:
    case Interpolation::cubic:
      break;
  }
  return {s, 1 / span.duration};
}

/// Hermite's polynomials and their slopes.
struct Hermite {
  double from, leave, to, arrive;
};

Hermite hermite(double s) {
  const double s2 = s * s, s3 = s2 * s;
  return {2 * s3 - 3 * s2 + 1, s3 - 2 * s2 + s, 3 * s2 - 2 * s3, s3 - s2};
}

Hermite hermite_slope(double s) {
  return {6 * s * (s - 1), (3 * s - 4) * s + 1, 6 * s * (1 - s), (3 * s - 2) * s};
}

template <class Value>
Value mix(const Hermite& h, const Value& from, const Value& leave, const Value& to,
          const Value& arrive) {
  return h.from * from + h.leave * leave + h.to * to + h.arrive * arrive;
}

/// The slope at a key of the parabola through it and its neighbours, from the slopes of the ways to
/// it and from it, which last `before` and `after`.
template <class Value>
Value slope_between(const Value& to_it, double before, const Value& from_it, double after) {
  return (after * to_it + before * from_it) / (before + after);
}

template <class Value>
Value zero_of();
template <>
double zero_of<double>() {
  return 0;
}
template <>
Vec3 zero_of<Vec3>() {
  return Vec3::Zero();
}

/// The ways that meet at a key: from the key before and to the key after, by the number of the key
/// each leads to. The ends have none but where the curve is cyclic.
struct Ways {
  std::size_t to_it, from_it;
};

template <class AnyCurve>
std::optional<Ways> ways_at(const AnyCurve& curve, std::size_t key) {
  const std::size_t last = curve.times.size() - 1;
  if (key > 0 && key < last) return Ways{key, key + 1};
  return curve.cyclic ? std::optional(Ways{last, 1}) : std::nullopt;
}

template <class Value>
Value made_tangent(const Curve<Value>& curve, std::size_t key) {
  const auto ways = ways_at(curve, key);
  if (!ways) return zero_of<Value>();
  const auto duration = [&](std::size_t k) { return curve.times[k] - curve.times[k - 1]; };
  const auto slope = [&](std::size_t k) -> Value {
    return (curve.values[k] - curve.values[k - 1]) / duration(k);
  };
  return slope_between<Value>(slope(ways->to_it), duration(ways->to_it), slope(ways->from_it),
                              duration(ways->from_it));
}

template <class Value>
typename Curve<Value>::Sample cubic(const Curve<Value>& curve, const Span& span) {
  const std::size_t k = span.key;
  const double h = span.duration;
  const Value leave = h * (curve.out.empty() ? made_tangent(curve, k) : curve.out[k]);
  const Value arrive = h * (curve.in.empty() ? made_tangent(curve, k + 1) : curve.in[k + 1]);
  const Value &from = curve.values[k], &to = curve.values[k + 1];
  return {mix(hermite(span.s), from, leave, to, arrive),
          mix(hermite_slope(span.s), from, leave, to, arrive) / h};
}

/// The rotation vector from key - 1 to key.
Vec3 turn_to(const RotationCurve& curve, std::size_t key) {
  if (!curve.turns.empty()) return curve.turns[key];
  return rotation_vector(curve.values[key] * curve.values[key - 1].conjugate());
}

Vec3 made_velocity(const RotationCurve& curve, std::size_t key) {
  const auto ways = ways_at(curve, key);
  if (!ways) return Vec3::Zero();
  const auto duration = [&](std::size_t k) { return curve.times[k] - curve.times[k - 1]; };
  const auto slope = [&](std::size_t k) -> Vec3 { return turn_to(curve, k) / duration(k); };
  return slope_between<Vec3>(slope(ways->to_it), duration(ways->to_it), slope(ways->from_it),
                             duration(ways->from_it));
}

/// The vector of `rotation` that is nearest to `wanted`, which may be longer than pi.
Vec3 rotation_vector_near(const Quat& rotation, const Vec3& wanted) {
  const Vec3 shortest = rotation_vector(rotation);
  const double angle = shortest.norm();
  if (angle < 1e-9) return shortest;  // no axis of its own
  const Vec3 axis = shortest / angle;
  return axis * (angle + 2 * pi * std::round((axis.dot(wanted) - angle) / (2 * pi)));
}

bool parallel(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm() <= 1e-12 * a.norm() * b.norm();
}

/// The way between two keys as three turns, one after the other, each along its own polynomial.
struct Turns {
  Vec3 first, second, third;
};

Turns turns_between(const RotationCurve& curve, const Span& span) {
  const Vec3 turn = turn_to(curve, span.key + 1);
  Turns w;
  w.first = span.duration / 3 * made_velocity(curve, span.key);
  w.third = span.duration / 3 * made_velocity(curve, span.key + 1);
  w.second = turn - w.first - w.third;
  if (parallel(turn, w.first) && parallel(turn, w.third) && parallel(w.first, w.third)) return w;
  const Quat second = rotation_by(-w.third) * rotation_by(turn) * rotation_by(-w.first);
  w.second = rotation_vector_near(second, w.second);
  return w;
}

RotationCurve::Sample along_turns(const RotationCurve& curve, const Span& span) {
  const Turns w = turns_between(curve, span);
  const double s = span.s, r = 1 - s;
  const Quat first = rotation_by((1 - r * r * r) * w.first),
             second = rotation_by(s * s * (3 - 2 * s) * w.second),
             third = rotation_by(s * s * s * w.third);
  const Vec3 rate =
      3 * s * s * w.third + third * (6 * s * r * w.second + second * (3 * r * r * w.first));
  return {third * second * first * curve.values[span.key], rate / span.duration};
}

/// glTF's: components one by one, then made a unit quaternion.
RotationCurve::Sample along_tangents(const RotationCurve& curve, const Span& span) {
  using Vec4 = Eigen::Vector4d;
  const std::size_t k = span.key;
  const double h = span.duration;
  const Vec4 from = curve.values[k].coeffs(), to = curve.values[k + 1].coeffs();
  const Vec4 leave = h * curve.out[k].coeffs(), arrive = h * curve.in[k + 1].coeffs();
  const Vec4 mixed = mix<Vec4>(hermite(span.s), from, leave, to, arrive);
  const Vec4 slope = mix<Vec4>(hermite_slope(span.s), from, leave, to, arrive) / h;
  const double size = mixed.norm();
  if (size == 0) return {curve.values[k].normalized(), Vec3::Zero()};
  const Vec4 unit = mixed / size;
  const Quat value(unit), rate(Vec4((slope - unit * unit.dot(slope)) / size));
  return {value, 2 * (rate * value.conjugate()).vec()};
}

}  // namespace

template <class Value>
typename Curve<Value>::Sample Curve<Value>::at(double time) const {
  if (time < times.front()) return {values.front(), zero_of<Value>()};
  if (time >= times.back()) return {values.back(), zero_of<Value>()};
  const Span span = span_at(times, time);
  if (interpolation == Interpolation::cubic) return cubic(*this, span);
  const Eased way = ease(interpolation, span);
  const Value &from = values[span.key], difference = values[span.key + 1] - from;
  return {from + way.value * difference, way.rate * difference};
}

template struct Curve<double>;
template struct Curve<Vec3>;

void find_turns(RotationCurve& curve) {
  if (curve.empty() || !curve.turns.empty()) return;
  std::vector<Vec3> turns = {Vec3::Zero()};
  for (std::size_t k = 1; k < curve.values.size(); ++k) turns.push_back(turn_to(curve, k));
  curve.turns = std::move(turns);
}

RotationCurve::Sample RotationCurve::at(double time) const {
  if (time < times.front()) return {values.front(), Vec3::Zero()};
  if (time >= times.back()) return {values.back(), Vec3::Zero()};
  const Span span = span_at(times, time);
  if (interpolation == Interpolation::step) return {values[span.key], Vec3::Zero()};
  if (interpolation == Interpolation::cubic)
    return in.empty() || out.empty() ? along_turns(*this, span) : along_tangents(*this, span);
  const Eased way = ease(interpolation, span);
  const Vec3 turn = turn_to(*this, span.key + 1);
  return {rotation_by(way.value * turn) * values[span.key], way.rate * turn};
}

}  // namespace sinew
