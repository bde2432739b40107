// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/figure/figure.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace sinew {
namespace {

// Radii of a grown human, of the height.
constexpr std::array<double, 3> leg_radii = {0.045, 0.032, 0.022}, arm_radii = {0.03, 0.024, 0.019};
constexpr double neck = 0.032, skull = 0.06, hips_deep = 0.058, waist_deep = 0.052,
                 chest_deep = 0.06, finger = 0.007;
constexpr double waist = 0.85;      // fraction of the width between hips and shoulders
constexpr double beside_arm = 1.3;  // radii of the upper arm, from its middle to the trunk
constexpr double room_kept = 0.8;   // fraction of the distance of two lines, for both radii
// Rigs that are no figure: of a bone's length, and of the rig's size.
constexpr double thick_bone = 0.2, thinnest_bone = 0.012, thickest_bone = 0.05;
constexpr double no_length = 1e-4;  // fraction of the height: what has a length

using Kind = FigurePart::Kind;

Vec3 nearest_on(const FigurePart& part, const Vec3& point) {
  const Vec3 along = part.to - part.from;
  const double square = along.squaredNorm();
  const double s = square > 0 ? std::clamp((point - part.from).dot(along) / square, 0.0, 1.0) : 0;
  return part.from + s * along;
}

bool is_body(const FigurePart& part) { return part.kind == Kind::trunk || part.kind == Kind::head; }

/// The half of a line that is farther from where two bones meet.
FigurePart outer_half(FigurePart part) {
  part.from = (part.from + part.to) / 2;
  return part;
}

/// Adds the parts of a figure one by one.
class Builder {
 public:
  Builder(const Skeleton& skeleton, const Anatomy& anatomy)
      : skeleton_(skeleton), anatomy_(anatomy), longest_(longest_children(skeleton)) {}

  std::vector<FigurePart> figure() {
    kinds_.assign(skeleton_.size(), Kind::limb);
    hands_.assign(skeleton_.size(), no_bone);
    done_.assign(skeleton_.size(), false);
    if (anatomy_.is_figure()) {
      leave_out_above(anatomy_.trunk);
      add_trunk();
      add_head();
      for (std::size_t side = 0; side < 2; ++side) {
        add_limb(anatomy_.legs(), side, leg_radii);
        add_limb(anatomy_.arms(), side, arm_radii);
      }
    }
    for (std::size_t b = 0; b < skeleton_.size(); ++b)
      if (!done_[b]) add_bone(static_cast<int>(b), usual_radius(b), kinds_[b]);
    return std::move(parts_);
  }

 private:
  double H() const { return anatomy_.height; }

  double usual_radius(std::size_t b) const {
    const double length = skeleton_.bones[b].length;
    if (kinds_[b] == Kind::end)
      return std::clamp(0.25 * length, finger * H(), arm_radii.back() * H());
    return std::clamp(thick_bone * length, thinnest_bone * H(), thickest_bone * H());
  }

  void add(int bone, Kind kind, const Vec3& from, const Vec3& to, double radius) {
    const Vec3 apart =
        (to - from).norm() > no_length * H() ? to : from + Vec3(0, 0, no_length * H());
    parts_.push_back({bone, hands_[bone], kind, from, apart, radius});
  }

  /// Along a bone, and from its parent where they lie apart.
  void add_bone(int b, double radius, Kind kind) {
    const Bone& bone = skeleton_.bones[b];
    done_[b] = true;
    add(b, kind, bone.head(), bone.tail(), radius);
    if (bone.parent == no_bone || left_out(bone.parent)) return;
    const Bone& parent = skeleton_.bones[bone.parent];
    const FigurePart line{bone.parent, no_bone, kind, parent.head(), parent.tail(), 0};
    const Vec3 from = nearest_on(line, bone.head());
    if ((from - bone.head()).norm() > 1e-3 * H()) add(b, kind, from, bone.head(), radius);
  }

  bool left_out(int b) const { return done_[b] && kinds_[b] == Kind::trunk; }

