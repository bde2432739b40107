// SPDX-License-Identifier: GPL-3.0-or-later
// Keys over time for the bones of a skeleton, and the pose they give at any moment.
//
//     const Motion motion = played(make_motion(tracks, skeleton), options);
//     const Pose pose = pose_at(skeleton, motion, time);
//
// A bone's rotation rotates it and all its descendants about its head; it is given in the
// directions of its parent (of the scene for a root), which at rest are the scene's. Twist rotates
// the bone about its own axis before that rotation and is separate, so that it may exceed 180
// degrees. Translation shifts the head in the parent's directions. Stretch is a factor of the
// bone's length; it moves the heads of its children in proportion to their position along it.
//
// A run begins at rest. During the preroll the bones move smoothly (smoothstep) to the pose with
// which the clip begins; then the clip runs from its start to its end and continues according to
// its extrapolation.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/options.h>
#include <sinew/rig/curve.h>
#include <sinew/rig/pose.h>
#include <sinew/rig/skeleton.h>

namespace sinew {

/// The motion of one bone at one moment, relative to the parent, with its rate of change.
struct LocalMotion {
  Quat rotation = Quat::Identity();
  Vec3 angular_velocity = Vec3::Zero();  ///< rate of rotation, in the parent's directions, rad/s
  double twist = 0, twist_rate = 0;      ///< rad, rad/s
  Vec3 translation = Vec3::Zero();       ///< m, in the parent's directions
  Vec3 velocity = Vec3::Zero();          ///< rate of translation, m/s
  double stretch = 1, stretch_rate = 0;  ///< factor of the bone's length; its rate, 1/s
};

struct TrackCursor;

/// The motion of one bone; a curve without keys leaves its part at rest.
struct Track {
  int bone = no_bone;
  RotationCurve rotation;
  Curve<double> twist;      ///< rad
  Curve<Vec3> translation;  ///< m
  Curve<double> stretch;    ///< > 0

  /// Whether it changes the bone's length.
  bool stretches() const;
  LocalMotion at(double time) const;  ///< time of the clip, s
  LocalMotion at(double time, TrackCursor& cursor) const;
};

/// The curve pieces that a track used last: near moments use the same ones.
struct TrackCursor {
  explicit TrackCursor(const Track& track);

  bool turns, twists, shifts, stretches;  ///< which curves there are
  RotationPiece rotation;
  CurvePiece<double> twist, stretch;
  CurvePiece<Vec3> translation;
};

/// A scale in the file of a clip, which a rigid bone does not follow.
struct IgnoredScale {
  int bone = no_bone;
  double factor = 1;  ///< size over that when bound, where it is farthest from 1
};

struct Motion {
  std::vector<Track> tracks;  ///< at most one per bone
  std::vector<IgnoredScale> ignored_scales = {};
  Extrapolation extrapolation = Extrapolation::hold;
  double start = 0;                ///< s of the clip: the part of it that is used
  std::optional<double> end = {};  ///< s of the clip; none: its last key
  double speed = 1;                ///< s of the clip per s of the scene
  double preroll = 0;              ///< s of the scene before the clip begins
};

/// Time of the last key, s of the clip; 0 without keys.
double last_key(const Track& track);
double last_key(const Motion& motion);

/// Duration of the part of the clip that is used, s of the clip.
double clip_length(const Motion& motion);

/// Whether any bone changes its length.
bool stretches(const Motion& motion);

/// A clip's motion, ready for poses: with start, end, speed, extrapolation and preroll from the
/// options (none where that is left open). Throws bad_value, with the key "start", for a clip that
/// would end before it starts.
Motion played(Motion clip, const MotionOptions& options);

/// The motion in a scene's directions and lengths; see placed() in skeleton.h.
Motion placed(Motion motion, const Placement& placement);

/// Builds the motion of these tracks; keys in frames count at `frame_rate` (1/s). played() prepares
/// it. Throws bad_value, with a key such as "tracks[0].keys[2].time", for an unknown bone, two
/// tracks of one bone, keys out of order, with no time or two, in frames of unknown rate, or with a
/// rotation that is given twice, incompletely, or by a quaternion that is no rotation.
Motion make_motion(std::span<const TrackDefinition> tracks, const Skeleton& skeleton,
                   std::optional<double> frame_rate = {});

/// The key that gives this motion at a time (s), without its rates.
KeyDefinition key_of(const LocalMotion& motion, double time);

/// A track of arrays: a rotation of the bone at each time (s), from rest, in the directions of its
/// parent; between them by the shortest way. Throws bad input where there are not as many.
TrackDefinition track_of(std::string bone, std::span<const double> times,
                         std::span<const Quat> rotations);

/// The moment of a clip at a time of the scene.
struct ClipMoment {
  double time = 0;     ///< time of the clip, s
  double speed = 1;    ///< s of the clip per s; 0 where it holds, below 0 where it plays backwards
  bool ramps = false;  ///< in the preroll:
  double reached = 1, rate = 0;  ///< reached fraction of the pose, and its rate, 1/s
};

ClipMoment clip_moment(const Motion& motion, double time);

/// The motion that a track requests of its bone, whatever the limits.
LocalMotion local_motion(const Track& track, const ClipMoment& moment, TrackCursor& cursor);

/// The motion of each bone at `time` (s of the scene), restricted to its limits.
std::vector<LocalMotion> local_motions(const Skeleton& skeleton, const Motion& motion, double time);

/// The pose at `time` (s of the scene), with the velocities of the moving bones. PoseCursor is
/// faster for many times.
Pose pose_at(const Skeleton& skeleton, const Motion& motion, double time);

// The contents of a rig file: a skeleton and named motions.

struct Clip {
  std::string name;
  Motion motion;
  double duration = 0;    ///< s
  int frames = 0;         ///< 0 without frames
  double frame_time = 0;  ///< s between frames; 0 without frames
};

struct Rig {
  Skeleton skeleton;
  std::vector<Clip> clips;
  /// Warnings of the file, with its place: what it gets wrong.
  std::vector<std::string> warnings = {};
};

/// Throws bad input (without the path) for an unknown name, with the nearest known one.
const Clip& find_clip(const std::vector<Clip>& clips, std::string_view name);

// Poses of one motion at many times, as in a run. What is the same from one to the next is computed
// once: the piece of each curve between two keys, and each bone's position on its parent. Any order
// of times gives the same bits.

class PoseCursor {
 public:
  /// Both must outlive the cursor, unchanged.
  PoseCursor(const Skeleton& skeleton, const Motion& motion);

  /// The pose at `time`, s of the scene; valid until the next call.
  const Pose& at(double time);

 private:
  /// A bone's place on its parent, or in the scene for roots.
  struct Link {
    int parent = no_bone, track = -1;  ///< -1: not moved by a track
    bool limited = false;
    Vec3 offset = Vec3::Zero();    ///< vector to its head from the parent's, at rest
    Vec3 along = Vec3::Zero();     ///< the part of it along the parent, which stretches
    Vec3 axis = Vec3::Zero();      ///< its own, at rest
    Mat3 rest = Mat3::Identity();  ///< its axes at rest
  };

  static void carry(const Link& link, const BonePose& parent, BonePose& pose);
  static void move(const Link& link, const LocalMotion& local, const BonePose& parent,
                   BonePose& pose);

  const Skeleton* skeleton_;
  const Motion* motion_;
  std::vector<Link> links_;           ///< one per bone
  std::vector<TrackCursor> cursors_;  ///< one per track
  Pose pose_;
};

}  // namespace sinew
