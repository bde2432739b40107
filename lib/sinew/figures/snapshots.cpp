// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/snapshots.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <string_view>

#include <sinew/core/error.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/text.h>
#include <sinew/figures/scene_picture.h>
#include <sinew/figures/view_ranges.h>
#include <sinew/render/camera.h>
#include <sinew/run/run_files.h>

namespace sinew {

Snapshot snapshot_of(const RunFiles& run, FrameState frame, double angle) {
  Snapshot snapshot;
  snapshot.values = displacements(run, frame);
  snapshot.caption = three_digits(frame.time) + " s";
  if (!frame.bones.empty())
    snapshot.caption += ",  " + std::to_string(std::lround(degrees(angle))) + "\u00b0";
  snapshot.particles = std::move(frame.positions);
  snapshot.radius = run.body.particles.radius;
  snapshot.surface = {std::move(frame.surface_points), run.surface.faces};
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    const RigidFrame& bone = frame.bones[b];
    const Vec3 tail = bone.origin + frame.bone_lengths[b] * bone.rotation.col(0);
    snapshot.bones.push_back({bone.origin, tail, bone.rotation});
  }
  return snapshot;
}

namespace {

std::vector<SnapshotForce> arrows_of(const std::vector<ShownForce>& forces) {
  std::vector<SnapshotForce> arrows;
  arrows.reserve(forces.size());
  for (const ShownForce& one : forces) arrows.push_back({one.from, one.along, one.is_load});
  return arrows;
}

constexpr double longest_arrow = 0.25;   // fraction of the body's longest side
constexpr double shortest_arrow = 0.05;  // fraction of the longest: shorter ones are dots
constexpr double arrow_spacing = 0.03;  // fraction of the longest side: closer ones hide each other
constexpr double weakest_line = 0.1;    // fraction of the largest stress: below it the lines end
constexpr double beside_plane = 1.1;    // radii: one layer of particles

std::vector<std::size_t> traced_places(const RunFiles& run, const std::vector<int>& ids) {
  std::vector<std::size_t> places;
  for (const int id : ids) {
    const std::ptrdiff_t place = id < 0 ? -1 : place_in_frames(run, static_cast<std::size_t>(id));
    const auto last =
        run.ids.empty() ? run.body.particles.size() - 1 : static_cast<std::size_t>(run.ids.back());
    const std::size_t first = run.ids.empty() ? 0 : static_cast<std::size_t>(run.ids.front());
    if (place < 0)
      throw bad_input(Place{run.folder.path.string()},
                      "the frames have no particle " + std::to_string(id),
                      "give ids of them, which lie from " + std::to_string(first) + " to " +
                          std::to_string(last) + ": --trace " + std::to_string(last));
    places.push_back(static_cast<std::size_t>(place));
  }
  return places;
}

Vec3 mean_of(const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

/// The quadratic mean of the distances between two sets of points, each about its mean, m.
double distance_about_means(const Points& a, const Points& b) {
  const Vec3 apart = mean_of(a) - mean_of(b);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i] - apart).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
}

