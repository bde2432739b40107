// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/particle_parts.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/mesh/refine.h>
#include <sinew/mesh/surface.h>
#include <sinew/mesh/winding.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/context.h>
#include <sinew/scene/rig.h>
#include <sinew/world/following_points.h>
#include <sinew/world/loads.h>

namespace sinew {
namespace {

std::string corner(const Vec3& point) {
  return '[' + three_digits(point.x()) + ", " + three_digits(point.y()) + ", " +
         three_digits(point.z()) + ']';
}

/// Vector from a part's axis to a place, m.
Vec3 from_axis(const PartSettings& part, const Vec3& place) {
  const Vec3 along = part.axis->normalized(), from = place - *part.axis_point;
  return from - from.dot(along) * along;
}

Vec3 center_of(const Triangles& surface, const std::array<int, 3>& face) {
  return (surface.points[face[0]] + surface.points[face[1]] + surface.points[face[2]]) / 3;
}

bool looks_as(const PartSettings& part, const Triangles& surface, const std::array<int, 3>& face) {
  return faces_as(part, area_vector(surface, face), center_of(surface, face));
}

/// Returns the winding of a mesh that is placed as the body's.
Winding inside_of(const Settings& settings, const std::string& mesh, const std::string& path) {
  BodyOptions file = settings.body;
  file.mesh = mesh;
  file.wrap.reset();
  file.close_holes = false;
  file.level.reset();
  const Surface surface = with_context(settings, (path + ".mesh").c_str(),
                                       [&] { return read_body_mesh(file, settings); });
  if (!surface.closed())
    throw bad_input(settings.place(path + ".mesh"), "the mesh of a part is open",
                    "close its holes, lest it is unknown which particles lie in it");
  return winding_of(surface);
}

/// The same faces with the points that they have.
Triangles without_other_points(const Triangles& surface,
                               const std::vector<std::array<int, 3>>& faces) {
  std::vector<int> place(surface.points.size(), -1);
  Triangles some;
  for (auto face : faces) {
    for (int& point : face) {
      if (place[point] < 0) {
        place[point] = static_cast<int>(some.points.size());
        some.points.push_back(surface.points[point]);
      }
      point = place[point];
    }
    some.faces.push_back(face);
  }
  return some;
}

}  // namespace

std::string extent_text(const Points& points) {
  const Box box = bounds(points);
  return "from " + corner(box.min()) + " to " + corner(box.max()) + " m";
}

bool is_in_region(const PartSettings& part, const Vec3& place, double slack) {
  const RegionSettings& region = part.region;
  const Vec3 wide = Vec3::Constant(slack);
  if (region.low && !Box(*region.low - wide, *region.high + wide).contains(place)) return false;
  if (region.center && !((place - *region.center).norm() <= *region.radius + slack)) return false;
  if (part.point && !((place - *part.point).dot(*part.normal) >= -slack * part.normal->norm()))
    return false;
  return !part.axis_radius || from_axis(part, place).norm() <= *part.axis_radius + slack;
}

bool faces_as(const PartSettings& part, const Vec3& area, const Vec3& center) {
  constexpr double slack = 1e-9;  // faces at exactly that angle are in
  const double least = (std::cos(radians(part.facing_angle)) - slack) * area.norm();
  const auto looks = [&](const Vec3& direction) {
    return area.dot(direction.normalized()) >= least;
  };
  if (part.facing && !looks(*part.facing)) return false;
  if (part.facing_axis == AxisSide::none) return true;
  const Vec3 outward = from_axis(part, center);
  return looks(part.facing_axis == AxisSide::outward ? outward : Vec3(-outward));
}

/// What a part asks for.
class ParticleParts::Test {
 public:
  Test(const ParticleParts& parts, const PartSettings& part, const std::string& path)
      : parts_(parts), part_(part) {
    bone_ = bone_at(parts.settings_, path, parts.body_.skeleton, part.bone);
    if (part.ids)
      ids_ = ids_of(parts_.settings_, path + ".ids", *part_.ids, parts_.body_.rest.size());
    if (part.component && parts.component_.empty())
      throw bad_input(parts.settings_.place(path + ".component"),
                      "the components of these particles are not known", "name another part");
    if (!part.mesh.empty()) inside_ = inside_of(parts.settings_, part.mesh, path);
  }

