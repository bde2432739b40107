// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/curve.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <sinew/core/vector.h>

namespace sinew {

namespace {

using Vec4 = Eigen::Vector4d;

/// The last key not after `time`, which is between the first and the last. Most clips have equal
/// intervals: then the guess is right.
std::size_t key_before(const std::vector<double>& times, double time) {
  const std::size_t last = times.size() - 2;
  const double fraction = (time - times.front()) / (times.back() - times.front());
  const auto guess =
      std::min(static_cast<std::size_t>(fraction * static_cast<double>(last + 1)), last);
  if (times[guess] <= time && time < times[guess + 1]) return guess;
  return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) -
                                  times.begin()) -
         1;
}

/// A time between two keys.
struct Span {
  std::size_t key;  ///< the earlier one; the later is key + 1
  double duration;  ///< s
  PieceTime time;
};

Span span_at(const std::vector<double>& times, double time) {
  const std::size_t key = key_before(times, time);
  const double begin = times[key], end = times[key + 1];
  return {key, end - begin, {begin, end, begin, 1 / (end - begin)}};
}

/// The constant part of a curve: before its first key and after its last.
struct Hold {
  std::size_t key;
  PieceTime time;
};

std::optional<Hold> hold_at(const std::vector<double>& times, double time) {
  constexpr double ever = PieceTime::never;
  if (time < times.front()) return Hold{0, {-ever, times.front()}};
  if (time >= times.back()) return Hold{times.size() - 1, {times.back(), ever}};
  return std::nullopt;
}

/// Relative error of times that are sums and multiples of steps, enlarged: a key that is reached
/// but for it counts as reached, or the jump of a step would come a frame late.
constexpr double rounding_of_times = 1e-12;

/// The time that decides between keys at a moment, s.
template <class AnyCurve>
double time_on(const AnyCurve& curve, double moment) {
  return curve.interpolation == Interpolation::step ? moment + rounding_of_times * std::abs(moment)
                                                    : moment;
}

/// When a piece between such times is valid.
template <class AnyCurve>
PieceTime valid_on(const AnyCurve& curve, PieceTime piece) {
  if (curve.interpolation != Interpolation::step) return piece;
  for (double* end : {&piece.begin, &piece.end})
    if (std::isfinite(*end)) *end -= rounding_of_times * std::abs(*end);
  return piece;
}

/// Progress from one key to the next, 0 to 1, as a polynomial without a constant; not for cubic.
std::array<double, 3> progress_of(Interpolation interpolation) {
  if (interpolation == Interpolation::step) return {0, 0, 0};
  if (interpolation == Interpolation::smooth) return {0, 3, -2};
  return {1, 0, 0};
}

/// Hermite's polynomial; the tangents are those at the keys times the duration between them.
template <class Value>
std::array<Value, 4> hermite(const Value& from, const Value& leave, const Value& to,
                             const Value& arrive) {
  const Value change = to - from;
  return {from, leave, 3 * change - 2 * leave - arrive, leave + arrive - 2 * change};
}

/// The slope at a key of the parabola through it and its neighbors, from the slopes of the segments
/// to and from it, with durations `before` and `after`.
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

/// The segments that meet at a key, from the key before and to the key after, each by the number of
/// the key at its end. The first and last key have none unless the curve is cyclic.
struct Segments {
  std::size_t to_it, from_it;
};

template <class AnyCurve>
std::optional<Segments> segments_at(const AnyCurve& curve, std::size_t key) {
  const std::size_t last = curve.times.size() - 1;
  if (key > 0 && key < last) return Segments{key, key + 1};
  return curve.cyclic ? std::optional(Segments{last, 1}) : std::nullopt;
}

template <class Value>
Value made_tangent(const Curve<Value>& curve, std::size_t key) {
  const auto segments = segments_at(curve, key);
  if (!segments) return zero_of<Value>();
  const auto duration = [&](std::size_t k) { return curve.times[k] - curve.times[k - 1]; };
  const auto slope = [&](std::size_t k) -> Value {
    return (curve.values[k] - curve.values[k - 1]) / duration(k);
  };
  return slope_between<Value>(slope(segments->to_it), duration(segments->to_it),
                              slope(segments->from_it), duration(segments->from_it));
}

template <class Value>
std::array<Value, 4> cubic(const Curve<Value>& curve, const Span& span) {
  const std::size_t k = span.key;
  const Value leave = curve.out.empty() ? made_tangent(curve, k) : curve.out[k];
  const Value arrive = curve.in.empty() ? made_tangent(curve, k + 1) : curve.in[k + 1];
  return hermite<Value>(curve.values[k], span.duration * leave, curve.values[k + 1],
                        span.duration * arrive);
}

/// The rotation vector from key - 1 to key.
Vec3 turn_to(const RotationCurve& curve, std::size_t key) {
  if (!curve.turns.empty()) return curve.turns[key];
  return rotation_vector(curve.values[key] * curve.values[key - 1].conjugate());
}

Vec3 made_velocity(const RotationCurve& curve, std::size_t key) {
  const auto segments = segments_at(curve, key);
  if (!segments) return Vec3::Zero();
  const auto duration = [&](std::size_t k) { return curve.times[k] - curve.times[k - 1]; };
  const auto slope = [&](std::size_t k) -> Vec3 { return turn_to(curve, k) / duration(k); };
  return slope_between<Vec3>(slope(segments->to_it), duration(segments->to_it),
                             slope(segments->from_it), duration(segments->from_it));
}