double quadratic_mean(const std::vector<double>& values) {
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double largest_of(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

/// What is shown where nobody asked for an array: strain as the run has written it. Of bodies for
/// which it has not, since they are large, the displacement.
std::string array_of(const ViewPreset& preset, const RunFiles& run) {
  if (preset.array != deformation) return std::string(preset.array);
  return has_array(run, run.particle_rows.front(), "strain_eq") ? "strain_eq" : "displacement";
}

}  // namespace

std::string DrawnView::quantity() const {
  return bonds || pulls || preset.view == View::curves ? "" : quantity_of(values.quantity());
}

DrawnRun::DrawnRun(const std::string& folder, DrawnRunOptions options)
    : run_(open_run({folder})), options_(std::move(options)) {
  apply_presets();
  ranges_ = run_.ranges;
  if (options_.by_front) face_front();
  select_bones();
  for (const std::size_t held : held_in_frames(run_)) {
    marks_.resize(run_.body.particles.size(), Mark::none);
    marks_[held] = Mark::held;
  }
  forces_.emplace(run_);
  read_overview();
}

void DrawnRun::apply_presets() {
  for (const ViewPreset& preset : options_.presets) try {
      views_.push_back(applied(preset));
    } catch (const Error& error) {
      if (error.exit() != Exit::bad_input || options_.presets.size() == 1) throw;
      left_out_.push_back({std::string(preset.name), error.what()});
    }
  if (views_.empty() && !left_out_.empty()) applied(options_.presets.front());  // throws
}

DrawnView DrawnRun::applied(const ViewPreset& preset) const {
  const std::string array = options_.array.empty() ? array_of(preset, run_) : options_.array;
  if (preset.view == View::lines)
    return {preset, DrawnValues(run_, "displacement"), {}, DrawnBonds(run_, array), {}};
  if (preset.view != View::binding) {
    DrawnView drawn{preset, DrawnValues(run_, array), {}, {}, {}};
    const bool has_skin = preset.view == View::surface || preset.name == "body";
    if (preset.view == View::halves || preset.view == View::cut ||
        (has_skin && !options_.array.empty()))
      drawn.skin.emplace(run_, drawn.values);
    if (preset.view == View::cut || preset.view == View::curves) drawn.volume = volume();
    if (preset.view == View::curves)
      largest_principals(drawn.values.column(0, read_frame(run_, 0)));
    return drawn;
  }
  if (!options_.array.empty())
    throw bad_input("the view binding shows forces of bones, not the array " + shown(array),
                    "leave out --array, or choose another view: --view forces");
  return {preset, DrawnValues(run_, array), {}, {}, DrawnPulls(run_)};
}

/// All views share it.
std::shared_ptr<const DrawnVolume> DrawnRun::volume() const {
  if (!volume_) volume_ = std::make_shared<DrawnVolume>(run_);
  return volume_;
}

DrawnView DrawnRun::cut_open(const DrawnView& body) const {
  DrawnView cut = body;
  cut.preset = view_preset_named("cut");
  cut.skin.emplace(run_, cut.values);
  cut.volume = volume();
  return cut;
}

void DrawnRun::select_bones() {
  if (options_.bones.empty()) return;
  selected_.resize(run_.skeleton.size());
  std::vector<std::string_view> names;
  for (const Bone& bone : run_.skeleton.bones) names.push_back(bone.name);
  for (const std::string& name : options_.bones) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw bad_input(Place{run_.folder.path.string()}, "there is no bone " + shown(name),
                      suggestion(name, names));
    selected_[static_cast<std::size_t>(found - names.begin())] = true;
  }
}

bool DrawnRun::is_selected(std::size_t particle) const {
  if (selected_.empty()) return true;
  const std::int32_t bone = (*run_.body.bone)[particle];
  return bone >= 0 && selected_[static_cast<std::size_t>(bone)];
}

void DrawnRun::Extent::extend(const Mat3& view, const Snapshot& snapshot) {
  frame.extend(seen(view, snapshot));
  around.extend(snapshot);
}

double DrawnRun::strongest_pull(const FrameState& frame, const DrawnView& drawn) const {
  double strongest = 0;
  for (const DrawnPull& pull : drawn.pulls->at(frame))
    if (is_selected(pull.particle)) strongest = std::max(strongest, pull.strongest());
  return strongest;
}

/// The values of a frame from which the range of a view comes.
std::vector<double> DrawnRun::colored(std::size_t index, const FrameState& frame,
                                      const DrawnView& drawn) const {
  if (drawn.preset.view == View::curves)
    return largest_principals(drawn.values.column(index, frame));
  if (!drawn.bonds)
    return drawn.skin && !drawn.values.is_of_particles() ? drawn.skin->at(index, frame)
                                                         : drawn.values.at(index, frame);
  std::vector<double> values;
  for (const DrawnBond& bond : drawn.bonds->at(index)) values.push_back(bond.value);
  return values;
}

