// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/lists/comoving_frames.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

// Frames between two bones: one per diameter by which the tissue there is sheared, but no more than
// save more checks than they cost.
constexpr std::size_t most_frames = 15;
constexpr std::size_t places_per_hinge = 64;
// Below this rotation, in rad, it is undecided which bone a particle follows.
constexpr double least_turn = 0.02;
constexpr std::size_t particles_per_piece = 8192;
constexpr auto unassigned = static_cast<std::uint32_t>(-1);

/// A rotation vector, rad, and its rate of change for the angular velocity `spin`.
struct Turn {
  Vec3 vector, rate;

  Turn(const Mat3& rotation, const Vec3& spin) {
    const Eigen::AngleAxisd given(rotation);
    const double half = given.angle() / 2;
    vector = given.angle() * given.axis();
    const double along = half < 1e-4 ? 1 : half / std::tan(half);
    rate =
        along * spin + (1 - along) * given.axis().dot(spin) * given.axis() - vector.cross(spin) / 2;
  }
  /// The rotation by a share of it, and its angular velocity.
  Mat3 rotation(double share) const {
    const double angle = share * vector.norm();
    return angle == 0 ? Mat3(Mat3::Identity())
                      : Eigen::AngleAxisd(angle, vector.normalized()).toRotationMatrix();
  }
  Vec3 spin(double share) const {
    const double angle = share * vector.norm();
    if (angle < 1e-4) return share * rate;
    const Vec3 axis = vector.normalized();
    const double sine = std::sin(angle) / angle, lift = (1 - std::cos(angle)) / angle;
    return share * (sine * rate + (1 - sine) * axis.dot(rate) * axis + lift * axis.cross(rate));
  }
};

/// Extent of the tissue around a joint, in diameters.
double width_at(const Body& body, std::size_t parent, std::size_t child) {
  const auto& section = body.binding.cross_section;
  return std::sqrt((section[parent] + section[child]) / 2) / (2 * body.material.pair.r);
}

}  // namespace

/// How the rotation of a joint is distributed along its axis: by place, the share of the tissue
/// there.
class ComovingFrames::Profile {
 public:
  Profile(const Hinge& hinge, const Pose& bones)
      : hinge_(&hinge), parent_(&bones[hinge.parent]), child_(&bones[hinge.child]) {
    const Eigen::AngleAxisd turn(Mat3(parent_->turn.transpose() * child_->turn));
    angle_ = turn.angle();
    about_ = turn.axis();
    if (angle_ > least_turn)
      frames_ = static_cast<int>(
          std::clamp(std::ceil(angle_ * hinge.width), 1.0, static_cast<double>(most_frames)));
  }

  /// Frames between the two bones; none while they have hardly rotated relative to each other.
  int frames() const { return frames_; }
  /// Adds a particle, with its position at rest.
  void add(const Vec3& rest, const Vec3& now) {
    const Vec3 from = rest - hinge_->place;
    const Vec3 to = parent_->turn.transpose() * (now - child_->frame.origin);
    const std::size_t place = place_of(rest);
    sine_[place] += about_.dot(from.cross(to));
    cosine_[place] += from.dot(to) - about_.dot(from) * about_.dot(to);
  }
  void add(const Profile& other) {
    for (std::size_t place = 0; place < places_per_hinge; ++place) {
      sine_[place] += other.sine_[place];
      cosine_[place] += other.cosine_[place];
    }
  }
  /// To be called after all particles were added.
  void settle() {
    for (std::size_t place = 0; place < places_per_hinge && frames_ > 0; ++place) {
      const double share = std::atan2(sine_[place], cosine_[place]) / angle_;
      share_[place] =
          static_cast<int>(std::clamp(std::round(share * (frames_ + 1)), 0.0, frames_ + 1.0));
    }
  }
  /// Of the rotation from parent to child, in units of the frames between: 0 for the parent.
  int share(const Vec3& rest) const { return share_[place_of(rest)]; }

 private:
  std::size_t place_of(const Vec3& rest) const {
    const double along = (rest - hinge_->place).dot(hinge_->axis) + hinge_->before;
    const double place = along / (hinge_->before + hinge_->beyond) * places_per_hinge;
    return static_cast<std::size_t>(std::clamp(place, 0.0, places_per_hinge - 1.0));
  }

