// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/force_field.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr double steepest_edge = 1.5;  // steepest slope of 3 s^2 - 2 s^3, per width

/// Unit vectors outside the core, proportionally shorter inside.
Vec3 softened(const Vec3& offset, double core) { return offset / std::max(offset.norm(), core); }

Vec3 force_of(const UniformAcceleration& form, const Vec3&, const ParticleInfo& grain) {
  return grain.mass * form.acceleration;
}

Vec3 force_of(const ForceDensity& form, const Vec3&, const ParticleInfo& grain) {
  return grain.volume * form.density;
}

Vec3 force_of(const Attraction& form, const Vec3& position, const ParticleInfo& grain) {
  return grain.mass * form.acceleration * softened(form.point - position, form.core);
}

Vec3 force_of(const Swirl& form, const Vec3& position, const ParticleInfo& grain) {
  return grain.mass * form.acceleration *
         softened(form.axis.normalized().cross(position - form.point), form.core);
}

Vec3 force_of(const CustomForce& form, const Vec3& position, const ParticleInfo& grain) {
  return form.force(position, grain);
}

/// The largest force, N, and the length over which the form itself changes by as much, m.
struct Steepness {
  double force;
  double length = std::numeric_limits<double>::infinity();
};

Steepness steepness(const UniformAcceleration& form, const ParticleInfo& grain) {
  return {grain.mass * form.acceleration.norm()};
}
Steepness steepness(const ForceDensity& form, const ParticleInfo& grain) {
  return {grain.volume * form.density.norm()};
}
Steepness steepness(const CustomForce& form, const ParticleInfo&) {
  return {form.largest, form.length};
}
template <typename Form>
Steepness steepness(const Form& form, const ParticleInfo& grain) {
  return {grain.mass * std::abs(form.acceleration), form.core};
}

void require_field(bool holds, const std::string& name, const std::string& wrong,
                   const std::string& cure) {
  if (!holds) throw bad_input("field '" + name + "' " + wrong, cure);
}

void check_core(double acceleration, double core, const std::string& name) {
  require_field(is_computable(acceleration), name,
                "has an acceleration that is too large or not finite", "give a finite number");
  require_field(is_computable(core) && core > 0, name, "has a core of " + number_text(core),
                "give a positive length");
}

void check_form(const UniformAcceleration& form, const std::string& name) {
  require_field(is_computable(form.acceleration), name,
                "has an acceleration that is too large or not finite", "give finite numbers");
}
void check_form(const ForceDensity& form, const std::string& name) {
  require_field(is_computable(form.density), name, "has a density that is too large or not finite",
                "give finite numbers");
}
void check_form(const Attraction& form, const std::string& name) {
  require_field(is_computable(form.point), name, "has a point that is too large or not finite",
                "give finite numbers");
  check_core(form.acceleration, form.core, name);
}
void check_form(const CustomForce& form, const std::string& name) {
  require_field(form.force != nullptr, name, "has no force",
                "give a function of position and grain");
  require_field(form.largest >= 0 && form.length > 0, name, "has no bounds",
                "give the largest force, and the length over which it changes by as much");
}
void check_form(const Swirl& form, const std::string& name) {
  require_field(is_computable(form.point), name, "has a point that is too large or not finite",
                "give finite numbers");
  require_field(is_computable(form.axis) && form.axis.norm() > 0, name,
                "has an axis without length", "give a direction");
  check_core(form.acceleration, form.core, name);
}

}  // namespace

Vec3 field_force(const ForceField& field, double scale, const Vec3& position,
                 const ParticleInfo& grain) {
  const double weight = scale * field.region.weight(position);
  if (weight == 0) return Vec3::Zero();
  return weight *
         std::visit([&](const auto& form) { return force_of(form, position, grain); }, field.form);
}

double field_stiffness(const ForceField& field, const ParticleInfo& grain) {
  const Steepness most =
      std::visit([&](const auto& form) { return steepness(form, grain); }, field.form);
  const bool soft_edge = field.region.shape && field.region.falloff > 0;
  const double edge = soft_edge ? steepest_edge / field.region.falloff : 0;
  return field.scale.largest() * most.force * (1 / most.length + edge);
}

void check_field(const ForceField& field) {
  std::visit([&](const auto& form) { check_form(form, field.name); }, field.form);
  check_region(field.region, "the region of field '" + field.name + "'");
  constexpr double any = std::numeric_limits<double>::max();
  check_keys(field.scale, -any, any, "field '" + field.name + "'");
}

void check_drag(const Drag& drag) {
  if (!is_computable(drag.rate) || drag.rate < 0)
    throw bad_input("drag has a rate of " + number_text(drag.rate), "give 0 or a positive number");
  if (!is_computable(drag.velocity))
    throw bad_input("the medium's velocity is too large or not finite", "give finite numbers");
}

}  // namespace sinew
