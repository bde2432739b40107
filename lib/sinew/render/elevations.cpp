// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/elevations.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/text.h>
#include <sinew/render/detail/text.h>

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
  const char *across, *along;  ///< names of the axes to the right and up
  Box seen;                    ///< in the view's axes, m
  Ticks ticks, up;             ///< to the right and up
  int x = 0, y = 0, width = 0, height = 0;
};

struct Plan {
  std::vector<Elevation> elevations;  ///< front, side and, of flat bodies, top
  double pixel = 0;                   ///< m
  TextStyle words, faint;
  int legend = 0;
};

/// Whether a body is so flat that its front and side do not show its shape.
bool is_flat(const Box& front, const Box& side) {
  constexpr double flat = 0.5;  // height over the shorter of length and width
  return front.sizes().y() < flat * std::min(front.sizes().x(), side.sizes().x());
}

double span_of(const Ticks& ticks) { return ticks.high() - ticks.low(); }

std::vector<Elevation> elevations_of(const Snapshot& snapshot) {
  std::vector<Elevation> all = {{view_from({0, -1, 0}), "front, from -y", "x", "z", {}, {}, {}},
                                {view_from({1, 0, 0}), "side, from +x", "y", "z", {}, {}, {}},
                                {view_from_above(), "top, from +z", "x", "y", {}, {}, {}}};
  double longest = 0;
  for (Elevation& elevation : all) {
    elevation.seen = seen(elevation.view, snapshot);
    if (elevation.seen.isEmpty()) elevation.seen = Box(-Vec3::Ones(), Vec3::Ones());
    longest = std::max(longest, elevation.seen.sizes().head<2>().maxCoeff());
  }
  if (!is_flat(all[0].seen, all[1].seen)) all.pop_back();
  const double step = longest > 0 ? longest / steps_along : 1;
  for (Elevation& elevation : all) {
    const Box& box = elevation.seen;
    elevation.ticks = ticks_over(box.min().x(), box.max().x(), step);
    elevation.up = ticks_over(box.min().y(), box.max().y(), step);
  }
  return all;
}

struct LegendEntry {
  std::string words;
  Color color;
  double radius;  ///< radius of its disc, pixels
};

/// `pixel`: size of one in the pictures, m.
std::vector<LegendEntry> legend_of(const Snapshot& snapshot, const TextStyle& words, double pixel,
                                   const Color& paper) {
  std::vector<LegendEntry> entries;
  // A particle's disc has its size in the pictures if that leaves the line of words below free.
  const double dot = 0.4 * words.size, ball = std::clamp(snapshot.radius / pixel, 1.0, 1.5 * dot);
  const auto has = [&](Mark mark) { return !marked(snapshot, mark).particles.empty(); };
  if (has(Mark::sample))
    entries.push_back(
        {"particle, r = " + quantity_text(snapshot.radius, "m"), palette::sample, ball});
  if (!snapshot.bones.empty()) entries.push_back({"bones", readable_on(paper, palette::bone), dot});
  if (!snapshot.bones.empty()) {
    entries.push_back({"along a bone", palette::axes[0], dot});
    entries.push_back({"its sides y", palette::axes[1], dot});
    entries.push_back({"and z", palette::axes[2], dot});
  }
  if (has(Mark::held)) entries.push_back({"held", readable_on(paper, palette::held), dot});
  if (has(Mark::loaded)) entries.push_back({"loaded", palette::loaded, dot});
  if (has(Mark::within)) entries.push_back({"flesh in flesh", palette::within, dot});
  if (has(Mark::muscle)) entries.push_back({"muscles", {232, 148, 146}, dot});
  if (!snapshot.obstacles.faces.empty()) entries.push_back({"obstacles", {192, 196, 200}, dot});
  return entries;
}

/// Width of an entry, and its distance to the next.
int width_of(const LegendEntry& entry, const TextStyle& words) {
  return 2 * static_cast<int>(std::ceil(entry.radius)) + words.size / 2 +
         text_width(entry.words, words);
}
int gap_of(const TextStyle& words) { return 2 * words.size; }

using Columns = std::vector<std::vector<Elevation*>>;

/// Front and side beside each other or, of flat bodies, beside the top one below the other.
Columns columns_of(std::vector<Elevation>& elevations) {
  Elevation *front = &elevations[0], *side = &elevations[1];
  if (elevations.size() > 2) return {{&elevations[2]}, {front, side}};
  return {{front}, {side}};
}

/// Size of a pixel in m, at which all columns fit into a width and a height.
double pixel_of(const Columns& columns, int width, int height, int between) {
  double across = 0, pixel = 0;
  for (const auto& column : columns) {
    double widest = 0, upward = 0;
    for (const Elevation* one : column) {
      widest = std::max(widest, span_of(one->ticks));
      upward += span_of(one->up);
    }
    across += widest;
    pixel =
        std::max(pixel, upward / std::max(16, height - static_cast<int>(column.size()) * between));
  }
  return std::max(pixel, across / std::max(32, width));
}

/// Gives the elevations their sizes in pixels. Returns the width of all columns.
int set_sizes(const Columns& columns, double pixel) {
  int used = 0;
  for (const auto& column : columns) {
    int widest = 0;
    for (Elevation* one : column) {
      one->width = std::max(16, static_cast<int>(span_of(one->ticks) / pixel));
      one->height = std::max(16, static_cast<int>(span_of(one->up) / pixel));
      widest = std::max(widest, one->width);
    }
    used += widest;
  }
  return used;
}

