// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/finite_elements.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include <sinew/core/local_origin.h>
#include <sinew/core/text.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/repair/volume_meshing.h>
#include <sinew/scene/context.h>
#include <sinew/scene/element_parts.h>
#include <sinew/scene/steps.h>
#include <sinew/scene/world.h>
#include <sinew/settings/read_scene.h>
#include <sinew/world/region.h>

namespace sinew {
namespace {

constexpr double bonded_ratio = 0.25;  // Poisson's, of central forces
constexpr double default_size = 4;     // radii: as many nodes as particles, or fewer
constexpr double max_elements = 500'000;

void refuse_what_it_cannot_hold(const Settings& settings, const Surface& surface, bool modes) {
  check_features(settings, {Feature::elements});
  if (!modes && settings.solver.method != Method::static_equilibrium)
    throw bad_input(settings.place("solver.method"),
                    "finite elements are brought to equilibrium, and this scene moves in time",
                    "set solver.method to static, or give --frequency for its modes");
  if (!modes && settings.supports.empty())
    throw bad_input(settings.place("solver.method"), "nothing holds the body", "add supports");
  if (!surface.closed())
    throw bad_input(settings.place("body.mesh"), "the mesh is open",
                    "set body.close_holes to true, or body.wrap");
}

// The mesh.

double size_of(const Settings& settings, const Triangles& surface, const ElementOptions& options) {
  if (options.size) return *options.size;
  const double radius = settings.body.radius
                            ? *settings.body.radius
                            : radius_for_count(volume(surface), *settings.body.count);
  return default_size * radius;
}

VolumeMesh mesh_of(const Settings& settings, const Triangles& surface, double size) {
  const double expected = volume(surface) / (size * size * size);
  if (!(expected < max_elements))
    throw bad_input("the body would have over " + number_text(max_elements) + " elements",
                    "give a larger --size than " + three_digits(size) + " m");
  if (const auto box = axis_box(surface)) return hexahedra(*box, size, cuts_of(settings));
  return with_context(settings, "body.mesh", [&] { return tetrahedra(surface, size); });
}

std::string list_entry(const char* list, std::size_t index) {
  return std::string(list) + '[' + std::to_string(index) + ']';
}

/// Once bonds have relaxed, which bear a bulk modulus of 5/3 of their shear modulus.
void relax(const MaterialOptions& given, DeckMaterial& material) {
  if (!given.relaxation_shares) return;
  double relaxed = 0;
  for (const double ratio : *given.relaxation_shares) relaxed += ratio;
  const double nu = material.poisson_ratio;
  const double of_bonds = material.young_modulus / (2 * (1 + nu)), G = (1 - relaxed) * of_bonds;
  const double K = material.young_modulus / (3 * (1 - 2 * nu)) - relaxed * of_bonds * 5 / 3;
  material.young_modulus = 9 * K * G / (3 * K + G);
  material.poisson_ratio = (3 * K - 2 * G) / (2 * (3 * K + G));
}

std::vector<DeckMaterial> materials_of(const Settings& settings, const VolumeMesh& mesh,
                                       const ElementParts& parts) {
  const MaterialOptions& given = settings.material;
  const bool bonded = given.model == MaterialModel::bonded;
  const double ratio = bonded ? bonded_ratio : given.poisson_ratio;
  std::vector<DeckMaterial> materials = {{"body", given.young_modulus, ratio, given.density, {}}};
  std::vector<std::size_t> of_element(mesh.elements.size(), 0);
  for (std::size_t k = 0; k < settings.materials.size(); ++k) {
    const LocalMaterialSettings& local = settings.materials[k];
    materials.push_back({local.name,
                         local.young_modulus.value_or(given.young_modulus),
                         bonded ? ratio : local.poisson_ratio.value_or(ratio),
                         local.density.value_or(given.density),
                         {}});
    for (const std::uint32_t e : parts.elements(local.part, list_entry("materials", k)))
      of_element[e] = k + 1;
  }
  for (DeckMaterial& material : materials) relax(given, material);
  for (std::uint32_t e = 0; e < of_element.size(); ++e)
    materials[of_element[e]].elements.push_back(e);
  std::erase_if(materials, [](const DeckMaterial& one) { return one.elements.empty(); });
  return materials;
}

// Supports.

struct NodeSupport {
  std::string name;
  std::vector<std::uint32_t> nodes;
  std::array<bool, 3> holds = {};
  Vec3 pivot = Vec3::Zero();
  ObstacleMotion motion;

