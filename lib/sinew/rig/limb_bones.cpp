// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/limbs.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <sinew/core/decompositions.h>

namespace sinew {
namespace {

constexpr double straight = 0.35;       // distances from the surface: curves within are lines
constexpr double max_of_stem = 0.4;     // largest part of a limb in the ball where it begins
constexpr double root_fraction = 0.15;  // fraction of two limbs, on either side of where they begin
constexpr double min_bone = 3;          // length of bones in distances from the surface
constexpr int max_alike = 5;            // bones of a straight limb
constexpr double trunk_fraction = 0.4;  // fraction of the angle, where a limb holds others
constexpr double stout_fraction = 0.67;  // fraction of the angle, where a limb is as thick as long
constexpr double long_trunk = 3;         // in distances from the surface: such limbs bend

/// A line with the length up to each of its points.
class Course {
 public:
  explicit Course(const Limb& limb) : line_(limb.line), inner_(limb.inner), so_far_(1, 0.0) {
    for (std::size_t i = 1; i < line_.size(); ++i)
      so_far_.push_back(so_far_.back() + (line_[i] - line_[i - 1]).norm());
  }

  double length() const { return so_far_.back(); }
  Vec3 at(double place) const { return mixed(line_, place); }
  double inner(double place) const { return mixed(inner_, place); }

  /// Lengths along the line at which its bones between two places begin and end: within the
  /// tolerance of the line (Douglas and Peucker).
  void add_knots(double from, double to, double least, std::vector<double>& knots) const {
    const Vec3 head = at(from), chord = at(to) - head;
    double worst = 1, where = 0;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      if (so_far_[i] <= from || so_far_[i] >= to) continue;
      const double fraction =
          std::clamp(chord.dot(line_[i] - head) / chord.squaredNorm(), 0.0, 1.0);
      const double off = (line_[i] - head - fraction * chord).norm();
      const double excess = off / std::max(straight * inner_[i], least);
      if (excess > worst) worst = excess, where = so_far_[i];
    }
    if (worst > 1)
      add_knots(from, where, least, knots), add_knots(where, to, least, knots);
    else
      knots.push_back(to);
  }

 private:
  template <class T>
  T mixed(const std::vector<T>& values, double place) const {
    std::size_t i = 1;
    while (i + 1 < so_far_.size() && so_far_[i] < place) ++i;
    const double span = so_far_[i] - so_far_[i - 1];
    const double fraction = span > 0 ? std::clamp((place - so_far_[i - 1]) / span, 0.0, 1.0) : 0;
    return (1 - fraction) * values[i - 1] + fraction * values[i];
  }

  const Points& line_;
  const std::vector<double>& inner_;
  std::vector<double> so_far_;
};

/// Cuts the pieces that are longer than `longest` into equal ones.
std::vector<double> divided(double from, const std::vector<double>& knots, double longest) {
  std::vector<double> all;
  for (const double to : knots) {
    const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / longest - 1e-6)));
    for (int i = 1; i <= pieces; ++i) all.push_back(from + (to - from) * i / pieces);
    from = to;
  }
  return all;
}

/// Joins pieces that are too short for a bone to a neighbor.
void join_short(double from, double least, std::vector<double>& knots) {
  for (std::size_t i = 0; knots.size() > 1 && i < knots.size();) {
    if (knots[i] - (i == 0 ? from : knots[i - 1]) >= least)
      ++i;
    else
      knots.erase(knots.begin() + static_cast<std::ptrdiff_t>(i + 1 < knots.size() ? i : i - 1));
  }
}

/// The direction in which the lines of the body spread the least, then the others.
Mat3 thin_axes(const std::vector<Limb>& limbs, int body) {
  Mat3 spread = Mat3::Zero();
  Box box;
  for (const Limb& limb : limbs)
    if (limb.body == body)
      for (const Vec3& p : limb.line) box.extend(p);
  for (const Limb& limb : limbs)
    if (limb.body == body)
      for (const Vec3& p : limb.line) spread += (p - box.center()) * (p - box.center()).transpose();
  Mat3 axes = principal_axes(spread).axes;
  for (int i = 0; i < 3; ++i) {
    Eigen::Index widest = 0;
    axes.col(i).cwiseAbs().maxCoeff(&widest);
    if (axes(widest, i) < 0) axes.col(i) *= -1;
  }
  return axes;
}

