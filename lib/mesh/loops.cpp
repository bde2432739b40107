// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/loops.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

namespace sinew {
namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// The points of each group as nodes, with the edges that leave them.
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

  /// Takes the next edge that leaves a node; gives the node it comes to.
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

/// The loop that ends a walk which has come back to its node at `begin`; the walk loses it.
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
