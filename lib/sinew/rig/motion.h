// SPDX-License-Identifier: GPL-3.0-or-later
// Keys over time for the bones of a skeleton, and the pose they give at any moment.
//
// A bone's rotation turns it, and all that hangs on it, about its head; it is given in the
// directions of its parent (of the scene for a root), which at rest are the scene's. Twist turns
// the bone about its own axis before that rotation and is kept apart, so that it may pass 180
// degrees. Translation shifts the head in the parent's directions. Stretch is a factor of the
// bone's length; it moves the heads of its children as far as they lie along it.
//
// A run begins at rest. Over the preroll the bones go smoothly (smoothstep) to the pose with which
// the clip begins; then the clip runs from its start to its end and goes on as its extrapolation
// says.
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

/// What a motion says of one bone at one moment, relative to the parent, with its rate of change.
struct LocalMotion {
  Quat rotation = Quat::Identity();
  Vec3 angular_velocity = Vec3::Zero();  ///< of rotation, in the parent's directions, rad/s
  double twist = 0, twist_rate = 0;      ///< rad, rad/s
  Vec3 translation = Vec3::Zero();       ///< m, in the parent's directions
  Vec3 velocity = Vec3::Zero();          ///< of translation, m/s
  double stretch = 1, stretch_rate = 0;  ///< of the bone's length, 1/s
};

struct TrackCursor;

/// What moves of one bone; a curve without keys leaves its part at rest.
struct Track {
  int bone = no_bone;
  RotationCurve rotation;
  Curve<double> twist;      ///< rad
  Curve<Vec3> translation;  ///< m
  Curve<double> stretch;    ///< > 0

  LocalMotion at(double time) const;  ///< time of the clip, s
  LocalMotion at(double time, TrackCursor& cursor) const;
};

/// Where in its curves a track was last: near moments find the same pieces.
struct TrackCursor {
  explicit TrackCursor(const Track& track);

  bool turns, twists, shifts, stretches;  ///< which curves there are
  RotationPiece rotation;
  CurvePiece<double> twist, stretch;
  CurvePiece<Vec3> translation;
};

struct Motion {
  std::vector<Track> tracks;  ///< at most one per bone
  Extrapolation extrapolation = Extrapolation::hold;
  double start = 0;                ///< s of the clip: what of it is used
  std::optional<double> end = {};  ///< s of the clip; none: its last key
  double preroll = 0;              ///< s before the clip begins
};

/// Time of the last key, s of the clip; 0 without keys.
double last_key(const Track& track);
double last_key(const Motion& motion);

/// What of the clip is used, s.
double clip_length(const Motion& motion);

/// Whether any bone changes its length.
bool stretches(const Motion& motion);

/// A clip's motion, ready for poses: with start, end, extrapolation and preroll as asked. Throws
/// bad_value, with the key "start", for a clip that would end before it starts.
Motion played(Motion clip, const MotionOptions& options);

/// The motion in a scene's directions and lengths, as the skeleton by its `placed`.
Motion placed(Motion motion, double scale, const Mat3& turn);

/// Builds the motion of these tracks; keys in frames count at `frame_rate` (1/s). played() prepares
/// it. Throws bad_value, with a key such as "tracks[0].keys[2].time", for an unknown bone, two
/// tracks of one bone, keys out of order, with no or two times, in frames of no known rate, or with
/// a rotation given in two ways, by half, or by a quaternion that is no rotation.
Motion make_motion(std::span<const TrackDefinition> tracks, const Skeleton& skeleton,
                   std::optional<double> frame_rate = {});

/// What a time of the scene is for a clip.
struct ClipMoment {
  double time = 0;               ///< of the clip, s
  double speed = 1;              ///< s of the clip per s; 0 where it holds, -1 on the way back
  bool ramps = false;            ///< within the preroll:
  double reached = 1, rate = 0;  ///< how much of the pose is reached, and its growth, 1/s
};

ClipMoment clip_moment(const Motion& motion, double time);

/// What a track asks of its bone then, whatever its limits.
LocalMotion local_motion(const Track& track, const ClipMoment& moment, TrackCursor& cursor);

/// What each bone does at `time` (s of the scene), held within its limits.
std::vector<LocalMotion> local_motions(const Skeleton& skeleton, const Motion& motion, double time);

/// The pose at `time` (s of the scene), with the velocities of the moving bones. For many times:
/// pose_cursor.h.
Pose pose_at(const Skeleton& skeleton, const Motion& motion, double time);

// What a file of a rig holds: a skeleton and the motions it knows by name.

struct Clip {
  std::string name;
  Motion motion;
  double duration = 0;    ///< s
  int frames = 0;         ///< 0 where keys lie in no frames
  double frame_time = 0;  ///< s between frames; 0 where keys lie in no frames
};

struct Rig {
  Skeleton skeleton;
  std::vector<Clip> clips;
};

/// Throws bad input (without the path) for a name that is not there, with the nearest one that is.
const Clip& find_clip(const std::vector<Clip>& clips, std::string_view name);

// Poses of one motion at many times, as a run asks for them: step by step. What stays the same from
// one to the next is found once: the piece of each curve between two keys, and how bones hang on
// each other. Any order of times gives the same bits.

class PoseCursor {
 public:
  /// Both must stay, as they are.
  PoseCursor(const Skeleton& skeleton, const Motion& motion);

  /// The pose at `time`, s of the scene; there until the next call.
  const Pose& at(double time);

 private:
  /// A bone on its parent; the scene holds roots.
  struct Link {
    int parent = no_bone, track = -1;  ///< -1: nothing moves it
    bool limited = false;
    Vec3 offset = Vec3::Zero();    ///< of its head from the parent's, at rest
    Vec3 along = Vec3::Zero();     ///< the part of it along the parent, which stretches
    Vec3 axis = Vec3::Zero();      ///< its own, at rest
    Mat3 rest = Mat3::Identity();  ///< its axes at rest
  };

  static void carry(const Link& link, const BonePose& parent, BonePose& pose);
  static void move(const Link& link, const LocalMotion& local, const BonePose& parent,
                   BonePose& pose);

  const Skeleton* skeleton_;
  const Motion* motion_;
  std::vector<Link> links_;           ///< of each bone
  std::vector<TrackCursor> cursors_;  ///< of each track
  Pose pose_;
};

}  // namespace sinew