  Vec3 displacement(std::uint32_t node, const Points& rest, double time) const {
    if (!motion) return Vec3::Zero();
    const RigidFrame frame = motion(time, {}).frame;
    return frame.origin - pivot + (frame.rotation - Mat3::Identity()) * (rest[node] - pivot);
  }
};

/// The middle of the faces, or of the elements around the nodes where a part faces nothing.
Vec3 middle_of(const VolumeMesh& mesh, const ElementParts& parts, const PartSettings& part,
               const std::string& path, const std::vector<std::uint32_t>& nodes) {
  Vec3 sum = Vec3::Zero();
  double weight = 0;
  if (part.faces()) {
    for (const ElementFace& face : parts.faces(part, path)) {
      const double area = area_vector(mesh, face).norm();
      sum += area * center_of(mesh, face), weight += area;
    }
    return sum / weight;
  }
  for (const VolumeElement& element : mesh.elements) {
    const double own = volume_of(mesh, element);
    for (const std::uint32_t node :
         element.used().first(static_cast<std::size_t>(corners_of(element.kind))))
      if (std::binary_search(nodes.begin(), nodes.end(), node))
        sum += own * mesh.nodes[node], weight += own;
  }
  return weight > 0 ? Vec3(sum / weight) : mesh.nodes[nodes.front()];
}

NodeSupport support_of(const SupportSettings& given, const std::string& path,
                       const VolumeMesh& mesh, const ElementParts& parts) {
  NodeSupport support;
  support.name = given.name;
  support.nodes = parts.nodes(given.part, path);
  const int bits = static_cast<int>(given.hold) + 1;
  for (std::size_t axis = 0; axis < 3; ++axis) support.holds[axis] = ((bits >> axis) & 1) != 0;
  support.pivot =
      given.pivot ? *given.pivot : middle_of(mesh, parts, given.part, path, support.nodes);
  if (!given.keys.empty())
    support.motion = keyed_motion(given.name, given.interpolation, given.keys, support.pivot);
  return support;
}

/// Supports by the node and axis that they hold.
using Holders = std::map<std::pair<std::uint32_t, int>, const NodeSupport*>;

Holders holders_of(const Settings& settings, const std::vector<NodeSupport>& supports) {
  Holders holders;
  for (const NodeSupport& support : supports)
    for (const std::uint32_t node : support.nodes)
      for (int axis = 0; axis < 3; ++axis) {
        if (!support.holds[static_cast<std::size_t>(axis)]) continue;
        const auto [found, fresh] = holders.try_emplace({node, axis}, &support);
        if (!fresh && (found->second->motion || support.motion))
          throw bad_input(settings.place("supports"),
                          "supports '" + found->second->name + "' and '" + support.name +
                              "' both hold one axis of a node, and move it differently",
                          "make their regions disjoint, or let one of them hold other axes");
      }
  return holders;
}

// Loads.

/// At a factor of 1.
struct NodeLoad {
  KeyedValue scale;
  std::vector<NodeForce> forces;
  std::vector<FacePressure> pressures;
};

/// Forces summed by node.
class ElementForces {
 public:
  explicit ElementForces(const VolumeMesh& mesh) : mesh_(mesh) {}

