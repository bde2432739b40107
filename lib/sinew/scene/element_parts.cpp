// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/element_parts.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/triangles.h>
#include <sinew/scene/particle_parts.h>

namespace sinew {
namespace {

void add_cuts(const PartSettings& part, Cuts& cuts) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<int>(axis);
    if (part.region.low)
      cuts[axis].insert(cuts[axis].end(), {(*part.region.low)[a], (*part.region.high)[a]});
    if (part.point && std::abs(part.normal->normalized()[a]) == 1)
      cuts[axis].push_back((*part.point)[a]);
  }
}

}  // namespace

Cuts cuts_of(const Settings& settings) {
  Cuts cuts;
  for (const LocalMaterialSettings& one : settings.materials) add_cuts(one.part, cuts);
  for (const SupportSettings& one : settings.supports) add_cuts(one.part, cuts);
  for (const LoadSettings& one : settings.loads) add_cuts(one.part, cuts);
  return cuts;
}

bool is_of_elements(const PartSettings& part) {
  return part.bone.empty() && !part.ids && !part.component && part.mesh.empty();
}

ElementParts::ElementParts(const Settings& settings, const VolumeMesh& mesh)
    : settings_(settings),
      mesh_(mesh),
      surface_(boundary_faces(mesh)),
      slack_(1e-9 * bounds(mesh.nodes).diagonal().norm()) {}

bool ElementParts::holds(const PartSettings& part, const Vec3& place) const {
  return is_in_region(part, place, slack_);
}

bool ElementParts::faces_it(const PartSettings& part, const ElementFace& face) const {
  return faces_as(part, area_vector(mesh_, face), center_of(mesh_, face));
}

void ElementParts::check(const PartSettings& part, const std::string& path) const {
  const auto refuse = [&](const char* key, const char* what) {
    throw bad_input(settings_.place(path + key), what,
                    "name the part by a box, a ball, a plane or the direction that it faces");
  };
  if (!part.bone.empty()) refuse(".bone", "finite elements have no bones");
  if (part.ids) refuse(".ids", "finite elements have no particles");
  if (!part.mesh.empty()) refuse(".mesh", "finite elements have no parts inside of meshes");
  if (part.component) refuse(".component", "finite elements have no components of particles");
}

void ElementParts::refuse_empty(const char* what, const std::string& path) const {
  throw bad_input(settings_.place(path), std::string("no ") + what + " is in the part of " + path,
                  "give a smaller --size, or choose a part that reaches into the body, " +
                      extent_text(mesh_.nodes));
}

std::vector<std::uint32_t> ElementParts::nodes(const PartSettings& part,
                                               const std::string& path) const {
  check(part, path);
  std::vector<std::uint32_t> found;
  if (part.faces()) {
    for (const ElementFace& face : surface_)
      if (faces_it(part, face))
        for (const std::uint32_t node : face_nodes(mesh_.elements[face.element], face.face))
          if (holds(part, mesh_.nodes[node])) found.push_back(node);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  } else {
    for (std::uint32_t node = 0; node < mesh_.nodes.size(); ++node)
      if (holds(part, mesh_.nodes[node])) found.push_back(node);
  }
  if (found.empty()) refuse_empty("node", path);
  return found;
}

std::vector<ElementFace> ElementParts::faces(const PartSettings& part,
                                             const std::string& path) const {
  check(part, path);
  std::vector<ElementFace> found;
  for (const ElementFace& face : surface_)
    if (faces_it(part, face) && holds(part, center_of(mesh_, face))) found.push_back(face);
  if (found.empty()) refuse_empty("face", path);
  return found;
}

std::vector<std::uint32_t> ElementParts::elements(const PartSettings& part,
                                                  const std::string& path) const {
  check(part, path);
  if (part.faces())
    throw bad_input(settings_.place(path + (part.facing ? ".facing" : ".facing_axis")),
                    "a surface has no elements", "name the part by a box, a ball or a plane");
  std::vector<std::uint32_t> found;
  for (std::uint32_t e = 0; e < mesh_.elements.size(); ++e)
    if (holds(part, center_of(mesh_, mesh_.elements[e]))) found.push_back(e);
  if (found.empty()) refuse_empty("element", path);
  return found;
}

}  // namespace sinew
