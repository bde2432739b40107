// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/metrics/report/base64.h>
#include <sinew/metrics/report/film.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

constexpr double outside = 1e-3;  // share of a field's values at either end that the range leaves

/// The cube that holds all places of the film.
struct Cube {
  Vec3 low = Vec3::Zero();
  double edge = 1;
};

Cube cube_of(const Film& film) {
  const Box box = box_of(film);
  if (box.isEmpty()) return {};
  const double edge = box.sizes().maxCoeff();
  return {box.min(), edge > 0 ? edge : 1};
}

void quantise(std::vector<std::uint16_t>& out, const std::vector<float>& places, const Cube& cube) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double share = (places[i] - cube.low[static_cast<int>(i % 3)]) / cube.edge;
    out.push_back(static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0))));
  }
}

std::string places_of(const Film& film, const Cube& cube,
                      const std::vector<float> FilmFrame::*places) {
  std::vector<std::uint16_t> all;
  for (const FilmFrame& frame : film.frames) quantise(all, frame.*places, cube);
  return base64_of(all);
}

struct Range {
  float low, high;
};

/// Where all but the outermost of the values lie; nothing where there are none.
std::vector<Range> range_of(const Film& film, std::size_t field) {
  std::vector<float> all;
  for (const FilmFrame& frame : film.frames)
    for (const float value : frame.values[field])
      if (std::isfinite(value)) all.push_back(value);
  if (all.empty()) return {};
  const auto at = [&](double share) {
    const auto place =
        all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), place, all.end());
    return *place;
  };
  return {{at(outside), at(1 - outside)}};
}

/// The values between 0 and 254 of their range; 255 is none.
std::string levels_of(const Film& film, std::size_t field, Range range) {
  std::vector<std::uint8_t> all;
  const double width = range.high > range.low ? double(range.high) - range.low : 1;
  for (const FilmFrame& frame : film.frames)
    for (const float value : frame.values[field]) {
      const double share = std::clamp((double(value) - range.low) / width, 0.0, 1.0);
      all.push_back(std::isnan(value) ? 255 : static_cast<std::uint8_t>(std::lround(254 * share)));
    }
  return base64_of(all);
}

Json fields_of(const Film& film) {
  Json fields = Json::array();
  for (std::size_t f = 0; f < film_fields().size(); ++f) {
    const FilmField& field = film_fields()[f];
    for (const Range range : range_of(film, f))
      fields.push_back({{"name", field.name},
                        {"unit", field.unit},
                        {"help", field.help},
                        {"low", range.low},
                        {"high", range.high},
                        {"levels", levels_of(film, f, range)}});
  }
  return fields;
}

Json shots_of(const Film& film) {
  Json shots = Json::array();
  for (const FilmFrame& frame : film.frames)
    shots.push_back({{"frame", frame.frame}, {"time", frame.time}});
  return shots;
}

Json balls_of(const Film& film) {
  Json all = Json::array();
  for (const auto& [count, radius] : film.balls) all.push_back({count, radius});
  return all;
}

std::string corners_of(const Film& film) {
  std::vector<std::uint32_t> corners;
  for (const auto& face : film.faces)
    for (const int corner : face) corners.push_back(static_cast<std::uint32_t>(corner));
  return base64_of(corners);
}

}  // namespace

std::string film_json(const Film& film) {
  const Cube cube = cube_of(film);
  const std::vector<std::int16_t> bone(film.bone.begin(), film.bone.end());
  const Json json = {{"run",
                      {{"frames", film.run_frames},
                       {"particles", film.run_particles},
                       {"points", film.run_points}}},
                     {"balls", balls_of(film)},
                     {"low", {cube.low.x(), cube.low.y(), cube.low.z()}},
                     {"edge", cube.edge},
                     {"shots", shots_of(film)},
                     {"particles", places_of(film, cube, &FilmFrame::particles)},
                     {"ids", base64_of(film.particles)},
                     {"bone", base64_of(bone)},
                     {"boneNames", film.bone_names},
                     {"surface", places_of(film, cube, &FilmFrame::surface)},
                     {"corners", corners_of(film)},
                     {"bones", places_of(film, cube, &FilmFrame::bones)},
                     {"fields", fields_of(film)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sinew
