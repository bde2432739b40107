// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/paraview/shown_run.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/core/arrays.h>
#include <sinew/core/error.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/text.h>
#include <sinew/core/triangles.h>
#include <sinew/core/value_range.h>
#include <sinew/io/series.h>
#include <sinew/io/series_table.h>
#include <sinew/io/vtu.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t min_samples = 2, max_samples = 12;
constexpr std::size_t max_particles_read = 4'000'000;  // in some seconds
constexpr double rounding = 1e-9;                      ///< rounding: the body is at rest

/// Frames spread over the run, the first and the last included; fewer of large ones.
std::vector<std::size_t> samples(std::size_t frames, std::size_t points) {
  const std::size_t affordable = max_particles_read / std::max<std::size_t>(1, points);
  const std::size_t count = std::min(frames, std::clamp(affordable, min_samples, max_samples));
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k)
    chosen.push_back(count == 1 ? 0 : k * (frames - 1) / (count - 1));
  return chosen;
}

/// Adds the corners of a box.
void add_box(ShownRun& run, const Vec3& low, const Vec3& high) {
  for (int corner = 0; corner < 8; ++corner)
    run.corners.emplace_back(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                             corner & 4 ? high.z() : low.z());
}

void add_corners(ShownRun& run, const Points& points) {
  if (points.empty()) return;
  Vec3 low = points[0], high = points[0];
  for (const Vec3& point : points) low = low.cwiseMin(point), high = high.cwiseMax(point);
  add_box(run, low - run.origin, high - run.origin);
}

/// Adds a box around the body at rest with space to bend: its motion is not yet known.
void make_room(ShownRun& run) {
  const Vec3 middle = (run.rest[0] + run.rest[1]) / 2, half = (run.rest[1] - run.rest[0]) / 2;
  const Vec3 reach = (3 * half).cwiseMin(1.2 * half.maxCoeff());
  add_box(run, middle - reach, middle + reach);
}

/// Values of a scalar, lengths of vectors and tensors; without those that are not defined.
std::vector<double> magnitudes(const Column& column) {
  return std::visit(
      [&](const auto& values) {
        std::vector<double> found;
        const auto width = static_cast<std::size_t>(column.components);
        for (std::size_t i = 0; i + width <= values.size(); i += width) {
          double sum = 0;
          for (std::size_t k = 0; k < width; ++k)
            sum += static_cast<double>(values[i + k]) * static_cast<double>(values[i + k]);
          const double value = width == 1 ? static_cast<double>(values[i]) : std::sqrt(sum);
          if (std::isfinite(value)) found.push_back(value);
        }
        return found;
      },
      column.values);
}

[[noreturn]] void refuse_array(const Dataset& frame, const std::string& name) {
  std::vector<std::string_view> names;
  for (const Column& column : frame.point_columns) names.push_back(column.name);
  throw bad_input("the particles have no array " + shown(name), suggestion(name, names));
}

bool has_array(const Dataset& frame, const std::string& name) {
  return find(frame.point_columns, name) != nullptr;
}

/// What is shown of the first frame, whose scene may have left arrays out.
void choose_arrays(ShownRun& run, const fs::path& file, const ViewOptions& options) {
  const Dataset first = read_vtu(file);
  run.array = options.array;
  for (const char* name : {"strain_eq", "displacement", "velocity", "bone", "id"})
    if (run.array.empty() && has_array(first, name)) run.array = name;
  run.forces = options.forces.value_or("");
  if (run.forces.empty()) run.forces = "force_pair";
  const bool asked = options.forces && !options.forces->empty();
  if (!has_array(first, run.forces)) {
    if (asked) refuse_array(first, run.forces);
    run.forces.clear();
  }
  if (!has_array(first, run.array)) refuse_array(first, run.array);
  run.can_be_cut = has_array(first, "displacement");
  run.components = find(first.point_columns, run.array)->components;
  const WrittenArray* row = find_written("particles", ArrayPlace::point, run.array);
  run.unit = row == nullptr ? "" : row->unit;
}

/// The numbers of the color scale's ends, which do not hang on single particles.
class ColorRange {
 public:
  void add(const Column& column, double time, double& moment) {
    const std::vector<double> values = magnitudes(column);
    RangeFinder here;
    here.add(values), all_.add(values);
    if (here.range().high > highest_) moment = time, highest_ = here.range().high;
  }

  /// The range of the options, else the one known for the run, else that of the frames read here.
  /// Numbers of an array of which all are alike are not known to grow.
  void put(ShownRun& run, const ViewOptions& options) const {
    const auto known = options.ranges.find(quantity_of(run.array));
    const ValueRange range = options.range                   ? *options.range
                             : known != options.ranges.end() ? known->second
                                                             : all_.range();
    run.grows = !options.range &&
                !(range.high - range.low > rounding * std::max(1.0, std::abs(range.high)));
    if (!run.grows) run.range = range;
  }