/// Number of lines that the legend takes, and the margin below it.
int legend_lines(const Snapshot& snapshot, const TextStyle& words,
                 const ElevationOptions& options) {
  int width = 0;
  for (const LegendEntry& entry : legend_of(snapshot, words, 1, options.paper.background))
    width += width_of(entry, words) + gap_of(words);
  return width < options.width * 9 / 10 ? 3 : 4;
}

/// Everything to one scale between the texts.
Plan plan_of(const Snapshot& snapshot, const ElevationOptions& options) {
  Plan plan;
  plan.elevations = elevations_of(snapshot);
  plan.words.size = std::max(9, std::min(options.height / 36, options.width / 60));
  plan.words.color = options.paper.ink;
  plan.faint = plan.words;
  plan.faint.color = readable_on(options.paper.background, palette::faint_ink);
  const int line = line_height(plan.words), axis = 5 * plan.words.size, between = 5 * line;
  plan.legend = options.height - legend_lines(snapshot, plan.words, options) * line;
  const Columns columns = columns_of(plan.elevations);
  const int room = options.width - 3 * axis;
  plan.pixel = pixel_of(columns, room, plan.legend, between);
  const int free = room - set_sizes(columns, plan.pixel);
  int x = axis + free / 4;
  for (const auto& column : columns) {
    int y = 2 * line;
    for (Elevation* one : column) {
      one->x = x, one->y = y;
      y += one->height + between;
    }
    x += column.front()->width + axis + free / 2;
  }
  return plan;
}

/// The ticks' box, of which a picture of the panel's size shows each pixel in the plan's scale.
Camera camera_of(const Elevation& elevation, const Plan& plan) {
  const Vec3 low(elevation.ticks.low(), elevation.up.low(), elevation.seen.min().z());
  const Vec3 size(elevation.width * plan.pixel, elevation.height * plan.pixel,
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
  const int x = elevation.x, right = x + elevation.width, bottom = elevation.y + elevation.height;
  const int tick = plan.words.size / 2;
  TextStyle numbers = plan.faint;
  page.fill(x, bottom, elevation.width, 1, numbers.color);
  page.fill(x, elevation.y, 1, elevation.height, numbers.color);
  numbers.align = Align::center;
  for (auto k = elevation.ticks.first; k <= elevation.ticks.last; ++k) {
    const double value = elevation.ticks.at(k);
    const int at = x + static_cast<int>((value - elevation.ticks.low()) / plan.pixel);
    page.fill(at, bottom, 1, tick, numbers.color);
    page.write(number_text(elevation.ticks.at(k - elevation.ticks.base())), at, bottom + tick + 2,
               numbers);
  }
  page.write(axis_title(elevation.across, elevation.ticks), (x + right) / 2,
             bottom + tick + line_height(numbers), numbers);
  numbers.align = Align::right;
  for (auto k = elevation.up.first; k <= elevation.up.last; ++k) {
    const double value = elevation.up.at(k);
    const int at = bottom - static_cast<int>((value - elevation.up.low()) / plan.pixel);
    page.fill(x - tick, at, tick, 1, numbers.color);
    page.write(number_text(elevation.up.at(k - elevation.up.base())), x - tick - 4,
               at - 3 * numbers.size / 5, numbers);
  }
  page.write(axis_title(elevation.along, elevation.up), x - 4, elevation.y - 2 * numbers.size,
             numbers);
  TextStyle title = plan.words;
  title.align = Align::center;
  page.write(elevation.title, (x + right) / 2,
             elevation.y - 2 * line_height(plan.words) + plan.words.size / 3, title);
}

/// The entries in one line or two, above the caption.
void draw_legend(Canvas& page, const Snapshot& snapshot, const Plan& plan, const Color& paper) {
  const int size = plan.words.size, line = line_height(plan.words), left = 2 * size;
  int x = left, y = plan.legend + line / 3;
  for (const LegendEntry& entry : legend_of(snapshot, plan.words, plan.pixel, paper)) {
    const int radius = static_cast<int>(std::ceil(entry.radius));
    const int width = width_of(entry, plan.words);
    if (x > left && x + width > page.width() - left) x = left, y += line;
    page.disc(x + radius, y + 0.6 * size, entry.radius, entry.color);
    page.write(entry.words, x + 2 * radius + size / 2, y, plan.words);
    x += width + gap_of(plan.words);
  }
  page.write(snapshot.caption, left, y + line, plan.words);
}

}  // namespace

Canvas elevations(Painter& painter, const Snapshot& snapshot, const ElevationOptions& options) {
  const Plan plan = plan_of(snapshot, options);
  Canvas page(options.width, options.height, options.paper.background);
  for (const Elevation& elevation : plan.elevations) {
    const PictureOptions picture{View::plan,
                                 camera_of(elevation, plan),
                                 elevation.width,
                                 elevation.height,
                                 0,
                                 options.finish,
                                 options.paper};
    page.add(painter.draw(snapshot, picture), elevation.x, elevation.y);
    draw_axes(page, elevation, plan);
  }
  draw_legend(page, snapshot, plan, options.paper.background);
  return page;
}

}  // namespace sinew
