// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/color.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace sinew {
namespace {

constexpr int steps = 256;
using ColorTable = std::array<Color, steps>;

double to_linear(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
double from_linear(double l) {
  return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
}

Mat3 cones_from_rgb() {
  return (Mat3() << 0.4122214708, 0.5363325363, 0.0514459929,  //
          0.2119034982, 0.6806995451, 0.1073969566,            //
          0.0883024619, 0.2817188376, 0.6299787005)
      .finished();
}

Mat3 lab_from_cones() {
  return (Mat3() << 0.2104542553, 0.7936177850, -0.0040720468,  //
          1.9779984951, -2.4285922050, 0.4505937099,            //
          0.0259040371, 0.7827717662, -0.8086757660)
      .finished();
}

Color from_oklab(const Vec3& lab) {
  const Vec3 cones = lab_from_cones().inverse() * lab;
  const Vec3 rgb = cones_from_rgb().inverse() * cones.cwiseProduct(cones).cwiseProduct(cones);
  Color color;
  for (int c = 0; c < 3; ++c)
    color[c] =
        static_cast<std::uint8_t>(std::lround(255 * from_linear(std::clamp(rgb[c], 0.0, 1.0))));
  return color;
}

/// The key colors of a map: those by S. van der Walt and N. Smith (2015), cividis by
/// J. Nunez, C. Anderton and R. Renslow (2018), evenly spaced.
std::vector<Color> stops_of(ColorMap map) {
  switch (map) {
    case ColorMap::indigo:
      return {{78, 74, 168},  {58, 112, 190},  {32, 150, 176},
              {78, 190, 146}, {172, 220, 108}, {255, 236, 124}};
    case ColorMap::viridis:
      return {{68, 1, 84},    {72, 40, 120},  {62, 73, 137},  {49, 104, 142}, {38, 130, 142},
              {31, 158, 137}, {53, 183, 121}, {110, 206, 88}, {181, 222, 43}, {253, 231, 37}};
    case ColorMap::cividis:
      return {{0, 34, 78},     {18, 53, 112},   {59, 73, 108},   {87, 93, 109},  {112, 113, 115},
              {138, 134, 120}, {165, 156, 116}, {195, 179, 105}, {225, 204, 85}, {254, 232, 56}};
    case ColorMap::plasma:
      return {{13, 8, 135},   {70, 3, 159},   {114, 1, 168},  {156, 23, 158}, {189, 55, 134},
              {216, 87, 107}, {237, 121, 83}, {251, 159, 58}, {253, 202, 38}, {240, 249, 33}};
    case ColorMap::inferno:
      return {{0, 0, 4},     {27, 12, 65},   {74, 12, 107}, {120, 28, 109}, {165, 44, 96},
              {207, 68, 70}, {237, 105, 37}, {251, 155, 6}, {247, 209, 61}, {252, 255, 164}};
    case ColorMap::magma:
      return {{0, 0, 4},      {24, 15, 61},  {68, 15, 118},   {114, 31, 129},  {158, 47, 127},
              {205, 64, 113}, {241, 96, 93}, {253, 150, 104}, {254, 202, 141}, {252, 253, 191}};
    case ColorMap::gray:
      return {{40, 40, 40}, {245, 245, 245}};
  }
  return {};
}

/// Along the polyline through the map's key colors, by length in Oklab.
ColorTable make_table(ColorMap map) {
  const std::vector<Color> stops = stops_of(map);
  std::vector<double> length(stops.size(), 0);
  for (std::size_t i = 1; i < stops.size(); ++i)
    length[i] = length[i - 1] + (oklab(stops[i]) - oklab(stops[i - 1])).norm();
  ColorTable shades;
  for (int k = 0; k < steps; ++k) {
    const double walked = length.back() * k / (steps - 1);
    std::size_t i = 1;
    while (i + 1 < stops.size() && length[i] < walked) ++i;
    const double part = (walked - length[i - 1]) / (length[i] - length[i - 1]);
    shades[k] = from_oklab(oklab(stops[i - 1]) * (1 - part) + oklab(stops[i]) * part);
  }
  return shades;
}

constexpr std::array<NamedColorMap, 7> names = {{{"indigo", ColorMap::indigo},
                                                 {"viridis", ColorMap::viridis},
                                                 {"cividis", ColorMap::cividis},
                                                 {"plasma", ColorMap::plasma},
                                                 {"inferno", ColorMap::inferno},
                                                 {"magma", ColorMap::magma},
                                                 {"gray", ColorMap::gray}}};

const ColorTable& table_of(ColorMap map) {
  static const std::vector<ColorTable> tables = [] {
    std::vector<ColorTable> made;
    made.reserve(names.size());
    for (const NamedColorMap& named : names) made.push_back(make_table(named.map));
    return made;
  }();
  return tables[static_cast<std::size_t>(map)];
}

}  // namespace

Paper paper_of(const Color& background) {
  constexpr double middle = 0.6;  // fraction of the lightness
  constexpr Color light_ink{236, 239, 243};
  return {background, oklab(background)[0] > middle ? palette::ink : light_ink};
}

Color readable_on(const Color& background, const Color& color) {
  constexpr double enough = 0.3, apart = 0.5, middle = 0.6;  // lightnesses
  const double behind = oklab(background)[0];
  Vec3 lab = oklab(color);
  if (std::abs(lab[0] - behind) >= enough) return color;
  lab[0] = behind > middle ? std::max(0.0, behind - apart) : std::min(1.0, behind + apart);
  return from_oklab(lab);
}

std::span<const NamedColor> named_colors() {
  static constexpr std::array<NamedColor, 12> colors = {{{"white", {255, 255, 255}},
                                                         {"black", {0, 0, 0}},
                                                         {"gray", {128, 128, 128}},
                                                         {"lightgray", {211, 211, 211}},
                                                         {"darkgray", {64, 64, 64}},
                                                         {"slate", {82, 87, 110}},
                                                         {"navy", {0, 0, 84}},
                                                         {"beige", {245, 245, 220}},
                                                         {"red", {255, 0, 0}},
                                                         {"green", {0, 128, 0}},
                                                         {"blue", {0, 0, 255}},
                                                         {"yellow", {255, 255, 0}}}};
  return colors;
}

std::optional<Color> hex_color(std::string_view text) {
  if (text.size() != 7 || text.front() != '#') return {};
  std::uint32_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, failed] = std::from_chars(text.data() + 1, end, value, 16);
  if (failed != std::errc() || stop != end) return {};
  const auto part = [&](int shift) { return static_cast<std::uint8_t>(value >> shift); };
  return Color{part(16), part(8), part(0)};
}

Vec3 oklab(const Color& color) {
  Vec3 rgb;
  for (int c = 0; c < 3; ++c) rgb[c] = to_linear(color[c] / 255.0);
  return lab_from_cones() *
         (cones_from_rgb() * rgb).unaryExpr([](double c) { return std::cbrt(c); });
}

std::span<const NamedColorMap> color_maps() { return names; }

Color mapped_color(double position, ColorMap map) {
  const ColorTable& shades = table_of(map);
  if (std::isnan(position)) return palette::no_value;
  if (position < 0) return shades.front();
  return shades[static_cast<int>(std::lround(std::min(position, 1.0) * (steps - 1)))];
}

}  // namespace sinew
