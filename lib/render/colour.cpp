// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/colour.h"

#include <algorithm>
#include <cmath>

#include "render/shot.h"

namespace sinew {
namespace {

constexpr int steps = 256;
using ColourTable = std::array<Colour, steps>;

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

Colour from_oklab(const Vec3& lab) {
  const Vec3 cones = lab_from_cones().inverse() * lab;
  const Vec3 rgb = cones_from_rgb().inverse() * cones.cwiseProduct(cones).cwiseProduct(cones);
  Colour colour;
  for (int c = 0; c < 3; ++c)
    colour[c] =
        static_cast<std::uint8_t>(std::lround(255 * from_linear(std::clamp(rgb[c], 0.0, 1.0))));
  return colour;
}

/// Along the line through a few hues, by the length walked in Oklab.
ColourTable make_table() {
  const std::array<Colour, 6> stops{{{78, 74, 168},
                                     {58, 112, 190},
                                     {32, 150, 176},
                                     {78, 190, 146},
                                     {172, 220, 108},
                                     {255, 236, 124}}};
  std::array<double, stops.size()> length{};
  for (std::size_t i = 1; i < stops.size(); ++i)
    length[i] = length[i - 1] + (oklab(stops[i]) - oklab(stops[i - 1])).norm();
  ColourTable table;
  for (int k = 0; k < steps; ++k) {
    const double walked = length.back() * k / (steps - 1);
    std::size_t i = 1;
    while (i + 1 < stops.size() && length[i] < walked) ++i;
    const double part = (walked - length[i - 1]) / (length[i] - length[i - 1]);
    table[k] = from_oklab(oklab(stops[i - 1]) * (1 - part) + oklab(stops[i]) * part);
  }
  return table;
}

}  // namespace

Vec3 oklab(const Colour& colour) {
  Vec3 rgb;
  for (int c = 0; c < 3; ++c) rgb[c] = to_linear(colour[c] / 255.0);
  return lab_from_cones() *
         (cones_from_rgb() * rgb).unaryExpr([](double c) { return std::cbrt(c); });
}

Colour mapped_colour(double position) {
  static const ColourTable table = make_table();
  if (!(position > 0)) return table.front();
  return table[static_cast<int>(std::lround(std::min(position, 1.0) * (steps - 1)))];
}

double ColourScale::position(double value) const {
  if (!(high > low) || !(value > low)) return 0;
  return std::min(1.0, (value - low) / (high - low));
}

}  // namespace sinew
