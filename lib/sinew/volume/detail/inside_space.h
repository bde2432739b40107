// SPDX-License-Identifier: GPL-3.0-or-later
// Whether any point is inside a surface, as the fill means it, and where a segment leaves it.
//
//     const InsideSpace space(surface, options.thickness);
//     const double at = space.crossing(inside, outside);   // 0 to 1
//
// Inside is where the winding number exceeds one half. For surfaces with holes it is that of the
// surface with its caps, an integer, less what the caps contribute: their solid angles, those of
// distant ones together (Barill et al. 2018).
#pragma once

#include <optional>
#include <vector>

#include <sinew/core/vector.h>
#include <sinew/mesh/face_queries.h>
#include <sinew/mesh/surface.h>
#include <sinew/mesh/winding.h>

namespace sinew {

/// The solid angle of many triangles, over 4 pi.
class SolidAngle {
 public:
  explicit SolidAngle(const Triangles& faces);
  double at(const Vec3& point) const;

 private:
  struct Node {
    int begin, end, second;  ///< its faces; its second child, the first follows it; 0: none
    Vec3 center, area;       ///< m; sum of area vectors, m^2
    double reach;            ///< distance of the farthest corner from the center, m
  };
  int build(int begin, int end);
  double sum(const Node& node, const Vec3& point) const;

  std::vector<Corners> faces_;
  std::vector<Node> nodes_;
};

class InsideSpace {
 public:
  /// `thickness` (m): of the layer along the surface that is inside instead.
  InsideSpace(const Surface& surface, std::optional<double> thickness);

  bool contains(const Vec3& point) const;
  /// Where the segment between a point inside and one outside crosses the border, as a fraction of
  /// it: in a face, or by bisection.
  double crossing(const Vec3& inside, const Vec3& outside) const;
  /// The nearest point of the surface, m.
  NearestOnFaces nearest(const Vec3& point) const { return nearest_.to(point); }
  const Triangles& surface() const { return surface_; }
  /// Whether what is inside ends there: it is behind the point, and not in front of it.
  bool is_border(const Vec3& point, const Vec3& outward) const {
    return contains(point - outward) && !contains(point + outward);
  }

 private:
  std::optional<double> in_face(const Vec3& from, const Vec3& to, double low, double high) const;

  Triangles surface_;
  NearestFace nearest_;
  Winding winding_;
  std::optional<SolidAngle> caps_;
  std::optional<double> half_thickness_;
  Vec3 nudge_;  ///< away from caps, m
};

}  // namespace sinew
