// SPDX-License-Identifier: GPL-3.0-or-later
// The run as the report's 3D view shows it: particles, skin and bones over time, thinned to fit a
// page of a few megabytes.
//
//     Playback playback = plan_playback(rest, frames);
//     if (playback.wants(i)) add_frame(playback, i, rest, state, particle_values(rest, state));
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/core/value_range.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/metrics/rest_body.h>

namespace sinew {

/// A value that particles can be colored by.
struct PlaybackField {
  std::string_view name, quantity, unit, help;  ///< quantity: its name in files and ranges
  std::vector<double> ParticleValues::*values;
};

/// The fields of a playback, in the order of PlaybackFrame::values.
std::span<const PlaybackField> playback_fields();

struct PlaybackFrame {
  std::size_t frame = 0;                   ///< frame of the run
  double time = 0;                         ///< s
  std::vector<float> particles, surface;   ///< x y z each, m, from the playback's origin, as below
  std::vector<float> bones;                ///< head and tail, x y z each, m
  std::vector<std::vector<float>> values;  ///< one per particle and field; empty: not measured
  std::vector<float> forces = {};          ///< arrows of supports and loads: both ends, m
  std::vector<float> obstacles = {};       ///< three corners of each triangle, x y z each, m
};

/// Consecutive particles drawn with one radius (m): larger than their own where one is shown for
/// several, so that the body appears filled.
struct Balls {
  std::size_t count = 0;
  double radius = 0;
  double layer = 0;  ///< thickness of the layer that a cut of their body shows, m
};

struct Playback {
  Vec3 origin = Vec3::Zero();  ///< origin of the places in its frames, m: near the body
  std::size_t run_frames = 0, run_particles = 0, run_points = 0;  ///< before thinning
  std::vector<std::size_t> wanted;                                ///< frames of the run, ascending
  std::vector<std::uint32_t> particles;  ///< particles of the run, ascending in each of the balls
  std::vector<Balls> balls;              ///< the particles, in their order
  std::vector<int> bone;                 ///< bone that each of them follows, -1 for none
  std::vector<int> material = {};        ///< number of each one's name; empty: unknown
  std::vector<std::string> material_names = {};
  std::vector<int> mark = {};  ///< number of each one's name; empty: nothing is marked
  std::vector<std::string> mark_names = {};
  Vec3 front = Vec3::Zero();  ///< where a figure looks, horizontal, of length 1; zero: not known
  std::vector<std::uint32_t> held = {};   ///< indices of those that are held, into `particles`
  std::vector<std::uint32_t> points;      ///< points of the run's surface, ascending
  std::vector<std::array<int, 3>> faces;  ///< indices into points
  std::vector<std::string> bone_names;
  std::vector<int> bone_color;     ///< number of the color of each: of two runs, that of its name
  std::vector<bool> is_load = {};  ///< one per force in the frames; false: of a support
  std::vector<PlaybackFrame> frames;
  ValueRanges ranges;  ///< ranges of the run's quantities; of others those of its frames

  bool wants(std::size_t frame) const;
  bool has(std::size_t frame) const;
};

/// Around all positions of all frames, m, in the scene's coordinates; empty where there are none.
Box box_of(const Playback& playback);

/// A coarser skin on a subset of a surface's points, by vertex clustering (Rossignac and Borrel):
/// one point is kept in each cell of a grid.
struct ThinSurface {
  std::vector<std::uint32_t> points;      ///< points of the surface, ascending
  std::vector<std::array<int, 3>> faces;  ///< indices into points
};

/// At most `most` points, all of a surface that has no more; collapsed faces are dropped.
ThinSurface thin_surface(const Triangles& surface, std::size_t most);

/// A playback without frames that selects what will be kept: all of a small run; of a large one,
/// frames at even intervals including the first and the last, the particles that a cut shows and
/// others selected by a hash of their index, and a coarser skin. `fraction`: fraction of a page's
/// bytes that it may take.
Playback plan_playback(const RestBody& rest, std::size_t frames, double fraction = 1);

/// Inserts a frame in order of time.
void add_frame(Playback& playback, std::size_t frame, const RestBody& rest, const FrameState& state,
               const ParticleValues& particles);

/// Appends a point of the scene as one of the playback's frames.
void append_place(std::vector<float>& places, const Vec3& point, const Vec3& origin);

/// The triangles as far as they lie in `space` (m), three corners each.
Points cut_to(const Box& space, const Triangles& surface);

/// Adds the obstacles at one of its frames, cut to `space`, to a playback.
void add_obstacles(Playback& playback, std::size_t frame, const Box& space,
                   const Triangles& obstacles);

/// For the page's script: positions as 16-bit fractions of the playback's box, values as 8-bit
/// fractions of their range (half a percent of the values at either end lies outside: it is between
/// the `percentiles`), all in base64, and the colors of pictures.
std::string playback_json(const Playback& playback);

}  // namespace sinew
