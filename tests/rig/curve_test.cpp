// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/curve.h>

#include <gtest/gtest.h>

#include <sinew/core/vector.h>

#include "support/world.h"

namespace sinew::curve_test {

const std::vector<double> uneven = {0.5, 1.0, 2.5, 2.75, 4.0};

Curve<double> numbers(Interpolation kind) {
  Curve<double> curve;
  curve.interpolation = kind;
  curve.times = uneven;
  curve.values = {1, -2, 3, 3.5, 0};
  return curve;
}

/// Keys with random rotations, by the shortest rotations or by up to two and a half turns.
RotationCurve rotations(Interpolation kind, bool far) {
  std::mt19937 random(11);
  RotationCurve curve;
  curve.interpolation = kind;
  curve.times = uneven;
  Quat value = rotation_by(test::random_vector(random));
  for (std::size_t k = 0; k < uneven.size(); ++k) {
    const Vec3 turn = (far ? 30 : 5) * test::random_vector(random);
    if (k > 0) value = rotation_by(turn) * value;
    if (far) curve.turns.push_back(turn);
    curve.values.push_back(value);
  }
  return curve;
}

RotationCurve rotations_with_tangents() {
  std::mt19937 random(12);
  RotationCurve curve = rotations(Interpolation::cubic, false);
  const auto tangent = [&] { return Quat(test::random_vector(random).x(), 0.3, -0.2, 0.4); };
  for (std::size_t k = 0; k < uneven.size(); ++k) {
    curve.in.push_back(tangent());
    curve.out.push_back(curve.in.back());
  }
  return curve;
}

std::vector<double> between_keys() {
  std::vector<double> times;
  for (std::size_t k = 0; k + 1 < uneven.size(); ++k)
    for (const double s : {0.1, 0.37, 0.5, 0.93})
      times.push_back(uneven[k] + s * (uneven[k + 1] - uneven[k]));
  return times;
}

void expect_derivative(const RotationCurve& curve) {
  const double h = 1e-6;
  for (const double time : between_keys()) {
    const Quat before = curve.at(time - h).value, after = curve.at(time + h).value;
    const Vec3 rate = rotation_vector(after * before.conjugate()) / (2 * h);
    const Vec3 spin = curve.at(time).angular_velocity;
    EXPECT_LT((rate - spin).norm(), 1e-6 * (1 + spin.norm())) << time;
    EXPECT_NEAR(curve.at(time).value.norm(), 1, 1e-14);
  }
}

TEST(Curve, PassesItsKeysAndHoldsBeyondThem) {
  for (const auto kind :
       {Interpolation::step, Interpolation::linear, Interpolation::smooth, Interpolation::cubic}) {
    const Curve<double> curve = numbers(kind);
    for (std::size_t k = 0; k < uneven.size(); ++k)
      EXPECT_NEAR(curve.at(uneven[k]).value, curve.values[k], 1e-14);
    for (const double time : {-3.0, 0.4999, 4.0, 9.0}) {
      EXPECT_EQ(curve.at(time).value, time < 1 ? 1 : 0);
      EXPECT_EQ(curve.at(time).rate, 0);
    }
  }
}

TEST(Curve, FindsItsKeysAmongManyEvenAndUneven) {
  std::mt19937 random(5);
  Curve<double> curve;
  for (int k = 0; k < 1000; ++k) {
    const double shift = k < 500 ? 0 : 900 * test::random_vector(random).x();
    curve.times.push_back(k + (k < 500 ? 0 : 1e6) + shift);
  }
  std::sort(curve.times.begin(), curve.times.end());
  curve.values = curve.times;  // linear then is the identity
  for (std::size_t k = 0; k + 1 < curve.times.size(); ++k)
    for (const double s : {0.0, 1e-9, 0.5, 0.999}) {
      const double time = curve.times[k] + s * (curve.times[k + 1] - curve.times[k]);
      EXPECT_NEAR(curve.at(time).value, time, 1e-9);
    }
}

TEST(Curve, OfStepsJumpsAtItsKeysHoweverTheirTimesAreRounded) {
  Curve<double> steps{Interpolation::step, {}, {}, {}, {}, false};
  RotationCurve turns{Interpolation::step, {}, {}, {}, {}, {}, false};
  for (int k = 0; k <= 2400; ++k) {
    steps.times.push_back(k / 24.0);
    steps.values.push_back(k);
    turns.values.push_back(rotation_by(Vec3(0, 0, k)));
  }
  turns.times = steps.times;
  const double frame = 1 / 24.0, step = frame / 7;
  for (int k = 0; k <= 2400; ++k)
    for (const double time : {k / 24.0, k * frame, 7 * k * step, std::nextafter(k / 24.0, 0)}) {
      EXPECT_EQ(steps.at(time).value, k);
      EXPECT_LT(turns.at(time).value.angularDistance(turns.values[k]), 1e-6);
      EXPECT_EQ(steps.at(time - step).value, std::max(k - 1, 0));
    }
  CurvePiece<double> kept = steps.piece_at(0);  // as long as it says that it is valid
  for (int n = 0; n <= 7 * 2400; ++n) {
    if (!kept.time.covers(n * step)) kept = steps.piece_at(n * step);
    EXPECT_EQ(kept.at(n * step).value, n / 7);
  }
}

TEST(Curve, RatesAreItsDerivative) {
  for (const auto kind :
       {Interpolation::step, Interpolation::linear, Interpolation::smooth, Interpolation::cubic}) {
    const Curve<double> curve = numbers(kind);
    const double h = 1e-6;
    for (const double time : between_keys())
      EXPECT_NEAR(curve.at(time).rate,
                  (curve.at(time + h).value - curve.at(time - h).value) / (2 * h), 1e-7);
  }
}

TEST(Curve, CubicIsExactForParabolasAndSmoothAtKeys) {
  Curve<double> curve = numbers(Interpolation::cubic);
  for (std::size_t k = 0; k < uneven.size(); ++k) curve.values[k] = uneven[k] * uneven[k];
  for (const double time : {1.2, 2.0, 2.6})  // between inner keys
    EXPECT_NEAR(curve.at(time).value, time * time, 1e-13);
  for (const double key : uneven)
    EXPECT_NEAR(curve.at(key - 1e-9).rate, curve.at(key + 1e-9).rate, 1e-6);
}

TEST(Curve, CubicWithTangentsIsHermites) {
  Curve<double> curve;
  curve.interpolation = Interpolation::cubic;
  curve.times = {1, 3};
  curve.values = {1, 27};  // t^3
  curve.in = {0, 27};
  curve.out = {3, 0};
  for (const double time : {1.1, 1.9, 2.8}) {
    EXPECT_NEAR(curve.at(time).value, time * time * time, 1e-13);
    EXPECT_NEAR(curve.at(time).rate, 3 * time * time, 1e-13);
  }
}

TEST(Curve, CyclicCubicHasNoJumpOfSpeedWhereItCloses) {
  Curve<double> curve = numbers(Interpolation::cubic);
  curve.values.back() = curve.values.front();
  curve.cyclic = true;
  EXPECT_NEAR(curve.at(0.5 + 1e-9).rate, curve.at(4.0 - 1e-9).rate, 1e-6);
  EXPECT_GT(std::abs(curve.at(0.5 + 1e-9).rate), 0.1);
}

TEST(RotationCurve, PassesItsKeysAndHoldsBeyondThem) {
  for (const bool far : {false, true})
    for (const auto kind : {Interpolation::step, Interpolation::linear, Interpolation::smooth,
                            Interpolation::cubic}) {
      const RotationCurve curve = rotations(kind, far);
      for (std::size_t k = 0; k < uneven.size(); ++k) {
        const Quat found = curve.at(uneven[k]).value;
        EXPECT_LT(found.angularDistance(curve.values[k]), 1e-7);
        if (k == 0 || kind == Interpolation::step) continue;
        EXPECT_LT(curve.at(uneven[k] - 1e-9).value.angularDistance(curve.values[k]), 1e-6);
      }
      EXPECT_EQ(curve.at(9).angular_velocity, Vec3::Zero());
    }
}

TEST(RotationCurve, AngularVelocityIsItsDerivative) {
  for (const bool far : {false, true})
    for (const auto kind :
         {Interpolation::step, Interpolation::linear, Interpolation::smooth, Interpolation::cubic})
      expect_derivative(rotations(kind, far));
  expect_derivative(rotations_with_tangents());
}

TEST(RotationCurve, CubicHasNoJumpOfAngularVelocityAtKeys) {
  for (const RotationCurve& curve :
       {rotations(Interpolation::cubic, false), rotations(Interpolation::cubic, true),
        rotations_with_tangents()})
    for (std::size_t k = 1; k + 1 < uneven.size(); ++k)
      EXPECT_LT((curve.at(uneven[k] - 1e-9).angular_velocity -
                 curve.at(uneven[k] + 1e-9).angular_velocity)
                    .norm(),
                1e-5);
}

TEST(RotationCurve, AboutOneAxisIsTheCurveOfItsAngle) {
  const Vec3 axis = Vec3(1, 2, -2) / 3;
  Curve<double> angle = numbers(Interpolation::cubic);
  angle.values = {0, radians(270), radians(1000), radians(-80), radians(-440)};
  RotationCurve curve;
  curve.times = uneven;
  for (std::size_t k = 0; k < uneven.size(); ++k) {
    curve.turns.push_back(axis * (k > 0 ? angle.values[k] - angle.values[k - 1] : 0));
    curve.values.push_back(rotation_by(angle.values[k] * axis));
  }
  for (const auto kind : {Interpolation::linear, Interpolation::smooth, Interpolation::cubic}) {
    curve.interpolation = angle.interpolation = kind;
    for (const double time : between_keys()) {
      const auto wanted = angle.at(time);
      const auto found = curve.at(time);
      EXPECT_LT(found.value.angularDistance(rotation_by(wanted.value * axis)), 1e-7) << time;
      EXPECT_LT((found.angular_velocity - wanted.rate * axis).norm(), 1e-11) << time;
    }
  }
}

TEST(RotationCurve, LinearIsSlerp) {
  const RotationCurve curve = rotations(Interpolation::linear, false);
  const Quat half = curve.values[1].slerp(0.5, curve.values[2]);
  EXPECT_LT(curve.at(1.75).value.angularDistance(half), 1e-7);
}

TEST(RotationCurve, TangentsAreThoseOfGltf) {
  const RotationCurve curve = rotations_with_tangents();
  const double s = 0.3, h = 1.5, s2 = s * s, s3 = s2 * s;  // from key 1 to key 2
  const Eigen::Vector4d mixed = (2 * s3 - 3 * s2 + 1) * curve.values[1].coeffs() +
                                h * (s3 - 2 * s2 + s) * curve.out[1].coeffs() +
                                (3 * s2 - 2 * s3) * curve.values[2].coeffs() +
                                h * (s3 - s2) * curve.in[2].coeffs();
  EXPECT_LT((curve.at(1 + s * h).value.coeffs() - mixed.normalized()).norm(), 1e-14);
}

}  // namespace sinew::curve_test
