// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/pressed_faces.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sinew {
namespace {

constexpr double growth_when_doubled = 4;  // growth of errors: by the square of the steps

/// The transposed lists: of each target, the sources that name it, in their order.
template <class Visit>
void transpose(std::size_t targets, const Visit& for_each, std::vector<std::uint32_t>& first,
               std::vector<std::uint32_t>& source) {
  first.assign(targets + 1, 0);
  for_each([&](std::uint32_t, std::uint32_t target) { ++first[target + 1]; });
  for (std::size_t k = 0; k < targets; ++k) first[k + 1] += first[k];
  source.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for_each([&](std::uint32_t from, std::uint32_t target) { source[next[target]++] = from; });
}

template <class Key>
std::vector<std::uint32_t> sorted(std::size_t count, const Key& key) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return order;
}

}  // namespace

PressedFaces::PressedFaces(const std::vector<std::array<int, 3>>& faces,
                           const FollowingPoints& corners, std::size_t particles)
    : origin_(corners.origin),
      at_(particles, Four::Zero()),
      corner_(corners.size(), Four::Zero()),
      motion_(corners.size(), Four::Zero()),
      area_(faces.size(), Four::Zero()),
      pushed_(corners.size(), Four::Zero()),
      forces_(particles, Four::Zero()) {
  order(faces, corners);
  std::vector<std::uint32_t> row_of(of_corners_.source.size()), entries;
  for (std::uint32_t k = 0; k + 1 < of_corners_.first.size(); ++k)
    for (std::uint32_t e = of_corners_.first[k]; e < of_corners_.first[k + 1]; ++e) row_of[e] = k;
  const auto for_each_entry = [&](const auto& visit) {
    for (std::uint32_t e = 0; e < row_of.size(); ++e) visit(e, of_corners_.source[e]);
  };
  transpose(particles, for_each_entry, of_particles_.first, entries);
  for (const std::uint32_t entry : entries) {
    of_particles_.source.push_back(row_of[entry]);
    of_particles_.weight.push_back(of_corners_.weight[entry]);
  }
  const auto for_each_corner = [&](const auto& visit) {
    for (std::uint32_t f = 0; f < face_.size(); ++f)
      for (const std::uint32_t corner : face_[f]) visit(f, corner);
  };
  transpose(corner_.size(), for_each_corner, of_faces_.first, of_faces_.source);
}

/// Corners and faces are taken in the order of the particles that they follow: so neighbors lie
/// near each other in memory, whatever the order of the mesh.
void PressedFaces::order(const std::vector<std::array<int, 3>>& faces,
                         const FollowingPoints& given) {
  const auto corners =
      sorted(given.size(), [&](std::uint32_t k) { return given.particle[given.first[k]]; });
  std::vector<std::uint32_t> place(given.size());
  of_corners_.first = {0};
  for (std::uint32_t n = 0; n < corners.size(); ++n) {
    place[corners[n]] = n;
    for (std::uint32_t e = given.first[corners[n]]; e < given.first[corners[n] + 1]; ++e) {
      of_corners_.source.push_back(given.particle[e]);
      of_corners_.weight.push_back(given.weight[e]);
    }
    of_corners_.first.push_back(static_cast<std::uint32_t>(of_corners_.source.size()));
  }
  const auto corner = [&](std::uint32_t f, std::size_t n) {
    return place[static_cast<std::size_t>(faces[f][n])];
  };
  for (const std::uint32_t f :
       sorted(faces.size(), [&](std::uint32_t face) { return corner(face, 0); }))
    face_.push_back({corner(f, 0), corner(f, 1), corner(f, 2)});
}

