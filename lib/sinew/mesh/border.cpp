// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/border.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace sinew {

int net_count(std::span<const EdgeUse> use) {
  int count = 0;
  for (const EdgeUse& side : use) count += side.forward ? 1 : -1;
  return count;
}

std::vector<Loop> border_loops(std::span<const EdgeUse> uses) {
  std::vector<BorderEdge> border;
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    const int count = net_count(use), low = use[0].low, high = use[0].high;
    border.insert(border.end(), std::abs(count),
                  count > 0 ? BorderEdge{0, low, high} : BorderEdge{0, high, low});
  });
  return simple_loops(std::move(border));
}

Border border_of(const Triangles& surface, std::span<const EdgeUse> uses,
                 std::span<const Loop> loops) {
  Border border;
  border.holes = loops.size();
  for_each_edge(uses, [&](std::span<const EdgeUse> use) {
    border.crowded_edges += use.size() > 2;
    if (net_count(use) == 0) return;
    ++border.edges;
    border.length += (surface.points[use[0].high] - surface.points[use[0].low]).norm();
  });
  return border;
}

namespace {

template <class Visit>
void for_each_side(const std::vector<std::array<int, 3>>& faces, Visit&& visit) {
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int side = 0; side < 3; ++side) {
      const int from = faces[i][side], to = faces[i][(side + 1) % 3];
      visit(EdgeUse{std::min(from, to), std::max(from, to), static_cast<int>(i), from < to});
    }
}

}  // namespace

std::vector<EdgeUse> edge_uses(const Triangles& surface) {
  std::vector<std::size_t> end(surface.points.size() + 1, 0);  // end of the uses of each low point
  for_each_side(surface.faces, [&](const EdgeUse& use) { ++end[use.low + 1]; });
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<EdgeUse> uses(end.back());
  for_each_side(surface.faces, [&](const EdgeUse& use) { uses[end[use.low]++] = use; });
  const auto before = [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.high, a.face) < std::tie(b.high, b.face);
  };
  for (std::size_t begin = 0; begin < uses.size(); begin = end[uses[begin].low])
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(begin),
              uses.begin() + static_cast<std::ptrdiff_t>(end[uses[begin].low]), before);
  return uses;
}

namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// The points of each group as nodes, with their outgoing edges.
class BorderGraph {
 public:
  explicit BorderGraph(std::vector<BorderEdge> edges) : edges_(std::move(edges)) {
    std::sort(edges_.begin(), edges_.end(), [](const BorderEdge& a, const BorderEdge& b) {
      return std::tie(a.group, a.from, a.to) < std::tie(b.group, b.from, b.to);
    });
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (i > 0 && place(edges_[i]) == place(edges_[i - 1])) continue;
      places_.push_back(place(edges_[i]));
      next_.push_back(i);
    }
    begin_.assign(next_.begin(), next_.end());
    begin_.push_back(edges_.size());
  }

  std::size_t nodes() const { return places_.size(); }
  int group(std::size_t node) const { return places_[node].first; }
  int point(std::size_t node) const { return places_[node].second; }
  bool exhausted(std::size_t node) const { return next_[node] == begin_[node + 1]; }

  /// Takes the next outgoing edge of a node; returns the node at its end.
  std::size_t step(std::size_t node) {
    const std::pair<int, int> wanted = {group(node), edges_[next_[node]++].to};
    return static_cast<std::size_t>(std::lower_bound(places_.begin(), places_.end(), wanted) -
                                    places_.begin());
  }

 private:
  static std::pair<int, int> place(const BorderEdge& edge) { return {edge.group, edge.from}; }

  std::vector<BorderEdge> edges_;
  std::vector<std::pair<int, int>> places_;  ///< ascending
  std::vector<std::size_t> next_;            ///< per node, the first edge not taken
  std::vector<std::size_t> begin_;           ///< per node, its first edge, and one past all
};

/// Splits off the loop of a walk that has returned to its node at `begin`.
Loop cut_off(const BorderGraph& graph, std::vector<std::size_t>& walk, std::size_t begin) {
  Loop loop{graph.group(walk[begin]), {}};
  for (std::size_t i = begin; i < walk.size(); ++i) loop.points.push_back(graph.point(walk[i]));
  walk.resize(begin + 1);
  return loop;
}

}  // namespace

std::vector<Loop> simple_loops(std::vector<BorderEdge> edges) {
  BorderGraph graph(std::move(edges));
  std::vector<Loop> loops;
  std::vector<std::size_t> walk, place(graph.nodes(), nowhere);  // place: of a node in the walk
  for (std::size_t start = 0; start < graph.nodes(); ++start) {
    walk.assign(1, start);
    place[start] = 0;
    while (!graph.exhausted(walk.back())) {
      const std::size_t node = graph.step(walk.back());
      if (place[node] == nowhere) {
        place[node] = walk.size();
        walk.push_back(node);
        continue;
      }
      for (std::size_t i = place[node] + 1; i < walk.size(); ++i) place[walk[i]] = nowhere;
      loops.push_back(cut_off(graph, walk, place[node]));
    }
    place[start] = nowhere;
  }
  return loops;
}

}  // namespace sinew
