// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/core/base64.h>
#include <sinew/core/json.h>
#include <sinew/metrics/report/playback.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

// Fraction of a field's values at either end that the range excludes.
constexpr double outside = 1e-3;

/// The numbers' bytes, lowest first.
template <class Number>
std::string base64_of(const std::vector<Number>& numbers) {
  return base64({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)});
}

/// The cube that contains all places of the playback, from its origin.
struct Cube {
  Vec3 low = Vec3::Zero();
  double edge = 1;
};

Cube cube_of(const Playback& playback) {
  const Box box = box_of(playback);
  if (box.isEmpty()) return {};
  const double edge = box.sizes().maxCoeff();
  return {box.min() - playback.origin, edge > 0 ? edge : 1};
}

void quantize(std::vector<std::uint16_t>& out, const std::vector<float>& places, const Cube& cube) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double fraction = (places[i] - cube.low[static_cast<int>(i % 3)]) / cube.edge;
    out.push_back(static_cast<std::uint16_t>(std::lround(65535 * std::clamp(fraction, 0.0, 1.0))));
  }
}

/// Lists obstacles of each frame; null where they are as in the frame before.
Json obstacles_of(const Playback& playback, const Cube& cube) {
  Json frames = Json::array();
  const std::vector<float>* before = nullptr;
  for (const PlaybackFrame& frame : playback.frames) {
    std::vector<std::uint16_t> all;
    quantize(all, frame.obstacles, cube);
    frames.push_back(before && *before == frame.obstacles ? Json() : Json(base64_of(all)));
    before = &frame.obstacles;
  }
  return frames;
}

std::string places_of(const Playback& playback, const Cube& cube,
                      const std::vector<float> PlaybackFrame::*places) {
  std::vector<std::uint16_t> all;
  for (const PlaybackFrame& frame : playback.frames) quantize(all, frame.*places, cube);
  return base64_of(all);
}

struct Range {
  float low, high;
};

/// The range of all but the outermost values of some particles; nothing where there are none.
std::vector<Range> range_of(const Playback& playback, std::size_t field, std::size_t first,
                            std::size_t count) {
  std::vector<float> all;
  for (const PlaybackFrame& frame : playback.frames)
    for (std::size_t i = first; i < std::min(first + count, frame.values[field].size()); ++i)
      if (const float value = frame.values[field][i]; std::isfinite(value)) all.push_back(value);
  if (all.empty()) return {};
  const auto at = [&](double fraction) {
    const auto place =
        all.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), place, all.end());
    return *place;
  };
  return {{at(outside), at(1 - outside)}};
}

/// The range of both, where there are two runs: neither is outermost, however few its particles.
std::vector<Range> range_of(const Playback& playback, std::size_t field) {
  std::vector<Range> range;
  std::size_t first = 0;
  for (const Balls& balls : playback.balls) {
    for (const Range own : range_of(playback, field, first, balls.count)) {
      if (range.empty()) range.push_back(own);
      range[0].low = std::min(own.low, range[0].low);
      range[0].high = std::max(own.high, range[0].high);
    }
    first += balls.count;
  }
  return range;
}

/// The values as 0 to 254 of their range; 255 stands for none.
std::string levels_of(const Playback& playback, std::size_t field, Range range) {
  std::vector<std::uint8_t> all;
  const double width = range.high > range.low ? double(range.high) - range.low : 1;
  for (const PlaybackFrame& frame : playback.frames)
    for (const float value : frame.values[field]) {
      const double fraction = std::clamp((double(value) - range.low) / width, 0.0, 1.0);
      all.push_back(std::isnan(value) ? 255
                                      : static_cast<std::uint8_t>(std::lround(254 * fraction)));
    }
  return base64_of(all);
}

Json fields_of(const Playback& playback) {
  Json fields = Json::array();
  for (std::size_t f = 0; f < playback_fields().size(); ++f) {
    const PlaybackField& field = playback_fields()[f];
    if (field.values == &ParticleValues::weight && playback.bone_names.empty()) continue;
    for (const Range range : range_of(playback, f))
      fields.push_back({{"name", field.name},
                        {"unit", field.unit},
                        {"help", field.help},
                        {"low", range.low},
                        {"high", range.high},
                        {"levels", levels_of(playback, f, range)}});
  }
  return fields;
}

Json snapshots_of(const Playback& playback) {
  Json snapshots = Json::array();
  for (const PlaybackFrame& frame : playback.frames)
    snapshots.push_back({{"frame", frame.frame}, {"time", frame.time}});
  return snapshots;
}

Json balls_of(const Playback& playback) {
  Json all = Json::array();
  for (const auto& [count, radius] : playback.balls) all.push_back({count, radius});
  return all;
}

std::string corners_of(const Playback& playback) {
  std::vector<std::uint32_t> corners;
  for (const auto& face : playback.faces)
    for (const int corner : face) corners.push_back(static_cast<std::uint32_t>(corner));
  return base64_of(corners);
}

}  // namespace

std::string playback_json(const Playback& playback) {
  const Cube cube = cube_of(playback);
  const Vec3 low = cube.low + playback.origin;
  const auto numbers = [](const std::vector<int>& all) {
    return base64_of(std::vector<std::int16_t>(all.begin(), all.end()));
  };
  const Json json = {{"run",
                      {{"frames", playback.run_frames},
                       {"particles", playback.run_particles},
                       {"points", playback.run_points}}},
                     {"balls", balls_of(playback)},
                     {"low", {low.x(), low.y(), low.z()}},
                     {"edge", cube.edge},
                     {"snapshots", snapshots_of(playback)},
                     {"particles", places_of(playback, cube, &PlaybackFrame::particles)},
                     {"ids", base64_of(playback.particles)},
                     {"bone", numbers(playback.bone)},
                     {"boneNames", playback.bone_names},
                     {"boneColor", playback.bone_color},
                     {"material", numbers(playback.material)},
                     {"materialNames", playback.material_names},
                     {"front", {playback.front.x(), playback.front.y()}},
                     {"mark", numbers(playback.mark)},
                     {"markNames", playback.mark_names},
                     {"surface", places_of(playback, cube, &PlaybackFrame::surface)},
                     {"corners", corners_of(playback)},
                     {"bones", places_of(playback, cube, &PlaybackFrame::bones)},
                     {"forces", places_of(playback, cube, &PlaybackFrame::forces)},
                     {"isLoad", playback.is_load},
                     {"held", base64_of(playback.held)},
                     {"obstacles", obstacles_of(playback, cube)},
                     {"percentiles", {100 * outside, 100 * (1 - outside)}},
                     {"fields", fields_of(playback)}};
  return json_text(json);
}

}  // namespace sinew
