// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/estimate.h"

#include <algorithm>
#include <cstdio>
#include <system_error>

#include "core/error.h"
#include "core/requested_arrays.h"
#include "io/arrays.h"
#include "physics/solid/solid.h"
#include "scene/step_way.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

// Real numbers per particle (position, displacement, velocity, four forces, radius, weight) and per
// point of the surface (position, displacement, normal), and whole numbers beside them.
constexpr double reals_per_particle = 23, wholes_per_particle = 6;
constexpr double reals_per_point = 9, wholes_per_point = 1, wholes_per_face = 4;
// Base64 makes four bytes of three; zlib at level 1 leaves about 0.8 of moving floats.
constexpr double base64 = 4.0 / 3, kept_by_zlib = 0.8;
// Positions, velocities and order of three checkpoints, one of them in the making; and their bonds.
constexpr double checkpoints_per_particle = 3 * 52, bonds_per_particle = 3 * (12 * 8 + 4);
constexpr double exported_per_point = 24;        // bytes in surface.pc2 and surface.glb
constexpr double bytes_per_frame_beside = 20e3;  // headers, bones, frames
// Peaks of runs of 1e5 to 1e7 particles, in bytes. Most of it is the frames on their way to the
// disk (two copies, and one as numbers in double) with the rest shape and its binding; lists take
// about 280 in double and 160 in single precision.
constexpr double memory_with_lists_double = 1250, memory_with_lists_single = 1130;
constexpr double memory_with_cells = 1500;
constexpr double memory_per_point = 600, memory_beside = 30e6;

double memory_per_particle(const StepWay& way) {
  if (way.search == NeighbourSearch::cells) return memory_with_cells;
  return way.precision == Precision::binary64 ? memory_with_lists_double : memory_with_lists_single;
}

/// Numbers of a particle in the arrays that the scene asks for.
double requested_numbers(const OutputSettings& output) {
  double numbers = 0;
  for (const std::string_view name : requested_arrays(output.arrays)) {
    const WrittenArray* row = find_written("particles", ArrayPlace::point, name);
    numbers += std::max(1.0, static_cast<double>(row->components.size()));
  }
  return numbers;
}

}  // namespace

Needs needs_of(const Settings& settings, const Setup& setup, std::size_t surface_points,
               std::size_t surface_faces) {
  const OutputSettings& output = settings.output;
  const auto particles = static_cast<double>(setup.body.rest.size());
  const auto points = static_cast<double>(surface_points);
  const auto faces = static_cast<double>(surface_faces);
  const double surfaces = 1 + (output.skin_lbs ? 1 : 0) + (output.skin_dqs ? 1 : 0);
  const double reals_of_world = setup.body.world ? 3 : 0;  // one more force
  const double reals =
      particles * (reals_per_particle + reals_of_world + requested_numbers(output)) +
      surfaces * points * reals_per_point;
  const double wholes = particles * wholes_per_particle +
                        surfaces * (points * wholes_per_point + faces * wholes_per_face);
  const double raw = reals * (output.double_precision ? 8 : 4) + wholes * 4;
  const bool compressed = output.encoding == Encoding::zlib || output.encoding == Encoding::lz4;
  const double coded =
      raw * (output.encoding == Encoding::raw ? 1 : base64) * (compressed ? kept_by_zlib : 1);
  const double exported = output.export_surface ? points * exported_per_point : 0;
  const bool bonds = remembers_neighbours(setup.body.material);
  const double checkpoints =
      particles * (checkpoints_per_particle + (bonds ? bonds_per_particle : 0));
  Needs needs;
  needs.disk = static_cast<std::uint64_t>(
      (coded + exported + bytes_per_frame_beside) * (setup.frames + 1) + checkpoints);
  const StepWay way = step_way(settings.solver, setup.body, setup.motion);
  needs.memory = static_cast<std::uint64_t>(particles * memory_per_particle(way) +
                                            points * memory_per_point + memory_beside);
  return needs;
}

std::uint64_t free_space(const fs::path& folder) {
  fs::path existing = fs::absolute(folder).lexically_normal();
  std::error_code failed;
  while (!fs::exists(existing, failed) && existing.has_relative_path())
    existing = existing.parent_path();
  const auto space = fs::space(existing, failed);
  return failed ? UINT64_MAX : space.available;
}

void check_space(const fs::path& folder, const Needs& needs, std::uint64_t freed) {
  const std::uint64_t space = free_space(folder);
  const std::uint64_t available = space > UINT64_MAX - freed ? space : space + freed;
  if (needs.disk <= available) return;
  throw not_written(
      folder.string(),
      "the run needs about " + bytes_text(needs.disk) + ", the disk has " + bytes_text(available),
      "make space, choose another folder with -o, or make output.interval longer");
}

std::string bytes_text(std::uint64_t bytes) {
  const char* units[] = {"B", "kB", "MB", "GB", "TB", "PB", "EB"};
  auto value = static_cast<double>(bytes);
  int unit = 0;
  for (; value >= 1000 && unit < 6; ++unit) value /= 1000;
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", value, units[unit]);
  return text;
}

}  // namespace sinew
