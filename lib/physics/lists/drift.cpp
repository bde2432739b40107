// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/lists/drift.h"

namespace sinew {

double excess_of_step(const BonePose& before, const BonePose& now, double step, double reach) {
  const Mat3 turn = now.frame.rotation * before.frame.rotation.transpose() - Mat3(Mat3::Identity());
  Mat3 spin;  // w -> the matrix of w x
  const Vec3 w = before.angular_velocity;
  spin << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  const Vec3 shift = now.frame.origin - before.frame.origin - step * before.velocity;
  return shift.norm() + (turn - step * spin).norm() * reach;
}

}  // namespace sinew