/// Refuses a plane that misses the body at all times; `body` is around it then.
void DrawnRun::check_plane(const Box& body) const {
  if (!options_.plane) return;
  bool before = false, behind = false;
  for (int corner = 0; corner < 8; ++corner)
    (options_.plane->distance(body.corner(static_cast<Box::CornerType>(corner))) > 0 ? before
                                                                                     : behind) =
        true;
  if (before && behind) return;
  const auto words = [](const Vec3& place) {
    return three_digits(place.x()) + ',' + three_digits(place.y()) + ',' + three_digits(place.z());
  };
  throw bad_input(
      "the plane does not meet the body",
      "give a point on it between " + words(body.min()) + " and " + words(body.max()) + " m");
}

/// Turns the view by as much as the figure is turned from -y in the first frame.
void DrawnRun::face_front() {
  const auto front = front_in(run_, read_frame(run_, 0));
  if (!front) return;
  const double angle = std::atan2(front->x(), -front->y());
  options_.view = options_.view * Eigen::AngleAxisd(-angle, Vec3::UnitZ()).toRotationMatrix();
}

Vec3 DrawnRun::travel(std::size_t index) const {
  return overview_.travel.empty() ? Vec3::Zero().eval() : overview_.travel[index];
}

/// What is found on the way through the frames.
struct DrawnRun::Walk {
  std::vector<std::size_t> traced;
  Vec3 start;              ///< mean place of the particles at rest, m
  Extent still, followed;  ///< for cameras that stay, and that follow the body
  JointTurns turns;
  RangesOfViews ranges;
  Box body = {}, body_followed = {};
  double farthest = 0;  ///< how far the body goes over the ground, m
  Turned widest = {};
  Points first = {};  ///< particles of the first frame, m
};

void DrawnRun::read_overview() {
  const Points rest = positions_of(run_.body.particles);
  overview_.origin = local_origin(bounds(run_.surface.points));
  overview_.around.axis = bounds(rest).center() - overview_.origin;
  const Extent around{{}, overview_.around};
  Walk walk{traced_places(run_, options_.traced),
            mean_of(rest),
            around,
            around,
            JointTurns(run_),
            RangesOfViews(ranges_)};
  overview_.paths.resize(walk.traced.size());
  FramesInOrder frames(run_, options_.ahead);
  for (std::size_t i = 0; i < run_.frames(); ++i) add(walk, i, frames.next());
  for (std::size_t v = 0; v < views_.size(); ++v) walk.ranges.put(views_[v], v);
  if (walk.widest.angle > 0) overview_.turned = run_.skeleton.bones[walk.widest.bone].name;
  // Bodies that go farther than they are large are followed, but where paths are drawn.
  const bool follows =
      options_.follows && walk.traced.empty() && walk.farthest > bounds(rest).diagonal().norm();
  if (!follows) overview_.travel.clear();
  check_plane(walk.body);
  overview_.plane =
      options_.plane ? DrawnPlane(*options_.plane) : DrawnPlane(run_, walk.turns, options_.view);
  overview_.obstacle_space =
      obstacle_space((follows ? walk.body_followed : walk.body).translated(-overview_.origin));
  add_surroundings(follows ? walk.followed : walk.still);
}

void DrawnRun::add(Walk& walk, std::size_t index, FrameState frame) {
  const Turned turned = largest_turn(run_, frame);
  overview_.angle.push_back(turned.angle);
  if (turned.angle > walk.widest.angle) walk.widest = turned;
  walk.turns.add(frame);
  const std::vector<double> moved_by = displacements(run_, frame);
  overview_.shift.push_back(quadratic_mean(moved_by));
  overview_.farthest.push_back(largest_of(moved_by));
  if (index == 0) walk.first = frame.positions;
  overview_.from_start.push_back(distance_about_means(walk.first, frame.positions));
  for (std::size_t v = 0; v < views_.size(); ++v) {
    DrawnView& drawn = views_[v];
    if (drawn.pulls) drawn.range.high = std::max(drawn.range.high, strongest_pull(frame, drawn));
    if (walk.ranges.wants(drawn, v)) walk.ranges.add(drawn, v, colored(index, frame, drawn));
  }
  for (std::size_t k = 0; k < walk.traced.size(); ++k)
    overview_.paths[k].push_back(frame.positions[walk.traced[k]]);
  add_extent(walk, std::move(frame));
}

