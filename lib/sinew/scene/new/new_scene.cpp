// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_scene.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/io/vtk/vtk_mesh.h>
#include <sinew/material/laws.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/refine.h>
#include <sinew/mesh/solids.h>
#include <sinew/mesh/winding.h>
#include <sinew/repair/curve_skeleton.h>
#include <sinew/repair/read_surface.h>
#include <sinew/rig/limbs.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/filling.h>
#include <sinew/scene/new/detail/size.h>

namespace sinew {
namespace {

constexpr double min_inside = 0.5;                    // fraction of the limbs' length, in the body
constexpr double pictures = 24, quick_pictures = 10;  // per second
constexpr double longest_quick = 2;                   // s
// A body half a meter long that is as stiff as muscle follows its bones within the motion; speeds
// of waves, and with them steps per second, go with the size.
constexpr double usual_size = 0.5, usual_modulus = 10e3;
constexpr double layer_fraction = 1.0 / 40;  // thickness of a layer along a mesh without inside
constexpr double open_fraction = 0.12;       // share of holes in an area that encloses nothing
constexpr double smallest_shell = 0.05;      // fraction of the area of the mesh
constexpr double max_added = 0.2;            // fraction of the skin, by closing holes

double extent(const Surface& surface) {
  return bounds(surface.triangles.points).sizes().maxCoeff();
}

/// Instead of a mesh without inside.
Surface layer_along(const Surface& sheet, NewChoices& choices) {
  const double thickness = layer_fraction * extent(sheet);
  choices.changed = "a layer of " + three_digits(thickness) + " m along";
  return clean(soup_of(thickened(sheet.triangles, thickness)));
}

/// Whether each component has holes so large that it encloses nothing: a mask, a skirt, not
/// a body that is cut off at the neck.
std::vector<bool> open_shells(const Surface& surface) {
  const Triangles& mesh = surface.triangles;
  std::vector<double> areas(static_cast<std::size_t>(surface.components)), holes = areas;
  std::vector<std::size_t> component_of(mesh.points.size());
  double all = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto component = static_cast<std::size_t>(surface.component[f]);
    const double face = area_vector(mesh, mesh.faces[f]).norm();
    areas[component] += face, all += face;
    for (const int point : mesh.faces[f]) component_of[static_cast<std::size_t>(point)] = component;
  }
  for (const Loop& loop : border_loops(edge_uses(mesh))) {
    Vec3 across = Vec3::Zero();
    for (std::size_t k = 0; k < loop.points.size(); ++k)
      across += mesh.points[loop.points[k]].cross(
                    mesh.points[loop.points[(k + 1) % loop.points.size()]]) /
                2;
    holes[component_of[static_cast<std::size_t>(loop.points.front())]] += across.norm();
  }
  std::vector<bool> open(areas.size());
  for (std::size_t c = 0; c < open.size(); ++c)
    open[c] = areas[c] > smallest_shell * all && holes[c] > open_fraction * areas[c];
  return open;
}

/// The mesh with layers in place of the shells in it.
Surface layered_shells(const Surface& surface, const std::vector<bool>& open, NewChoices& choices) {
  const Triangles& mesh = surface.triangles;
  Triangles shells{mesh.points, {}}, all{mesh.points, {}};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    (open[static_cast<std::size_t>(surface.component[f])] ? shells : all)
        .faces.push_back(mesh.faces[f]);
  const double thickness = layer_fraction * extent(surface);
  append(thickened(shells, thickness), all);
  const auto count = std::count(open.begin(), open.end(), true);
  choices.changed = "layers of " + three_digits(thickness) + " m along " + std::to_string(count) +
                    " open " + (count == 1 ? "shell" : "shells") + " of";
  return clean(soup_of(all));
}

/// The mesh with its holes closed, where that adds little to its skin.
std::optional<Surface> with_closed_holes(const Surface& open, BodyOptions body) {
  if (open.closed()) return std::nullopt;
  body.close_holes = true;
  try {
    Surface closed = read_body_mesh(body);
    const double skin = area(closed.triangles);
    if (!closed.closed() || skin - area(open.triangles) > max_added * skin ||
        !(volume_inside(closed).volume > 0))
      return std::nullopt;
    return closed;
  } catch (const Error&) {  // nothing is enclosed
    return std::nullopt;
  }
}

/// Reads the mesh; unit and axes as guessed, and its holes closed where that is asked for and they
/// can be.
Surface read_guessing(NewChoices& choices, const std::optional<Axis>& given_up, bool close) {
  BodyOptions& body = choices.settings.body;
  Surface surface = read_body_mesh(body);
  const UnitGuess unit = guess_unit(body.mesh, extent(surface));
  const UpGuess up =
      given_up ? UpGuess{*given_up, "as --up says"} : guess_up(body.mesh, surface.triangles.points);
  body.unit = unit.unit, choices.unit = unit.why;
  body.up = up.up, choices.axes = up.why;
  if (up.up == Axis::y) body.forward = Axis::z;
  if (unit.unit != LengthUnit::m || up.up != Axis::z) surface = read_body_mesh(body);
  const std::vector<bool> open = open_shells(surface);
  const auto shells = std::count(open.begin(), open.end(), true);
  if (auto closed = close && shells == 0 ? with_closed_holes(surface, body) : std::nullopt) {
    body.close_holes = true;
    const std::size_t holes = closed->cleaning.holes_closed;
    choices.holes = std::to_string(holes) + (holes == 1 ? " hole" : " holes") +
                    " of the mesh, closed (body.close_holes)";
    return std::move(*closed);
  }
  if (shells > 0 && shells < surface.components) surface = layered_shells(surface, open, choices);
  const bool no_inside =
      ambiguous_fraction(surface) > max_ambiguous || !(volume_inside(surface).volume > 0);
  return no_inside || shells == surface.components ? layer_along(surface, choices) : surface;
}

/// The fraction of the limbs' length that lies in the body.
double fraction_inside(const std::vector<Limb>& limbs, const Surface& surface) {
  const Winding winding = winding_of(surface);
  double inside = 0, all = 0;
  for (const Limb& limb : limbs)
    for (std::size_t i = 1; i < limb.line.size(); ++i) {
      const double length = (limb.line[i] - limb.line[i - 1]).norm();
      const Vec3 middle = (limb.line[i] + limb.line[i - 1]) / 2;
      all += length;
      if (winding.around(middle).value_or(1) != 0) inside += length;
    }
  return all > 0 ? inside / all : 0;
}

/// The limbs by the curves of the skin, or along the longest axis of its points: of hollow bodies,
/// such as a cup, the curves lie in the hollow.
std::vector<Limb> limbs_in(const Surface& surface, NewChoices& choices) {
  try {
    std::vector<Limb> limbs = limbs_of(curve_skeleton(surface.triangles));
    choices.hollow = !limbs.empty() && fraction_inside(limbs, surface) < min_inside;
    if (!limbs.empty() && !choices.hollow) return limbs;
  } catch (const Error&) {  // no closed surface can be made of the mesh
  }
  return axis_limbs(surface.triangles.points);
}

void use_limbs(const std::vector<Limb>& limbs, NewChoices& choices) {
  const double radius = *choices.settings.body.radius;
  LimbRig rig = bones_of(limbs, {.radius = radius});
  if (rig.tracks.empty()) {
    Points skin;
    for (const Limb& limb : limbs) skin.insert(skin.end(), limb.line.begin(), limb.line.end());
    rig = bones_of(axis_limbs(skin), {.radius = radius});
  }
  choices.settings.bones = std::move(rig.bones);
  choices.settings.tracks = std::move(rig.tracks);
  const auto tips = std::count_if(limbs.begin(), limbs.end(),
                                  [](const Limb& limb) { return limb.end == Limb::End::tip; });
  choices.bones = std::to_string(choices.settings.bones.size()) + " bones along ";
  choices.bones +=
      tips == 0 ? "the rings" : std::to_string(tips) + (tips == 1 ? " limb" : " limbs");
  choices.bones += " of the mesh";
  if (choices.hollow) choices.bones += ", which is hollow: along its longest axis";
  double last = 0;
  for (const TrackDefinition& track : choices.settings.tracks)
    last = std::max(last, *track.keys.back().time);
  choices.settings.solver.duration = last + rest_after;
}

/// Sides no longer than half a limb's thickness, of so many faces at most: halving makes right
/// triangles whose longest side is up to half as long.
double bending_side(const Surface& surface, double thickness) {
  constexpr double max_faces = 40e3;
  return std::max(thickness / 2, 4 * std::sqrt(area(surface.triangles) / max_faces));
}

/// Writes the mesh anew where its large triangles would not show how the body bends, or where it
/// has been changed.
void refine_mesh(const std::string& scene, const Surface& surface, NewChoices& choices,
                 NewScene& made) {
  constexpr double too_long = 3;
  const double side = bending_side(surface, choices.thickness);
  const bool coarse = longest_side(surface.triangles) > too_long * side;
  if (!coarse && choices.changed.empty()) return;
  std::filesystem::path path = scene;
  path.replace_filename(path.stem().string() + "_fine.obj");
  made.mesh = path.string();
  made.mesh_text = obj_text(coarse ? refined(surface.triangles, side) : surface.triangles);
  BodyOptions& body = choices.settings.body;
  if (choices.changed.empty()) choices.changed = "smaller triangles of";
  choices.changed += ' ' + shown(std::filesystem::path(body.mesh).filename().string());
  body.mesh = made.mesh;
  body.unit = LengthUnit::m, body.up = Axis::z, body.forward.reset(), body.close_holes = false;
}

/// Finite element meshes number the materials of their cells: all but the largest one become parts
/// of the body, each in a file of its own, with the modulus of all until a person gives another.
void add_materials(const NewSceneFiles& files, const BodyOptions& placed, NewChoices& choices,
                   NewScene& made) {
  const std::string extension = lower(std::filesystem::path(files.mesh).extension().string());
  if (files.figure != nullptr || (extension != ".vtu" && extension != ".vtk")) return;
  std::vector<MaterialSurface> materials = read_vtk_materials(files.mesh);
  if (materials.size() < 2) return;
  std::vector<double> sizes;
  sizes.reserve(materials.size());
  for (const MaterialSurface& one : materials)
    sizes.push_back(volume(clean(one.surface).triangles));
  const auto largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
  choices.materials = "parts by the numbers of materials of the file's cells; the others have " +
                      std::to_string(materials[static_cast<std::size_t>(largest)].number);
  materials.erase(materials.begin() + largest);
  for (MaterialSurface& one : materials) {
    std::filesystem::path path = files.scene;
    path.replace_filename(path.stem().string() + "_material_" + std::to_string(one.number) +
                          ".ply");
    LocalMaterialSettings local{"material " + std::to_string(one.number)};
    local.young_modulus = choices.settings.material.young_modulus;
    local.part.mesh = path.string();
    choices.settings.materials.push_back(local);
    if (!made.mesh.empty()) place(one.surface, placed);
    made.parts.emplace_back(path.string(), ply_text(one.surface));
  }
}

void choose_material(const Surface& surface, NewChoices& choices) {
  const double ratio = extent(surface) / usual_size;
  choices.settings.material.model = MaterialModel::bonded;
  choices.settings.material.young_modulus = three_figures(usual_modulus * ratio * ratio);
}

void choose_binding(BindingOptions& binding, bool hollow) {
  binding.joint_zone = 0.7;
  binding.rigid_below = 2;
  binding.soften_below = 64;
  binding.stiffness = binding.twist_stiffness = 6.4;
  binding.axial_stiffness = 2.56;
  if (binding.method == BindMethod::nearest && !hollow) binding.method = BindMethod::inside;
}

/// Clips are made without flesh, which they drive into other flesh.
void choose_contacts(Settings& settings) {
  const double r = *settings.body.radius;
  const Material material =
      make_material(settings.material, {r, settings.material.density * volume_per_particle(r),
                                        lattice_axes(settings.body), settings.body.packing});
  const ForceLaw& law = law_of(material);
  settings.binding.max_force =
      three_figures(law.has_bonds ? law.bond_force(material, {2 * r, material.bond.stiffness}, r)
                                  : law.force(material, r));
  settings.contact.pass_through.automatic = true;
}

void shorten(NewChoices& choices) {
  double& end = choices.settings.solver.duration;
  if (choices.quick) end = std::min(end, longest_quick);
  if (choices.duration) end = *choices.duration;
}

/// Moves joints that skin follows, where a rig has no clip, and chooses the radius by the work.
void try_out(const Surface& surface, NewChoices& choices) {
  try {
    shorten(choices);
    Prepared prepared = tried(surface, choices);
    if (!choices.settings.skeleton.file.empty() && !choices.settings.tracks.empty()) {
      bend_joints(prepared.body, choices);
      shorten(choices);
      BodyFile filled = std::move(prepared.filled);
      prepared = tried(surface, choices, std::move(filled));
    }
    use_budget(prepared, choices);
  } catch (const Error&) {  // check names what is wrong
  }
}

}  // namespace