  void add_volume(std::uint32_t element, const Vec3& density) {
    const VolumeElement& one = mesh_.elements[element];
    add(one.used(), nodal_volume_weights(one.kind), volume_of(mesh_, one) * density);
  }
  void add_area(const ElementFace& face, const Vec3& traction) {
    const VolumeElement& one = mesh_.elements[face.element];
    add(face_nodes(one, face.face), nodal_face_weights(one.kind),
        area_vector(mesh_, face).norm() * traction);
  }
  std::vector<NodeForce> all() const {
    std::vector<NodeForce> forces;
    for (const auto& [node, force] : sum_) forces.push_back({node, force});
    return forces;
  }

 private:
  void add(std::span<const std::uint32_t> nodes, std::span<const double> weights,
           const Vec3& force) {
    for (std::size_t k = 0; k < nodes.size(); ++k)
      sum_.try_emplace(nodes[k], Vec3::Zero()).first->second += weights[k] * force;
  }

  const VolumeMesh& mesh_;
  std::map<std::uint32_t, Vec3> sum_;
};

std::vector<NodeForce> by_volume(const VolumeMesh& mesh, const std::vector<std::uint32_t>& on,
                                 const Vec3& density) {
  ElementForces forces(mesh);
  for (const std::uint32_t element : on) forces.add_volume(element, density);
  return forces.all();
}

std::vector<NodeForce> by_area(const VolumeMesh& mesh, const std::vector<ElementFace>& on,
                               const Vec3& traction) {
  ElementForces forces(mesh);
  for (const ElementFace& face : on) forces.add_area(face, traction);
  return forces.all();
}

NodeLoad load_of(const LoadSettings& given, const std::string& path, const Settings& settings,
                 const VolumeMesh& mesh, const ElementParts& parts) {
  NodeLoad load;
  for (const ValueKeySettings& key : given.keys) {
    load.scale.times.push_back(key.time);
    load.scale.values.push_back(key.value);
  }
  if (given.pressure || given.traction || (given.force && given.part.faces())) {
    const std::vector<ElementFace> on = parts.faces(given.part, path);
    double area = 0;
    for (const ElementFace& face : on) area += area_vector(mesh, face).norm();
    if (given.pressure)
      for (const ElementFace& face : on) load.pressures.push_back({face, *given.pressure});
    else
      load.forces = by_area(mesh, on, given.traction ? *given.traction : *given.force / area);
    return load;
  }
  const std::vector<std::uint32_t> on = parts.elements(given.part, path);
  double volume = 0;
  for (const std::uint32_t element : on) volume += volume_of(mesh, mesh.elements[element]);
  const Vec3 density =
      given.gravity ? Vec3(settings.material.density * *given.gravity) : *given.force / volume;
  load.forces = by_volume(mesh, on, density);
  return load;
}

std::vector<NodeLoad> loads_of(const Settings& settings, const VolumeMesh& mesh,
                               const ElementParts& parts) {
  std::vector<NodeLoad> loads;
  for (std::size_t k = 0; k < settings.loads.size(); ++k)
    loads.push_back(load_of(settings.loads[k], list_entry("loads", k), settings, mesh, parts));
  if (settings.solver.gravity != Vec3::Zero()) {
    LoadSettings weight;
    weight.gravity = settings.solver.gravity;
    loads.push_back(load_of(weight, "solver.gravity", settings, mesh, parts));
  }
  return loads;
}

// Steps.

DeckStep step_at(double time, const Points& rest, const Holders& holders,
                 const std::vector<NodeLoad>& loads) {
  DeckStep step;
  step.time = time;
  for (const auto& [at, support] : holders)
    step.held.push_back(
        {at.first, at.second, support->displacement(at.first, rest, time)[at.second]});
  std::map<std::uint32_t, Vec3> forces;
  std::map<std::pair<std::uint32_t, int>, double> pressures;
  for (const NodeLoad& load : loads) {
    const double scale = load.scale.at(time);
    for (const NodeForce& one : load.forces)
      forces.try_emplace(one.node, Vec3::Zero()).first->second += scale * one.force;
    for (const FacePressure& one : load.pressures)
      pressures[{one.face.element, one.face.face}] += scale * one.pressure;
  }
  for (const auto& [node, force] : forces) step.forces.push_back({node, force});
  for (const auto& [face, pressure] : pressures)
    step.pressures.push_back({{face.first, face.second}, pressure});
  return step;
}

bool is_at_rest(const DeckStep& step) {
  const auto still = [](const HeldNode& one) { return one.displacement == 0; };
  const auto free = [](const NodeForce& one) { return one.force == Vec3::Zero(); };
  const auto open = [](const FacePressure& one) { return one.pressure == 0; };
  return std::all_of(step.held.begin(), step.held.end(), still) &&
         std::all_of(step.forces.begin(), step.forces.end(), free) &&
         std::all_of(step.pressures.begin(), step.pressures.end(), open);
}

/// Radians by which any of the supports turns, sampled.
double turn_of(const std::vector<NodeSupport>& supports, double from, double to) {
  constexpr int samples = 16;
  double most = 0;
  for (const NodeSupport& support : supports) {
    if (!support.motion) continue;
    double turn = 0;
    for (int k = 0; k < samples; ++k) {
      const auto at = [&](int sample) {
        return support.motion(from + (to - from) * sample / samples, {}).frame.rotation;
      };
      turn += Eigen::AngleAxisd(Mat3(at(k + 1) * at(k).transpose())).angle();
    }
    most = std::max(most, turn);
  }
  return most;
}

/// Returns the times of frames, as the static method has them, and of moments between where
/// supports turn: what goes straight from one place to another does not turn.
std::vector<double> step_times(const FrameTimes& frames, const std::vector<NodeSupport>& supports) {
  const double max_turn = radians(15);
  std::vector<double> times = {0};
  for (int frame = 1; frame <= frames.count; ++frame) {
    const double from = frames.at(frame - 1), to = frames.at(frame);
    const int parts =
        std::max(1, static_cast<int>(std::ceil(turn_of(supports, from, to) / max_turn - 1e-6)));
    for (int part = 1; part < parts; ++part) times.push_back(from + (to - from) * part / parts);
    times.push_back(to);
  }
  return times;
}

}  // namespace

Deck deck_of(const Settings& settings, const Surface& surface, const ElementOptions& options) {
  refuse_what_it_cannot_hold(settings, surface, options.frequencies > 0);
  const Triangles& skin = surface.triangles;
  Deck deck;
  deck.title = "sinew: " + std::filesystem::path(settings.body.mesh).filename().string();
  deck.large_displacements = !options.linear;
  deck.mesh = mesh_of(settings, skin, size_of(settings, skin, options));
  deck.origin = local_origin(bounds(skin.points));
  const ElementParts parts(settings, deck.mesh);
  deck.materials = materials_of(settings, deck.mesh, parts);
  std::vector<NodeSupport> supports;
  for (std::size_t k = 0; k < settings.supports.size(); ++k)
    supports.push_back(
        support_of(settings.supports[k], list_entry("supports", k), deck.mesh, parts));
  for (const NodeSupport& support : supports) deck.sets.push_back({support.name, support.nodes});
  const Holders holders = holders_of(settings, supports);
  deck.frequencies = options.frequencies;
  if (deck.frequencies > 0) {
    deck.steps.push_back(step_at(0, deck.mesh.nodes, holders, {}));
    return deck;
  }
  const std::vector<NodeLoad> loads = loads_of(settings, deck.mesh, parts);
  for (const double time : step_times(frame_times(settings), supports)) {
    DeckStep step = step_at(time, deck.mesh.nodes, holders, loads);
    if (time == 0 && settings.solver.duration > 0 && is_at_rest(step)) continue;
    deck.steps.push_back(std::move(step));
  }
  return deck;
}

}  // namespace sinew
