// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/bone_metrics.h>

#include <array>

#include <sinew/core/decompositions.h>
#include <sinew/core/particles.h>
#include <sinew/metrics/files.h>

namespace sinew {
namespace {

using B = BoneMetrics;

constexpr std::array bone_table = {
    BoneMetric{"time", "s", "Simulated time", "t", &B::time},
    BoneMetric{"bone", "", "Index of the bone, as in frames.pvd", "", &B::bone},
    BoneMetric{"followers", "", "Particles that follow this bone more than any other", "count",
               &B::followers},
    BoneMetric{"adherence_rms", "m", "Change of their distance to the bone, rms",
               "sqrt(mean (|x - p| - l0)^2)", &B::adherence_rms},
    BoneMetric{"adherence_95", "m", "The same, not exceeded by 95 % of them",
               "95 % of ||x - p| - l0|", &B::adherence_95},
    BoneMetric{"adherence_max", "m", "The same, maximum", "max ||x - p| - l0|", &B::adherence_max},
    BoneMetric{"adherence_joint_rms", "m", "The same, rms, within half a width of a joint",
               "where |c - joint| <= sqrt(A_B) / 2", &B::adherence_joint_rms},
    BoneMetric{"adherence_far_rms", "m", "The same, rms, of the others",
               "where |c - joint| > sqrt(A_B) / 2", &B::adherence_far_rms},
    BoneMetric{"radial_mean", "m", "Mean outward displacement from the bone; negative: inward",
               "mean (|x - p| - l0)", &B::radial_mean},
    BoneMetric{"twist_rms", "deg", "Twist about the bone relative to the bone's own, rms",
               "angle about the axis from q - p to x - p", &B::twist_rms},
    BoneMetric{"twist_mean", "deg", "The same, mean, signed", "mean alpha", &B::twist_mean},
    BoneMetric{"pose_error_rms", "m", "Distance from the rigid pose, rms", "sqrt(mean |x - q|^2)",
               &B::pose_error_rms},
    BoneMetric{"pose_error_max", "m", "Distance from the rigid pose, maximum", "max |x - q|",
               &B::pose_error_max},
    BoneMetric{"turn_error", "deg",
               "Angle between the rotations of the bone and of its particles away from joints, "
               "from rest; of a dozen particles at least",
               "angle of Q^T R R0^T, Q the best-fit rotation (Kabsch)", &B::turn_error},
    BoneMetric{"volume", "m^3", "Volume of the strained particles that follow it",
               "sum V0 J, V0 = 4 sqrt(2) r^3, where J is defined", &B::volume},
    BoneMetric{"volume_ratio", "", "The same, relative to rest", "mean J", &B::volume_ratio},
    BoneMetric{"volume_joint_ratio", "", "The same, within half a width of a joint",
               "mean J where |c - joint| <= sqrt(A_B) / 2", &B::volume_joint_ratio},
    BoneMetric{"volume_far_ratio", "", "The same, of the others",
               "mean J where |c - joint| > sqrt(A_B) / 2", &B::volume_far_ratio},
};

/// Errors in the position of one particle.
struct Miss {
  double radial = 0, pose = 0;  ///< m
  double twist = not_measured;  ///< rad; not for a particle on the axis
};

constexpr double near_axis = 1e-9;  // fraction of l0: particles nearer the axis have no angle

Miss miss_of(const RestBody& rest, const FrameState& state, const Bound& bound) {
  const RigidFrame& before = rest.bones[bound.bone].rest;
  const RigidFrame& now = state.bones[bound.bone];
  const Vec3 foot = carried(bound.foot, before, now), axis = now.rotation.col(0);
  const Vec3 target = carried(rest.shape.points[bound.particle], before, now);
  const Vec3& x = state.positions[bound.particle];
  const auto across = [&](const Vec3& p) -> Vec3 { return p - foot - axis.dot(p - foot) * axis; };
  const Vec3 wanted = across(target), found = across(x);
  Miss miss{(x - foot).norm() - bound.distance, (x - target).norm(), not_measured};
  if (wanted.norm() > near_axis * rest.radius() && found.norm() > near_axis * rest.radius())
    miss.twist = std::atan2(axis.dot(wanted.cross(found)), wanted.dot(found));
  return miss;
}

/// Moments of where the particles of a limb are (x) and were at rest (X), about its first particle:
/// about a point far away they would lose all digits.
struct LimbMoments {
  double count = 0;
  Vec3 first_x, first_X;
  Vec3 x = Vec3::Zero(), X = Vec3::Zero();
  Mat3 xX = Mat3::Zero(), XX = Mat3::Zero();

