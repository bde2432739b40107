// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/snapshots.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>

#include <sinew/core/arrays.h>
#include <sinew/core/dataset.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/metrics/pair_forces.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/render/camera.h>
#include <sinew/run/run_files.h>
#include <sinew/run/scene_picture.h>

namespace sinew {

Snapshot snapshot_of(const RunFiles& run, RunFrame frame, double angle) {
  Snapshot snapshot;
  snapshot.caption = three_digits(frame.time) + " s,  " +
                     std::to_string(static_cast<int>(std::lround(degrees(angle)))) + "\u00b0";
  snapshot.particles = std::move(frame.positions);
  snapshot.radius = run.body.particles.radius;
  snapshot.values = std::move(frame.displacement);
  snapshot.surface = {std::move(frame.surface_points), run.surface.faces};
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    const RigidFrame& bone = frame.bones[b];
    const Vec3 tail = bone.origin + frame.bone_lengths[b] * bone.rotation.col(0);
    snapshot.bones.push_back({bone.origin, tail, bone.rotation});
  }
  return snapshot;
}

namespace {

struct MeasuredArray {
  std::string_view name, unit;
  std::vector<double> ParticleValues::*values;
};

constexpr std::array<MeasuredArray, 6> measured_arrays = {{
    {"strain", "", &ParticleValues::strain},
    {"stretch", "", &ParticleValues::stretch},
    {"J", "", &ParticleValues::J},
    {"D2min", "m^2", &ParticleValues::D2min},
    {"von_mises", "Pa", &ParticleValues::von_mises},
    {"speed", "m/s", &ParticleValues::speed},
}};

const MeasuredArray* find_measured(const std::string& name) {
  for (const MeasuredArray& array : measured_arrays)
    if (array.name == name) return &array;
  return nullptr;
}

Error unknown(const std::string& name) {
  std::vector<std::string_view> names;
  names.reserve(measured_arrays.size());
  for (const MeasuredArray& array : measured_arrays) names.push_back(array.name);
  for (const WrittenArray& array : written_arrays())
    if (array.series == "particles" && array.place == ArrayPlace::point && array.name != "Points")
      names.push_back(array.name);
  return bad_input("particles have no array " + shown(name), suggestion(name, names));
}

Dataset columns_of(const RunFiles& run, std::size_t index, const std::string& name) {
  const auto file = run.folder.path / run.particle_rows[index].file;
  Dataset data = read_vtu(file, {name.c_str()});
  if (!find(data.point_columns, name))
    throw bad_input(Place{file.string()}, "has no array " + shown(name),
                    "choose another one; sinew info FILE lists them");
  if (data.points.size() != run.body.particles.size())
    throw bad_input(Place{file.string()}, "has another number of particles than the run",
                    "run the scene again with --force");
  return data;
}

}  // namespace

DrawnValues::DrawnValues(const RunFiles& run, const std::string& name) : run_(&run), name_(name) {
  if (const MeasuredArray* array = find_measured(name)) {
    unit_ = array->unit;
    rest_ = std::make_shared<RestBody>(rest_body(measured_body(run)));
    if (name == "von_mises" && !knows_forces(*rest_, {}) && read_frame(run, 0).von_mises.empty())
      throw bad_input("the forces of this run do not follow from its positions alone",
                      "run the scene with output.arrays von_mises");
    return;
  }
  const WrittenArray* array = find_written("particles", ArrayPlace::point, name);
  if (!array || name == "Points") throw unknown(name);
  if (array->unit != "1") unit_ = array->unit;
  components_ = std::max<int>(1, static_cast<int>(array->components.size()));
}

std::vector<double> DrawnValues::measured(const RunFrame& frame) const {
  const FrameState state = measured_frame(frame);
  return particle_values(*rest_, state).*find_measured(name_)->values;
}