/// The vector of `rotation` that is nearest to `wanted`, which may be longer than pi.
Vec3 rotation_vector_near(const Quat& rotation, const Vec3& wanted) {
  Vec3 shortest = rotation_vector(rotation);
  const double angle = shortest.norm();
  if (angle < 1e-9) return shortest;  // no axis of its own
  const Vec3 axis = shortest / angle;
  return axis * (angle + 2 * pi * std::round((axis.dot(wanted) - angle) / (2 * pi)));
}

bool parallel(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm() <= 1e-12 * a.norm() * b.norm();
}

Vec4 as_4(const Vec3& v) { return {v.x(), v.y(), v.z(), 0}; }

/// The rotation between two keys as three rotations in sequence, each with its own polynomial.
void put_turns(const RotationCurve& curve, const Span& span, RotationPiece& piece) {
  const Vec3 turn = turn_to(curve, span.key + 1);
  const Vec3 first = span.duration / 3 * made_velocity(curve, span.key);
  const Vec3 third = span.duration / 3 * made_velocity(curve, span.key + 1);
  Vec3 second = turn - first - third;
  if (!parallel(turn, first) || !parallel(turn, third) || !parallel(first, third))
    second =
        rotation_vector_near(rotation_by(-third) * rotation_by(turn) * rotation_by(-first), second);
  piece.form = RotationPiece::Form::turns;
  piece.c = {curve.values[span.key].coeffs(), as_4(first), as_4(second), as_4(third)};
}

/// Interpolates as glTF does: component by component.
void put_tangents(const RotationCurve& curve, const Span& span, RotationPiece& piece) {
  const std::size_t k = span.key;
  piece.form = RotationPiece::Form::tangents;
  piece.c = hermite<Vec4>(curve.values[k].coeffs(), span.duration * curve.out[k].coeffs(),
                          curve.values[k + 1].coeffs(), span.duration * curve.in[k + 1].coeffs());
}

}  // namespace

template <class Value>
CurvePiece<Value> Curve<Value>::piece_at(double moment) const {
  const Value zero = zero_of<Value>();
  const double time = time_on(*this, moment);
  if (const auto hold = hold_at(times, time))
    return {valid_on(*this, hold->time), {values[hold->key], zero, zero, zero}};
  Span span = span_at(times, time);
  span.time = valid_on(*this, span.time);
  if (interpolation == Interpolation::cubic) return {span.time, cubic(*this, span)};
  const auto [linear, square, cube] = progress_of(interpolation);
  const Value &from = values[span.key], difference = values[span.key + 1] - from;
  return {span.time, {from, linear * difference, square * difference, cube * difference}};
}

template struct Curve<double>;
template struct Curve<Vec3>;

RotationPiece RotationCurve::piece_at(double moment) const {
  RotationPiece piece;
  const double time = time_on(*this, moment);
  if (const auto hold = hold_at(times, time)) {
    piece.time = valid_on(*this, hold->time);
    piece.c = {values[hold->key].coeffs(), Vec4::Zero()};
    return piece;
  }
  const Span span = span_at(times, time);
  piece.time = valid_on(*this, span.time);
  if (interpolation != Interpolation::cubic) {
    piece.progress = progress_of(interpolation);
    piece.c = {values[span.key].coeffs(), as_4(turn_to(*this, span.key + 1))};
  } else if (in.empty() || out.empty()) {
    put_turns(*this, span, piece);
  } else {
    put_tangents(*this, span, piece);
  }
  return piece;
}

namespace {

using Vec4 = Eigen::Vector4d;

RotationSample by_turn(const RotationPiece& piece, double s) {
  const auto& [linear, square, cube] = piece.progress;
  const Vec3 turn = piece.c[1].head<3>();
  const double fraction = s * (linear + s * (square + s * cube));
  const double rate = piece.time.speed * (linear + s * (2 * square + s * (3 * cube)));
  return {rotation_by(fraction * turn) * Quat(piece.c[0]), rate * turn};
}

RotationSample by_turns(const RotationPiece& piece, double s) {
  const double r = 1 - s;
  const Vec3 one = piece.c[1].head<3>(), two = piece.c[2].head<3>(), three = piece.c[3].head<3>();
  const Quat first = rotation_by((1 - r * r * r) * one),
             second = rotation_by(s * s * (3 - 2 * s) * two),
             third = rotation_by(s * s * s * three);
  const Vec3 rate = 3 * s * s * three + third * (6 * s * r * two + second * (3 * r * r * one));
  return {third * second * first * Quat(piece.c[0]), piece.time.speed * rate};
}

RotationSample by_tangents(const RotationPiece& piece, double s) {
  const auto& c = piece.c;
  const Vec4 mixed = c[0] + s * (c[1] + s * (c[2] + s * c[3]));
  const Vec4 slope = piece.time.speed * (c[1] + s * (2 * c[2] + s * (3 * c[3])));
  const double size = mixed.norm();
  if (size == 0) return {Quat(c[0]).normalized(), Vec3::Zero()};
  const Vec4 unit = mixed / size;
  const Quat value(unit), rate(Vec4((slope - unit * unit.dot(slope)) / size));
  return {value, 2 * (rate * value.conjugate()).vec()};
}

}  // namespace

RotationSample RotationPiece::at(double moment) const {
  const double s = time.s(moment);
  if (form == Form::turns) return by_turns(*this, s);
  return form == Form::turn ? by_turn(*this, s) : by_tangents(*this, s);
}

}  // namespace sinew
