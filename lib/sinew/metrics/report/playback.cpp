// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/report/playback.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <sinew/core/local_origin.h>

namespace sinew {
namespace {

// In base64 these are below 8 MB: with the libraries and the charts, a page of 10.
constexpr std::size_t particle_bytes = 3'800'000, surface_bytes = 1'200'000;
constexpr std::size_t extra_frames = 8;          // in addition to the planned ones
constexpr std::size_t max_frames = 120;          // four seconds at 30 per second
constexpr std::size_t fewest_particles = 6'000;  // particles that still resemble a body

/// A hash for each particle, for selecting among them (splitmix64).
std::uint64_t mixed(std::uint64_t i) {
  i += 0x9e3779b97f4a7c15;
  i = (i ^ (i >> 30)) * 0xbf58476d1ce4e5b9;
  i = (i ^ (i >> 27)) * 0x94d049bb133111eb;
  return i ^ (i >> 31);
}

/// A choice of as many as wanted, by chance, in their order.
std::vector<std::uint32_t> picked(std::vector<std::uint32_t> all, std::size_t wanted) {
  if (wanted >= all.size()) return all;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(wanted), all.end(),
                   [](std::uint32_t a, std::uint32_t b) { return mixed(a) < mixed(b); });
  all.resize(wanted);
  std::sort(all.begin(), all.end());
  return all;
}

constexpr double layer_thickness = 2.5;  // radii: the second layer fills gaps of the first

/// Whether each particle lies in the layer that is seen where the page cuts the body open: behind
/// the middle of its box, across its shorter horizontal axis (beforeCut in view.js).
std::vector<bool> layer_of_cut(const RestBody& rest) {
  const Box box = bounds(rest.shape.points);
  const int axis = box.sizes().y() <= 1.01 * box.sizes().x() ? 1 : 0;  // places are rounded there
  const double back = axis == 1 ? 1 : -1, middle = box.center()[axis];
  std::vector<bool> is_in;
  for (const Vec3& point : rest.shape.points) {
    const double behind = back * (point[axis] - middle);
    is_in.push_back(behind >= 0 && behind <= layer_thickness * rest.radius());
  }
  return is_in;
}

std::vector<std::size_t> evenly(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> frames;
  if (wanted >= count) wanted = count;
  for (std::size_t k = 0; k < wanted; ++k)
    frames.push_back(wanted > 1 ? k * (count - 1) / (wanted - 1) : 0);
  return frames;
}

/// All of the run's frames where they fit, else as many as leave space for the worst ones.
std::size_t frames_paid(std::size_t run_frames, std::size_t bytes, std::size_t frame_bytes) {
  const std::size_t paid = std::min(max_frames, bytes / frame_bytes);
  if (paid >= run_frames) return run_frames;
  return paid > extra_frames ? paid - extra_frames : 1;
}

std::size_t max_snapshots(const Playback& playback) {
  return std::min(playback.run_frames, playback.wanted.size() + extra_frames);
}

/// All, or some of the layer of the cut and of the others, larger by as much as is left out, so
/// that the layer appears closed and the body filled.
void choose_particles(Playback& playback, const RestBody& rest, std::size_t wanted) {
  std::vector<std::uint32_t> all(playback.run_particles);
  std::iota(all.begin(), all.end(), 0u);
  const double layer = layer_thickness * rest.radius();
  if (wanted >= all.size()) {
    playback.balls = {{all.size(), rest.radius(), layer}};
    playback.particles = std::move(all);
    return;
  }
  const std::vector<bool> is_in_layer = layer_of_cut(rest);
  const auto others = std::stable_partition(all.begin(), all.end(),
                                            [&](std::uint32_t i) { return is_in_layer[i]; });
  const std::size_t beside = static_cast<std::size_t>(all.end() - others);
  playback.particles = picked({all.begin(), others}, wanted / 2);
  const std::size_t shown = playback.particles.size();
  const std::vector<std::uint32_t> some = picked({others, all.end()}, wanted - shown);
  playback.particles.insert(playback.particles.end(), some.begin(), some.end());
  const auto over = [](std::size_t all_of_them, std::size_t of_them) {
    return static_cast<double>(all_of_them) /
           static_cast<double>(std::max<std::size_t>(of_them, 1));
  };
  const auto in_layer = static_cast<std::size_t>(others - all.begin());
  playback.balls = {{shown, std::sqrt(over(in_layer, shown)) * rest.radius(), layer},
                    {some.size(), std::cbrt(over(beside, some.size())) * rest.radius(), layer}};
}

void plan_particles(Playback& playback, const RestBody& rest, std::size_t bytes) {
  const std::size_t each = 6 + playback_fields().size();
  const std::size_t fewest = std::min(playback.run_particles, fewest_particles);
  playback.wanted =
      evenly(playback.run_frames, frames_paid(playback.run_frames, bytes, each * fewest));
  choose_particles(playback, rest,
                   bytes / (each * std::max<std::size_t>(max_snapshots(playback), 1)));
  for (const auto i : playback.particles) playback.bone.push_back(rest.bone_of[i]);
}

std::vector<float> coordinates(const Points& points, const std::vector<std::uint32_t>& chosen,
                               const Vec3& origin) {
  std::vector<float> out;
  for (const auto i : chosen) append_place(out, points[i], origin);
  return out;
}

std::vector<float> chosen_values(const std::vector<double>& values,
                                 const std::vector<std::uint32_t>& chosen) {
  std::vector<float> out;
  if (values.empty()) return out;
  for (const auto i : chosen) out.push_back(static_cast<float>(values[i]));
  return out;
}

auto place_of(const Playback& playback, std::size_t frame) {
  return std::lower_bound(
      playback.frames.begin(), playback.frames.end(), frame,
      [](const PlaybackFrame& one, std::size_t number) { return one.frame < number; });
}

using GridCell = std::array<std::int64_t, 3>;

/// For each point the first one in its cell, for cells of that edge length.
std::vector<std::uint32_t> first_in_cell(const Points& points, const Vec3& low, double edge) {
  std::map<GridCell, std::uint32_t> first;
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Vec3 at = (points[i] - low) / edge;
    const GridCell cell{std::llround(at.x()), std::llround(at.y()), std::llround(at.z())};
    out.push_back(first.try_emplace(cell, i).first->second);
  }
  return out;
}

