// SPDX-License-Identifier: GPL-3.0-or-later
// Particles as Python has them, between filling and simulating.
#pragma once

#include <string>
#include <vector>

#include <sinew/sinew.h>
#include "made.h"

namespace sinew::python {

struct FilledBody {
  Points points;                                          ///< at rest, m
  double radius = 0, mass = 0;                            ///< values of each particle, m and kg
  std::vector<std::int32_t> component, neighbors;         ///< columns of Filling; or empty
  std::vector<double> volume_share = {}, stiffness = {};  ///< columns of Filling
  Triangles surface = {};                                 ///< surface of the mesh that is filled, m
  std::string meta = {};                                  ///< meta of body.vtu, JSON; "": none
  std::vector<std::string> warnings = {};                 ///< warnings of the filling

  /// The same for prepare().
  BodyFile file() const {
    BodyFile file;
    file.particles = particles_at(points, radius, mass);
    file.component = component;
    if (!volume_share.empty()) file.volume_share = volume_share;
    if (!stiffness.empty()) file.stiffness = stiffness;
    return file;
  }
};

}  // namespace sinew::python

template <>
class pybind11::detail::type_caster<sinew::python::FilledBody>
    : public pybind11::detail::made_caster<sinew::python::FilledBody> {};
