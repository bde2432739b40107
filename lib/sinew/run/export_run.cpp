// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/export_run.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <system_error>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/run/drawn_bonds.h>

namespace sinew {
namespace {

std::vector<std::string> names_of(const Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const Bone& bone : skeleton.bones) names.push_back(bone.name);
  return names;
}

void check_time(double time, const RunFiles& run) {
  constexpr double slack = 1e-6;  // fraction of the run: times are typed in a few digits
  const double first = run.particle_rows.front().time, last = run.particle_rows.back().time;
  if (!(time >= first && time <= last + slack * (last - first)))
    throw bad_input("there is no frame at " + number_text(time) + " s",
                    "give times from " + number_text(first) + " to " + number_text(last) + " s");
}

std::size_t frame_at(const RunFiles& run, double time) {
  const auto& rows = run.particle_rows;
  const auto nearer = [time](const PvdRow& a, const PvdRow& b) {
    return std::abs(a.time - time) < std::abs(b.time - time);
  };
  return static_cast<std::size_t>(std::min_element(rows.begin(), rows.end(), nearer) -
                                  rows.begin());
}

/// Puts a frame in place of the one before.
void read_into(ParticleCloud& cloud, const RunFiles& run, std::size_t index, FrameState frame) {
  cloud.positions = std::move(frame.positions);
  cloud.velocities = std::move(frame.velocities);
  cloud.time = frame.time;
  cloud.frame = static_cast<std::int64_t>(index);
  if (cloud.bonds.empty() || index >= run.bond_rows.size()) return;
  cloud.bonds.clear();
  for (const DrawnBond& bond : DrawnBonds(run, "length").at(index))
    cloud.bonds.push_back(
        {static_cast<std::uint32_t>(bond.ends[0]), static_cast<std::uint32_t>(bond.ends[1])});
}

/// Each is counted by both of its particles.
std::size_t broken_bonds(const FrameState& frame) {
  const std::vector<std::int32_t>& of_each = frame.broken_bonds;
  return std::accumulate(of_each.begin(), of_each.end(), std::size_t{0}) / 2;
}

}  // namespace

std::filesystem::path numbered(const std::filesystem::path& folder, const std::string& name,
                               std::size_t frame, std::string_view extension) {
  const std::string digits = std::to_string(frame);
  const std::size_t zeros = digits.size() < 6 ? 6 - digits.size() : 0;
  return folder / (name + '_' + std::string(zeros, '0') + digits + std::string(extension));
}

std::vector<std::size_t> frames_at(const RunFiles& run, const std::vector<double>& times) {
  if (run.frames() == 0)
    throw bad_input(Place{run.folder.path.string()}, "has no frames",
                    "run the scene to its first frame");
  std::vector<std::size_t> frames(times.empty() ? run.frames() : 0);
  std::iota(frames.begin(), frames.end(), std::size_t{0});
  for (const double time : times) {
    check_time(time, run);
    frames.push_back(frame_at(run, time));
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

ParticleCloud rest_cloud(const RunFiles& run, const ParticleFormat& format) {
  ParticleCloud cloud = cloud_of(run.body, run.settings.material.density, names_of(run.skeleton));
  if (!run.ids.empty()) cloud.id = run.ids;
  if (format.bonds) cloud.bonds = touching_pairs(cloud.positions, cloud.radius);
  return cloud;
}

ExportedFrames export_frames(const RunFiles& run, const ParticleFormat& format,
                             const std::vector<std::size_t>& frames,
                             const std::filesystem::path& target) {
  ExportedFrames done;
  ParticleCloud cloud = rest_cloud(run, format);
  const std::vector<std::array<std::uint32_t, 2>> at_rest = cloud.bonds;
  const auto read = [&](std::size_t index) {
    FrameState frame = read_frame(run, index);
    if (format.bonds && index >= run.bond_rows.size())
      done.broken_bonds = std::max(done.broken_bonds, broken_bonds(frame));
    cloud.bonds = at_rest;
    read_into(cloud, run, index, std::move(frame));
  };
  if (format.many_frames) {
    NewFile file(target);
    for (const std::size_t frame : frames) read(frame), format.add(file, cloud);
    file.finish();
    done.files = {target};
    return done;
  }
  if (frames.size() > 1) create_folder(target);
  for (const std::size_t frame : frames) {
    read(frame);
    done.files.push_back(frames.size() > 1
                             ? numbered(target, "particles", frame, format.extensions.front())
                             : target);
    write_particles(done.files.back(), cloud, format);
  }
  return done;
}

}  // namespace sinew