std::size_t kept(const std::vector<std::uint32_t>& stand_in) {
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < stand_in.size(); ++i) count += stand_in[i] == i;
  return count;
}

std::vector<std::uint32_t> stand_ins(const Triangles& surface, std::size_t most) {
  std::vector<std::uint32_t> all(surface.points.size());
  std::iota(all.begin(), all.end(), 0u);
  const Box box = bounds(surface.points);
  // The initial cell size puts `most` cells on the skin; it grows while too many points are kept.
  double edge = std::sqrt(area(surface) / static_cast<double>(std::max<std::size_t>(most, 1)));
  for (int attempt = 0; attempt < 60 && kept(all) > most && edge > 0; ++attempt, edge *= 1.2)
    all = first_in_cell(surface.points, box.min(), edge);
  return all;
}

}  // namespace

std::span<const PlaybackField> playback_fields() {
  using V = ParticleValues;
  static constexpr std::array fields = {
      PlaybackField{"displacement", "displacement", "m", "Distance from the position at rest",
                    &V::displacement},
      PlaybackField{"speed", "speed", "m/s", "Size of the velocity", &V::speed},
      PlaybackField{"J", "J", "", "Local volume ratio; below zero inside out", &V::J},
      PlaybackField{"strain", "strain_eq", "", "Equivalent Hencky strain: change of shape",
                    &V::strain},
      PlaybackField{"von Mises stress", "von_mises", "Pa", "Of Cauchy's stress", &V::von_mises},
      PlaybackField{"D2min", "D2min", "m²", "Nonaffine motion: flow", &V::D2min},
      PlaybackField{"neighbors", "neighbors", "", "Particles within the interaction range",
                    &V::neighbors},
      PlaybackField{"turnover", "turnover", "", "Neighbors lost and gained, over those at rest",
                    &V::turnover},
      PlaybackField{"distance to rigid pose", "pose_error", "m",
                    "Distance from the rigid pose of its bone", &V::pose_error},
      PlaybackField{"weight of its bone", "weight", "",
                    "Weight of the bone it follows; 1: that one alone", &V::weight},
  };
  return fields;
}