  const Hinge* hinge_;
  const BonePose *parent_, *child_;
  double angle_;
  int frames_ = 0;
  Vec3 about_;  ///< in the parent's directions at rest
  std::array<double, places_per_hinge> sine_{}, cosine_{};
  std::array<int, places_per_hinge> share_{};
};

ComovingFrames::ComovingFrames(const Body& body) : hinges_of_(body.skeleton.size()) {
  const auto& bones = body.skeleton.bones;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    if (bones[b].parent == no_bone) continue;
    const auto parent = static_cast<std::size_t>(bones[b].parent);
    const Vec3 axis = bones[parent].axis() + bones[b].axis();
    hinges_of_[parent].push_back(hinges_.size());
    hinges_of_[b].push_back(hinges_.size());
    hinges_.push_back({parent, b, bones[b].head(),
                       axis.norm() > 1e-6 ? axis.normalized() : bones[b].axis(), 1e-300, 1e-300,
                       width_at(body, parent, b)});
  }
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    const int bone = body.binding.bone(i);
    if (bone == no_bone) continue;
    for (const std::size_t h : hinges_of_[static_cast<std::size_t>(bone)]) {
      const double along = (body.rest[i] - hinges_[h].place).dot(hinges_[h].axis);
      hinges_[h].before = std::max(hinges_[h].before, -along);
      hinges_[h].beyond = std::max(hinges_[h].beyond, along);
    }
  }
}

/// The head is halfway between the places to which both bones have moved the joint.
BonePose ComovingFrames::pose_of(const Between& between, const Pose& bones) const {
  const Hinge& hinge = hinges_[between.hinge];
  const BonePose &parent = bones[hinge.parent], &child = bones[hinge.child];
  const Mat3 back = parent.turn.transpose();
  const Turn turn(back * child.turn, back * (child.angular_velocity - parent.angular_velocity));
  BonePose pose;
  pose.turn = parent.turn * turn.rotation(between.share);
  pose.frame.rotation = pose.turn;
  pose.frame.origin = child.frame.origin;
  pose.velocity = child.velocity;
  pose.angular_velocity = parent.angular_velocity + parent.turn * turn.spin(between.share);
  return pose;
}

template <class Real>
std::vector<ComovingFrames::Profile> ComovingFrames::profiles(
    const Body& body, const Pose& bones, const BlockState<Real>& state, const Units& units,
    std::span<const std::int32_t> id) const {
  std::vector<Profile> sums;
  for (const Hinge& hinge : hinges_) sums.emplace_back(hinge, bones);
  const std::vector<Profile> none = sums;
  std::vector<std::vector<Profile>> pieces(id.size() / particles_per_piece + 1);
  parallel_for(id.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    auto& piece = pieces[begin / particles_per_piece] = none;
    for (std::size_t k = begin; k < end; ++k) {
      const int bone = body.binding.bone(static_cast<std::size_t>(id[k]));
      if (bone == no_bone) continue;
      for (const std::size_t h : hinges_of_[static_cast<std::size_t>(bone)])
        if (piece[h].frames() > 0) piece[h].add(body.rest[id[k]], state.position(k, units));
    }
  });
  // In the order of the pieces: the sums are the same for any number of threads.
  for (const auto& piece : pieces)
    for (std::size_t h = 0; h < piece.size(); ++h) sums[h].add(piece[h]);
  for (Profile& profile : sums) profile.settle();
  return sums;
}

template <class Real>
void ComovingFrames::choose(const Body& body, const Pose& bones, const BlockState<Real>& state,
                            const Units& units, std::span<const std::int32_t> id) {
  const auto profile = profiles(body, bones, state, units, id);
  of_.resize(id.size());
  parallel_for(id.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      of_[k] = choice(body.binding.bone(static_cast<std::size_t>(id[k])), body.rest[id[k]], profile,
                      bones.size());
  });
  compress(profile, bones.size());
}

