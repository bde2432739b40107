// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/region.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {

double Region::weight(const Vec3& point) const {
  if (!shape) return 1;
  if (falloff > 0 && !may_be_within(*shape, point, falloff)) return 0;
  const double distance = signed_distance(*shape, point).distance;
  if (distance <= 0) return 1;
  if (!(distance < falloff)) return 0;
  const double s = 1 - distance / falloff;
  return s * s * (3 - 2 * s);
}

void check_region(const Region& region, const std::string& what) {
  if (region.shape) check_shape(*region.shape, what);
  if (!is_computable(region.falloff) || region.falloff < 0)
    throw bad_input(what + " has a falloff of " + number_text(region.falloff),
                    "give 0 or a positive width");
}

namespace {

/// Index of the first key after `time`.
std::size_t after(const std::vector<double>& times, double time) {
  return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) -
                                  times.begin());
}

double slope_before(const KeyedValue& keys, std::size_t next) {
  return (keys.values[next] - keys.values[next - 1]) / (keys.times[next] - keys.times[next - 1]);
}

}  // namespace

double KeyedValue::at(double time) const {
  if (times.empty()) return 1;
  const std::size_t next = after(times, time);
  if (next == 0) return values.front();
  if (next == times.size()) return values.back();
  return values[next - 1] + slope_before(*this, next) * (time - times[next - 1]);
}

Vec3 KeyedPlace::at(double time) const {
  if (times.empty()) return Vec3::Zero();
  const std::size_t next = after(times, time);
  if (next == 0) return places.front();
  if (next == times.size()) return places.back();
  const double reached = (time - times[next - 1]) / (times[next] - times[next - 1]);
  return places[next - 1] + reached * (places[next] - places[next - 1]);
}

double KeyedValue::rate(double time) const {
  const std::size_t next = after(times, time);
  return next == 0 || next == times.size() ? 0 : slope_before(*this, next);
}

double KeyedValue::largest() const {
  if (values.empty()) return 1;
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

void check_keys(const KeyedValue& keys, double low, double high, const std::string& what) {
  if (keys.times.size() != keys.values.size())
    throw bad_input(what + " has " + std::to_string(keys.times.size()) + " times and " +
                        std::to_string(keys.values.size()) + " values",
                    "give one value per time");
  for (std::size_t k = 0; k < keys.times.size(); ++k) {
    const double time = keys.times[k], value = keys.values[k];
    if (!is_computable(time) || (k > 0 && !(time > keys.times[k - 1])))
      throw bad_input(what + " has a key at " + number_text(time) + " s that does not come later",
                      "give keys in ascending time");
    if (!is_computable(value) || value < low || value > high)
      throw bad_input(what + " has the value " + number_text(value),
                      "give values from " + number_text(low) + " to " + number_text(high));
  }
}

}  // namespace sinew
