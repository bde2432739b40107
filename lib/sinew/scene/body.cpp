// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/body.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/json.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/core/random.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/io/gltf/look.h>
#include <sinew/io/vtk/vtk_mesh.h>
#include <sinew/mesh/winding.h>
#include <sinew/repair/read_surface.h>
#include <sinew/settings/row.h>
#include <sinew/settings/table.h>

namespace sinew {

namespace {

PolygonSoup read_gltf_file(const std::string& path) { return read_gltf(path); }

PolygonSoup read_vtk_file(const std::string& path) { return read_vtk_mesh(path); }

PolygonSoup read_gltf_look_file(const std::string& path, PolygonLook& look) {
  return read_gltf_look(path, look);
}

/// In addition to those of the room mesh, which does not depend on io.
constexpr std::array<MeshFormat, 6> formats_of_io = {
    {{"glTF", ".gltf", read_gltf_file, nullptr, read_gltf_look_file},
     {"GLB", ".glb", read_gltf_file, nullptr, read_gltf_look_file},
     {"VTP", ".vtp", read_vtk_file},
     {"VTU", ".vtu", read_vtk_file},
     {"VTK", ".vtk", read_vtk_file},
     {"VTI", ".vti", read_vtk_file}}};

}  // namespace

std::string mesh_formats() { return mesh_format_names(formats_of_io); }

Surface read_body_mesh(const BodyOptions& body) { return read_surface(body, formats_of_io); }

Surface read_body_mesh(const BodyOptions& body, const Settings& scene) {
  const auto held = scene.meshes.find(body.mesh);
  return held == scene.meshes.end() ? read_body_mesh(body) : read_surface(*held->second, body);
}

namespace {

constexpr std::uint64_t largest_mesh = std::uint64_t{4} << 30;  // bytes

}  // namespace

bool is_scene(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

void refuse_mesh_as_scene(const std::string& path) {
  if (names_mesh(path, formats_of_io))
    throw bad_input({path}, "this is a mesh, not a scene",
                    "make a scene of it: sinew new " + shell_quoted(path));
  if (lower(std::filesystem::path(path).extension().string()) == ".bvh")
    throw bad_input({path}, "this is a rig, not a scene",
                    "make a scene of it and a mesh: sinew new MESH " + shell_quoted(path));
}

void refuse_to_replace_scene(const std::filesystem::path& output) {
  std::error_code missing;
  if (is_scene(output) && std::filesystem::exists(output, missing))
    throw bad_input(Place{output.string()}, "is a scene, and would be replaced",
                    "give another name with -o");
}

void refuse_output(const std::string& output, std::initializer_list<std::string> inputs,
                   const std::string& extension) {
  if (std::filesystem::path(output).extension() != extension)
    throw bad_input("'" + output + "' is no name for a " + extension + " file",
                    "give a name that ends in " + extension);
  std::error_code missing;
  for (const std::string& input : inputs)
    if (std::filesystem::equivalent(output, input, missing))
      throw bad_input(Place{output}, "is an input, and would be replaced",
                      "give another name with -o");
  refuse_to_replace_scene(output);
}

Mat3 lattice_axes(const BodyOptions& body) {
  return body.lattice_rotation ? rotation_of(*body.lattice_rotation) : random_rotation(body.seed);
}

namespace {

std::string path_of_part(std::size_t part, const char* key) {
  return "bodies[" + std::to_string(part) + "]." + key;
}

/// Closed, lest it is unknown which particles lie in it.
Surface read_part(const Settings& settings, std::size_t part) {
  const std::string key = path_of_part(part, "mesh");
  Surface surface = with_context(
      settings, key.c_str(), [&] { return read_body_mesh(settings.bodies[part].body, settings); });
  if (!surface.closed())
    throw bad_input(settings.place(key), "one of several bodies has holes in its mesh",
                    "set close_holes: true for it");
  return surface;
}

std::vector<Corners> corners_of(const Triangles& surface, std::size_t first, std::size_t end) {
  std::vector<Corners> faces;
  for (std::size_t f = first; f < end; ++f) {
    const auto& [a, b, c] = surface.faces[f];
    faces.push_back({surface.points[a], surface.points[b], surface.points[c]});
  }
  return faces;
}

}  // namespace

SurfaceLook look_of_mesh(const Settings& settings, const Triangles& surface) {
  if (settings.meshes.contains(settings.body.mesh)) return {};
  return look_of(settings.body, surface, formats_of_io);
}

Surface read_mesh(const Settings& settings) {
  std::vector<Surface> parts;
  parts.push_back(
      with_context(settings, "body.mesh", [&] { return read_body_mesh(settings.body, settings); }));
  for (std::size_t part = 0; part < settings.bodies.size(); ++part)
    parts.push_back(read_part(settings, part));
  return joined(std::move(parts));
}

std::vector<std::size_t> meshes_of_particles(const Settings& settings, const Surface& surface,
                                             const Points& rest) {
  std::vector<std::size_t> mesh(rest.size());
  for (std::size_t part = 1; part <= settings.bodies.size(); ++part) {
    const std::size_t first = surface.first_face[part];
    const std::size_t end = part + 1 < surface.first_face.size() ? surface.first_face[part + 1]
                                                                 : surface.triangles.faces.size();
    const Winding winding(corners_of(surface.triangles, first, end));
    parallel_for(rest.size(), 1024, [&](std::size_t begin, std::size_t last) {
      for (std::size_t i = begin; i < last; ++i)
        if (winding.around(rest[i]).value_or(0) > 0) mesh[i] = part;
    });
  }
  return mesh;
}

std::vector<double> stiffness_of(const Settings& settings, const Surface& surface,
                                 const Points& rest) {
  const double own = settings.material.young_modulus;
  std::vector<double> relative = {1};
  for (const PartOptions& part : settings.bodies)
    relative.push_back(part.young_modulus.value_or(own) / own);
  if (std::count(relative.begin(), relative.end(), 1.0) == std::ssize(relative)) return {};
  std::vector<double> stiffness;
  for (const std::size_t mesh : meshes_of_particles(settings, surface, rest))
    stiffness.push_back(relative[mesh]);
  return stiffness;
}

namespace {

/// Whether the forces depend on how much of the body is around each particle.
bool needs_volume_shares(const Settings& settings) {
  return is_isotropic(settings.material, settings.body.packing);
}

}  // namespace

namespace {

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

nlohmann::ordered_json json_of(const ReportValue& value) {
  const auto json = [](const auto& one) -> nlohmann::ordered_json {
    if constexpr (std::is_same_v<std::decay_t<decltype(one)>, Vec3>)
      return {one.x(), one.y(), one.z()};
    else
      return one;
  };
  return std::visit(json, value);
}

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

std::string file_name_of(const std::string& mesh) {
  std::string name = std::filesystem::path(mesh).stem().string();
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-') letter = '_';
  return name;
}

/// The bytes of a mesh file.
std::string bytes_of(const Settings& settings, const std::string& mesh, const std::string& key) {
  const auto held = settings.meshes.find(mesh);
  if (held != settings.meshes.end()) return ply_text(*held->second);
  return with_context(settings, key.c_str(), [&] { return read_file(mesh, largest_mesh); });
}

/// Calls visit(mesh) for every mesh that a scene names.
template <class Visit>
void for_each_mesh(Settings& scene, const Visit& visit) {
  visit(scene.body.mesh);
  for (PartOptions& part : scene.bodies) visit(part.body.mesh);
  for (LocalMaterialSettings& material : scene.materials) visit(material.part.mesh);
  for (ObstacleSettings& obstacle : scene.world.obstacles) visit(obstacle.mesh);
}

}  // namespace

Settings with_mesh_files(Settings scene, const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  std::map<std::string, SharedPolygons> meshes;
  for (const auto& [name, soup] : scene.meshes) {
    std::string stem = file_name_of(name);
    while (meshes.contains((folder / stem).string() + ".ply")) stem += '_';
    files[name] = (folder / stem).string() + ".ply";
    meshes[files[name]] = soup;
  }
  for_each_mesh(scene, [&](std::string& mesh) {
    if (const auto file = files.find(mesh); file != files.end()) mesh = file->second;
  });
  scene.meshes = std::move(meshes);
  return scene;
}

void write_mesh_files(const Settings& scene) {
  for (const auto& [path, soup] : scene.meshes) {
    create_folder(std::filesystem::path(path).parent_path());
    write_file(path, ply_text(*soup));
  }
}

namespace {

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
    hash.add(bytes_of(settings, options.body.mesh, path_of_part(part, "mesh")));
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
