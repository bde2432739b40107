// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/drawn_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "draw/run_shot.h"
#include "render/camera.h"

namespace sinew {
namespace {

constexpr std::size_t most_arrows = 900;  // more of them hide each other
constexpr double longest_arrow = 0.25;    // of the body's longest side
constexpr double shortest_arrow = 0.1;    // of the longest: shorter ones are dots
constexpr double least_turn = 0.01;       // rad: below it no bone tells the story
constexpr std::size_t moments_without_turn = 5;

double largest_turn(const RunFiles& run, const RunFrame& frame) {
  double most = 0;
  for (std::size_t b = 0; b < frame.bones.size(); ++b) {
    const Mat3 turn = frame.bones[b].rotation * run.skeleton.bones[b].rest.rotation.transpose();
    most = std::max(most, Eigen::AngleAxisd(turn).angle());
  }
  return most;
}

/// Evenly over all frames, the first and the last among them.
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

DrawnRun::DrawnRun(const std::string& folder, const std::vector<Look>& looks,
                   const std::string& array, const Mat3& view, bool ahead)
    : run_(open_run({folder})), view_(view) {
  for (const Look& look : looks)
    looks_.push_back(
        {look, DrawnValues(run_, array.empty() ? std::string(look.array) : array), {}});
  read_story(view, ahead);
}

void DrawnRun::read_story(const Mat3& view, bool ahead) {
  FramesInOrder frames(run_, ahead);
  for (std::size_t i = 0; i < run_.frames(); ++i) {
    RunFrame frame = frames.next();
    story_.angle.push_back(largest_turn(run_, frame));
    for (DrawnLook& drawn : looks_)
      widen(drawn.range, DrawnValues::range_of(drawn.values.at(i, frame)), i == 0);
    story_.frame.extend(seen(view, shot_of(run_, std::move(frame), 0)));
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

std::vector<std::size_t> DrawnRun::telling_frames() const {
  const std::vector<double>& angle = story_.angle;
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

/// The cut stands upright across the viewer's direction at rest and bends with the body, so that
/// the same particles are seen at all times.
void DrawnRun::cut_open(Shot& shot) const {
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
    shot.particles[kept] = shot.particles[i];
    shot.values[kept++] = shot.values[i];
  }
  shot.particles.resize(kept);
  shot.values.resize(kept);
}

void DrawnRun::add_arrows(Shot& shot, std::size_t index, const DrawnLook& drawn) const {
  const Points vectors = drawn_vectors(run_, index, drawn.values.name());
  const double size = bounds(positions_of(run_.body.particles)).sizes().maxCoeff();
  const double strongest = drawn.range.high;
  if (!(strongest > 0)) return;
  const std::size_t stride = std::max<std::size_t>(1, vectors.size() / most_arrows);
  for (std::size_t i = 0; i < vectors.size(); i += stride) {
    const double force = vectors[i].norm();
    if (!(force > shortest_arrow * strongest)) continue;
    const double length = longest_arrow * size * std::min(1.0, force / strongest);
    shot.arrows.push_back({shot.particles[i], length / force * vectors[i], force});
  }
}

Shot DrawnRun::shot(std::size_t index, const DrawnLook& drawn) const {
  RunFrame frame = read_frame(run_, index);
  std::vector<double> values = drawn.values.at(index, frame);
  Shot shot = shot_of(run_, std::move(frame), story_.angle[index]);
  shot.values = std::move(values);
  if (drawn.look.cut_open) cut_open(shot);
  if (drawn.look.view == View::arrows) add_arrows(shot, index, drawn);
  return shot;
}

}  // namespace sinew