  void add(const Vec3& now, const Vec3& rest) {
    if (count++ == 0) first_x = now, first_X = rest;
    const Vec3 at = now - first_x, at_rest = rest - first_X;
    x += at, X += at_rest;
    xX += at * at_rest.transpose(), XX += at_rest * at_rest.transpose();
  }
};

struct Misses {
  LimbMoments limb;
  Statistics slip, joint, far, radial, twist, pose;
  Statistics volume_joint, volume_far;  ///< volume ratios J
  std::vector<double> slips;
};

void add(Misses& all, const Miss& miss, bool far) {
  const double slip = std::abs(miss.radial);
  all.slip.add(slip);
  (far ? all.far : all.joint).add(slip);
  all.radial.add(miss.radial);
  all.pose.add(miss.pose);
  if (!std::isnan(miss.twist)) all.twist.add(miss.twist);
  all.slips.push_back(slip);
}

void add_volumes(BoneMetrics& out, const Misses& all, double radius) {
  Statistics both = all.volume_joint;
  both.add(all.volume_far);
  if (both.count > 0) out.volume = volume_per_particle(radius) * both.sum;
  out.volume_ratio = both.mean();
  out.volume_joint_ratio = all.volume_joint.mean();
  out.volume_far_ratio = all.volume_far.mean();
}

/// Degrees. Particles along a line have no rotation.
double turn_error(const LimbMoments& limb, const Mat3& bone_turn, double radius) {
  constexpr double fewest = 12;
  if (limb.count < fewest) return not_measured;
  const Mat3 spread =
      limb.XX / limb.count - limb.X * limb.X.transpose() / (limb.count * limb.count);
  const Mat3 moved = limb.xX / limb.count - limb.x * limb.X.transpose() / (limb.count * limb.count);
  if (!moved.allFinite() || eigenvalues(spread)[1] < radius * radius) return not_measured;
  const Mat3 off = rotation_part(moved).transpose() * bone_turn;
  return degrees(Eigen::AngleAxisd(off).angle());
}

BoneMetrics summed(Misses& all, double time, std::size_t bone) {
  BoneMetrics out{time, static_cast<double>(bone), static_cast<double>(all.slip.count)};
  out.adherence_rms = all.slip.rms();
  out.adherence_95 = percentile(all.slips, 95);
  out.adherence_max = all.slip.max();
  out.adherence_joint_rms = all.joint.rms();
  out.adherence_far_rms = all.far.rms();
  out.radial_mean = all.radial.mean();
  out.twist_rms = degrees(all.twist.rms());
  out.twist_mean = degrees(all.twist.mean());
  out.pose_error_rms = all.pose.rms();
  out.pose_error_max = all.pose.max();
  return out;
}

}  // namespace

std::span<const BoneMetric> bone_metrics_table() { return bone_table; }

std::vector<BoneMetrics> measure_bones(const RestBody& rest, const FrameState& state,
                                       const ParticleValues& particles) {
  std::vector<Miss> misses(rest.bound.size());
  parallel_for(misses.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) misses[k] = miss_of(rest, state, rest.bound[k]);
  });
  std::vector<Misses> bones(rest.bones.size());
  for (std::size_t k = 0; k < misses.size(); ++k) {  // in order, for the same bits
    const Bound& bound = rest.bound[k];
    Misses& bone = bones[bound.bone];
    add(bone, misses[k], bound.far);
    if (bound.far)
      bone.limb.add(state.positions[bound.particle], rest.shape.points[bound.particle]);
    const double J = particles.J[bound.particle];
    if (!std::isnan(J)) (bound.far ? bone.volume_far : bone.volume_joint).add(J);
  }
  std::vector<BoneMetrics> out;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    out.push_back(summed(bones[b], state.time, b));
    add_volumes(out.back(), bones[b], rest.radius());
    out.back().turn_error =
        turn_error(bones[b].limb, state.bones[b].rotation * rest.bones[b].rest.rotation.transpose(),
                   rest.radius());
  }
  return out;
}

std::string bone_metrics_csv(std::span<const BoneMetrics> rows) {
  return csv_text(bone_table, rows);
}

}  // namespace sinew