/// How far the body goes, and what cameras have to show of it.
void DrawnRun::add_extent(Walk& walk, FrameState frame) {
  const Box now = bounds(frame.positions).merged(bounds(frame.surface_points));
  const Vec3 moved = mean_of(frame.positions) - walk.start;
  const Vec3& travel = overview_.travel.emplace_back(moved.x(), moved.y(), 0);
  walk.farthest = std::max(walk.farthest, travel.norm());
  walk.body.extend(now), walk.body_followed.extend(now.translated(-travel));
  Snapshot snapshot = snapshot_of(run_, std::move(frame), 0);
  sinew::shift(snapshot, -overview_.origin);
  walk.still.extend(options_.view, snapshot);
  sinew::shift(snapshot, -travel);
  walk.followed.extend(options_.view, snapshot);
}

/// Sets the extents of the overview: those of the body, and of what is around it.
void DrawnRun::add_surroundings(Extent extent) {
  const auto add = [&](Snapshot& snapshot, std::size_t index) {
    sinew::shift(snapshot, -overview_.origin - travel(index));
    extent.extend(options_.view, snapshot);
  };
  for (std::size_t i = 0; i < run_.obstacle_rows.size(); ++i) {
    Snapshot obstacles;
    add_obstacles(obstacles, i);
    add(obstacles, i);
  }
  for (std::size_t i = 0; i < run_.support_rows.size(); ++i) {
    Snapshot machine;
    machine.forces = arrows_of(forces_->at(i));
    add(machine, i);
  }
  overview_.frame = extent.frame;
  overview_.around = extent.around;
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

std::vector<KeyMoment> DrawnRun::key_moments() const {
  std::vector<KeyMoment> moments = sinew::key_moments(overview_, run_.body.particles.radius);
  if (run_.settings.solver.method != Method::dynamic)
    for (KeyMoment& moment : moments)
      if (moment.what.empty()) moment.what = "in equilibrium";
  return moments;
}

std::string DrawnRun::return_in_words() const {
  return sinew::return_in_words(overview_, run_.body.particles.radius);
}

/// Keeps some of the particles.
void DrawnRun::keep(Snapshot& snapshot, const std::function<bool(std::size_t i)>& is_kept) const {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < snapshot.particles.size(); ++i) {
    if (!is_kept(i)) continue;
    snapshot.particles[kept] = snapshot.particles[i];
    if (!snapshot.marks.empty()) snapshot.marks[kept] = snapshot.marks[i];
    snapshot.values[kept++] = snapshot.values[i];
  }
  snapshot.particles.resize(kept);
  if (!snapshot.marks.empty()) snapshot.marks.resize(kept);
  snapshot.values.resize(kept);
}

/// The cut is vertical, across the viewer's direction at rest, and deforms with the body, so that
/// the same particles are seen at all times.
void DrawnRun::show_section(Snapshot& snapshot) const {
  const Vec3 back = options_.view.row(2);
  Vec3 across = Vec3::UnitY();
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())})
    if (std::abs(axis.dot(back)) > std::abs(across.dot(back))) across = axis;
  if (across.dot(back) < 0) across = -across;
  const double middle = across.dot(bounds(positions_of(run_.body.particles)).center());
  const Points rest = positions_of(run_.body.particles);
  keep(snapshot, [&](std::size_t i) { return across.dot(rest[i]) <= middle; });
  snapshot.opened = true;
  std::vector<bool> is_before;  // one per bone that is drawn
  for (std::size_t b = 0; b < run_.skeleton.size(); ++b)
    if (const Bone& bone = run_.skeleton.bones[b]; selected_.empty() || selected_[b])
      is_before.push_back(across.dot(bone.head() + bone.tail()) / 2 > middle);
  hide_bones(snapshot, [&](std::size_t bone) { return is_before[bone]; });
}

/// Bones in the part that is left out would hang in the air.
void DrawnRun::hide_bones(Snapshot& snapshot,
                          const std::function<bool(std::size_t bone)>& is_left_out) const {
  std::vector<SnapshotBone> bones;
  for (std::size_t b = 0; b < snapshot.bones.size(); ++b)
    if (!is_left_out(b)) bones.push_back(snapshot.bones[b]);
  snapshot.bones = std::move(bones);
}