class Maker {
 public:
  Maker(const std::vector<Limb>& limbs, const LimbRigOptions& options)
      : limbs_(limbs), options_(options), last_(limbs.size()) {}

  LimbRig made() {
    const int bodies = limbs_.empty() ? 0 : limbs_.back().body + 1;
    for (int body = 0; body < bodies; ++body) add_body(body, bodies);
    return std::move(rig_);
  }

 private:
  struct Begin {
    double place;  ///< along the limb, where its first bone begins
    std::string parent;
    bool stem;  ///< the first bone does not move
  };

  void add_body(int body, int bodies) {
    axes_ = thin_axes(limbs_, body);
    root_ = bodies == 1 ? "root" : "root" + std::to_string(body + 1);
    prefix_ = bodies == 1 ? "" : "part" + std::to_string(body + 1) + "_";
    std::vector<int> first;
    for (std::size_t i = 0; i < limbs_.size(); ++i)
      if (limbs_[i].body == body && limbs_[i].parent < 0) first.push_back(static_cast<int>(i));
    std::stable_sort(first.begin(), first.end(),
                     [&](int a, int b) { return length(limbs_[a]) > length(limbs_[b]); });
    const double begun = first.size() == 2 ? add_root_between(first) : add_root_along(first[0]);
    for (const int i : first) {
      const bool two = first.size() == 2;
      add_limb(i, {two || i == first[0] ? begun : 0, root_, !two && i != first[0]});
    }
    for (std::size_t i = 0; i < limbs_.size(); ++i)
      if (limbs_[i].body == body && limbs_[i].parent >= 0)
        add_limb(static_cast<int>(i), {0, last_[limbs_[i].parent], true});
  }

  /// Adds a bone from one limb to the other, as long as that is about straight.
  double add_root_between(const std::vector<int>& two) {
    const Course a(limbs_[two[0]]), b(limbs_[two[1]]);
    const double inner = a.inner(0);
    double half = std::min(root_fraction * (a.length() + b.length()), b.length() / 3);
    while (half > inner / 4 && ((a.at(half) + b.at(half)) / 2 - a.at(0)).norm() > straight * inner)
      half *= 0.8;
    add_bone(root_, "", b.at(half), a.at(half));
    return half;
  }

  double add_root_along(int limb) {
    const Course course(limbs_[limb]);
    const double place = stem_of(course);
    add_bone(root_, "", course.at(0), course.at(place));
    return place;
  }

  static double stem_of(const Course& course) {
    return std::min(course.inner(0), max_of_stem * course.length());
  }

  void add_bone(const std::string& name, const std::string& parent, const Vec3& head,
                const Vec3& tail) {
    BoneDefinition& bone = rig_.bones.emplace_back();
    bone.name = name, bone.parent = parent;
    bone.tail = tail;
    const bool connected =
        !parent.empty() && (tail_of(parent) - head).norm() < 1e-9 * (1 + head.norm());
    if (!connected) bone.head = head;
  }

  Vec3 tail_of(const std::string& name) const {
    for (const BoneDefinition& bone : rig_.bones)
      if (bone.name == name) return *bone.tail;
    return Vec3::Zero();
  }

  void add_limb(int number, const Begin& begin) {
    const Limb& limb = limbs_[number];
    const Course course(limb);
    const bool trunk = limb.end == Limb::End::fork;
    const std::string name = prefix_ + (trunk ? "trunk" : "limb") + std::to_string(number + 1);
    const double end =
        course.length() - (trunk ? 0 : std::min(options_.radius, course.length() / 4));
    double place = begin.place;
    std::string parent = begin.parent;
    if (begin.stem) {
      place = stem_of(course);
      add_bone(name, parent, course.at(0), course.at(place));
      parent = name;
    }
    last_[number] = parent;
    if (end - place < options_.radius) return;  // the stem is all there is
    add_chain(number, name, parent, course, place, end);
  }

