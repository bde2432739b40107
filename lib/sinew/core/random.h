// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that are the same on every machine: SplitMix64 (Steele, Lea and Flood 2014).
//
//     Random random(seed);
//     const double x = random.between(-1, 1);
#pragma once

#include <cstdint>

#include <sinew/core/vector.h>

namespace sinew {

class Random {
 public:
  explicit Random(std::int64_t seed) { mix(seed); }

  /// Makes the numbers that follow depend on another one, too.
  void mix(std::int64_t number) {
    state_ ^= static_cast<std::uint64_t>(number);
    state_ = next();
  }

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  /// Evenly in [low, high).
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
  }

 private:
  std::uint64_t state_ = 0;
};

/// A point of a ball of radius 1, anywhere alike.
inline Vec3 in_ball(Random& random) {
  for (;;) {
    Vec3 point(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    if (point.squaredNorm() <= 1) return point;
  }
}

/// Any rotation alike.
inline Mat3 random_rotation(std::int64_t seed) {
  Random random(seed);
  for (;;) {
    Quat turn(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
              random.between(-1, 1));
    const double length = turn.norm();
    if (length > 0.1 && length <= 1) return turn.normalized().toRotationMatrix();
  }
}

}  // namespace sinew