/// The bone's own frame or, of the frames between it and others, the one farthest from it.
std::uint32_t ComovingFrames::choice(int bone, const Vec3& rest, std::span<const Profile> profiles,
                                     std::size_t bones) const {
  if (bone == no_bone) return unassigned;
  auto found = static_cast<std::uint32_t>(bone);
  int farthest = 0;
  for (const std::size_t h : hinges_of_[static_cast<std::size_t>(bone)]) {
    if (profiles[h].frames() == 0) continue;
    const int whole = profiles[h].frames() + 1, share = profiles[h].share(rest);
    const bool is_child = hinges_[h].child == static_cast<std::size_t>(bone);
    const int away = is_child ? whole - share : share;
    if (away <= farthest) continue;
    farthest = away;
    found = static_cast<std::uint32_t>(share == 0       ? hinges_[h].parent
                                       : share == whole ? hinges_[h].child
                                                        : bones + h * most_frames +
                                                              static_cast<std::size_t>(share) - 1);
  }
  return found;
}

template void ComovingFrames::choose(const Body&, const Pose&, const BlockState<double>&,
                                     const Units&, std::span<const std::int32_t>);
template void ComovingFrames::choose(const Body&, const Pose&, const BlockState<float>&,
                                     const Units&, std::span<const std::int32_t>);

void ComovingFrames::compress(std::span<const Profile> profile, std::size_t bones) {
  std::vector<std::uint32_t> place(bones + hinges_.size() * most_frames, unassigned);
  for (const std::uint32_t comoving_frame : of_)
    if (comoving_frame != unassigned) place[comoving_frame] = 0;
  between_.clear();
  for (std::size_t c = 0; c < place.size(); ++c) {
    if (c >= bones && place[c] == unassigned) continue;
    place[c] = static_cast<std::uint32_t>(c < bones ? c : bones + between_.size());
    if (c < bones) continue;
    const std::size_t h = (c - bones) / most_frames;
    between_.push_back(
        {h, static_cast<double>((c - bones) % most_frames + 1) / (profile[h].frames() + 1)});
  }
  const auto scene = static_cast<std::uint32_t>(bones + between_.size());
  for (std::uint32_t& comoving_frame : of_)
    comoving_frame = comoving_frame == unassigned ? scene : place[comoving_frame];
}

Pose ComovingFrames::at(const Pose& bones) const {
  Pose all = bones;
  for (const Between& between : between_) all.push_back(pose_of(between, bones));
  return all;
}

template <class Real>
FrameSlots<Real> frame_slots(std::span<const std::uint32_t> comoving_frame) {
  constexpr std::size_t size = kernel::Traits<Real>::block;
  FrameSlots<Real> out;
  out.first.reserve(comoving_frame.size() / size + 2);
  out.first.push_back(0);
  for (std::size_t begin = 0; begin < comoving_frame.size(); begin += size) {
    const auto block = comoving_frame.subspan(begin, std::min(size, comoving_frame.size() - begin));
    const bool alone = block.size() == size &&
                       std::all_of(block.begin(), block.end(),
                                   [&](std::uint32_t one) { return one == block.front(); });
    const std::size_t first = out.slots.size();
    if (alone) out.slots.push_back({static_cast<std::int32_t>(block.front()), -1});
    for (std::size_t lane = 0; lane < block.size() && !alone; ++lane) {
      const auto frame = static_cast<std::int32_t>(block[lane]);
      auto slot =
          std::find_if(out.slots.begin() + static_cast<std::ptrdiff_t>(first), out.slots.end(),
                       [&](const kernel::FrameSlot& one) { return one.frame == frame; });
      if (slot == out.slots.end()) {
        out.slots.push_back({frame, static_cast<std::int32_t>(out.lanes.size() / size)});
        out.lanes.resize(out.lanes.size() + size, Real(0));
        slot = out.slots.end() - 1;
      }
      out.lanes[static_cast<std::size_t>(slot->lanes) * size + lane] = 1;
    }
    out.first.push_back(static_cast<std::uint32_t>(out.slots.size()));
  }
  return out;
}

template FrameSlots<double> frame_slots(std::span<const std::uint32_t>);
template FrameSlots<float> frame_slots(std::span<const std::uint32_t>);

}  // namespace sinew
