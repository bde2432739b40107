// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/body_mesh.h>

#include <algorithm>
#include <array>
#include <map>

#include <sinew/core/file.h>
#include <sinew/core/parallel.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/geometry.h>
#include <sinew/io/gltf/look.h>
#include <sinew/io/vtk/vtk_mesh.h>
#include <sinew/mesh/winding.h>
#include <sinew/repair/read_surface.h>
#include <sinew/scene/context.h>

namespace sinew {

namespace {

PolygonSoup read_gltf_file(const std::string& path) { return read_gltf(path); }

PolygonSoup read_vtk_file(const std::string& path) { return read_vtk_mesh(path); }

PolygonSoup read_vtk_image(const std::string& path, double level) {
  return read_vtk_mesh(path, level);
}

PolygonSoup read_gltf_look_file(const std::string& path, PolygonLook& look) {
  return read_gltf_look(path, look);
}

/// In addition to those of the room mesh, which does not depend on io.
constexpr std::array<MeshFormat, 9> formats_of_io = {
    {{"glTF", ".gltf", read_gltf_file, nullptr, read_gltf_look_file},
     {"GLB", ".glb", read_gltf_file, nullptr, read_gltf_look_file},
     {"VRM", ".vrm", read_gltf_file, nullptr, read_gltf_look_file},
     {"FBX", ".fbx", read_gltf_file, nullptr, read_gltf_look_file},
     {"COLLADA", ".dae", read_gltf_file, nullptr, read_gltf_look_file},
     {"VTP", ".vtp", read_vtk_file},
     {"VTU", ".vtu", read_vtk_file},
     {"VTK", ".vtk", read_vtk_file, nullptr, nullptr, read_vtk_image},
     {"VTI", ".vti", read_vtk_file, nullptr, nullptr, read_vtk_image}}};

}  // namespace

std::string mesh_formats() { return mesh_format_names(formats_of_io); }

Surface read_body_mesh(const BodyOptions& body) { return read_surface(body, formats_of_io); }

Surface read_body_mesh(const BodyOptions& body, const Settings& scene) {
  const auto held = scene.meshes.find(body.mesh);
  return held == scene.meshes.end() ? read_body_mesh(body) : read_surface(*held->second, body);
}

bool is_mesh(const std::filesystem::path& path) { return names_mesh(path, formats_of_io); }

namespace {

/// Closed, lest it is unknown which particles lie in it.
Surface read_part(const Settings& settings, std::size_t part) {
  const std::string key = "bodies[" + std::to_string(part) + "].mesh";
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

std::string file_name_of(const std::string& mesh) {
  std::string name = std::filesystem::path(mesh).stem().string();
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-') letter = '_';
  return name;
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

}  // namespace sinew
