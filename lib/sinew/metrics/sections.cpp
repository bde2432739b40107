// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/sections.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <sinew/metrics/files.h>

namespace sinew {
namespace {

using S = SectionMetrics;

constexpr std::array section_table = {
    SectionMetric{"time", "s", "Simulated time", "t", &S::time},
    SectionMetric{"bone", "", "Index of the bone, as in frames.pvd", "", &S::bone},
    SectionMetric{"along", "",
                  "Position of the section along the bone: 0 at its head, 1 at its tail",
                  "axis . (x - o) / length, at rest", &S::along},
    SectionMetric{"joint", "", "1 within half a width of a joint, else 0",
                  "|place - joint| <= sqrt(A_B) / 2", &S::joint},
    SectionMetric{"area", "m^2", "Area within the ring of the skin that lay in the plane at rest",
                  "A = |sum x_i cross x_i+1| / 2", &S::area},
    SectionMetric{"area_ratio", "", "Area relative to the rest area; 0: pinched off", "A / A0",
                  &S::area_ratio},
};

using Edge = std::array<int, 2>;  // ascending
using Ring = std::vector<EdgePoint>;

/// The rings in which the plane where `height` is zero cuts the surface. A point in the plane
/// counts as above it, so that every edge is either crossed or not.
class Cut {
 public:
  Cut(const Triangles& surface, const std::vector<double>& height) : height_(height) {
    for (const auto& face : surface.faces) add(face);
  }

  std::vector<Ring> rings() {
    std::vector<Ring> all;
    while (!next_.empty())
      if (Ring ring = taken(next_.begin()->first); !ring.empty()) all.push_back(std::move(ring));
    return all;
  }

 private:
  bool above(int point) const { return height_[point] >= 0; }

  /// Seen from outside with the axis upward, the ring enters a face where its edge descends.
  void add(const std::array<int, 3>& face) {
    Edge in{}, out{};
    int crossed = 0;
    for (int k = 0; k < 3; ++k) {
      const int from = face[k], to = face[(k + 1) % 3];
      if (above(from) == above(to)) continue;
      (above(from) ? in : out) = Edge{std::min(from, to), std::max(from, to)};
      ++crossed;
    }
    if (crossed == 2) next_[in] = out;
  }

  /// Follows the ring from an edge; empty where it does not close (at a hole of the surface).
  Ring taken(const Edge start) {
    Ring ring;
    Edge edge = start;
    do {
      const auto found = next_.find(edge);
      if (found == next_.end()) return {};
      ring.push_back(crossing(edge));
      edge = found->second;
      next_.erase(found);
    } while (edge != start);
    return ring;
  }

  EdgePoint crossing(const Edge& edge) const {
    const double from = height_[edge[0]], to = height_[edge[1]];
    return {edge[0], edge[1], from / (from - to)};
  }

  const std::vector<double>& height_;
  std::map<Edge, Edge> next_;
};

Vec3 place_of(const EdgePoint& point, const Points& points) {
  return points[point.from] + point.fraction * (points[point.to] - points[point.from]);
}

Vec3 area_vector(const Ring& ring, const Points& points) {
  Vec3 sum = Vec3::Zero();
  const Vec3 base = place_of(ring.front(), points);
  for (std::size_t i = 0; i < ring.size(); ++i)
    sum += (place_of(ring[i], points) - base)
               .cross(place_of(ring[(i + 1) % ring.size()], points) - base);
  return sum / 2;
}

/// Whether a ray across the axis from `center` crosses the ring an odd number of times.
bool surrounds(const Ring& ring, const Points& points, const Vec3& center, const Mat3& axes) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 p = axes.transpose() * (place_of(ring[i], points) - center);
    const Vec3 q = axes.transpose() * (place_of(ring[(i + 1) % ring.size()], points) - center);
    if ((p.z() >= 0) == (q.z() >= 0)) continue;
    inside ^= p.y() + p.z() / (p.z() - q.z()) * (q.y() - p.y()) > 0;
  }
  return inside;
}

std::optional<Section> section_at(const Triangles& surface, const Bone& bone, const Vec3& center) {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();  // error of a coordinate
  std::vector<double> height(surface.points.size());
  for (std::size_t i = 0; i < height.size(); ++i) {
    const Vec3& point = surface.points[i];
    height[i] = bone.axis().dot(point - center);
    if (std::abs(height[i]) < rounding * point.cwiseAbs().maxCoeff()) height[i] = 0;
  }
  std::optional<Section> least;
  for (Ring& ring : Cut(surface, height).rings()) {
    const double area = area_vector(ring, surface.points).dot(bone.axis());
    if (!(area > 0) || (least && area >= least->area)) continue;
    if (!surrounds(ring, surface.points, center, bone.rest.rotation)) continue;
    least = Section{0, 0, false, area, std::move(ring)};
  }
  return least;
}

}  // namespace

std::vector<Section> make_sections(const Triangles& surface, std::span<const Bone> bones,
                                   const std::function<bool(const Vec3&)>& near_joint) {
  std::vector<std::optional<Section>> found(bones.size() * (sections_per_bone + 1));
  parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t b = i / (sections_per_bone + 1);
      const double along = static_cast<double>(i % (sections_per_bone + 1)) / sections_per_bone;
      const Vec3 center = bones[b].rest.origin + along * bones[b].length * bones[b].axis();
      found[i] = section_at(surface, bones[b], center);
      if (!found[i]) continue;
      found[i]->bone = static_cast<int>(b);
      found[i]->along = along;
      found[i]->joint = near_joint(center);
    }
  });
  std::vector<Section> sections;
  for (std::optional<Section>& section : found)
    if (section) sections.push_back(std::move(*section));
  return sections;
}

double area_of(const Section& section, const Points& surface_points) {
  return area_vector(section.ring, surface_points).norm();
}

std::span<const SectionMetric> section_metrics_table() { return section_table; }

std::vector<SectionMetrics> measure_sections(std::span<const Section> sections,
                                             const Points& surface_points, double time) {
  std::vector<SectionMetrics> rows;
  for (const Section& section : sections) {
    const double area = area_of(section, surface_points);
    rows.push_back({time, static_cast<double>(section.bone), section.along,
                    section.joint ? 1.0 : 0.0, area, area / section.area});
  }
  return rows;
}

std::string sections_csv(std::span<const SectionMetrics> rows) {
  return csv_text(section_table, rows);
}

}  // namespace sinew
