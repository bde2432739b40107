// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/surface_gap.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/mesh/surface.h>

namespace sinew {

namespace {

constexpr std::size_t faces_per_search = 4;  // few enough to lie close together
constexpr std::size_t searches_per_task = 32;
constexpr std::size_t max_shared = 128;  // faces near a search, as between surfaces far apart
constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

// Exact for quadratics over a triangle.
constexpr double corner_weight = 1.0 / 12, center_weight = 3.0 / 4;

Vec3 center_of(const Triangles& surface, std::size_t face) {
  const auto& [a, b, c] = surface.faces[face];
  return (surface.points[a] + surface.points[b] + surface.points[c]) / 3;
}

/// Distances of a surface's corners and centers of faces from another one.
class Distances {
 public:
  Distances(const FaceTree& from, const FaceTree& to)
      : from_(from.surface()),
        other_(to.surface()),
        to_(to),
        order_(from.faces()),
        same_(from_.points.size() == other_.points.size() && from_.faces == other_.faces),
        finder_(from_.points.size(), nobody),
        corners_(from_.points.size()),
        centers_(from_.faces.size()) {
    add_left_out();
    for (const std::uint32_t face : order_)
      for (const int corner : from_.faces[face])
        if (finder_[corner] == nobody) finder_[corner] = face;
    const std::size_t searches = (order_.size() + faces_per_search - 1) / faces_per_search;
    parallel_for(searches, searches_per_task, [&](std::size_t begin, std::size_t end) {
      Group group;
      for (std::size_t n = begin; n < end; ++n) search(n * faces_per_search, group);
    });
  }

  double corner(int i) const { return corners_[i]; }
  double center(std::size_t face) const { return centers_[face]; }

 private:
  struct Sample {
    Vec3 place;
    double bound;  ///< m; no place farther away is nearest
    double* distance;
  };
  struct Group {
    std::vector<Sample> samples;
    FaceTree::Candidates near;
  };

  /// Faces without area, which trees leave out, are sampled as well.
  void add_left_out() {
    if (order_.size() == from_.faces.size()) return;
    std::vector<char> there(from_.faces.size());
    for (const std::uint32_t face : order_) there[face] = true;
    for (std::uint32_t face = 0; face < there.size(); ++face)
      if (!there[face]) order_.push_back(face);
  }

  /// One search for the samples of a few faces beside each other.
  void search(std::size_t first, Group& group) {
    group.samples.clear();
    const std::size_t last = std::min(first + faces_per_search, order_.size());
    const std::uint32_t central = order_[first + (last - first) / 2];
    const Vec3 middle = center_of(from_, central);
    const double near = to_.distance(middle, same_ ? (center_of(other_, central) - middle).norm()
                                                   : std::numeric_limits<double>::infinity());
    const auto add = [&](const Vec3& place, const Vec3& likely, double* distance) {
      double bound = near + (middle - place).norm();
      if (same_) bound = std::min(bound, (likely - place).norm());
      group.samples.push_back({place, bound, distance});
    };
    for (std::size_t k = first; k < last; ++k) {
      const std::uint32_t face = order_[k];
      add(center_of(from_, face), same_ ? center_of(other_, face) : middle, &centers_[face]);
      for (const int corner : from_.faces[face])
        if (finder_[corner] == face)
          add(from_.points[corner], same_ ? other_.points[corner] : middle, &corners_[corner]);
    }
    find(group);
  }

  void find(Group& group) const {
    Box box;
    double reach = 0;
    for (const Sample& sample : group.samples) {
      box.extend(sample.place);
      reach = std::max(reach, sample.bound);
    }
    to_.find_near(box, reach, group.near);
    const bool crowded = group.near.face.size() > max_shared;
    for (const Sample& sample : group.samples) {
      double bound = sample.bound;
      if (crowded) {
        bound = to_.distance(sample.place, bound);
        to_.find_near(Box(sample.place), bound, group.near);
      }
      *sample.distance = (to_.nearest(sample.place, bound, group.near) - sample.place).norm();
    }
  }

  const Triangles &from_, &other_;
  const FaceTree& to_;
  std::vector<std::uint32_t> order_;   ///< order of the faces: neighbors are near each other
  bool same_;                          ///< mesh: the same place of the other one is likely near
  std::vector<std::uint32_t> finder_;  ///< face with which each corner is searched
  std::vector<double> corners_, centers_;
};

struct OneWay {
  double farthest = 0, integral = 0, area = 0;
};

OneWay one_way(const Triangles& from, const Distances& distances) {
  OneWay all;
  for (std::size_t f = 0; f < from.faces.size(); ++f) {  // in order, for the same bits
    const double area = face_area(from, from.faces[f]);
    double sum = center_weight * distances.center(f);
    all.farthest = std::max(all.farthest, distances.center(f));
    for (const int i : from.faces[f]) {
      sum += corner_weight * distances.corner(i);
      all.farthest = std::max(all.farthest, distances.corner(i));
    }
    all.integral += area * sum;
    all.area += area;
  }
  return all;
}

}  // namespace

SurfaceGap surface_gap(const FaceTree& one, const FaceTree& other) {
  if (one.faces().empty() || other.faces().empty())
    throw bad_input("the surface has no face with an area", "use a mesh that encloses a volume");
  const OneWay there = one_way(one.surface(), Distances(one, other));
  const OneWay back = one_way(other.surface(), Distances(other, one));
  return {std::max(there.farthest, back.farthest),
          (there.integral + back.integral) / (there.area + back.area)};
}

SurfaceGap surface_gap(const Triangles& one, const Triangles& other) {
  return surface_gap(FaceTree(one), FaceTree(other));
}

}  // namespace sinew