std::vector<double> DrawnValues::at(std::size_t index, const RunFrame& frame) const {
  if (rest_) return measured(frame);
  if (name_ == "displacement") return frame.displacement;
  if (components_ == 1) {
    const Dataset data = columns_of(*run_, index, name_);
    const Column& column = *find(data.point_columns, name_);
    if (const auto* whole = std::get_if<std::vector<std::int32_t>>(&column.values))
      return {whole->begin(), whole->end()};
    return numbers(data.point_columns, name_);
  }
  std::vector<double> sizes;
  for (const Vec3& vector : drawn_vectors(*run_, index, name_)) sizes.push_back(vector.norm());
  return sizes;
}

DrawnValues::Range DrawnValues::range_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return value != value; });
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t outliers = values.size() / 100;
  const double low = values[outliers], high = values[values.size() - 1 - outliers];
  return {values.front() >= 0 && low < high / 2 ? 0 : low, high};
}

Points drawn_vectors(const RunFiles& run, std::size_t index, const std::string& name) {
  return vectors(columns_of(run, index, name).point_columns, name);
}

namespace {

constexpr std::size_t most_arrows = 900;  // more would hide each other
constexpr double longest_arrow = 0.25;    // of the body's longest side
constexpr double shortest_arrow = 0.1;    // of the longest: shorter ones are dots
constexpr double least_turn = 0.01;       // rad: below it the bones do not move
constexpr std::size_t moments_without_turn = 5;

double largest_turn(const RunFiles& run, const RunFrame& frame) {
  double most = 0;
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    const Mat3 turn = frame.bones[b].rotation * run.skeleton.bones[b].rest.rotation.transpose();
    most = std::max(most, Eigen::AngleAxisd(turn).angle());
  }
  return most;
}

/// Evenly over all frames, including the first and the last.
std::vector<std::size_t> spread_over(std::size_t frames) {
  const std::size_t count = std::min(frames, moments_without_turn);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k)
    chosen.push_back(count == 1 ? 0 : k * (frames - 1) / (count - 1));
  return chosen;
}

void widen(DrawnValues::Range& range, const DrawnValues::Range& other, bool first) {
  range.low = first ? other.low : std::min(range.low, other.low);
  range.high = first ? other.high : std::max(range.high, other.high);
}

}  // namespace

DrawnRun::DrawnRun(const std::string& folder, const std::vector<ViewPreset>& presets,
                   const std::string& array, const Mat3& view, bool ahead)
    : run_(open_run({folder})), view_(view) {
  for (const ViewPreset& preset : presets)
    views_.push_back(
        {preset, DrawnValues(run_, array.empty() ? std::string(preset.array) : array), {}});
  if (const auto world = world_of_run(run_)) marks_ = written_marks(*world);
  read_overview(view, ahead);
}

/// Of the particles in the frames.
std::vector<Mark> DrawnRun::written_marks(const World& world) const {
  std::vector<Mark> marks(run_.body.particles.size(), Mark::none);
  for (const Pinned& pin : world.pins) {
    if (run_.ids.empty()) {
      marks[pin.particle] = Mark::held;
      continue;
    }
    const auto id = static_cast<std::int32_t>(pin.particle);
    const auto at = std::lower_bound(run_.ids.begin(), run_.ids.end(), id);
    if (at != run_.ids.end() && *at == id) marks[at - run_.ids.begin()] = Mark::held;
  }
  return marks;
}

void DrawnRun::read_overview(const Mat3& view, bool ahead) {
  FramesInOrder frames(run_, ahead);
  Box body;
  for (std::size_t i = 0; i < run_.frames(); ++i) {
    RunFrame frame = frames.next();
    overview_.angle.push_back(largest_turn(run_, frame));
    for (DrawnView& drawn : views_)
      widen(drawn.range, DrawnValues::range_of(drawn.values.at(i, frame)), i == 0);
    body.extend(bounds(frame.positions)).extend(bounds(frame.surface_points));
    overview_.frame.extend(seen(view, snapshot_of(run_, std::move(frame), 0)));
  }
  overview_.obstacle_space = obstacle_space(body);
  for (std::size_t i = 0; i < run_.obstacle_rows.size(); ++i) {
    Snapshot obstacles;
    add_obstacles(obstacles, i);
    overview_.frame.extend(seen(view, obstacles));
  }
}

