// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/parts.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/mesh/refine.h>
#include <sinew/mesh/surface.h>
#include <sinew/physics/world/following_points.h>
#include <sinew/scene/rig.h>

namespace sinew {
namespace {

std::string corner(const Vec3& point) {
  return '[' + three_digits(point.x()) + ", " + three_digits(point.y()) + ", " +
         three_digits(point.z()) + ']';
}

Vec3 center_of(const Triangles& surface, const std::array<int, 3>& face) {
  return (surface.points[face[0]] + surface.points[face[1]] + surface.points[face[2]]) / 3;
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

/// What a part asks for.
class Parts::Test {
 public:
  Test(const Parts& parts, const PartSettings& part, const std::string& path)
      : parts_(parts), part_(part) {
    bone_ = bone_at(parts.settings_, path, parts.body_.skeleton, part.bone);
    if (part.facing) direction_ = part.facing->normalized();
    if (part.ids)
      ids_ = ids_of(parts_.settings_, path + ".ids", *part_.ids, parts_.body_.rest.size());
    if (part.component && parts.component_.empty())
      throw bad_input(parts.settings_.place(path + ".component"),
                      "the components of these particles are not known", "name another part");
  }

  /// Whether a particle, or a place next to it, is in the part.
  bool holds(std::uint32_t particle, const Vec3& place) const {
    const RegionSettings& region = part_.region;
    if (region.low && !Box(*region.low, *region.high).contains(place)) return false;
    if (region.center && !((place - *region.center).norm() <= *region.radius)) return false;
    if (part_.point && !((place - *part_.point).dot(*part_.normal) >= 0)) return false;
    if (part_.component && parts_.component_[particle] != *part_.component) return false;
    if (bone_ != no_bone && parts_.body_.binding.bone(particle) != bone_) return false;
    return !part_.ids || std::binary_search(ids_.begin(), ids_.end(), particle);
  }

  bool faces(const Vec3& area) const {
    constexpr double slack = 1e-9;  // faces at exactly that angle are in
    return !part_.facing ||
           area.dot(direction_) >= (std::cos(radians(part_.facing_angle)) - slack) * area.norm();
  }

 private:
  const Parts& parts_;
  const PartSettings& part_;
  int bone_ = no_bone;
  Vec3 direction_ = Vec3::Zero();
  std::vector<std::uint32_t> ids_;
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

Parts::Parts(const Settings& settings, const Body& body, const Triangles& surface,
             std::span<const std::int32_t> component)
    : settings_(settings), body_(body), surface_(surface), component_(component) {}

const Triangles& Parts::fine_surface(const std::string& path) const {
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

std::vector<std::uint32_t> Parts::particles(const PartSettings& part,
                                            const std::string& path) const {
  const Test test(*this, part, path);
  std::vector<std::uint32_t> found;
  if (part.facing) {
    const Triangles& fine = fine_surface(path);
    for (std::size_t f = 0; f < fine.faces.size(); ++f)
      if (test.faces(area_vector(fine, fine.faces[f])) &&
          test.holds(nearest_[f], body_.rest[nearest_[f]]))
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

Triangles Parts::faces(const PartSettings& part, const std::string& path) const {
  const Test test(*this, part, path);
  const Triangles& fine = fine_surface(path);
  std::vector<std::array<int, 3>> found;
  for (std::size_t f = 0; f < fine.faces.size(); ++f)
    if (test.faces(area_vector(fine, fine.faces[f])) &&
        test.holds(nearest_[f], center_of(fine, fine.faces[f])))
      found.push_back(fine.faces[f]);
  if (!found.empty()) return without_other_points(fine, found);
  throw bad_input(settings_.place(path), "no face of the surface is in the part of " + path,
                  "choose one that reaches it, " + extent_text(surface_.points));
}

void set_local_materials(const Settings& settings, const Parts& parts, Body& body) {
  if (settings.materials.empty()) return;
  body.material_number.assign(body.rest.size(), 0);
  body.stiffness.resize(body.rest.size(), 1);
  for (std::size_t k = 0; k < settings.materials.size(); ++k) {
    const LocalMaterialSettings& given = settings.materials[k];
    const double relative = given.young_modulus / settings.material.young_modulus;
    for (const std::uint32_t i :
         parts.particles(given.part, "materials[" + std::to_string(k) + ']')) {
      body.stiffness[i] = relative;
      body.material_number[i] = static_cast<std::int32_t>(k + 1);
    }
  }
  if (std::all_of(body.stiffness.begin(), body.stiffness.end(), [](double s) { return s == 1; }))
    body.stiffness.clear();
}

}  // namespace sinew