NewScene new_scene(const NewSceneFiles& files) {
  NewChoices choices;
  Settings& settings = choices.settings;
  settings.body.mesh = files.mesh;
  choices.quick = files.quick, choices.clip = files.clip;
  choices.count = files.count, choices.duration = files.duration;
  settings.output.interval = 1 / (files.quick ? quick_pictures : pictures);
  const std::string rig = !files.rig.empty() ? files.rig : rig_within(files.mesh);
  Surface surface = files.figure == nullptr ? read_guessing(choices, files.up, rig.empty())
                                            : read_body_mesh(settings.body);
  const std::string warning = surface.warning;
  if (files.figure != nullptr)
    use_rig(*files.figure, surface, choices);
  else if (!rig.empty())
    surface = use_rig(rig, std::move(surface), choices);
  const std::vector<Limb> limbs = limbs_in(surface, choices);
  choices.box = bounds(surface.triangles.points);
  choose_radius(surface, limbs, choices);
  if (rig.empty())
    use_limbs(limbs, choices);
  else
    choices.hollow = false;
  shorten(choices);
  choose_material(surface, choices);
  choose_binding(settings.binding, choices.hollow);
  try_out(surface, choices);
  if (settings.motion.begin == Begin::automatic) choose_contacts(settings);
  NewScene made;
  const BodyOptions placed = settings.body;
  refine_mesh(files.scene, surface, choices, made);
  add_materials(files, placed, choices, made);
  made.text = new_scene_text(choices, std::filesystem::path(files.scene).parent_path());
  made.unit = choices.unit, made.axes = choices.axes, made.holes = choices.holes;
  made.materials = choices.materials;
  made.bones = choices.bones, made.pose = choices.pose, made.size = choices.size,
  made.warning = warning, made.time = choices.time;
  return made;
}

}  // namespace sinew
