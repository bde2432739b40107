// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/limbs.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include <sinew/core/decompositions.h>
#include <sinew/core/union_find.h>

namespace sinew {
namespace {

constexpr double min_reach = 1.7;  // reach of a limb in widths of the place where it begins
constexpr double flat_end = 0.15;  // fraction of the width: points so near the farthest are the tip
constexpr double min_trunk = 0.75;  // length of a limb between two forks, in their widths
constexpr double min_both = 2.5;    // length of a body with limbs, in its widths
constexpr double inf = std::numeric_limits<double>::infinity();

/// The graph while it becomes a tree.
struct CurveTree {
  explicit CurveTree(const CurveGraph& given);

  double distance(int a, int b) const { return (graph.points[a] - graph.points[b]).norm(); }

  const CurveGraph& graph;
  std::vector<std::vector<int>> joined;    ///< neighbors by links
  std::vector<std::vector<int>> skin;      ///< points of the surface, of each point
  std::vector<int> parent;                 ///< -1: root, or not in the tree
  std::vector<std::vector<int>> children;  ///< in the tree
  std::vector<bool> on_ring, cut;          ///< cut: where a ring ends
  std::vector<double> width;               ///< width of the body around the points, m
};

/// Root mean square distance of the skin around a point, m.
double width_at(const CurveTree& tree, int point) {
  const double inner = tree.graph.inner[point];
  double sum = 0;
  std::size_t count = 0;
  const auto add = [&](int of) {
    for (const int i : tree.skin[of])
      sum += (tree.graph.skin[i] - tree.graph.points[point]).squaredNorm();
    count += tree.skin[of].size();
  };
  add(point);
  for (const int next : tree.joined[point])
    if (tree.distance(point, next) <= inner) add(next);
  return count == 0 ? inner : std::max(inner, std::sqrt(sum / static_cast<double>(count)));
}

CurveTree::CurveTree(const CurveGraph& given) : graph(given) {
  const std::size_t count = graph.points.size();
  joined.resize(count), skin.resize(count), children.resize(count);
  parent.assign(count, -1);
  on_ring.assign(count, false), cut.assign(count, false);
  for (const auto& [a, b] : graph.links) joined[a].push_back(b), joined[b].push_back(a);
  for (std::size_t i = 0; i < graph.skin.size(); ++i)
    skin[graph.owner[i]].push_back(static_cast<int>(i));
  for (std::size_t i = 0; i < count; ++i) width.push_back(width_at(*this, static_cast<int>(i)));
}

struct CurvePaths {
  std::vector<double> length;  ///< infinite where there is none
  std::vector<int> before;
  std::vector<int> order;  ///< reached points, the nearest first
};

CurvePaths paths_from(const CurveTree& tree, int start) {
  const std::size_t count = tree.graph.points.size();
  CurvePaths paths{std::vector<double>(count, inf), std::vector<int>(count, -1), {}};
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  paths.length[start] = 0;
  queue.push({0, start});
  while (!queue.empty()) {
    const auto [so_far, here] = queue.top();
    queue.pop();
    if (so_far > paths.length[here]) continue;
    paths.order.push_back(here);
    for (const int next : tree.joined[here]) {
      const double longer = so_far + tree.distance(here, next);
      if (longer >= paths.length[next]) continue;
      paths.length[next] = longer;
      paths.before[next] = here;
      queue.push({longer, next});
    }
  }
  return paths;
}

/// About the volume of the body around a point.
double weight_of(const CurveTree& tree, int point) {
  return static_cast<double>(tree.skin[point].size()) * tree.graph.inner[point];
}

/// The point from which the way to all of the body is the shortest.
int middle_of(const CurveTree& tree, const std::vector<int>& points) {
  int best = points.front();
  double least = inf;
  for (const int start : points) {
    const CurvePaths paths = paths_from(tree, start);
    double sum = 0;
    for (const int point : points) sum += weight_of(tree, point) * paths.length[point];
    if (sum < least) least = sum, best = start;
  }
  return best;
}

/// Links outside of the tree close rings: marks the ways from both ends to where they meet.
void mark_ring(CurveTree& tree, int a, int b) {
  tree.cut[a] = tree.cut[b] = true;
  std::vector<int> above_a;
  for (int at = a; at >= 0; at = tree.parent[at]) above_a.push_back(at);
  int meeting = b;
  while (std::find(above_a.begin(), above_a.end(), meeting) == above_a.end())
    meeting = tree.parent[meeting];
  for (const int end : {a, b})
    for (int at = end; at != meeting; at = tree.parent[at]) tree.on_ring[at] = true;
}

void grow(CurveTree& tree, int root) {
  const CurvePaths paths = paths_from(tree, root);
  for (const int point : paths.order) {
    tree.parent[point] = paths.before[point];
    if (point != root) tree.children[paths.before[point]].push_back(point);
  }
  for (const int a : paths.order)
    for (const int b : tree.joined[a])
      if (a < b && tree.parent[a] != b && tree.parent[b] != a) mark_ring(tree, a, b);
}

/// The points of the branch that ends at a leaf, from there, without the one where it begins.
std::vector<int> branch_of(const CurveTree& tree, int leaf) {
  std::vector<int> branch{leaf};
  while (true) {
    const int next = tree.parent[branch.back()];
    if (next < 0 || tree.parent[next] < 0 || tree.children[next].size() > 1) return branch;
    branch.push_back(next);
  }
}

/// How far the skin of a branch reaches from where it begins, in widths there.
double reach_of(const CurveTree& tree, const std::vector<int>& branch) {
  const int from = tree.parent[branch.back()];
  double farthest = 0;
  for (const int point : branch) {
    farthest = std::max(farthest, tree.distance(from, point) + tree.graph.inner[point]);
    for (const int i : tree.skin[point])
      farthest = std::max(farthest, (tree.graph.skin[i] - tree.graph.points[from]).norm());
  }
  return farthest / tree.width[from];
}

bool is_leaf(const CurveTree& tree, int point) {
  return tree.children[point].empty() && tree.parent[point] >= 0;
}

/// Its skin goes to where it began.
void cut_off(CurveTree& tree, const std::vector<int>& branch) {
  const int from = tree.parent[branch.back()];
  std::erase(tree.children[from], branch.back());
  for (const int point : branch) {
    tree.skin[from].insert(tree.skin[from].end(), tree.skin[point].begin(), tree.skin[point].end());
    tree.parent[point] = -1;
    tree.children[point].clear();
    tree.skin[point].clear();
  }
}

/// Cuts the shortest branches first: what is left of a fork may then be one limb.
void prune(CurveTree& tree, const std::vector<int>& points) {
  while (true) {
    std::vector<int> shortest;
    double least = min_reach;
    for (const int leaf : points) {
      if (!is_leaf(tree, leaf) || tree.on_ring[leaf]) continue;
      std::vector<int> branch = branch_of(tree, leaf);
      const int from = tree.parent[branch.back()];
      if (tree.children[from].size() < 2) continue;  // all there is
      const double reach = reach_of(tree, branch);
      if (reach < least) least = reach, shortest = std::move(branch);
    }
    if (shortest.empty()) return;
    cut_off(tree, shortest);
  }
}

/// The middle of the farthest points of the skin around the last part of a line.
Vec3 tip_of(const CurveTree& tree, const std::vector<int>& chain) {
  const Points& points = tree.graph.points;
  const int leaf = chain.back();
  const double width = tree.width[leaf];
  std::size_t back = chain.size() - 1;
  while (back > 0 && (points[chain[back]] - points[leaf]).norm() < 2 * width) --back;
  const Vec3 along = (points[leaf] - points[chain[back]]).normalized();
  double farthest = 0;
  const auto visit = [&](auto&& use) {
    for (std::size_t i = back; i < chain.size(); ++i)
      for (const int s : tree.skin[chain[i]])
        use(tree.graph.skin[s], along.dot(tree.graph.skin[s] - points[leaf]));
  };
  visit([&](const Vec3&, double ahead) { farthest = std::max(farthest, ahead); });
  Vec3 sum = Vec3::Zero();
  int count = 0;
  visit([&](const Vec3& place, double ahead) {
    if (ahead > 0 && ahead >= farthest - flat_end * width) sum += place, ++count;
  });
  return count == 0 ? points[leaf] : Vec3(sum / count);
}

Limb limb_along(const CurveTree& tree, const std::vector<int>& chain, int body, int parent) {
  Limb limb;
  limb.body = body, limb.parent = parent;
  for (const int point : chain) {
    limb.line.push_back(tree.graph.points[point]);
    limb.inner.push_back(tree.graph.inner[point]);
  }
  const int last = chain.back();
  limb.on_ring = tree.on_ring[last];
  if (tree.children[last].size() > 1) {
    limb.end = Limb::End::fork;
  } else if (tree.cut[last]) {
    limb.end = Limb::End::ring;
  } else {
    limb.line.push_back(tip_of(tree, chain));
    limb.inner.push_back(0);
  }
  return limb;
}

void add_limbs(const CurveTree& tree, int from, int parent, int body, std::vector<Limb>& limbs) {
  for (const int child : tree.children[from]) {
    std::vector<int> chain{from, child};
    while (tree.children[chain.back()].size() == 1)
      chain.push_back(tree.children[chain.back()].front());
    const int number = static_cast<int>(limbs.size());
    limbs.push_back(limb_along(tree, chain, body, parent));
    add_limbs(tree, chain.back(), number, body, limbs);
  }
}

/// Limbs between forks that are one place of the body: those beyond begin where they do.
void merge_forks(std::vector<Limb>& limbs) {
  std::vector<int> number(limbs.size());  // -1: merged
  std::vector<Limb> kept;
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    Limb limb = std::move(limbs[i]);
    while (limb.parent >= 0 && number[limb.parent] < 0) {
      const Limb& fork = limbs[limb.parent];
      limb.line.insert(limb.line.begin(), fork.line.begin(), fork.line.end() - 1);
      limb.inner.insert(limb.inner.begin(), fork.inner.begin(), fork.inner.end() - 1);
      limb.parent = fork.parent;
    }
    const bool short_fork =
        limb.end == Limb::End::fork &&
        length(limb) < min_trunk * std::max(limb.inner.front(), limb.inner.back());
    number[i] = short_fork ? -1 : static_cast<int>(kept.size());
    if (short_fork) {
      limbs[i] = std::move(limb);
      continue;
    }
    if (limb.parent >= 0) limb.parent = number[limb.parent];
    kept.push_back(std::move(limb));
  }
  limbs = std::move(kept);
}

/// The points of each component, the component of the lowest point first.
std::vector<std::vector<int>> components_of(const CurveGraph& graph) {
  UnionFind sets(graph.points.size());
  for (const auto& [a, b] : graph.links) sets.join(a, b);
  std::vector<std::vector<int>> components(graph.points.size());
  for (std::size_t i = 0; i < graph.points.size(); ++i)
    components[sets.first_of(static_cast<int>(i))].push_back(static_cast<int>(i));
  std::erase_if(components, [](const auto& points) { return points.empty(); });
  return components;
}

/// Too short for its width: what there is of limbs says nothing about the body.
bool is_compact(const CurveTree& tree, int root, const std::vector<Limb>& limbs) {
  double longest = 0, second = 0;
  for (const Limb& limb : limbs) {
    if (limb.parent >= 0 || limb.end != Limb::End::tip) return false;
    const double now = length(limb);
    if (now > longest)
      second = std::exchange(longest, now);
    else
      second = std::max(second, now);
  }
  return longest + second < min_both * 2 * tree.width[root];
}

std::vector<Limb> limbs_in(CurveTree& tree, const std::vector<int>& points, int body) {
  const int root = middle_of(tree, points);
  grow(tree, root);
  prune(tree, points);
  std::vector<Limb> limbs;
  add_limbs(tree, root, -1, body, limbs);
  merge_forks(limbs);
  if (!is_compact(tree, root, limbs)) return limbs;
  Points skin;
  for (const int point : points)
    for (const int i : tree.skin[point]) skin.push_back(tree.graph.skin[i]);
  limbs = axis_limbs(skin);
  for (Limb& limb : limbs) limb.body = body;
  return limbs;
}

/// The first of z, x, y along which the points are about as wide as anywhere, or the axis itself.
Vec3 longest_axis(const Points& points, const Vec3& middle) {
  constexpr double as_wide = 0.95;
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : points) spread += (p - middle) * (p - middle).transpose();
  const PrincipalAxes solved = principal_axes(spread);
  for (const int axis : {2, 0, 1})
    if (spread(axis, axis) >= as_wide * solved.values[2]) return Vec3::Unit(axis);
  return solved.axes.col(2);
}

}  // namespace

