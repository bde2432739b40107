// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include <sinew/core/base64.h>
#include <sinew/core/color.h>
#include <sinew/core/json.h>
#include <sinew/metrics/report/playback.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

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

/// The range of a field: the run's, else that of the frames here; nothing where there are no
/// values. Of two runs neither is outermost, however few its particles.
std::optional<ValueRange> range_of(const Playback& playback, std::size_t field) {
  const auto known = playback.ranges.find(std::string(playback_fields()[field].quantity));
  const bool is_known = known != playback.ranges.end();
  std::optional<ValueRange> range;
  std::size_t first = 0;
  for (const Balls& balls : playback.balls) {
    RangeFinder finder;
    for (const PlaybackFrame& frame : playback.frames)
      if (const auto& values = frame.values[field]; first < values.size())
        finder.add(std::span(values).subspan(first, std::min(balls.count, values.size() - first)));
    first += balls.count;
    if (finder.empty()) continue;
    const ValueRange own = is_known ? known->second : finder.range();
    range =
        range ? ValueRange{std::min(range->low, own.low), std::max(range->high, own.high)} : own;
  }
  return range;
}

/// The values as 0 to 254 of their range; 255 stands for none.
std::string levels_of(const Playback& playback, std::size_t field, const ValueRange& range) {
  std::vector<std::uint8_t> all;
  const double width = range.high > range.low ? range.high - range.low : 1;
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
    if (const auto range = range_of(playback, f))
      fields.push_back({{"name", field.name},
                        {"unit", field.unit},
                        {"help", field.help},
                        {"low", range->low},
                        {"high", range->high},
                        {"levels", levels_of(playback, f, *range)}});
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
  for (const auto& [count, radius, layer] : playback.balls) all.push_back({count, radius, layer});
  return all;
}

/// Colors of the pictures, at even fractions of a range.
Json colors_of_scale() {
  constexpr int steps = 32;
  Json colors = Json::array();
  for (int k = 0; k <= steps; ++k) colors.push_back(mapped_color(double(k) / steps));
  return colors;
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
                     {"percentiles", {100 * beyond_range, 100 * (1 - beyond_range)}},
                     {"colors", colors_of_scale()},
                     {"fields", fields_of(playback)}};
  return json_text(json);
}

}  // namespace sinew