 private:
  RangeFinder all_;
  double highest_ = -std::numeric_limits<double>::infinity();
};

void read_particles(ShownRun& run, const std::vector<PvdRow>& rows, std::size_t particles,
                    const ViewOptions& options) {
  ColorRange range;
  for (const std::size_t k : samples(rows.size(), particles)) {
    const Dataset frame =
        read_vtu(run.folder / rows[k].file, {run.array.c_str(), run.forces.c_str()});
    const Column* colors = find(frame.point_columns, run.array);
    const Column* forces = find(frame.point_columns, run.forces);
    run.particles = frame.points.size();
    add_corners(run, frame.points);
    if (colors != nullptr) range.add(*colors, rows[k].time, run.moment);
    if (forces == nullptr) continue;
    for (const double force : magnitudes(*forces)) run.strongest = std::max(run.strongest, force);
  }
  range.put(run, options);
}

void read_supports(ShownRun& run) {
  const std::vector<PvdRow> rows = read_pvd(run.folder / "supports.pvd");
  std::vector<Dataset> frames;
  for (const std::size_t k : samples(rows.size(), 1)) {
    frames.push_back(read_vtu(run.folder / rows[k].file, {"force"}));
    for (const Vec3& force : vectors(frames.back().point_columns, "force"))
      run.hardest = std::max(run.hardest, force.norm());
  }
  if (!(run.hardest > 0)) return;
  const double scale = arrow_fraction * run.size() / run.hardest;
  for (const Dataset& frame : frames) {
    Points tips = vectors(frame.point_columns, "force");
    for (std::size_t i = 0; i < tips.size(); ++i) tips[i] = frame.points[i] + scale * tips[i];
    add_corners(run, tips);
  }
}

/// The first frame of a series, with these arrays only; empty where there is none.
Dataset first_frame(const ShownRun& run, const std::string& series,
                    std::initializer_list<const char*> arrays = {}) {
  if (!run.has(series)) return {};
  const std::vector<PvdRow> rows = read_pvd(run.folder / (series + ".pvd"));
  return rows.empty() ? Dataset{} : read_vtu(run.folder / rows[0].file, arrays);
}

/// Cells that lack the array, or what their cut needs, are not shown.
void choose_cells(ShownRun& run) {
  const Dataset cells = first_frame(run, "volume", {run.array.c_str(), "displacement", "torn"});
  run.has_cells = cells.cells() > 0 && has_array(cells, run.array) &&
                  has_array(cells, "displacement") && find(cells.cell_columns, "torn") != nullptr;
  if (!run.has_cells) std::erase(run.series, "volume");
  run.skin_has_array = has_array(first_frame(run, "surface", {run.array.c_str()}), run.array);
}

/// Nearest time of a frame.
double frame_at(const std::vector<double>& times, double time) {
  time = std::clamp(time, times.front(), times.back());
  return *std::min_element(times.begin(), times.end(), [&](double a, double b) {
    return std::abs(a - time) < std::abs(b - time);
  });
}

}  // namespace

bool ShownRun::has(const std::string& name) const {
  return std::find(series.begin(), series.end(), name) != series.end();
}

double ShownRun::size() const {
  Vec3 first = corners.at(0), last = corners[0];
  for (const Vec3& corner : corners) first = first.cwiseMin(corner), last = last.cwiseMax(corner);
  return (last - first).maxCoeff();
}

ShownRun shown_run(const fs::path& folder, const ViewOptions& options) {
  ShownRun run;
  run.folder = fs::absolute(folder).lexically_normal();
  const std::vector<PvdRow> rows = read_pvd(run.folder / "particles.pvd");
  if (rows.empty())
    throw bad_input(Place{folder.string()}, "the run has no frames yet", "wait for its first one");
  for (const PvdRow& row : rows) run.times.push_back(row.time);
  for (const std::string_view name : series_in(run.folder)) run.series.emplace_back(name);
  const Dataset rest = read_vtu(run.folder / "body.vtu", {"radius"});
  if (rest.points.empty())
    throw bad_input(Place{(run.folder / "body.vtu").string()}, "has no particles",
                    "run the scene again");
  run.origin = local_origin(bounds(rest.points));
  add_corners(run, rest.points);
  run.rest = {run.corners.at(0), run.corners[7]};
  run.radius = numbers(rest.point_columns, "radius").at(0);
  choose_arrays(run, run.folder / rows[0].file, options);
  read_particles(run, rows, rest.points.size(), options);
  if (run.has("supports")) read_supports(run);
  choose_cells(run);
  run.has_bones = first_frame(run, "bones").cells() > 0;
  if (options.live) make_room(run);
  run.moment = frame_at(run.times, options.time.value_or(run.moment));
  return run;
}

}  // namespace sinew
