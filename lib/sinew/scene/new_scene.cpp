// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new_scene.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <utility>

#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/core/union_find.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/fill/pack.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/refine.h>
#include <sinew/mesh/winding.h>
#include <sinew/repair/curve_skeleton.h>
#include <sinew/rig/limbs.h>
#include <sinew/scene/body.h>

namespace sinew {
namespace {

// Seconds of filling and stepping on two cores, and at least as fine as looks like a body.
constexpr double fewest = 3000, most = 10000, max_if_split = 60000;
constexpr double max_overlap = 0.8;    // of the volume by the faces lies there once
constexpr double across = 4.5;         // particles across a limb
constexpr double thin_fraction = 0.1;  // of the limbs' length is thinner than what counts as thin
constexpr double max_loose = 0.01;     // of the particles, such as single ones at a tip
constexpr double min_within = 0.1;     // of the particles, with neighbors on all sides
constexpr double min_inside = 0.5;     // of the limbs' length, in the body
constexpr double pictures = 24;        // per second
// A body half a meter long that is as stiff as muscle follows its bones within the motion; speeds
// of waves, and with them steps per second, go with the size.
constexpr double usual_size = 0.5, usual_modulus = 10e3;
constexpr double layer_fraction = 1.0 / 40;  // thickness of a layer along a mesh without inside

double extent(const Surface& surface) {
  return bounds(surface.triangles.points).sizes().maxCoeff();
}

/// Instead of a mesh without inside.
Surface layer_along(const Surface& sheet, NewChoices& choices) {
  const double thickness = layer_fraction * extent(sheet);
  choices.changed = "a layer of " + three_digits(thickness) + " m along";
  const Triangles layer = thickened(sheet.triangles, thickness);
  PolygonSoup soup{layer.points, {}};
  for (const auto& face : layer.faces) soup.polygons.emplace_back(face.begin(), face.end());
  return clean(soup);
}

/// Reads the mesh; unit and axes as guessed.
Surface read_guessing(NewChoices& choices) {
  BodyOptions& body = choices.settings.body;
  Surface surface = read_body_mesh(body);
  const UnitGuess unit = guess_unit(body.mesh, extent(surface));
  const UpGuess up = guess_up(body.mesh, bounds(surface.triangles.points));
  body.unit = unit.unit, choices.unit = unit.why;
  body.up = up.up, choices.axes = up.why;
  if (up.up == Axis::y) body.forward = Axis::z;
  if (unit.unit != LengthUnit::m || up.up != Axis::z) surface = read_body_mesh(body);
  if (ambiguous_fraction(surface) <= max_ambiguous && volume_inside(surface) > 0) return surface;
  return layer_along(surface, choices);
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

/// Distance from the surface along the limbs: a tenth of their length is thinner.
double thin_inner(const std::vector<Limb>& limbs) {
  std::vector<std::pair<double, double>> pieces;  // inner, length
  double all = 0;
  for (const Limb& limb : limbs) {
    const std::size_t end = limb.line.size() - (limb.end == Limb::End::tip ? 1 : 0);
    for (std::size_t i = 1; i < end; ++i) {
      pieces.emplace_back(limb.inner[i], (limb.line[i] - limb.line[i - 1]).norm());
      all += pieces.back().second;
    }
  }
  std::sort(pieces.begin(), pieces.end());
  double so_far = 0;
  for (const auto& [inner, length] : pieces)
    if ((so_far += length) >= thin_fraction * all) return inner;
  return std::numeric_limits<double>::infinity();
}

/// Rounds to what a person writes.
double three_figures(double value) {
  const double step = std::pow(10, std::floor(std::log10(value)) - 2);
  const double steps = std::round(value / step), parts = std::round(1 / step);
  return parts > 1 ? steps / parts : steps * step;
}

/// The fraction of the particles that do not belong to the `parts` largest groups that touch.
double loose_fraction(const Particles& particles, const NeighborLists& touching,
                      std::size_t parts) {
  const int count = static_cast<int>(particles.size());
  UnionFind groups(particles.size());
  for (int i = 0; i < count; ++i)
    for (const std::uint32_t j : touching.of(i)) groups.join(i, static_cast<int>(j));
  std::vector<std::size_t> sizes(particles.size());
  for (int i = 0; i < count; ++i) ++sizes[groups.first_of(i)];
  std::sort(sizes.rbegin(), sizes.rend());
  const std::size_t connected = std::accumulate(
      sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(std::min(parts, sizes.size())),
      std::size_t{0});
  return 1 - static_cast<double>(connected) / static_cast<double>(particles.size());
}

/// Whether the particles are too large: parts of the body do not hold together, or it is one or two
/// layers thick.
bool too_coarse(const Particles& particles, std::size_t parts) {
  constexpr std::size_t complete = 12;  // neighbors, of a particle within
  const NeighborLists touching =
      neighbors_within(positions_of(particles), rest_neighbor_range(particles.radius));
  std::size_t within = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) within += touching.of(i).size() == complete;
  return loose_fraction(particles, touching, parts) > max_loose ||
         static_cast<double>(within) < min_within * static_cast<double>(particles.size());
}

/// Chooses by the thickness of limbs, within what a first picture needs and takes.
double usual_radius(double inner, double volume) {
  return three_figures(
      std::clamp(inner / across, radius_for_count(volume, most), radius_for_count(volume, fewest)));
}

/// Makes particles smaller where they are too large for the body.
void choose_radius(const Surface& surface, const std::vector<Limb>& limbs, NewChoices& choices) {
  BodyOptions& body = choices.settings.body;
  const double area_of = area(surface.triangles);
  const double volume = volume_inside(surface);
  const double mean = 2 * volume / area_of;  // of a rod its radius, of a sheet its thickness
  const double inner = choices.hollow ? mean / 2 : std::min(thin_inner(limbs), mean);
  const std::size_t parts =
      static_cast<std::size_t>(std::max(limbs.back().body + 1, surface.components));
  choices.thickness = 2 * inner;
  body.radius = usual_radius(inner, volume);
  Particles particles = fill_body(choices.settings, surface).particles;
  const double filled = static_cast<double>(particles.size()) * volume_per_particle(*body.radius);
  if (filled > 0 && filled < max_overlap * volume) {  // pieces lie within each other
    body.radius = usual_radius(inner, filled);
    particles = fill_body(choices.settings, surface).particles;
  }
  while (too_coarse(particles, parts) && static_cast<double>(particles.size()) < max_if_split / 2) {
    body.radius = three_figures(0.8 * *body.radius);
    particles = fill_body(choices.settings, surface).particles;
  }
  choices.particles = particles.size();
  choices.size = "About " + std::to_string(choices.particles) + " particles, " +
                 three_digits(inner / *body.radius) + " across " +
                 (choices.hollow ? "walls" : "limbs") + " that are " + three_digits(2 * inner) +
                 " m thick";
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
  body.unit = LengthUnit::m, body.up = Axis::z, body.forward.reset();
}

void choose_material(const Surface& surface, NewChoices& choices) {
  const double ratio = extent(surface) / usual_size;
  choices.settings.material.model = MaterialModel::bonded;
  choices.settings.material.young_modulus = three_figures(usual_modulus * ratio * ratio);
}

void choose_binding(BindingOptions& binding, bool hollow) {
  binding.joint_zone = 0.7;
  binding.stiffness = binding.twist_stiffness = 6.4;
  binding.axial_stiffness = 2.56;
  if (binding.method == BindMethod::nearest && !hollow) binding.method = BindMethod::inside;
}

}  // namespace

NewScene new_scene(const NewSceneFiles& files) {
  NewChoices choices;
  Settings& settings = choices.settings;
  settings.body.mesh = files.mesh;
  settings.output.interval = 1 / pictures;
  Surface surface =
      files.figure == nullptr ? read_guessing(choices) : read_body_mesh(settings.body);
  const std::string warning = surface.warning;
  const std::string rig = !files.rig.empty() ? files.rig : rig_within(files.mesh);
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
  choose_material(surface, choices);
  choose_binding(settings.binding, choices.hollow);
  NewScene made;
  refine_mesh(files.scene, surface, choices, made);
  made.text = new_scene_text(choices, std::filesystem::path(files.scene).parent_path());
  made.unit = choices.unit, made.axes = choices.axes;
  made.bones = choices.bones, made.pose = choices.pose, made.size = choices.size,
  made.warning = warning;
  return made;
}

}  // namespace sinew
