// SPDX-License-Identifier: GPL-3.0-or-later
// Particles as files of other programs, one row of a table per format.
//
//     ParticleCloud cloud = cloud_of(read_body("body.vtu"), density);
//     const ParticleFormat& format = format_of("lammps", "body.data");
//     if (format.bonds) cloud.bonds = touching_pairs(cloud.positions, cloud.radius);
//     write_particles("body.data", cloud, format);
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/file.h>
#include <sinew/core/vector.h>
#include <sinew/io/single_files.h>

namespace sinew {

/// Equal particles at one moment. Columns have one value per particle.
struct ParticleCloud {
  Points positions;                                 ///< m
  Points velocities;                                ///< m/s; empty: they are not known
  double radius = 0, mass = 0, volume = 0;          ///< values of each: m, kg, m^3
  std::vector<std::int32_t> id;                     ///< ascending, from 0
  std::vector<std::int32_t> component;              ///< connected component, from 0
  std::vector<std::int32_t> bone;                   ///< -1 for none; empty: not bound
  std::vector<std::int32_t> region;                 ///< region of one material and one bone, from 0
  std::vector<std::string> region_names;            ///< one line of ASCII each
  std::vector<std::array<std::uint32_t, 2>> bonds;  ///< rows of two particles each
  double time = 0;                                  ///< s
  std::int64_t frame = 0;
  Vec3 origin = Vec3::Zero();  ///< to which formats in single precision are relative, m
};

/// The body at rest, without bonds; `density` (kg/m^3) gives the volumes, `bones` the names of its
/// regions.
ParticleCloud cloud_of(const BodyFile& body, double density,
                       std::span<const std::string> bones = {});

/// Pairs of particles (rows, the lower first) that touch at rest, `radius` (m) in size: in closest
/// packing each has up to 12.
std::vector<std::array<std::uint32_t, 2>> touching_pairs(const Points& rest, double radius);

struct ParticleFormat {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< with the dot; the first is the usual one
  std::string_view help;                     ///< what it is
  bool bonds = false;                        ///< has a place for them
  bool many_frames = false;                  ///< in one file
  void (*add)(NewFile&, const ParticleCloud&) = nullptr;  ///< a frame; null: VTU
  /// Writes what belongs into files beside that of the particles; null: nothing.
  void (*write_beside)(const std::filesystem::path&, const ParticleCloud&) = nullptr;
};

std::span<const ParticleFormat> particle_formats();

/// "lammps (LAMMPS data ...), xyz (...), ..." for help texts.
std::string help_of_formats();

/// The format of that name, whatever `path` is called, or where it is "" of the extension of
/// `path`. Throws bad input for unknown ones, and for an extension that several formats share.
const ParticleFormat& format_of(const std::string& name, const std::filesystem::path& path);

/// Each file atomically. Throws not written.
void write_particles(const std::filesystem::path& path, const ParticleCloud& cloud,
                     const ParticleFormat& format);

}  // namespace sinew