  /// Roots that only carry the figure.
  void leave_out_above(const std::vector<int>& trunk) {
    int top = trunk.front();
    for (const int b : trunk) top = std::min(top, b);  // parents come first
    for (int b = skeleton_.bones[top].parent; b != no_bone; b = skeleton_.bones[b].parent)
      done_[b] = true, kinds_[b] = Kind::trunk;
  }

  Vec3 head_of(int bone) const { return skeleton_.bones[bone].head(); }
  Vec3 across(const LimbPair& pair) const {
    return head_of(pair.joint[1]) - head_of(pair.joint[0]);
  }
  Vec3 middle(const LimbPair& pair) const {
    return (head_of(pair.joint[1]) + head_of(pair.joint[0])) / 2;
  }

  /// The places through which the trunk goes: hips, joints between, shoulders.
  std::vector<std::pair<int, Vec3>> spine() const {
    std::vector<std::pair<int, Vec3>> places = {{anatomy_.legs().fork, middle(anatomy_.legs())}};
    for (std::size_t k = 1; k + 1 < anatomy_.trunk.size(); ++k)
      places.emplace_back(anatomy_.trunk[k], head_of(anatomy_.trunk[k]));
    const LimbPair& arms = anatomy_.arms();
    places.emplace_back(arms.fork, head_of(arms.fork));
    // Collar bones may rise from low in the chest.
    if ((middle(arms) - head_of(arms.fork)).norm() > no_length * H())
      places.emplace_back(arms.fork, middle(arms));
    return places;
  }

  void mark_trunk() {
    for (const int b : anatomy_.trunk) done_[b] = true, kinds_[b] = Kind::trunk;
    for (const LimbPair& pair : anatomy_.pairs)
      for (std::size_t side = 0; side < 2; ++side)
        for (int b = pair.first[side]; b != pair.joint[side]; b = longest_[b])
          done_[b] = true, kinds_[b] = Kind::trunk;
  }

  void add_trunk() {
    mark_trunk();
    const auto places = spine();
    std::vector<double> along = {0};
    for (std::size_t k = 1; k < places.size(); ++k)
      along.push_back(along.back() + (places[k].second - places[k - 1].second).norm());
    constexpr int bars = 16;  // closer than they are deep
    for (int i = 0; i <= bars; ++i) {
      const double s = static_cast<double>(i) / bars, at = s * along.back();
      std::size_t k = 1;
      while (k + 1 < places.size() && along[k] < at) ++k;
      const double step = along[k] - along[k - 1];
      const double t = step > 0 ? std::clamp((at - along[k - 1]) / step, 0.0, 1.0) : 0;
      const Vec3 place = (1 - t) * places[k - 1].second + t * places[k].second;
      add_bar(places[t < 0.5 ? k - 1 : k].first, place, s);
    }
    for (std::size_t side = 0; side < 2; ++side) {
      add_corner(anatomy_.legs(), side, leg_radii[0]);
      add_corner(anatomy_.arms(), side, 1.1 * arm_radii[0]);
    }
  }

  /// A bar across the trunk, at a fraction of the way from the hips to the shoulders.
  void add_bar(int bone, const Vec3& at, double s) {
    const Vec3 low = across(anatomy_.legs()), high = across(anatomy_.arms());
    const double hips = low.norm() / 2 + 0.8 * leg_radii[0] * H();
    const double shoulders = std::max(high.norm() / 2 - 0.3 * arm_radii[0] * H(), neck * H());
    const double usual_width =
        (1 - (1 - waist) * std::sin(pi * s)) * ((1 - s) * hips + s * shoulders);
    const double width = std::min(usual_width, room_beside_arms(at));
    const double usual = s < 0.5 ? hips_deep + 2 * s * (waist_deep - hips_deep)
                                 : waist_deep + (2 * s - 1) * (chest_deep - waist_deep);
    const double deep = std::min(usual * H(), width);
    Vec3 side = (1 - s) * low.normalized() + s * turned_to(low, high).normalized();
    if (side.norm() < 0.1) side = low;
    const Vec3 half = (width - deep) * side.normalized();
    add(bone, Kind::trunk, at - half, at + half, deep);
  }

