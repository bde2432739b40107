// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/particle_formats/formats.h>

#include <algorithm>
#include <map>
#include <utility>

#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/io/particle_formats/detail/writers.h>
#include <sinew/io/vtu.h>

namespace sinew {
namespace {

const std::vector<ParticleFormat> formats = {
    {"vtu", {".vtu"}, "VTK and ParaView"},
    {"lammps", {".data", ".lmp"}, "LAMMPS data with bonds", true, false, add_lammps_data},
    {"dump", {".lammpstrj", ".dump"}, "LAMMPS dump", false, true, add_lammps_dump},
    {"xyz", {".xyz", ".extxyz"}, "extended XYZ of OVITO and ASE", false, true, add_xyz},
    {"csv", {".csv"}, "table", false, false, add_csv},
    {"yade", {".txt"}, "spheres for YADE's ymport.textExt", false, false, add_yade},
    {"peridigm",
     {".txt"},
     "mesh of Peridigm and PeriLab",
     false,
     false,
     add_peridigm,
     write_node_sets},
    {"bgeo", {".bgeo"}, "Partio, SPlisHSPlasH, Houdini", false, false, add_bgeo},
    {"gltf", {".glb"}, "glTF points", false, false, add_gltf_points},
};

/// Names may come from files of others.
std::string ascii_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '_');
  return text;
}

/// Stiffness and bone.
using RegionKey = std::pair<double, std::int32_t>;

std::string name_of(const RegionKey& key, const BodyFile& body,
                    std::span<const std::string> bones) {
  std::string name;
  if (body.stiffness) name = "stiffness " + number_text(key.first);
  if (!body.bone) return name.empty() ? "body" : name;
  if (!name.empty()) name += ", ";
  if (key.second < 0) return name + "no bone";
  const auto bone = static_cast<std::size_t>(key.second);
  return ascii_line(name + "bone " + (bone < bones.size() ? bones[bone] : std::to_string(bone)));
}

void find_regions(ParticleCloud& cloud, const BodyFile& body, std::span<const std::string> bones) {
  const auto key_of = [&](std::size_t i) {
    return RegionKey{body.stiffness ? (*body.stiffness)[i] : 1, body.bone ? (*body.bone)[i] : -1};
  };
  const std::size_t count = cloud.positions.size();
  std::map<RegionKey, std::int32_t> number;
  for (std::size_t i = 0; i < count; ++i) number.try_emplace(key_of(i), 0);
  for (auto& [key, place] : number) {
    place = static_cast<std::int32_t>(cloud.region_names.size());
    cloud.region_names.push_back(name_of(key, body, bones));
  }
  cloud.region.resize(count);
  for (std::size_t i = 0; i < count; ++i) cloud.region[i] = number.at(key_of(i));
}

bool has_extension(const ParticleFormat& format, const std::string& extension) {
  return std::find(format.extensions.begin(), format.extensions.end(), extension) !=
         format.extensions.end();
}

std::vector<std::string_view> names_of_formats() {
  std::vector<std::string_view> names;
  names.reserve(formats.size());
  for (const ParticleFormat& format : formats) names.push_back(format.name);
  return names;
}

const ParticleFormat& format_named(const std::string& name) {
  for (const ParticleFormat& format : formats)
    if (format.name == name) return format;
  throw bad_input("no format is named " + shown(name), suggestion(name, names_of_formats()));
}

const ParticleFormat& format_of_extension(const std::string& extension,
                                          const std::filesystem::path& path) {
  const ParticleFormat* found = nullptr;
  for (const ParticleFormat& format : formats) {
    if (!has_extension(format, extension)) continue;
    if (found)
      throw bad_input(
          "formats " + std::string(found->name) + " and " + std::string(format.name) +
              " both end in " + extension,
          "add --to " + std::string(found->name) + " or --to " + std::string(format.name));
    found = &format;
  }
  if (found) return *found;
  throw bad_input(shown(path.string()) + " has the extension of no format",
                  "add --to with one of " + listed(names_of_formats()));
}

/// What the series "particles" says of a moment, as far as it is known.
void write_particles_vtu(const std::filesystem::path& path, const ParticleCloud& cloud) {
  Dataset data;
  data.time = cloud.time;
  data.points = cloud.positions;
  data.connectivity = vertex_cells(cloud.positions.size());
  data.point_columns = {
      column("id", cloud.id),
      column("radius", std::vector<double>(cloud.positions.size(), cloud.radius))};
  if (!cloud.bone.empty()) data.point_columns.push_back(column("bone", cloud.bone));
  if (!cloud.velocities.empty()) data.point_columns.push_back(column("velocity", cloud.velocities));
  VtuFormat format;
  format.series = "particles";
  format.radius = cloud.radius;
  write_vtu(path, data, format);
}

}  // namespace

ParticleCloud cloud_of(const BodyFile& body, double density, std::span<const std::string> bones) {
  ParticleCloud cloud;
  cloud.positions = positions_of(body.particles);
  cloud.origin = local_origin(bounds(cloud.positions));
  cloud.radius = body.particles.radius;
  cloud.mass = body.particles.mass;
  cloud.volume = cloud.mass / density;
  cloud.id = body.particles.id;
  cloud.component = body.component;
  if (body.bone) cloud.bone = *body.bone;
  find_regions(cloud, body, bones);
  return cloud;
}

std::vector<std::array<std::uint32_t, 2>> touching_pairs(const Points& rest, double radius) {
  const NeighborLists lists = neighbors_within(rest, rest_neighbor_range(radius));
  std::vector<std::array<std::uint32_t, 2>> pairs;
  pairs.reserve(lists.neighbor.size() / 2);
  for (std::uint32_t i = 0; i < lists.size(); ++i)
    for (const std::uint32_t j : lists.of(i))
      if (i < j) pairs.push_back({i, j});
  return pairs;
}

std::span<const ParticleFormat> particle_formats() { return formats; }

std::string help_of_formats() {
  std::string text;
  for (const ParticleFormat& format : formats)
    ((text += text.empty() ? "" : ", ") += format.name) += " (" + std::string(format.help) + ')';
  return text;
}

const ParticleFormat& format_of(const std::string& name, const std::filesystem::path& path) {
  return name.empty() ? format_of_extension(lower(path.extension().string()), path)
                      : format_named(name);
}

void write_particles(const std::filesystem::path& path, const ParticleCloud& cloud,
                     const ParticleFormat& format) {
  if (!format.add) return write_particles_vtu(path, cloud);
  NewFile file(path);
  format.add(file, cloud);
  file.finish();
  if (format.write_beside) format.write_beside(path, cloud);
}

}  // namespace sinew
