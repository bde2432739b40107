// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/detail/holes.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <tuple>

#include <sinew/mesh/border.h>

namespace sinew {
namespace {

int third_corner(const std::array<int, 3>& face, int a, int b) {
  for (const int corner : face)
    if (corner != a && corner != b) return corner;
  return a;
}

/// Sorted by their start.
std::vector<HoleEdge> open_edges(const Triangles& surface) {
  std::vector<HoleEdge> open;
  const std::vector<EdgeUse> uses = edge_uses(surface);
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    const int count = net_count(use), low = use[0].low, high = use[0].high;
    if (low == high || count == 0) return;  // a face with a repeated corner has a side of one point
    const bool forward = count > 0;
    const auto one = std::find_if(use.begin(), use.end(),
                                  [&](const EdgeUse& side) { return side.forward == forward; });
    const int opposite = third_corner(surface.faces[one->face], low, high);
    open.insert(open.end(), std::abs(count),
                forward ? HoleEdge{high, low, opposite} : HoleEdge{low, high, opposite});
  });
  std::sort(open.begin(), open.end(), [](const HoleEdge& a, const HoleEdge& b) {
    return std::tie(a.from, a.to) < std::tie(b.from, b.to);
  });
  return open;
}

/// An open edge at a point, by its direction seen along the normal.
struct EdgeEnd {
  double angle;
  bool leaves;
  int edge;
};

/// A path that meets itself at a point is two holes where both parts have the same orientation. A
/// part of the opposite orientation encircles an island in a hole.
class PinchCutter {
 public:
  explicit PinchCutter(const Points& points) : points_(points), place_(points.size(), -1) {}

  void cut(const Hole& hole, std::vector<Hole>& holes) {
    const Vec3& origin = points_[hole[0].from];
    std::vector<Vec3> turned = {Vec3::Zero()};  // doubled area vectors up to each edge of the rest
    Vec3 all = Vec3::Zero();
    for (const HoleEdge& edge : hole) all += turn_of(edge, origin);
    Hole rest;
    for (const HoleEdge& edge : hole) {
      const int before = place_[edge.from];
      const Vec3 part = before < 0 ? Vec3(Vec3::Zero()) : Vec3(turned.back() - turned[before]);
      if (before >= 0 && part.dot(all - part) >= 0) {
        holes.emplace_back(rest.begin() + before, rest.end());
        for (const HoleEdge& gone : holes.back()) place_[gone.from] = -1;
        rest.resize(before);
        turned.resize(before + 1);
        all -= part;
      }
      place_[edge.from] = static_cast<int>(rest.size());
      rest.push_back(edge);
      turned.push_back(turned.back() + turn_of(edge, origin));
    }
    for (const HoleEdge& edge : rest) place_[edge.from] = -1;
    holes.push_back(std::move(rest));
  }

 private:
  Vec3 turn_of(const HoleEdge& edge, const Vec3& origin) const {
    return (points_[edge.from] - origin).cross(points_[edge.to] - origin);
  }

  const Points& points_;
  std::vector<int> place_;  ///< per point, of the last outgoing edge of the rest
};

class Walker {
 public:
  explicit Walker(const Triangles& surface)
      : points_(surface.points), edges_(open_edges(surface)), normals_(point_normals(surface)) {}

  std::vector<Hole> holes() const {
    const std::vector<int> next = next_edges();
    std::vector<bool> walked(edges_.size(), false);
    std::vector<Hole> holes;
    PinchCutter cutter(points_);
    for (std::size_t start = 0; start < edges_.size(); ++start) {
      Hole hole;
      for (int i = static_cast<int>(start); !walked[i]; i = next[i]) {
        walked[i] = true;
        hole.push_back(edges_[i]);
      }
      if (!hole.empty()) cutter.cut(hole, holes);
    }
    return holes;
  }

 private:
  /// Each point has as many incoming as outgoing edges.
  std::vector<int> next_edges() const {
    std::vector<int> coming(edges_.size()), next(edges_.size());
    std::iota(coming.begin(), coming.end(), 0);
    std::stable_sort(coming.begin(), coming.end(),
                     [&](int a, int b) { return edges_[a].to < edges_[b].to; });
    for (std::size_t begin = 0, end = 0; begin < edges_.size(); begin = end) {
      while (end < edges_.size() && edges_[end].from == edges_[begin].from) ++end;
      if (end - begin == 1)
        next[coming[begin]] = static_cast<int>(begin);
      else
        join(edge_ends({coming.data() + begin, end - begin}, static_cast<int>(begin)), next);
    }
    return next;
  }

  /// Clockwise around a point: the incoming edges and the outgoing ones from `first` on.
  std::vector<EdgeEnd> edge_ends(std::span<const int> coming, int first) const {
    const int point = edges_[first].from;
    const bool known = normals_[point].squaredNorm() > 0.5;
    const Vec3 normal = known ? normals_[point] : Vec3(Vec3::UnitZ());
    const Vec3 side = normal.unitOrthogonal(), up = normal.cross(side);
    const auto angle = [&](int to) {
      const Vec3 along = points_[to] - points_[point];
      return std::atan2(along.dot(up), along.dot(side));
    };
    std::vector<EdgeEnd> all;
    for (std::size_t i = 0; i < coming.size(); ++i) {
      const int out = first + static_cast<int>(i);
      all.push_back({angle(edges_[coming[i]].from), false, coming[i]});
      all.push_back({angle(edges_[out].to), true, out});
    }
    std::sort(all.begin(), all.end(), [](const EdgeEnd& a, const EdgeEnd& b) {
      return std::tie(b.angle, a.leaves, a.edge) < std::tie(a.angle, b.leaves, b.edge);
    });
    return all;
  }

  /// A hole is on the left of its edges, clockwise from the incoming to the outgoing one: they are
  /// matched as brackets, starting where as many are closed as opened.
  static void join(std::vector<EdgeEnd> clockwise, std::vector<int>& next) {
    int depth = 0, least = 0;
    auto start = clockwise.begin();
    for (auto at = clockwise.begin(); at != clockwise.end(); ++at) {
      depth += at->leaves ? -1 : 1;
      if (depth >= least) continue;
      least = depth;
      start = at + 1;
    }
    std::rotate(clockwise.begin(), start, clockwise.end());
    std::vector<int> open;
    for (const EdgeEnd& end : clockwise) {
      if (!end.leaves) {
        open.push_back(end.edge);
        continue;
      }
      next[open.back()] = end.edge;
      open.pop_back();
    }
  }

  const Points& points_;
  std::vector<HoleEdge> edges_;
  Points normals_;
};

}  // namespace

std::vector<Hole> holes_of(const Triangles& surface) { return Walker(surface).holes(); }

}  // namespace sinew