  /// How far the trunk may reach from a place, so that arms that hang stay apart from it.
  double room_beside_arms(const Vec3& at) const {
    double room = std::numeric_limits<double>::infinity();
    for (const int joint : anatomy_.arms().joint) {
      const Bone& bone = skeleton_.bones[joint];
      const FigurePart arm{joint, no_bone, Kind::limb, bone.head(), bone.tail(), 0};
      room = std::min(room, (nearest_on(outer_half(arm), at) - at).norm());
    }
    return std::max(room - beside_arm * arm_radii[0] * H(), neck * H());
  }

  /// A shoulder, or what leads to the hip.
  void add_corner(const LimbPair& pair, std::size_t side, double radius) {
    const Vec3 joint = head_of(pair.joint[side]);
    add(pair.joint[side], Kind::trunk, (joint + middle(pair)) / 2, joint, radius * H());
  }

  /// Left and right may be exchanged between the pairs.
  static Vec3 turned_to(const Vec3& like, const Vec3& side) {
    return like.dot(side) < 0 ? Vec3(-side) : side;
  }

  void add_head() {
    const std::vector<int>& head = anatomy_.head;
    if (head.empty()) return;
    for (const int b : head) done_[b] = true, kinds_[b] = Kind::head;
    for (std::size_t b = 0; b < skeleton_.size(); ++b) {  // faces and hair lie in it
      const int parent = skeleton_.bones[b].parent;
      if (parent != no_bone && kinds_[parent] == Kind::head)
        done_[b] = true, kinds_[b] = Kind::head;
    }
    const Vec3 start = middle(anatomy_.arms()), end = skeleton_.bones[head.back()].tail();
    Vec3 up = end - start;
    if (up.norm() < no_length * H()) up = Vec3(0, 0, 1);
    up.normalize();
    const double r = skull * H();
    // The skull ends at the end of the head; of rigs that end at its joint, above it.
    const double high = (end - start).dot(up);
    const double top = std::max(high, 2.6 * r);
    const Vec3 center_high = start + (top - r) * up, center_low = start + (top - 1.4 * r) * up;
    add(head.back(), Kind::head, center_low, center_high, r);
    add(head.front(), Kind::head, start, center_low, neck * H());
  }

  void add_limb(const LimbPair& pair, std::size_t side, const std::array<double, 3>& radii) {
    mark_hand(pair, side);
    std::size_t k = 0;
    for (int b = pair.joint[side]; b != no_bone && hands_[b] == no_bone; b = longest_[b], ++k)
      add_bone(b, radii[k] * H(), Kind::limb);
  }

  /// All that is below a wrist or an ankle.
  void mark_hand(const LimbPair& pair, std::size_t side) {
    int wrist = pair.joint[side];
    for (int k = 0; k < 2 && wrist != no_bone; ++k) wrist = longest_[wrist];
    if (wrist == no_bone) return;
    hands_[wrist] = wrist;
    for (std::size_t b = 0; b < skeleton_.size(); ++b) {
      const int parent = skeleton_.bones[b].parent;
      if (parent != no_bone && hands_[parent] == wrist) hands_[b] = wrist;
      if (hands_[b] == wrist) kinds_[b] = Kind::end;
    }
  }

  const Skeleton& skeleton_;
  const Anatomy& anatomy_;
  std::vector<int> longest_;
  std::vector<Kind> kinds_;  ///< kinds of the bones
  std::vector<int> hands_;   ///< first bone of the hand or foot of each bone
  std::vector<bool> done_;   ///< they have their parts, or none
  std::vector<FigurePart> parts_;
};

/// The factor by which each part becomes thinner.
std::vector<double> room_of(const std::vector<FigurePart>& parts, const Neighborhood& near) {
  std::vector<double> factors(parts.size(), 1.0);
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t k = i + 1; k < parts.size(); ++k) {
      const double both = parts[i].radius + parts[k].radius;
      const double factor = room_kept * near.distance(parts[i], parts[k]) / both;
      factors[i] = std::min(factors[i], factor), factors[k] = std::min(factors[k], factor);
    }
  return factors;
}

}  // namespace

