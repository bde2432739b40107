// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/rig/bvh/bvh.h>
#include <sinew/rig/skeleton.h>

namespace sinew {
namespace {

constexpr double max_keys = 20e6;      // about 1 GB
constexpr double largest_scale = 1e9;  // m: a slip rather than a unit; the Earth has 1.3e7 m
// In key intervals; a key may be this much after the last frame: files write 1/30 s as 0.033333,
// and a rate of 30 must not lose the last frame of a thousand.
constexpr double slack = 0.05;

/// "x", "+x" or "-x" as a vector of the file.
Vec3 direction(const std::string& name, const std::string& option) {
  const bool sign = !name.empty() && (name[0] == '-' || name[0] == '+');
  const std::string axis = name.substr(sign ? 1 : 0);
  if (axis != "x" && axis != "y" && axis != "z")
    throw bad_input(shown(name) + ", given as " + option + ", is no direction",
                    "use x, y, z, -x, -y or -z");
  return (name[0] == '-' ? -1 : 1) * Vec3::Unit(axis[0] - 'x');
}

/// Rotates the file's directions into the scene's: forward into x, up into z.
Mat3 axes_of(const BvhOptions& options) {
  const Vec3 up = direction(options.up, "up"), forward = direction(options.forward, "forward");
  if (up.dot(forward) != 0)
    throw bad_input("up " + options.up + " and forward " + options.forward + " lie in one line",
                    "name two different axes of the file");
  Mat3 axes;
  axes << forward.transpose(), up.cross(forward).transpose(), up.transpose();
  return axes;
}

void check_numbers(const BvhOptions& options) {
  if (!(options.scale > 0 && options.scale <= largest_scale))
    throw bad_input("a scale of " + number_text(options.scale),
                    "give the meters per unit of the file, above 0: 0.01 for centimeters");
  if (!(options.rate >= 0 && std::isfinite(options.rate)))
    throw bad_input("a rate of " + number_text(options.rate) + " keys per second",
                    "give one above 0, or 0 for the file's own");
}

struct Frames {
  int first, count;
};

Frames frames_of(const Bvh& bvh, const BvhOptions& options) {
  const int last = options.end == -1 ? bvh.frames - 1 : options.end;
  if (options.start < 0 || last >= bvh.frames || options.start > last)
    throw bad_input("no frames " + std::to_string(options.start) + " to " + std::to_string(last),
                    "the file's are 0 to " + std::to_string(bvh.frames - 1));
  return {options.start, last - options.start + 1};
}

/// The file's numbers in the scene's units: meters, its directions, quaternions.
class Reading {
 public:
  Reading(const Bvh& bvh, const BvhOptions& options)
      : bvh_(bvh), options_(options), axes_(axes_of(options)), width_(bvh.channels()) {}

  Vec3 vector(const Vec3& given) const { return options_.scale * (axes_ * given); }

  /// Returns the rotation of a joint whose channels begin at `column` of the frame.
  Quat rotation(const BvhJoint& joint, std::size_t column, int frame) const {
    const double* values = bvh_.values.data() + frame * width_ + column;
    Quat rotation = Quat::Identity();
    for (const BvhChannel channel : joint.channels) {
      const double half = radians(*values++) / 2;
      if (is_position(channel)) continue;
      Quat turn(std::cos(half), 0, 0, 0);
      turn.vec()[axis_of(channel)] = std::sin(half);
      rotation = rotation * turn;
    }
    rotation.vec() = axes_ * rotation.vec();
    return rotation;
  }

  /// The joint's displacement from its place at rest.
  Vec3 translation(const BvhJoint& joint, std::size_t column, int frame) const {
    const double* values = bvh_.values.data() + frame * width_ + column;
    const bool replace = options_.positions == BvhPositions::replace;
    Vec3 shift = Vec3::Zero();
    for (const BvhChannel channel : joint.channels) {
      const double value = *values++;
      if (!is_position(channel)) continue;
      const int axis = axis_of(channel);
      shift[axis] = replace ? value - joint.offset[axis] : value;
    }
    return vector(shift);
  }

  static bool is_position(BvhChannel channel) { return channel <= BvhChannel::z_position; }
  static int axis_of(BvhChannel channel) { return static_cast<int>(channel) % 3; }