/// The skin left of the plane through the body's middle that the viewer sees edge-on at rest, the
/// particles right of it. It deforms with the body, too.
void DrawnRun::halve(Snapshot& snapshot) const {
  const Vec3 right = options_.view.row(0);
  const double middle = right.dot(bounds(positions_of(run_.body.particles)).center());
  for (const Vec3& rest : run_.surface.points)
    snapshot.skin_sides.push_back(right.dot(rest) - middle);
  const Points rest = positions_of(run_.body.particles);
  keep(snapshot, [&](std::size_t i) { return right.dot(rest[i]) > middle; });
}

/// The skin behind the plane alone.
void DrawnRun::open_skin(Snapshot& snapshot, const CutPlane& plane) const {
  snapshot.skin_sides.clear();
  for (const Vec3& point : snapshot.surface.points)
    snapshot.skin_sides.push_back(plane.distance(point));
  snapshot.opened = true;
  hide_bones(snapshot, [&](std::size_t b) {
    const SnapshotBone& bone = snapshot.bones[b];
    return plane.distance((bone.head + bone.tail) / 2) > snapshot.radius;
  });
}

void DrawnRun::color_skin(Snapshot& snapshot, std::vector<double> values) const {
  snapshot.skin_values = std::move(values);
  for (std::size_t i = 0; i < snapshot.skin_values.size(); ++i) {
    const std::int32_t bone = run_.surface_bone[i];
    if (!selected_.empty() && (bone < 0 || !selected_[static_cast<std::size_t>(bone)]))
      snapshot.skin_values[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

/// Arrows of the particles beside the plane: the strongest first, none close to another.
void DrawnRun::add_arrows(Snapshot& snapshot, std::size_t index, const DrawnView& drawn,
                          const CutPlane& plane) const {
  const Points vectors = drawn_vectors(run_, index, drawn.values.name());
  const double size = bounds(positions_of(run_.body.particles)).sizes().maxCoeff();
  const double strongest = drawn.range.high;
  if (!(strongest > 0)) return;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < vectors.size(); ++i)
    if (vectors[i].norm() > shortest_arrow * strongest && is_selected(i) &&
        std::abs(plane.distance(snapshot.particles[i])) < beside_plane * snapshot.radius)
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return vectors[a].squaredNorm() > vectors[b].squaredNorm();
  });
  const double apart = std::max(arrow_spacing * size, 1.9 * snapshot.radius);
  for (const std::size_t i : order) {
    const Vec3& from = snapshot.particles[i];
    if (std::any_of(snapshot.arrows.begin(), snapshot.arrows.end(),
                    [&](const SnapshotArrow& other) { return (other.from - from).norm() < apart; }))
      continue;
    const double force = vectors[i].norm();
    const double length = longest_arrow * size * std::min(1.0, force / strongest);
    snapshot.arrows.push_back({from, length / force * vectors[i], force});
  }
  open_skin(snapshot, plane);
}

/// Shows these particles alone, each with its reference point and the arrows of its forces.
void DrawnRun::add_pulls(Snapshot& snapshot, const std::vector<DrawnPull>& pulls,
                         const DrawnView& drawn) const {
  const double size = bounds(positions_of(run_.body.particles)).sizes().maxCoeff();
  const double scale = drawn.is_pulled() ? longest_arrow * size / drawn.range.high : 0;  // m/N
  snapshot.particles.clear(), snapshot.values.clear(), snapshot.marks.clear();
  for (const DrawnPull& pull : pulls) {
    if (!is_selected(pull.particle)) continue;
    snapshot.particles.push_back(pull.position);
    snapshot.references.push_back(pull.reference);
    snapshot.lines.push_back(
        {pull.reference, pull.position, std::numeric_limits<double>::quiet_NaN()});
    double number = 0;  // in the legend
    for (const Vec3& force : {pull.radial, pull.twist, pull.axial}) {
      if (scale * force.norm() > snapshot.radius)  // shorter ones lie within the sphere
        snapshot.arrows.push_back({pull.position, scale * force, number});
      ++number;
    }
  }
}