double distance_between(const FigurePart& a, const FigurePart& b) {
  const Vec3 u = a.to - a.from, v = b.to - b.from, w = a.from - b.from;
  const double uu = u.dot(u), vv = v.dot(v), uv = u.dot(v), cross = uu * vv - uv * uv;
  double s =
      cross > 1e-12 * uu * vv ? std::clamp((uv * v.dot(w) - vv * u.dot(w)) / cross, 0.0, 1.0) : 0;
  const double t = vv > 0 ? std::clamp((uv * s + v.dot(w)) / vv, 0.0, 1.0) : 0;
  s = uu > 0 ? std::clamp((uv * t - u.dot(w)) / uu, 0.0, 1.0) : 0;
  double least = (a.from + s * u - b.from - t * v).norm();
  for (const Vec3& end : {a.from, a.to}) least = std::min(least, (nearest_on(b, end) - end).norm());
  for (const Vec3& end : {b.from, b.to}) least = std::min(least, (nearest_on(a, end) - end).norm());
  return least;
}

Neighborhood::Neighborhood(const Skeleton& skeleton, const Anatomy& anatomy)
    : skeleton_(skeleton), links_(links_of(skeleton)), begins_(skeleton.size()) {
  for (const LimbPair& pair : anatomy.pairs)
    for (const int joint : pair.joint) begins_[joint] = true;
}

bool Neighborhood::in_line(const FigurePart& a, const FigurePart& b) const {
  const int top = std::min(a.bone, b.bone);  // parents come first
  double between = 0;
  int bone = skeleton_.bones[std::max(a.bone, b.bone)].parent;
  for (; bone != no_bone && bone > top; bone = skeleton_.bones[bone].parent)
    between += links_[bone];
  return bone == top && between < 2 * (a.radius + b.radius);
}

bool Neighborhood::joins(const FigurePart& a, const FigurePart& b) const {
  const std::vector<Bone>& bones = skeleton_.bones;
  const auto holds = [&](const FigurePart& one, const FigurePart& other) {
    return bones[other.bone].parent == one.bone ||
           (other.hand != no_bone && bones[other.hand].parent == one.bone);
  };
  return a.bone == b.bone || (is_body(a) && is_body(b)) || holds(a, b) || holds(b, a) ||
         (a.hand != no_bone && a.hand == b.hand) || in_line(a, b);
}

double Neighborhood::distance(const FigurePart& a, const FigurePart& b) const {
  const auto begins = [&](const FigurePart& part) { return !is_body(part) && begins_[part.bone]; };
  if (is_body(a) && begins(b)) return distance_between(a, outer_half(b));
  if (is_body(b) && begins(a)) return distance_between(outer_half(a), b);
  if (joins(a, b)) return std::numeric_limits<double>::infinity();
  const int parent = skeleton_.bones[a.bone].parent;
  const bool siblings = parent != no_bone && parent == skeleton_.bones[b.bone].parent;
  return siblings ? distance_between(outer_half(a), outer_half(b)) : distance_between(a, b);
}

std::vector<FigurePart> parts_of(const Skeleton& skeleton, const Anatomy& anatomy) {
  return Builder(skeleton, anatomy).figure();
}

std::vector<FigurePart> figure_of(const Skeleton& skeleton, const Anatomy& anatomy) {
  std::vector<FigurePart> parts = parts_of(skeleton, anatomy);
  const std::vector<double> factors = room_of(parts, Neighborhood(skeleton, anatomy));
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].radius *= factors[i];
  return parts;
}

}  // namespace sinew
