// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a body of finite elements, as materials, supports and loads of a scene name them.
//
//     const ElementParts parts(settings, mesh);
//     const std::vector<std::uint32_t> held = parts.nodes(settings.supports[0].part,
//     "supports[0]");
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sinew/core/volume_mesh.h>
#include <sinew/repair/volume_meshing.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Where boxes and planes along the axes, of all parts that a scene names, cut the body.
Cuts cuts_of(const Settings& settings);

/// Whether elements have such a part: one that names no bone, component or particles.
bool is_of_elements(const PartSettings& part);

/// Each throws bad input, with the scene's line, for parts by bone, component or numbers of
/// particles, which elements have not, and for a part in which nothing lies.
class ElementParts {
 public:
  /// Keeps references.
  ElementParts(const Settings& settings, const VolumeMesh& mesh);

  /// Ascending: of a part that faces a direction those of its faces.
  std::vector<std::uint32_t> nodes(const PartSettings& part, const std::string& path) const;
  /// Finds faces of the surface by their centers.
  std::vector<ElementFace> faces(const PartSettings& part, const std::string& path) const;
  /// Finds elements by their centers. Also throws for a part that faces a direction: a skin has no
  /// thickness.
  std::vector<std::uint32_t> elements(const PartSettings& part, const std::string& path) const;

 private:
  bool holds(const PartSettings& part, const Vec3& place) const;
  bool faces_it(const PartSettings& part, const ElementFace& face) const;
  void check(const PartSettings& part, const std::string& path) const;
  [[noreturn]] void refuse_empty(const char* what, const std::string& path) const;

  const Settings& settings_;
  const VolumeMesh& mesh_;
  std::vector<ElementFace> surface_;
  double slack_ = 0;  ///< tolerance of places on the border of a region, m
};

}  // namespace sinew
