// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/filling.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/json.h>
#include <sinew/core/particles.h>
#include <sinew/core/random.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/mesh/mesh_formats.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/context.h>
#include <sinew/settings/row.h>
#include <sinew/settings/table.h>

namespace sinew {

Mat3 lattice_axes(const BodyOptions& body) {
  return body.lattice_rotation ? rotation_of(*body.lattice_rotation) : random_rotation(body.seed);
}

namespace {

/// Whether the forces depend on how much of the body is around each particle.
bool needs_volume_shares(const Settings& settings) {
  return is_isotropic(settings.material, settings.body.packing);
}

PackOptions pack_options(const Settings& settings) {
  const BodyOptions& body = settings.body;
  PackOptions options;
  options.packing = body.packing;
  options.seed = body.seed;
  options.radius = body.radius;
  options.count = body.count;
  options.density = settings.material.density;
  options.lattice_origin = body.lattice_origin;
  options.lattice_axes = lattice_axes(body);
  options.keep = body.keep;
  options.clearance = body.clearance;
  options.thickness = body.thickness;
  options.volume_shares = needs_volume_shares(settings);
  return options;
}

}  // namespace

Filling fill_body(const Settings& settings, const Surface& surface, bool verify) {
  PackOptions options = pack_options(settings);
  options.verify = verify;
  Filling filling = with_context(settings, options.radius ? "body.radius" : "body.count",
                                 [&] { return pack(surface, options); });
  filling.stiffness = stiffness_of(settings, surface, positions_of(filling.particles));
  return filling;
}

VolumeCells cells_of_body(const Settings& settings, const Surface& surface, const Points& rest,
                          double radius) {
  PackOptions options = pack_options(settings);
  options.count.reset();
  options.radius = radius;
  return volume_cells(surface, options, rest);
}

namespace {

nlohmann::ordered_json json_of(const ReportValue& value) {
  const auto json = [](const auto& one) -> nlohmann::ordered_json {
    if constexpr (std::is_same_v<std::decay_t<decltype(one)>, Vec3>)
      return {one.x(), one.y(), one.z()};
    else
      return one;
  };
  return std::visit(json, value);
}

}  // namespace

BodyFile body_file(Filling filling, const std::string& origin) {
  nlohmann::ordered_json meta;
  meta["program"] = "sinew";
  meta["version"] = version();
  meta["origin"] = origin;
  for (const ReportRow& row : rows_of(filling.report)) {
    meta["fill"][row.key] = json_of(row.value);
    if (!row.unit.empty()) meta["fill_units"][row.key] = row.unit;
  }
  meta["fill"]["warnings"] = filling.report.warnings;
  BodyFile body;
  body.particles = std::move(filling.particles);
  body.neighbors = std::move(filling.neighbors);
  body.component = std::move(filling.component);
  if (!filling.volume_share.empty()) body.volume_share = std::move(filling.volume_share);
  if (!filling.stiffness.empty()) body.stiffness = std::move(filling.stiffness);
  body.meta = json_text(meta);
  return body;
}

std::vector<std::string> fill_warnings(const BodyFile& body) {
  const auto meta = own_json<nlohmann::json>(body.meta);
  const auto place = nlohmann::json::json_pointer("/fill/warnings");
  std::vector<std::string> warnings;
  if (!meta.is_object() || !meta.contains(place)) return warnings;
  for (const auto& one : meta[place])
    if (one.is_string()) warnings.push_back(one);
  return warnings;
}

namespace {

constexpr std::uint64_t largest_mesh = std::uint64_t{4} << 30;  // bytes

/// The bytes of a mesh file.
std::string bytes_of(const Settings& settings, const std::string& mesh, const std::string& key) {
  const auto held = settings.meshes.find(mesh);
  if (held != settings.meshes.end()) return ply_text(*held->second);
  return with_context(settings, key.c_str(), [&] { return read_file(mesh, largest_mesh); });
}

/// Whether the particles depend on this text of a body; on its mesh they do by the contents.
bool fills(std::string_view key) {
  return key != "mesh" && key != "velocity" && key != "angular_velocity";
}

}  // namespace

std::string origin_of(const Settings& settings) {
  Hash hash;
  hash.add(bytes_of(settings, settings.body.mesh, "body.mesh"));
  for (const auto& field : settings_table())
    if ((field.section == "body" && fills(field.name)) || field.name == "density")
      hash.add(scene_text(field.get(settings), "") + '\n');
  for (std::size_t part = 0; part < settings.bodies.size(); ++part) {
    const PartOptions& options = settings.bodies[part];
    hash.add(bytes_of(settings, options.body.mesh, "bodies[" + std::to_string(part) + "].mesh"));
    for (const auto& field : part_fields())
      if (fills(field.name)) hash.add(scene_text(field.get(options), "") + '\n');
    if (options.young_modulus) hash.add(number_text(settings.material.young_modulus));
  }
  for (const LocalMaterialSettings& material : settings.materials)
    for (const auto& field : material_fields())
      hash.add(scene_text(field.get(material), "") + '\n');
  if (needs_volume_shares(settings)) hash.add("shares of 24 lattices\n");
  return hash_text(hash.value());
}

std::optional<BodyFile> body_of_scene(const std::filesystem::path& path,
                                      const std::string& origin) {
  std::error_code unreachable;
  if (!std::filesystem::exists(path, unreachable)) return std::nullopt;
  try {
    BodyFile body = read_body(path);
    const auto meta = own_json<nlohmann::json>(body.meta);
    if (meta.is_object() && meta.contains("origin") && meta["origin"] == origin) return body;
  } catch (const Error&) {
    // Not a body, or an incomplete one: it is filled again.
  }
  return std::nullopt;
}

}  // namespace sinew
