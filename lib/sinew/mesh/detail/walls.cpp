// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/detail/walls.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>

#include <sinew/core/union_find.h>
#include <sinew/mesh/border.h>
#include <sinew/mesh/detail/triangulate.h>
#include <sinew/mesh/solids.h>

namespace sinew {
namespace {

using Edge = std::span<const EdgeUse>;

/// Edges with faces in both directions, and which of these are connected.
class Opposed {
 public:
  Opposed(std::span<const EdgeUse> uses, const std::vector<bool>& opposed)
      : opposed_(opposed), network_(opposed.size()), patch_(opposed.size()) {
    for_each_edge(uses, [&](Edge edge) {
      if (std::any_of(edge.begin(), edge.end(), [&](const EdgeUse& u) { return opposed[u.face]; }))
        add(edge);
    });
  }

  FaceKinds kinds() {
    FaceKinds kinds{std::vector<bool>(opposed_.size()), {}};
    std::map<int, std::vector<int>> alone;
    const std::map<int, Gain> gains = gains_of_networks();
    for (int face = 0; face < static_cast<int>(opposed_.size()); ++face) {
      if (!opposed_[face]) continue;
      const Gain& gain = gains.at(network_.first_of(face));
      if (!gain.meets_others) alone[network_.first_of(face)].push_back(face);
      kinds.wall[face] = gain.meets_others && gain.closed > 0;
    }
    turn_patches(kinds.wall);
    for (auto& [first, faces] : alone) kinds.alone.push_back(std::move(faces));
    return kinds;
  }

 private:
  /// Effect of leaving out a whole network.
  struct Gain {
    bool meets_others = false;
    int closed = 0;  ///< edges that get an even number of faces, less those that get an odd one
  };

  void add(Edge edge) {
    edges_.push_back(edge);
    int first = -1;
    for (const EdgeUse& use : edge) {
      if (!opposed_[use.face]) continue;
      if (first < 0) first = use.face;
      network_.join(first, use.face);
      if (edge.size() == 2 && opposed_[edge[0].face] && opposed_[edge[1].face])
        patch_.join(first, use.face);
    }
  }

  std::map<int, Gain> gains_of_networks() {
    std::map<int, Gain> gains;
    for (const Edge& edge : edges_) {
      const auto ours = std::find_if(edge.begin(), edge.end(),
                                     [&](const EdgeUse& use) { return opposed_[use.face]; });
      const auto others = std::count_if(edge.begin(), edge.end(),
                                        [&](const EdgeUse& use) { return !opposed_[use.face]; });
      Gain& gain = gains[network_.first_of(ours->face)];
      gain.meets_others = gain.meets_others || others > 0;
      gain.closed += static_cast<int>(edge.size() % 2) - static_cast<int>(others % 2);
    }
    return gains;
  }

  /// Connected faces without others between them.
  struct Patch {
    std::vector<int> faces;
    std::vector<std::size_t> rim;  ///< edges with an odd number of its faces
  };

  std::map<int, Patch> patches() {
    std::map<int, Patch> patches;
    for (int face = 0; face < static_cast<int>(opposed_.size()); ++face)
      if (opposed_[face]) patches[patch_.first_of(face)].faces.push_back(face);
    for (std::size_t e = 0; e < edges_.size(); ++e)
      for (const auto& [patch, faces] : faces_at(edges_[e]))
        if (faces % 2 > 0) patches[patch].rim.push_back(e);
    return patches;
  }

  /// Number of faces of each patch at an edge.
  std::map<int, int> faces_at(Edge edge) {
    std::map<int, int> faces;
    for (const EdgeUse& use : edge)
      if (opposed_[use.face]) ++faces[patch_.first_of(use.face)];
    return faces;
  }

  /// Makes walls of patches of skin, or skin of walls, as long as that leaves fewer odd edges.
  void turn_patches(std::vector<bool>& wall) {
    const std::map<int, Patch> all = patches();
    std::vector<bool> odd;
    for (const Edge& edge : edges_)
      odd.push_back(std::count_if(edge.begin(), edge.end(),
                                  [&](const EdgeUse& use) { return !wall[use.face]; }) %
                        2 >
                    0);
    std::set<int> tried;  // walls that became skin for nothing: others beside them may follow
    std::vector<int> queue;
    for (const auto& [number, patch] : all) queue.push_back(number);
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const Patch& patch = all.at(queue[i]);
      const auto closed = static_cast<std::size_t>(
          std::count_if(patch.rim.begin(), patch.rim.end(), [&](std::size_t e) { return odd[e]; }));
      const bool even = 2 * closed == patch.rim.size() && wall[patch.faces.front()];
      if (2 * closed <= patch.rim.size() && !(closed > 0 && even && tried.insert(queue[i]).second))
        continue;
      for (const int face : patch.faces) wall[face] = !wall[face];
      for (const std::size_t e : patch.rim) {
        odd[e] = !odd[e];
        for (const auto& [neighbor, faces] : faces_at(edges_[e])) queue.push_back(neighbor);
      }
    }
  }