 private:
  const Bvh& bvh_;
  const BvhOptions& options_;
  Mat3 axes_;
  std::size_t width_;
};

std::vector<Joint> joints_of(const Bvh& bvh, const Reading& reading) {
  std::vector<Joint> joints;
  for (const BvhJoint& given : bvh.joints) {
    Joint joint{given.name, given.parent, reading.vector(given.offset), {}};
    if (given.parent != no_bone) joint.place += joints[given.parent].place;
    if (given.end) joint.end = joint.place + reading.vector(*given.end);
    joints.push_back(std::move(joint));
  }
  return joints;
}

/// Consecutive quaternions on the same side of the sphere: q and -q are one rotation.
void choose_shortest_turns(std::vector<Quat>& rotations) {
  for (std::size_t i = 1; i < rotations.size(); ++i)
    if (rotations[i].dot(rotations[i - 1]) < 0) rotations[i].coeffs() *= -1;
}

std::vector<double> times_every(double step, int count) {
  std::vector<double> times(count);
  for (int i = 0; i < count; ++i) times[i] = i * step;
  return times;
}

template <class Curve>
void resample(Curve& curve, const std::vector<double>& times) {
  if (curve.times.empty()) return;
  Curve other;
  other.interpolation = curve.interpolation;
  other.times = times;
  for (const double time : times) other.values.push_back(curve.at(time).value);
  curve = std::move(other);
}

/// Builds the clip of a file that has frames.
class ClipMaker {
 public:
  ClipMaker(const Bvh& bvh, const BvhOptions& options, const Reading& reading)
      : bvh_(bvh), options_(options), reading_(reading), frames_(frames_of(bvh, options)) {
    duration_ = (frames_.count - 1) * bvh.frame_time;
    const double keys =
        options.rate > 0 ? std::floor(duration_ * options.rate + slack) + 1 : frames_.count;
    if (std::max<double>(keys, frames_.count) * static_cast<double>(moving()) > max_keys)
      throw bad_input("a clip of " + three_digits(keys) + " keys in each of " +
                          std::to_string(moving()) + " joints, more than 2e7 in all",
                      "read fewer frames, by start and end, or choose a lower rate");
    count_ = static_cast<int>(keys);
  }

  Clip clip() const {
    Clip clip;
    clip.name = options_.name;
    clip.frames = count_;
    clip.frame_time = options_.rate > 0 ? 1 / options_.rate : bvh_.frame_time;
    clip.duration = (count_ - 1) * clip.frame_time;
    std::size_t column = 0;
    for (std::size_t i = 0; i < bvh_.joints.size(); ++i) {
      if (!bvh_.joints[i].channels.empty())
        clip.motion.tracks.push_back(track(static_cast<int>(i), column));
      column += bvh_.joints[i].channels.size();
    }
    return clip;
  }

 private:
  std::size_t moving() const {
    return std::count_if(bvh_.joints.begin(), bvh_.joints.end(),
                         [](const BvhJoint& joint) { return !joint.channels.empty(); });
  }

  Track track(int joint, std::size_t column) const {
    Track track;
    track.bone = joint;
    track.rotation = rotations(bvh_.joints[joint], column);
    track.translation = translations(bvh_.joints[joint], column);
    if (options_.rate == 0) return track;
    const std::vector<double> times = times_every(1 / options_.rate, count_);
    resample(track.rotation, times);
    resample(track.translation, times);
    choose_shortest_turns(track.rotation.values);
    return track;
  }

  RotationCurve rotations(const BvhJoint& joint, std::size_t column) const {
    RotationCurve curve;
    curve.interpolation = Interpolation::linear;
    const auto& channels = joint.channels;
    if (std::all_of(channels.begin(), channels.end(), Reading::is_position)) return curve;
    curve.times = times_every(bvh_.frame_time, frames_.count);
    curve.values.reserve(frames_.count);
    for (int i = 0; i < frames_.count; ++i)
      curve.values.push_back(reading_.rotation(joint, column, frames_.first + i));
    choose_shortest_turns(curve.values);
    return curve;
  }

  /// No curve for a joint that stays at its offset, as in files with positions for every joint.
  Curve<Vec3> translations(const BvhJoint& joint, std::size_t column) const {
    Curve<Vec3> curve;
    curve.interpolation = Interpolation::linear;
    const auto& channels = joint.channels;
    if (std::none_of(channels.begin(), channels.end(), Reading::is_position)) return curve;
    for (int i = 0; i < frames_.count; ++i)
      curve.values.push_back(reading_.translation(joint, column, frames_.first + i));
    if (std::all_of(curve.values.begin(), curve.values.end(),
                    [](const Vec3& shift) { return shift.isZero(0); }))
      curve.values.clear();
    else
      curve.times = times_every(bvh_.frame_time, frames_.count);
    return curve;
  }

  const Bvh& bvh_;
  const BvhOptions& options_;
  const Reading& reading_;
  Frames frames_;
  double duration_ = 0;  // s
  int count_ = 0;        // number of keys
};

}  // namespace

Rig rig_of(const Bvh& bvh, const BvhOptions& options) {
  check_numbers(options);
  const Reading reading(bvh, options);
  Rig rig;
  rig.skeleton = skeleton_of(joints_of(bvh, reading), "give them OFFSETs, or an End Site");
  rig.warnings = bvh.warnings;
  if (bvh.frames > 0) rig.clips.push_back(ClipMaker(bvh, options, reading).clip());
  return rig;
}

}  // namespace sinew
