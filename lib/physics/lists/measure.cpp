// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/lists/measure.h"

#include <limits>

namespace sinew {
namespace {

// Coordinates are whole numbers of 32 bits that wrap round. A body fills a quarter of their range
// at first; it is measured anew when it is larger than 1.25 of that, or off the middle by more than
// an eighth of it, which is looked at when it may have travelled by 0.36 of it. So no particle
// comes farther out than 0.625 + 0.125 + 0.36 of 2^30; pads are beyond.
constexpr double body_range = 1073741824;  // 2^30
constexpr double largest = 1.25, off_the_middle = 0.125, travelled = 0.36;

}  // namespace

template <>
Measure measure_for<double>(const Box&, const PairForce&, double) {
  return {};
}

template <>
Measure measure_for<float>(const Box& box, const PairForce& pair, double step) {
  // So wide that pads are out of each other's range as well.
  const double extent = (box.isEmpty() ? 0 : box.sizes().maxCoeff()) + 16 * pair.b;
  Measure measure;
  measure.length = extent / body_range;
  measure.time = step;
  measure.origin = box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.center());
  return measure;
}

template <>
bool serves<double>(const Measure&, const Box&) {
  return true;
}

template <>
bool serves<float>(const Measure& measure, const Box& box) {
  const double usual = body_range * measure.length;
  return box.isEmpty() || ((box.center() - measure.origin).norm() < off_the_middle * usual &&
                           box.sizes().maxCoeff() < largest * usual);
}

template <>
double free_travel<double>(const Measure&) {
  return std::numeric_limits<double>::infinity();
}

template <>
double free_travel<float>(const Measure& measure) {
  return travelled * body_range * measure.length;
}

}  // namespace sinew