std::string DrawnRun::name() const {
  const auto path = std::filesystem::absolute(run_.folder.path / ".").lexically_normal();
  return path.parent_path().filename();
}

std::size_t DrawnRun::frame_at(double time) const {
  const auto& rows = run_.particle_rows;
  const auto nearer = [time](const PvdRow& a, const PvdRow& b) {
    return std::abs(a.time - time) < std::abs(b.time - time);
  };
  return static_cast<std::size_t>(
      std::min_element(rows.begin(), rows.begin() + run_.frames(), nearer) - rows.begin());
}

std::vector<std::size_t> DrawnRun::key_frames() const {
  const std::vector<double>& angle = overview_.angle;
  const double most = *std::max_element(angle.begin(), angle.end());
  if (most < least_turn) return spread_over(angle.size());
  std::size_t half = 0, farthest = 0;
  while (angle[half] < most / 2) ++half;
  for (std::size_t i = 0; i < angle.size(); ++i)
    if (angle[i] >= most * (1 - 1e-5)) farthest = i;
  std::vector<std::size_t> frames{0, half, farthest, angle.size() - 1};
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

/// The cut is vertical, across the viewer's direction at rest, and deforms with the body, so that
/// the same particles are seen at all times.
void DrawnRun::cut_open(Snapshot& snapshot) const {
  const Points rest = positions_of(run_.body.particles);
  const Vec3 back = view_.row(2);
  Vec3 across = Vec3::UnitY();
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())})
    if (std::abs(axis.dot(back)) > std::abs(across.dot(back))) across = axis;
  if (across.dot(back) < 0) across = -across;
  const double middle = across.dot(bounds(rest).center());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (across.dot(rest[i]) > middle) continue;
    snapshot.particles[kept] = snapshot.particles[i];
    if (!snapshot.marks.empty()) snapshot.marks[kept] = snapshot.marks[i];
    snapshot.values[kept++] = snapshot.values[i];
  }
  snapshot.particles.resize(kept);
  if (!snapshot.marks.empty()) snapshot.marks.resize(kept);
  snapshot.values.resize(kept);
}

void DrawnRun::add_arrows(Snapshot& snapshot, std::size_t index, const DrawnView& drawn) const {
  const Points vectors = drawn_vectors(run_, index, drawn.values.name());
  const double size = bounds(positions_of(run_.body.particles)).sizes().maxCoeff();
  const double strongest = drawn.range.high;
  if (!(strongest > 0)) return;
  const std::size_t stride = std::max<std::size_t>(1, vectors.size() / most_arrows);
  for (std::size_t i = 0; i < vectors.size(); i += stride) {
    const double force = vectors[i].norm();
    if (!(force > shortest_arrow * strongest)) continue;
    const double length = longest_arrow * size * std::min(1.0, force / strongest);
    snapshot.arrows.push_back({snapshot.particles[i], length / force * vectors[i], force});
  }
}

void DrawnRun::add_obstacles(Snapshot& snapshot, std::size_t index) const {
  snapshot.obstacles = read_obstacles(run_, index);
  snapshot.obstacle_space = overview_.obstacle_space;
}

Snapshot DrawnRun::snapshot(std::size_t index, const DrawnView& drawn) const {
  RunFrame frame = read_frame(run_, index);
  std::vector<double> values = drawn.values.at(index, frame);
  Snapshot snapshot = snapshot_of(run_, std::move(frame), overview_.angle[index]);
  snapshot.values = std::move(values);
  snapshot.marks = marks_;
  add_obstacles(snapshot, index);
  if (drawn.preset.cut_open) cut_open(snapshot);
  if (drawn.preset.view == View::arrows) add_arrows(snapshot, index, drawn);
  return snapshot;
}

}  // namespace sinew