double length(const Limb& limb) {
  double sum = 0;
  for (std::size_t i = 1; i < limb.line.size(); ++i)
    sum += (limb.line[i] - limb.line[i - 1]).norm();
  return sum;
}

std::vector<Limb> axis_limbs(const Points& skin) {
  if (skin.empty()) return {};
  const Vec3 middle = std::accumulate(skin.begin(), skin.end(), Vec3(Vec3::Zero())) /
                      static_cast<double>(skin.size());
  const Vec3 axis = longest_axis(skin, middle);
  double inner = inf;
  for (const Vec3& p : skin) inner = std::min(inner, (p - middle).norm());
  std::vector<Limb> limbs;
  for (const Vec3& along : {axis, Vec3(-axis)}) {
    double reach = 0;
    for (const Vec3& p : skin) reach = std::max(reach, along.dot(p - middle));
    Limb& limb = limbs.emplace_back();
    limb.line = {middle, middle + reach * along};
    limb.inner = {inner, 0};
  }
  return limbs;
}

std::vector<Limb> limbs_of(const CurveGraph& graph) {
  CurveTree tree(graph);
  std::vector<Limb> limbs;
  int body = 0;
  for (const std::vector<int>& points : components_of(graph)) {
    const int first = static_cast<int>(limbs.size());
    for (Limb& limb : limbs_in(tree, points, body++)) {
      if (limb.parent >= 0) limb.parent += first;
      limbs.push_back(std::move(limb));
    }
  }
  return limbs;
}

}  // namespace sinew