  void add_chain(int number, const std::string& name, std::string parent, const Course& course,
                 double place, double end) {
    const double inner = mean_inner(course, place, end), from = place;
    std::vector<double> knots;
    course.add_knots(place, end, options_.radius / 2, knots);
    const double longest = std::max((end - place) / max_alike, min_bone * inner);
    knots = divided(place, knots, std::min(longest, std::max((end - place) / 2, 2 * inner)));
    join_short(place, std::max(2 * options_.radius, inner / 2), knots);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < knots.size(); ++i) {
      names.push_back(name + '_' + std::to_string(i + 1));
      add_bone(names.back(), parent, course.at(i == 0 ? from : knots[i - 1]), course.at(knots[i]));
      parent = names.back();
    }
    last_[number] = parent;
    move(number, names, course.at(end) - course.at(place), (end - place) / inner);
  }

  static double mean_inner(const Course& course, double from, double to) {
    constexpr int samples = 16;
    double sum = 0;
    for (int i = 0; i < samples; ++i) sum += course.inner(from + (to - from) * i / samples);
    return sum / samples;
  }

  /// Bends the bones of a limb about one axis; `slender`: its length in distances from the surface.
  void move(int number, const std::vector<std::string>& names, const Vec3& chord, double slender) {
    const Limb& limb = limbs_[number];
    const bool loop = closes_loop(number);
    double angle = options_.angle;
    if (limb.on_ring && !loop) return;
    if (limb.end == Limb::End::fork)
      angle *= slender < long_trunk ? 0 : trunk_fraction;
    else if (slender < long_trunk)
      angle *= stout_fraction;
    if (angle == 0) return;
    const Vec3 axis = bend_axis(loop ? Vec3(limb.line.back() - limb.line.front()) : chord);
    for (const std::string& name : names)
      rig_.tracks.push_back(track_of(name, axis, angle / static_cast<double>(names.size())));
  }

  /// Whether another limb from the same place ends where this one does: both bend about one axis.
  bool closes_loop(int number) const {
    const Limb& limb = limbs_[number];
    for (const Limb& other : limbs_)
      if (&other != &limb && other.body == limb.body && other.parent == limb.parent &&
          other.end == Limb::End::ring && limb.end == Limb::End::ring &&
          (other.line.back() - limb.line.back()).norm() < limb.inner.back())
        return true;
    return false;
  }

  /// Across the limb, towards the thin side of the body unless the limb goes there.
  Vec3 bend_axis(const Vec3& chord) const {
    constexpr double along = 0.8;
    const Vec3 direction = chord.normalized();
    const int side = std::abs(direction.dot(axes_.col(0))) < along ? 0 : 1;
    return direction.cross(axes_.col(side)).normalized();
  }

  TrackDefinition track_of(const std::string& bone, const Vec3& axis, double angle) const {
    TrackDefinition track;
    track.bone = bone;
    const double bent = options_.bend, back = bent + options_.hold;
    for (const auto& [time, now] :
         {std::pair{0.0, 0.0}, {bent, angle}, {back, angle}, {back + options_.bend, 0.0}}) {
      KeyDefinition& key = track.keys.emplace_back();
      key.time = time, key.axis = axis, key.angle = now;
    }
    return track;
  }

  const std::vector<Limb>& limbs_;
  const LimbRigOptions& options_;
  LimbRig rig_;
  std::vector<std::string> last_;  ///< bone of each limb at which others begin
  Mat3 axes_ = Mat3::Identity();
  std::string root_, prefix_;
};

}  // namespace

LimbRig bones_of(const std::vector<Limb>& limbs, const LimbRigOptions& options) {
  return Maker(limbs, options).made();
}

}  // namespace sinew