void append_place(std::vector<float>& places, const Vec3& point, const Vec3& origin) {
  for (int k = 0; k < 3; ++k) places.push_back(static_cast<float>(point[k] - origin[k]));
}

Box box_of(const Playback& playback) {
  Box box;
  for (const PlaybackFrame& frame : playback.frames)
    for (const auto* places :
         {&frame.particles, &frame.surface, &frame.bones, &frame.forces, &frame.obstacles})
      for (std::size_t i = 0; i + 2 < places->size(); i += 3)
        box.extend(Vec3((*places)[i], (*places)[i + 1], (*places)[i + 2]));
  return box.isEmpty() ? box : box.translated(playback.origin);
}

bool Playback::wants(std::size_t frame) const {
  return std::binary_search(wanted.begin(), wanted.end(), frame);
}

bool Playback::has(std::size_t frame) const {
  const auto place = place_of(*this, frame);
  return place != frames.end() && place->frame == frame;
}

ThinSurface thin_surface(const Triangles& surface, std::size_t most) {
  ThinSurface out;
  const std::vector<std::uint32_t> stand_in = stand_ins(surface, most);
  std::vector<int> place(stand_in.size(), -1);
  for (std::uint32_t i = 0; i < stand_in.size(); ++i)
    if (stand_in[i] == i) {
      place[i] = static_cast<int>(out.points.size());
      out.points.push_back(i);
    }
  for (const auto& face : surface.faces) {
    std::array<int, 3> corners;
    for (int c = 0; c < 3; ++c) corners[c] = place[stand_in[face[c]]];
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      out.faces.push_back(corners);
  }
  return out;
}

Playback plan_playback(const RestBody& rest, std::size_t frames, double fraction) {
  Playback playback;
  playback.run_frames = frames;
  playback.run_particles = rest.particles();
  playback.run_points = rest.surface.points.size();
  playback.origin = local_origin(bounds(rest.surface.points));
  const auto bytes_of = [&](std::size_t all) {
    return static_cast<std::size_t>(fraction * static_cast<double>(all));
  };
  plan_particles(playback, rest, bytes_of(particle_bytes));
  ThinSurface skin =
      thin_surface(rest.surface, bytes_of(surface_bytes) / (6 * max_snapshots(playback)));
  playback.points = std::move(skin.points);
  playback.faces = std::move(skin.faces);
  for (const Bone& bone : rest.bones) {
    playback.bone_color.push_back(static_cast<int>(playback.bone_color.size()));
    playback.bone_names.push_back(bone.name);
  }
  return playback;
}

void add_frame(Playback& playback, std::size_t frame, const RestBody& rest, const FrameState& state,
               const ParticleValues& particles) {
  const Vec3& origin = playback.origin;
  PlaybackFrame snapshot{frame,
                         state.time,
                         coordinates(state.positions, playback.particles, origin),
                         coordinates(state.surface_points, playback.points, origin),
                         {},
                         {}};
  for (std::size_t b = 0; b < rest.bones.size(); ++b) {
    const RigidFrame& bone = state.bones[b];
    append_place(snapshot.bones, bone.origin, origin);
    const double length = state.bone_lengths.empty() ? rest.bones[b].length : state.bone_lengths[b];
    append_place(snapshot.bones, bone.origin + length * bone.rotation.col(0), origin);
  }
  for (const PlaybackField& field : playback_fields())
    snapshot.values.push_back(chosen_values(particles.*field.values, playback.particles));
  playback.frames.insert(place_of(playback, frame), std::move(snapshot));
}

}  // namespace sinew
