// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/elevations.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/text.h>

namespace sinew {

double Ticks::at(std::int64_t tick) const {
  // Divided rather than multiplied by negative powers, which are not exact.
  const double power = std::pow(10.0, std::abs(exponent));
  const double steps = mantissa * static_cast<double>(tick);
  return exponent < 0 ? steps / power : steps * power;
}

std::int64_t Ticks::base() const {
  constexpr std::int64_t far = 1000, round = 10;
  return std::min(std::abs(first), std::abs(last)) < far ? 0 : first / round * round;
}

Ticks ticks_over(double low, double high, double step) {
  Ticks ticks;
  ticks.exponent = static_cast<int>(std::floor(std::log10(step)));
  const double power = std::pow(10.0, ticks.exponent);
  ticks.mantissa = 10;
  for (const int mantissa : {5, 2, 1})
    if (mantissa * power >= step * (1 - 1e-9)) ticks.mantissa = mantissa;
  const double distance = ticks.mantissa * power;
  ticks.first = static_cast<std::int64_t>(std::floor(low / distance + 1e-9));
  ticks.last =
      std::max(ticks.first + 1, static_cast<std::int64_t>(std::ceil(high / distance - 1e-9)));
  return ticks;
}

namespace {

constexpr double steps_along = 6;  // steps of the longest side, at most

struct Elevation {
  Mat3 view;
  const char* title;
  const char* across;  ///< name of the axis to the right
  Box seen;            ///< in the view's axes, m
  Ticks ticks;         ///< to the right
  int x = 0, width = 0;
};

struct Plan {
  std::vector<Elevation> elevations;
  Ticks up;
  double pixel = 1;  ///< m
  TextStyle words;
  int top = 0, height = 0, legend = 0;
};

/// Everything to one scale between the texts.
Plan plan_of(const Snapshot& snapshot, const ElevationOptions& options) {
  Plan plan;
  plan.elevations = {{view_from({0, -1, 0}), "front, from -y", "x", {}, {}},
                     {view_from({1, 0, 0}), "side, from +x", "y", {}, {}}};
  double longest = 0;
  for (Elevation& elevation : plan.elevations) {
    elevation.seen = seen(elevation.view, snapshot);
    if (elevation.seen.isEmpty()) elevation.seen = Box(-Vec3::Ones(), Vec3::Ones());
    longest = std::max(longest, elevation.seen.sizes().head<2>().maxCoeff());
  }
  const double step = longest > 0 ? longest / steps_along : 1;
  const Box& front = plan.elevations.front().seen;
  plan.up = ticks_over(front.min().y(), front.max().y(), step);
  double across = 0;
  for (Elevation& elevation : plan.elevations) {
    elevation.ticks = ticks_over(elevation.seen.min().x(), elevation.seen.max().x(), step);
    across += elevation.ticks.high() - elevation.ticks.low();
  }
  plan.words.size = std::max(9, std::min(options.height / 36, options.width / 60));
  plan.words.color = options.paper.ink;
  const int line = line_height(plan.words), axis = 5 * plan.words.size;
  plan.top = 2 * line;
  plan.legend = options.height - 3 * line;
  const int wide = std::max(32, options.width - 3 * axis);
  const int high = std::max(16, plan.legend - 3 * line - plan.top);
  plan.pixel = std::max(across / wide, (plan.up.high() - plan.up.low()) / high);
  plan.height = std::max(16, static_cast<int>((plan.up.high() - plan.up.low()) / plan.pixel));
  int used = 0;
  for (Elevation& elevation : plan.elevations) {
    elevation.width = std::max(
        16, static_cast<int>((elevation.ticks.high() - elevation.ticks.low()) / plan.pixel));
    used += elevation.width;
  }
  int x = axis + (options.width - 3 * axis - used) / 4;
  for (Elevation& elevation : plan.elevations) {
    elevation.x = x;
    x += elevation.width + axis + (options.width - 3 * axis - used) / 2;
  }
  return plan;
}

/// The ticks' box, of which a picture of the panel's size shows each pixel in the plan's scale.
Camera camera_of(const Elevation& elevation, const Plan& plan) {
  const Vec3 low(elevation.ticks.low(), plan.up.low(), elevation.seen.min().z());
  const Vec3 size(elevation.width * plan.pixel, plan.height * plan.pixel,
                  elevation.seen.sizes().z());
  return {elevation.view, Box(low, low + size)};
}

/// "x (m)", "x - 403000 (m)"
std::string axis_title(const std::string& name, const Ticks& ticks) {
  const double from = ticks.at(ticks.base());
  const std::string less =
      from == 0 ? "" : (from < 0 ? " + " : " - ") + number_text(std::abs(from));
  return name + less + " (m)";
}

/// A frame with ticks outside of it and their numbers in meters.
void draw_axes(Canvas& page, const Elevation& elevation, const Plan& plan) {
  const int x = elevation.x, right = x + elevation.width, bottom = plan.top + plan.height;
  const int tick = plan.words.size / 2;
  TextStyle numbers = plan.words;
  numbers.color = palette::faint_ink;
  page.fill(x, bottom, elevation.width, 1, palette::faint_ink);
  page.fill(x, plan.top, 1, plan.height, palette::faint_ink);
  numbers.align = Align::center;
  for (auto k = elevation.ticks.first; k <= elevation.ticks.last; ++k) {
    const double value = elevation.ticks.at(k);
    const int at = x + static_cast<int>((value - elevation.ticks.low()) / plan.pixel);
    page.fill(at, bottom, 1, tick, palette::faint_ink);
    page.write(number_text(elevation.ticks.at(k - elevation.ticks.base())), at, bottom + tick + 2,
               numbers);
  }
  page.write(axis_title(elevation.across, elevation.ticks), (x + right) / 2,
             bottom + tick + line_height(numbers), numbers);
  numbers.align = Align::right;
  for (auto k = plan.up.first; k <= plan.up.last; ++k) {
    const double value = plan.up.at(k);
    const int at = bottom - static_cast<int>((value - plan.up.low()) / plan.pixel);
    page.fill(x - tick, at, tick, 1, palette::faint_ink);
    page.write(number_text(plan.up.at(k - plan.up.base())), x - tick - 4, at - 3 * numbers.size / 5,
               numbers);
  }
  page.write(axis_title("z", plan.up), x - 4, plan.top - 2 * numbers.size, numbers);
  TextStyle title = plan.words;
  title.align = Align::center;
  page.write(elevation.title, (x + right) / 2, plan.words.size / 3, title);
}

struct LegendEntry {
  std::string words;
  Color color;
  double radius;  ///< radius of its disc, pixels
};

std::vector<LegendEntry> legend_of(const Snapshot& snapshot, const Plan& plan) {
  std::vector<LegendEntry> entries;
  const double dot = 0.4 * plan.words.size, ball = std::max(1.0, snapshot.radius / plan.pixel);
  const auto has = [&](Mark mark) { return !marked(snapshot, mark).particles.empty(); };
  if (has(Mark::sample))
    entries.push_back(
        {"particle, r = " + three_digits(snapshot.radius) + " m", palette::sample, ball});
  if (!snapshot.bones.empty()) entries.push_back({"bones", palette::bone, dot});
  if (has(Mark::held)) entries.push_back({"held", palette::held, dot});
  if (has(Mark::loaded)) entries.push_back({"loaded", palette::loaded, dot});
  if (has(Mark::within)) entries.push_back({"flesh in flesh", palette::within, dot});
  if (has(Mark::muscle)) entries.push_back({"muscles", {232, 148, 146}, dot});
  if (!snapshot.obstacles.faces.empty()) entries.push_back({"obstacles", {192, 196, 200}, dot});
  return entries;
}

void draw_legend(Canvas& page, const Snapshot& snapshot, const Plan& plan) {
  const int size = plan.words.size;
  int x = 2 * size;
  const int y = plan.legend + line_height(plan.words) / 3;
  page.write(snapshot.caption, x, y + line_height(plan.words), plan.words);
  for (const LegendEntry& entry : legend_of(snapshot, plan)) {
    x += static_cast<int>(std::ceil(entry.radius));
    page.disc(x, y + 0.6 * size, entry.radius, entry.color);
    x += static_cast<int>(std::ceil(entry.radius)) + size / 2;
    page.write(entry.words, x, y, plan.words);
    x += static_cast<int>(entry.words.size()) * size / 2 + 2 * size;
  }
}

}  // namespace

Canvas elevations(Painter& painter, const Snapshot& snapshot, const ElevationOptions& options) {
  const Plan plan = plan_of(snapshot, options);
  Canvas page(options.width, options.height, options.paper.background);
  for (const Elevation& elevation : plan.elevations) {
    const PictureOptions picture{
        View::plan,   camera_of(elevation, plan), elevation.width, plan.height, 0, options.finish,
        options.paper};
    page.add(painter.draw(snapshot, picture), elevation.x, plan.top);
    draw_axes(page, elevation, plan);
  }
  draw_legend(page, snapshot, plan);
  return page;
}

}  // namespace sinew