  const std::vector<bool>& opposed_;
  std::vector<Edge> edges_;
  UnionFind network_;  ///< faces that meet at any edge
  UnionFind patch_;    ///< faces that meet at edges without others
};

}  // namespace

FaceKinds kinds_of(const Triangles& faces, const std::vector<bool>& opposed) {
  return Opposed(edge_uses(faces), opposed).kinds();
}

namespace {

/// A side of a face at an edge, as seen along it from low to high.
struct Wedge {
  double angle;
  bool opens;  ///< material lies at larger angles
  int side;
};

/// The sides of faces: one of each face of the outline, which comes first, two of each wall.
class Sides {
 public:
  Sides(const Triangles& all, std::size_t outline)
      : all_(all), outline_(static_cast<int>(outline)), sets_(2 * all.faces.size() - outline) {
    const std::vector<EdgeUse> uses = edge_uses(all);
    for_each_edge(uses, [&](Edge edge) {
      if (!std::any_of(edge.begin(), edge.end(), [&](const EdgeUse& u) { return is_wall(u); }) ||
          !join_wedges(edge))
        join_all(edge);
    });
  }

  /// Behind a face.
  int behind(int face) const { return face < outline_ ? face : 2 * face - outline_; }

  /// Per side, the number of its component, by the first side of each.
  std::vector<int> components(int& count) {
    count = 0;
    std::vector<int> number(2 * all_.faces.size() - static_cast<std::size_t>(outline_));
    for (int side = 0; side < static_cast<int>(number.size()); ++side)
      number[side] = sets_.first_of(side) == side ? count++ : number[sets_.first_of(side)];
    return number;
  }

 private:
  bool is_wall(const EdgeUse& use) const { return use.face >= outline_; }

  void join_all(Edge edge) {
    for (const EdgeUse& use : edge) {
      sets_.join(behind(edge[0].face), behind(use.face));
      if (is_wall(use)) sets_.join(behind(edge[0].face), behind(use.face) + 1);
    }
  }

  std::vector<Wedge> wedges_at(Edge edge) const {
    const Vec3 low = all_.points[edge[0].low];
    const Vec3 along = (all_.points[edge[0].high] - low).normalized();
    const Vec3 u = along.unitOrthogonal(), v = along.cross(u);
    std::vector<Wedge> wedges;
    for (const EdgeUse& use : edge) {
      const auto& [a, b, c] = all_.faces[use.face];
      const Vec3 third = all_.points[a + b + c - use.low - use.high] - low;
      const double angle = std::atan2(third.dot(v), third.dot(u));
      wedges.push_back({angle, !use.forward, behind(use.face)});
      if (is_wall(use)) wedges.push_back({angle, use.forward, behind(use.face) + 1});
    }
    std::sort(wedges.begin(), wedges.end(), [](const Wedge& a, const Wedge& b) {
      return std::tie(a.angle, a.opens, a.side) < std::tie(b.angle, b.opens, b.side);
    });
    return wedges;
  }

  /// False where sides do not take turns.
  bool join_wedges(Edge edge) {
    const std::vector<Wedge> wedges = wedges_at(edge);
    const std::size_t count = wedges.size();
    for (std::size_t i = 0; i < count; ++i)
      if (wedges[i].opens == wedges[(i + 1) % count].opens) return false;
    for (std::size_t i = 0; i < count; ++i)
      if (wedges[i].opens) sets_.join(wedges[i].side, wedges[(i + 1) % count].side);
    return true;
  }

  const Triangles& all_;
  int outline_;
  UnionFind sets_;
};

/// The faces of both on common points.
Triangles on_common_points(const Triangles& outline, const Triangles& walls) {
  Triangles all = outline;
  append(walls, all);
  const std::vector<int> first = first_within(all.points, 0);
  for (auto& face : all.faces)
    for (int& corner : face) corner = first[corner];
  return all;
}

}  // namespace

void part(Surface& surface, Triangles walls) {
  if (walls.faces.empty()) return;
  const std::size_t outline = surface.triangles.faces.size();
  const Triangles all = on_common_points(surface.triangles, walls);
  Sides sides(all, outline);
  const std::vector<int> number = sides.components(surface.components);
  std::copy_n(number.begin(), outline, surface.component.begin());
  for (std::size_t k = 0; k < walls.faces.size(); ++k) {
    const int side = sides.behind(static_cast<int>(outline + k));
    surface.walls.component.push_back({number[side], number[side + 1]});
  }
  surface.walls.triangles = std::move(walls);
}

}  // namespace sinew
