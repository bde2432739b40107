// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/check/needs.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>

#include <sinew/body/solid.h>
#include <sinew/core/arrays.h>
#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/scene/frame_content.h>
#include <sinew/scene/steps.h>

namespace sinew {

namespace {

namespace fs = std::filesystem;

// Real numbers per particle (position, displacement, velocity, four forces, radius, weight) and per
// point of the surface (position, displacement, normal), and integers in addition.
constexpr double reals_per_particle = 23, wholes_per_particle = 6;
constexpr double reals_per_bond = 3, wholes_per_bond = 4;
constexpr double wholes_per_cell = 6;  // four points, end, torn
constexpr double reals_per_point = 9, wholes_per_point = 1, wholes_per_face = 4;
// Base64 makes four bytes of three; zlib at level 1 leaves about 0.8 of moving floats.
constexpr double base64 = 4.0 / 3, kept_by_zlib = 0.8;
// Positions, velocities and order of three checkpoints, one of them being written; and their bonds.
constexpr double checkpoints_per_particle = 3 * 52, bonds_per_particle = 3 * (12 * 8 + 4);
constexpr double exported_per_point = 24;        // bytes in surface.pc2 and surface.glb
constexpr double bytes_per_frame_beside = 20e3;  // headers, bones, frames
// Peak memory of runs of 3e5 to 1e7 particles, in bytes: the body at rest with its binding, a frame
// being written (about 150), and lists and states, 100 to 200.
constexpr double memory_with_lists_double = 510, memory_with_lists_single = 400;
constexpr double memory_with_cells = 1500;
constexpr double memory_of_strain = 170, memory_of_changing_bonds = 120;  // in double precision
constexpr double memory_of_branch = 300;  // in double precision: its bonds, and a state beside
constexpr double memory_of_measuring = 500, memory_of_bonds = 700;  // what frames request
constexpr double memory_of_volume = 2000;
// Bodies of 1e4 to 1e5 particles.
constexpr double volume_cells_per_particle = 6.5, volume_points_per_particle = 1.35;
constexpr double memory_per_point = 600, memory_beside = 60e6;

// Lists are valid for all steps of a trial at rest; those of a deforming body must be rebuilt.
constexpr double slower_with_lists_in_motion = 1.8;

double memory_per_particle(const StepperChoice& choice, const Body& body) {
  if (choice.search == NeighborSearch::cells) return memory_with_cells;
  const bool single = choice.precision == Precision::binary32;
  double bytes = single ? memory_with_lists_single : memory_with_lists_double;
  const BondStrength& bond = body.material.bond;
  const double fraction = single ? 0.5 : 1;
  if (keeps_volume(body) || has_muscles(body)) bytes += fraction * memory_of_strain;
  if (bond.yield_shear > 0 || bond.breaking_strain > 0)
    bytes += fraction * memory_of_changing_bonds;
  bytes += fraction * memory_of_branch * static_cast<double>(bond.branch_count());
  return bytes;
}

double numbers_in(const std::vector<std::string_view>& arrays) {
  double numbers = 0;
  for (const std::string_view name : arrays) {
    const WrittenArray* row = find_written("particles", ArrayPlace::point, name);
    numbers += std::max(1.0, static_cast<double>(row->components.size()));
  }
  return numbers;
}

/// Numbers per particle in the arrays that not every scene has.
double additional_numbers(const OutputSettings& output, const Body& body) {
  return numbers_in(additional_arrays(output, body));
}

/// Numbers per point of the surface in the arrays of particles.
double numbers_on_skin(const ContentOfSkin& skin) {
  const SkinArrays& named = skin.named;
  return numbers_in(skin.usual) + numbers_in(named.frame) + numbers_in(named.requested.measured) +
         numbers_in(named.requested.stepped) + static_cast<double>(named.contact.size());
}

/// Counts bonds of a particle inside, each shared by two.
double bonds_of_one(const Body& body) { return body.material.bond.second > 0 ? 9 : 6; }

}  // namespace

Needs needs_of(const Prepared& prepared) {
  const OutputSettings& output = prepared.settings.output;
  const auto particles = static_cast<double>(prepared.body.rest.size());
  const auto points = static_cast<double>(prepared.surface.triangles.points.size());
  const auto faces = static_cast<double>(prepared.surface.triangles.faces.size());
  const double surfaces = 1 + (output.skin_lbs ? 1 : 0) + (output.skin_dqs ? 1 : 0);
  const ContentOfSkin skin = content_of_skin(output, prepared.body);
  const bool measures_skin = !skin.usual.empty() || !skin.named.requested.measured.empty();
  const double reals_of_world = prepared.body.world ? 3 : 0;  // the force of the world
  const double written =
      particles * written_fraction(output, prepared.body.rest, prepared.body.material.pair.r,
                                   prepared.body.neighbors);
  const double bond_lines = output.bonds ? written * bonds_of_one(prepared.body) : 0;
  const double reals =
      bond_lines * reals_per_bond +
      written * (reals_per_particle + reals_of_world + additional_numbers(output, prepared.body)) +
      surfaces * points * reals_per_point + points * numbers_on_skin(skin) +
      (output.volume ? particles : 0) *
          (volume_points_per_particle *
               (reals_per_particle + reals_of_world + additional_numbers(output, prepared.body)) +
           volume_cells_per_particle);
  const double volume = output.volume ? particles : 0;
  const double wholes = volume * (volume_points_per_particle * wholes_per_particle +
                                  volume_cells_per_particle * wholes_per_cell) +
                        written * wholes_per_particle + bond_lines * wholes_per_bond +
                        surfaces * (points * wholes_per_point + faces * wholes_per_face);
  const double raw = reals * (output.double_precision ? 8 : 4) + wholes * 4;
  const bool compressed = output.encoding == Encoding::zlib || output.encoding == Encoding::lz4;
  const double coded =
      raw * (output.encoding == Encoding::raw ? 1 : base64) * (compressed ? kept_by_zlib : 1);
  const double exported = output.export_surface ? points * exported_per_point : 0;
  const bool bonds = remembers_neighbors(prepared.body.material);
  const double checkpoints =
      particles * (checkpoints_per_particle + (bonds ? bonds_per_particle : 0));
  Needs needs;
  needs.disk = static_cast<std::uint64_t>(
      (coded + exported + bytes_per_frame_beside) * (prepared.frames.count + 1) + checkpoints);
  const StepperChoice choice = stepper_choice(prepared.settings.solver);
  double per_particle = memory_per_particle(choice, prepared.body);
  if (output.bonds) per_particle += memory_of_bonds;
  if (output.volume) per_particle += memory_of_volume;
  if (output.bonds || measures_skin || additional_numbers(output, prepared.body) > 0)
    per_particle += memory_of_measuring;
  needs.memory = static_cast<std::uint64_t>(particles * per_particle + points * memory_per_point +
                                            memory_beside);
  return needs;
}

double speed_at_rest(Prepared prepared, std::vector<std::string>& warnings) {
  const double usual = usual_speed(stepper_choice(prepared.settings.solver));
  const auto particles = static_cast<double>(prepared.filled.particles.size());
  prepared.motion = {};
  Simulation simulation = start(std::move(prepared));
  double spent = 0;
  int steps = 0;
  try {
    simulation.step();
    for (Stopwatch watch; steps < 20 && spent < 0.5; ++steps) {
      simulation.step();
      spent += watch.lap();
    }
  } catch (const Error& error) {
    if (error.exit() != Exit::unstable) throw;
    warnings.push_back(std::string("the body leaves its bones at once: ") + error.what());
  }
  return steps > 0 ? steps * particles / spent : usual;
}

double speed_in_motion(const Prepared& prepared, double at_rest) {
  const bool lists_are_made_again =
      stepper_choice(prepared.settings.solver).search == NeighborSearch::lists &&
      !prepared.motion.tracks.empty();
  return lists_are_made_again ? at_rest / slower_with_lists_in_motion : at_rest;
}

double seconds_of_showing(std::size_t points, int frames) {
  constexpr double start = 2.5, per_frame = 0.04,
                   per_point = 8e-6;  // s, within a third of six runs
  return start + frames * (per_frame + per_point * static_cast<double>(points));
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
  throw not_written(folder.string(),
                    "the run needs about " + bytes_text(static_cast<double>(needs.disk)) +
                        ", the disk has " + bytes_text(static_cast<double>(available)),
                    "make space, choose another folder with -o, or make output.interval longer");
}

}  // namespace sinew