  /// Whether a particle, or a place next to it, is in the part.
  bool holds(std::uint32_t particle, const Vec3& place) const {
    if (!is_in_region(part_, place)) return false;
    if (part_.component && parts_.component_[particle] != *part_.component) return false;
    if (inside_ && inside_->around(place).value_or(0) <= 0) return false;
    if (bone_ != no_bone && parts_.body_.binding.bone(particle) != bone_) return false;
    return !part_.ids || std::binary_search(ids_.begin(), ids_.end(), particle);
  }

 private:
  const ParticleParts& parts_;
  const PartSettings& part_;
  int bone_ = no_bone;
  std::vector<std::uint32_t> ids_;
  std::optional<Winding> inside_;
};

std::vector<std::uint32_t> ids_of(const Settings& settings, const std::string& path,
                                  const std::vector<double>& numbers, std::size_t particles) {
  const auto text = [](double number) {
    const bool whole = number == std::floor(number) && std::abs(number) < 1e15;
    return whole ? std::to_string(static_cast<std::int64_t>(number)) : number_text(number);
  };
  std::vector<std::uint32_t> ids;
  for (const double number : numbers) {
    if (number != std::floor(number) || !(number >= 0 && number < static_cast<double>(particles)))
      throw bad_input(settings.place(path), "there is no particle " + text(number),
                      "give whole numbers from 0 to " + std::to_string(particles - 1));
    ids.push_back(static_cast<std::uint32_t>(number));
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

ParticleParts::ParticleParts(const Settings& settings, const Body& body, const Triangles& surface,
                             std::span<const std::int32_t> component)
    : settings_(settings), body_(body), surface_(surface), component_(component) {}

const Triangles& ParticleParts::fine_surface(const std::string& path) const {
  if (surface_.faces.empty())
    throw bad_input(settings_.place(path), "a surface without a mesh", "name a part by a region");
  if (fine_.faces.empty()) {
    const double radius = body_.material.pair.r;
    fine_ = refined(surface_, 2 * radius);
    Points centers;
    for (const auto& face : fine_.faces) centers.push_back(center_of(fine_, face));
    nearest_ = nearest_particles(centers, body_.rest, radius);
  }
  return fine_;
}

std::vector<std::uint32_t> ParticleParts::particles(const PartSettings& part,
                                                    const std::string& path) const {
  const Test test(*this, part, path);
  std::vector<std::uint32_t> found;
  if (part.faces()) {
    const Triangles& fine = fine_surface(path);
    for (std::size_t f = 0; f < fine.faces.size(); ++f)
      if (looks_as(part, fine, fine.faces[f]) && test.holds(nearest_[f], body_.rest[nearest_[f]]))
        found.push_back(nearest_[f]);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  } else {
    for (std::uint32_t i = 0; i < body_.rest.size(); ++i)
      if (test.holds(i, body_.rest[i])) found.push_back(i);
  }
  if (!found.empty()) return found;
  throw bad_input(settings_.place(path), "no particle is in the part of " + path,
                  "choose one that reaches into the body, " + extent_text(body_.rest));
}

Triangles ParticleParts::faces(const PartSettings& part, const std::string& path) const {
  const Test test(*this, part, path);
  const Triangles& fine = fine_surface(path);
  std::vector<std::array<int, 3>> found;
  for (std::size_t f = 0; f < fine.faces.size(); ++f)
    if (looks_as(part, fine, fine.faces[f]) &&
        test.holds(nearest_[f], center_of(fine, fine.faces[f])))
      found.push_back(fine.faces[f]);
  if (!found.empty()) return without_other_points(fine, found);
  throw bad_input(settings_.place(path), "no face of the surface is in the part of " + path,
                  "choose one that reaches it, " + extent_text(surface_.points));
}

namespace {

/// Whether no region but the direction that it faces tells it apart.
bool is_by_direction(PartSettings part) {
  part.facing.reset();
  if (!part.axis_radius) part.axis.reset();
  part.facing_axis = AxisSide::none;
  return part.empty();
}

}  // namespace

Triangles ParticleParts::pressed_faces(const PartSettings& part, const std::string& path) const {
  if (!is_by_direction(part) || surface_.faces.empty()) return faces(part, path);
  const Triangles coarse = refined(surface_, longest_pressed_side * body_.material.pair.r);
  std::vector<std::array<int, 3>> found;
  for (const auto& face : coarse.faces)
    if (looks_as(part, coarse, face)) found.push_back(face);
  return found.empty() ? faces(part, path) : without_other_points(coarse, found);
}

namespace {

/// Sets what the parts of a body have of their own.
class LocalMaterials {
 public:
  LocalMaterials(const Settings& settings, Body& body)
      : settings_(settings), body_(body), base_poisson_(poisson_ratio_of(settings.material)) {
    const std::size_t n = body.rest.size();
    body.material_number.assign(n, 0);
    body.stiffness.resize(n, 1);
    body.density.assign(n, 1);
    modulus_.assign(n, settings.material.young_modulus);
    poisson_.assign(n, base_poisson_);
    yield_.assign(n, settings.material.yield_strain.value_or(0));
    breaking_.assign(n, body.material.bond.breaking_strain);
  }

  void add(const LocalMaterialSettings& given, std::int32_t number, std::uint32_t i) {
    body_.material_number[i] = number;
    modulus_[i] = given.young_modulus.value_or(modulus_[i]);
    poisson_[i] = given.poisson_ratio.value_or(poisson_[i]);
    breaking_[i] = given.breaking_strain.value_or(breaking_[i]);
    yield_[i] = given.yield_strain.value_or(yield_[i]);
    if (given.density) body_.density[i] = *given.density / settings_.material.density;
    if (given.is_elastic())
      body_.stiffness[i] =
          modulus_[i] / settings_.material.young_modulus * (1 + base_poisson_) / (1 + poisson_[i]);
  }

  void finish() {
    const auto& all = settings_.materials;
    const auto any = [&](auto member) {
      return std::any_of(all.begin(), all.end(), [&](const LocalMaterialSettings& one) {
        return (one.*member).has_value();
      });
    };
    if (any(&LocalMaterialSettings::breaking_strain)) body_.local.breaking = breaking_;
    if (any(&LocalMaterialSettings::yield_strain)) set_yield();
    if (!any(&LocalMaterialSettings::density)) body_.density.clear();
    if (all.empty()) body_.material_number.clear();
    if (std::all_of(body_.stiffness.begin(), body_.stiffness.end(),
                    [](double stiffness) { return stiffness == 1; }))
      body_.stiffness.clear();
    if (!body_.stiffness.empty() || any(&LocalMaterialSettings::poisson_ratio)) set_volumes();
  }

 private:
  void set_volumes() {
    if (!keeps_volume(body_.material.model)) return;
    for (std::size_t i = 0; i < poisson_.size(); ++i)
      body_.local.volume.push_back(
          local_volume_stiffness(body_.material, value_at(body_.stiffness, i, 1), poisson_[i]));
  }

  void set_yield() {
    for (std::size_t i = 0; i < yield_.size(); ++i)
      body_.local.yield.push_back(yield_[i] > 0 ? yield_shear(yield_[i], poisson_[i])
                                                : never_reached);
  }

  const Settings& settings_;
  Body& body_;
  double base_poisson_;
  std::vector<double> modulus_, poisson_, yield_, breaking_;
};

}  // namespace

void set_local_materials(const Settings& settings, const ParticleParts& parts, Body& body) {
  if (settings.materials.empty() && body.stiffness.empty()) return;
  LocalMaterials local(settings, body);
  for (std::size_t k = 0; k < settings.materials.size(); ++k)
    for (const std::uint32_t i :
         parts.particles(settings.materials[k].part, "materials[" + std::to_string(k) + ']'))
      local.add(settings.materials[k], static_cast<std::int32_t>(k + 1), i);
  local.finish();
}

}  // namespace sinew