/// Finds for how many steps forces may hold at corners `now`, as many steps after the last ones.
int PressedFaces::planned(const std::vector<Four>& now) const {
  std::vector<double> squares(face_.size());
  // The root mean square over faces of differences of their sides, over those.
  const auto mean = [&](const auto& difference) {
    on_all(face_.size(), [&](std::size_t f) {
      const auto [a, b, c] = face_[f];
      squares[f] =
          (difference(a, b).squaredNorm() + difference(a, c).squaredNorm()) /
          ((corner_[b] - corner_[a]).squaredNorm() + (corner_[c] - corner_[a]).squaredNorm());
    });
    return std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) /
                     static_cast<double>(squares.size()));
  };
  const auto change = [&](std::uint32_t a, std::uint32_t b) -> Four {
    return now[b] - corner_[b] - now[a] + corner_[a];
  };
  const double in_step = mean(change) / steps_;
  const double error = mean([&](std::uint32_t a, std::uint32_t b) -> Four {
    return change(a, b) - steps_ * (motion_[b] - motion_[a]);
  });
  int steps = steps_;
  if (!(error <= tolerance))
    steps /= 2;
  else if (error <= tolerance / growth_when_doubled)
    steps *= 2;
  while (steps > 1 && (steps > max_steps || steps * in_step > max_change)) steps /= 2;
  return std::max(steps, 1);
}

void PressedFaces::move_corners(bool stepping) {
  std::vector<Four> now(corner_.size());
  on_all(now.size(), [&](std::size_t k) { now[k] = of_corners_.sum(k, at_); });
  const bool known = stepping && moving_;  // where they were for an earlier step
  const int steps = known ? planned(now) : 1;
  on_all(now.size(), [&](std::size_t k) {
    motion_[k] = known ? Four((now[k] - corner_[k]) / steps_) : Four(Four::Zero());
    corner_[k] = now[k];
  });
  steps_ = steps;
  left_ = stepping ? steps : 0;
  moving_ = stepping;
  find_forces();
}

void PressedFaces::find_forces() {
  const double ahead = (steps_ - 1) / 2.;
  const auto at = [&](std::uint32_t k) -> Vec3 {
    return (corner_[k] + ahead * motion_[k]).head<3>();
  };
  on_all(face_.size(), [&](std::size_t f) {
    const Vec3 a = at(face_[f][0]), b = at(face_[f][1]), c = at(face_[f][2]);
    area_[f] << (b - a).cross(c - a) / -6, 0;  // sum over three corners; twice the area
  });
  on_all(pushed_.size(), [&](std::size_t k) {
    Four sum = Four::Zero();
    for (std::uint32_t e = of_faces_.first[k]; e < of_faces_.first[k + 1]; ++e)
      sum += area_[of_faces_.source[e]];
    pushed_[k] = sum;
  });
  on_all(forces_.size(), [&](std::size_t k) { forces_[k] = of_particles_.sum(k, pushed_); });
  found_ = true;
}

double PressedFaces::size() const {
  return parallel_sum(pushed_.size(), per_task, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t k = begin; k < end; ++k) sum += pushed_[k].norm();
    return sum;
  });
}

void PressedFaces::save(std::vector<double>& state) const {
  if (empty()) return;
  state.insert(state.end(),
               {moving_ ? 1. : 0., static_cast<double>(steps_), static_cast<double>(left_)});
  for (const auto* all : {&corner_, &motion_})
    for (const Four& one : *all) state.insert(state.end(), {one[0], one[1], one[2]});
}

bool PressedFaces::restore(const double* state) {
  if (empty()) return true;
  const auto is_count = [](double value) {
    return value >= 0 && value <= max_steps && value == std::floor(value);
  };
  if (!is_count(state[1]) || !is_count(state[2]) || (state[0] != 0 && state[1] < 1)) return false;
  moving_ = *state++ != 0;
  steps_ = static_cast<int>(*state++);
  left_ = static_cast<int>(*state++);
  for (auto* all : {&corner_, &motion_})
    for (Four& one : *all) {
      one << state[0], state[1], state[2], 0;
      state += 3;
    }
  found_ = false;
  if (moving_) find_forces();
  return true;
}

void PressedFaces::forget() {
  found_ = moving_ = false;
  steps_ = left_ = 0;
}

}  // namespace sinew