void DrawnRun::add_obstacles(Snapshot& snapshot, std::size_t index) const {
  snapshot.obstacles = read_obstacles(run_, index);
  snapshot.obstacle_space = overview_.obstacle_space;
}

/// Gray is what has no value.
void DrawnRun::show_selected(Snapshot& snapshot) const {
  if (selected_.empty()) return;
  std::vector<SnapshotBone> bones;
  for (std::size_t b = 0; b < snapshot.bones.size(); ++b)
    if (selected_[b]) bones.push_back(snapshot.bones[b]);
  snapshot.bones = std::move(bones);
  for (std::size_t i = 0; i < snapshot.values.size(); ++i)
    if (!is_selected(i)) snapshot.values[i] = std::numeric_limits<double>::quiet_NaN();
}

void DrawnRun::add_traces(Snapshot& snapshot, std::size_t index) const {
  for (std::size_t k = 0; k < overview_.paths.size(); ++k) {
    const auto begin = overview_.paths[k].begin();
    snapshot.traces.push_back({Points(begin, begin + static_cast<std::ptrdiff_t>(index) + 1),
                               std::to_string(options_.traced[k])});
  }
}

void DrawnRun::add_bonds(Snapshot& snapshot, std::size_t index, const DrawnView& drawn) const {
  for (const DrawnBond& bond : drawn.bonds->at(index)) {
    snapshot.lines.push_back({bond.from, bond.to, bond.value});
    if (!is_selected(static_cast<std::size_t>(bond.ends[0])) &&
        !is_selected(static_cast<std::size_t>(bond.ends[1])))
      snapshot.lines.back().value = std::numeric_limits<double>::quiet_NaN();
  }
}

Snapshot DrawnRun::snapshot(std::size_t index, const DrawnView& drawn) const {
  FrameState frame = read_frame(run_, index);
  const View view = drawn.preset.view;
  const CutPlane plane = overview_.plane->at(frame);
  const bool shows_particles = view != View::curves && (view != View::surface || !drawn.skin);
  std::vector<double> values, of_skin;
  if (shows_particles) values = drawn.values.at(index, frame);
  if (drawn.skin) of_skin = drawn.skin->at(index, frame);
  std::vector<DrawnPull> pulls;
  if (drawn.pulls) pulls = drawn.pulls->at(frame);
  DrawnVolume::Opened opened;
  if (view == View::cut) opened = drawn.volume->cut(index, frame, values, plane);
  std::vector<SnapshotCurve> curves;
  if (view == View::curves)
    curves = drawn.volume->lines(index, frame, drawn.values.column(index, frame),
                                 weakest_line * drawn.range.high);
  Snapshot snapshot = snapshot_of(run_, std::move(frame), overview_.angle[index]);
  snapshot.values = std::move(values);
  snapshot.marks = marks_;
  snapshot.cut = std::move(opened.cut);
  snapshot.curves = std::move(curves);
  show_selected(snapshot);
  color_skin(snapshot, std::move(of_skin));
  add_obstacles(snapshot, index);
  snapshot.forces = arrows_of(forces_->at(index));
  add_traces(snapshot, index);
  if (drawn.pulls) add_pulls(snapshot, pulls, drawn);
  if (drawn.bonds) add_bonds(snapshot, index, drawn);
  if (drawn.preset.cut_open) show_section(snapshot);
  if (view == View::halves) halve(snapshot);
  if (view == View::cut) {
    open_skin(snapshot, plane);
    const Points now = snapshot.particles;
    keep(snapshot, [&](std::size_t i) {
      return opened.in_hole[i] && plane.distance(now[i]) < -snapshot.radius;
    });
  }
  if (view == View::arrows) add_arrows(snapshot, index, drawn, plane);
  const Vec3 moved = travel(index);
  sinew::shift(snapshot, -overview_.origin - moved);
  if (!moved.isZero(0)) snapshot.caption += ",  " + three_digits(moved.norm()) + " m on";
  return snapshot;
}

}  // namespace sinew
