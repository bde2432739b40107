// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/volume/detail/stuffing.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t edges_at_a_time = 64;
constexpr double longest_touching = 2.4;  // radii
constexpr double flat_at_crease = 12;     // degrees
constexpr double thin_wall = 1;           // fraction of the longest edge between touching sites
constexpr double flat_in_wall = 8;        // degrees
constexpr double nearest_side = 0.22;     // fraction of its thickness, from a point in it
constexpr double opposed = -0.6;          // cosine between crossings on two sides of a wall

/// An edge that crosses the border.
struct CutEdge {
  std::uint32_t inside, outside;
  double at = 0;              ///< fraction of it, from inside
  Vec3 place = Vec3::Zero();  ///< m
  bool open = true;           ///< neither end is on the border
  std::uint32_t point = 0;

  auto ends() const { return std::pair(inside, outside); }
};

enum class Side : signed char { outside = -1, border = 0, inside = 1 };

class Stuffing {
 public:
  Stuffing(const Scaffold& scaffold, const BodyBorder& border, double radius,
           const NearFractions& near, const std::vector<char>& left)
      : scaffold_(scaffold),
        border_(border),
        near_(near),
        touching_(longest_touching * radius),
        left_(left) {
    for (const char inside : scaffold.inside)
      side_.push_back(inside ? Side::inside : Side::outside);
    body_.points = scaffold.points;
    body_.id = body_.beside = scaffold.particle;
    find_edges();
    parallel_for(edges_.size(), edges_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) cross(edges_[e]);
    });
    center_in_walls();
    move_points();
    add_crossings();
    for (const Cell& cell : scaffold.cells) cut(cell);
  }

  /// Points that center_in_walls() has moved, at cells that are too flat.
  std::vector<std::uint32_t> moved_at_flat_cells() const {
    std::vector<std::uint32_t> found;
    if (std::find(in_wall_.begin(), in_wall_.end(), 1) == in_wall_.end()) return found;
    std::vector<std::uint32_t> owner(body_.points.size());  // end inside of each crossing
    std::iota(owner.begin(), owner.end(), 0U);
    for (const CutEdge& edge : edges_)
      if (edge.open) owner[edge.point] = edge.inside;
    for (const Cell& cell : body_.cells) {
      if (std::none_of(cell.begin(), cell.end(),
                       [&](std::uint32_t v) { return in_wall_[owner[v]] != 0; }) ||
          smallest_angle({&cell, 1}) >= flat_in_wall)
        continue;
      for (const std::uint32_t v : cell)
        if (in_wall_[owner[v]]) found.push_back(owner[v]);
    }
    return found;
  }

  VolumeCells result() && {
    drop_unused_points();
    return std::move(body_);
  }

 private:
  void find_edges() {
    for (const Cell& cell : scaffold_.cells)
      for (const std::uint32_t i : cell)
        for (const std::uint32_t j : cell)
          if (scaffold_.inside[i] && !scaffold_.inside[j]) edges_.push_back({i, j});
    const auto before = [](const CutEdge& a, const CutEdge& b) { return a.ends() < b.ends(); };
    std::sort(edges_.begin(), edges_.end(), before);
    const auto same = [](const CutEdge& a, const CutEdge& b) { return a.ends() == b.ends(); };
    edges_.erase(std::unique(edges_.begin(), edges_.end(), same), edges_.end());
  }

  void cross(CutEdge& edge) const {
    const Vec3 &from = body_.points[edge.inside], &to = body_.points[edge.outside];
    edge.at = border_.crossing(from, to);
    edge.place = from + edge.at * (to - from);
  }

  double near(const CutEdge& edge) const {
    return length(edge) < touching_ ? near_.touching : near_.longer;
  }

  double length(const CutEdge& edge) const {
    return (scaffold_.points[edge.inside] - scaffold_.points[edge.outside]).norm();
  }

  /// Moves points inside of thin walls, if near one side, to the middle: on the border they would
  /// take their cells with them. Leaves `left` ones, and those that stay near a side.
  void center_in_walls() {
    in_wall_.assign(side_.size(), 0);
    for (auto begin = edges_.begin(), end = begin; begin != edges_.end(); begin = end) {
      end = std::find_if(begin, edges_.end(),
                         [&](const CutEdge& edge) { return edge.inside != begin->inside; });
      if (!left_[begin->inside] &&
          std::any_of(begin, end, [&](const CutEdge& edge) { return edge.at < near(edge); }))
        center(std::span(begin, end));
    }
  }

  void center(std::span<CutEdge> edges) {
    Vec3& point = body_.points[edges[0].inside];
    const auto shorter = [&](const CutEdge& a, const CutEdge& b) {
      return (a.place - point).squaredNorm() < (b.place - point).squaredNorm();
    };
    const Vec3 nearest = std::min_element(edges.begin(), edges.end(), shorter)->place - point;
    std::optional<Vec3> opposite;
    for (const CutEdge& edge : edges) {
      const Vec3 displacement = edge.place - point;
      if (displacement.dot(nearest) < opposed * displacement.norm() * nearest.norm() &&
          (!opposite || displacement.norm() < opposite->norm()))
        opposite = displacement;
    }
    if (!opposite) return;
    const double thickness = (nearest.norm() + opposite->norm()) / touching_;
    if (thickness > thin_wall) return;
    const Vec3 before = std::exchange(point, point + (nearest + *opposite) / 2);
    for (CutEdge& edge : edges) cross(edge);
    const bool centered = std::none_of(edges.begin(), edges.end(), [&](const CutEdge& edge) {
      return edge.at < nearest_side * thickness;
    });
    if (centered) {
      body_.id[edges[0].inside] = -1;
      in_wall_[edges[0].inside] = 1;
    } else {
      point = before;
      for (CutEdge& edge : edges) cross(edge);
    }
  }

  /// Moves ends of edges to crossings that are near, nearest first.
  void move_points() {
    struct Move {
      double fraction;
      std::uint32_t edge, point;
    };
    std::vector<Move> moves;
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      const CutEdge& edge = edges_[e];
      const double scale = length(edge) / touching_;
      if (edge.at < near(edge) && !in_wall_[edge.inside])
        moves.push_back({edge.at * scale, e, edge.inside});
      if (1 - edge.at < near(edge)) moves.push_back({(1 - edge.at) * scale, e, edge.outside});
    }
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return std::tie(a.fraction, a.edge, a.point) < std::tie(b.fraction, b.edge, b.point);
    });
    for (const Move& move : moves) {
      const CutEdge& edge = edges_[move.edge];
      if (side_[edge.inside] == Side::border || side_[edge.outside] == Side::border) continue;
      side_[move.point] = Side::border;
      body_.points[move.point] = edge.place;
      body_.id[move.point] = -1;
      if (move.point == edge.outside) body_.beside[move.point] = scaffold_.particle[edge.inside];
    }
  }

  void add_crossings() {
    for (CutEdge& edge : edges_) {
      edge.open = side_[edge.inside] == Side::inside && side_[edge.outside] == Side::outside;
      if (!edge.open) continue;
      edge.point = static_cast<std::uint32_t>(body_.points.size());
      body_.points.push_back(edge.place);
      body_.id.push_back(-1);
      body_.beside.push_back(scaffold_.particle[edge.inside]);
    }
  }

  const CutEdge& edge(std::uint32_t inside, std::uint32_t outside) const {
    const auto ends = std::pair(inside, outside);
    return *std::lower_bound(edges_.begin(), edges_.end(), ends,
                             [](const CutEdge& one, const auto& two) { return one.ends() < two; });
  }
  std::uint32_t crossing(std::uint32_t inside, std::uint32_t outside) const {
    return edge(inside, outside).point;
  }

  /// Whether of a quadrangle, left by a face with two corners inside, the diagonal ends at the
  /// crossing beyond `a`, not `b`: the shorter one of an equilateral face. An order of corners, so
  /// that three such faces of a prism never contradict each other.
  bool first_of(std::uint32_t a, std::uint32_t b, std::uint32_t outside) const {
    const auto rank = [&](std::uint32_t corner) {
      return std::pair(std::abs(edge(corner, outside).at - 0.5), corner);
    };
    return rank(a) < rank(b);
  }

  void add(Cell cell) {
    if (volume_of(body_.points, cell) < 0) std::swap(cell[2], cell[3]);
    body_.cells.push_back(cell);
  }

  /// The part inside of a tetrahedron.
  void cut(const Cell& cell) {
    std::array<std::uint32_t, 4> in, out, border;
    int ins = 0, outs = 0, borders = 0;
    for (const std::uint32_t v : cell) {
      if (side_[v] == Side::inside) in[ins++] = v;
      if (side_[v] == Side::outside) out[outs++] = v;
      if (side_[v] == Side::border) border[borders++] = v;
    }
    if (ins == 0 && outs == 0) return add_at_crease(cell);
    if (ins == 0) return;
    if (outs == 0) return add(cell);
    if (ins == 1) return add_corner(in[0], {out.data(), out.data() + outs}, border);
    if (ins == 3) return add_base(in, out[0]);
    if (outs == 2) return add_wedge(in, out);
    add_pyramid(in[0], in[1], out[0], border[0]);
  }

  void add_corner(std::uint32_t in, std::span<const std::uint32_t> out, const Cell& border) {
    Cell cell = {in};
    std::size_t at = 1;
    for (const std::uint32_t v : out) cell[at++] = crossing(in, v);
    for (std::size_t b = 0; at < 4; ++b) cell[at++] = border[b];
    add(cell);
  }

  void add_pyramid(std::uint32_t a, std::uint32_t b, std::uint32_t out, std::uint32_t top) {
    if (!first_of(a, b, out)) std::swap(a, b);
    const std::uint32_t p = crossing(a, out), q = crossing(b, out);
    add({a, b, p, top});
    add({b, q, p, top});
  }

  struct Prism {
    std::array<std::uint32_t, 3> base, top;
  };

  /// Tetrahedra of a prism whose diagonals end at its top in front of later corners, at its base in
  /// front of earlier ones.
  static std::array<Cell, 3> parts_of(const Prism& prism, const std::array<int, 3>& order) {
    const auto [x, y, z] = order;
    const auto& [base, top] = prism;
    return {{{base[x], base[y], base[z], top[x]},
             {base[y], base[z], top[x], top[y]},
             {base[z], top[x], top[y], top[z]}}};
  }

  void add_base(const std::array<std::uint32_t, 4>& in, std::uint32_t out) {
    const Prism prism{{in[0], in[1], in[2]},
                      {crossing(in[0], out), crossing(in[1], out), crossing(in[2], out)}};
    std::array<int, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return a != b && first_of(in[a], in[b], out); });
    for (const Cell& part : parts_of(prism, order)) add(part);
  }

  double smallest_angle(std::span<const Cell> parts) const {
    double smallest = 180;
    for (const Cell& part : parts) {
      std::array<Vec3, 4> corners;
      for (int v = 0; v < 4; ++v) corners[v] = body_.points[part[v]];
      smallest = std::min(smallest, dihedral_angles(corners).smallest);
    }
    return smallest;
  }

  /// All corners have moved to the border: flat outside of creases.
  void add_at_crease(const Cell& cell) {
    Vec3 center = Vec3::Zero();
    for (const std::uint32_t v : cell) center += body_.points[v] / 4;
    if (smallest_angle({&cell, 1}) > flat_at_crease && border_.contains(center)) add(cell);
  }

  /// Two corners inside: the diagonal along the border concerns no other cell, and may be the
  /// better one.
  void add_wedge(const std::array<std::uint32_t, 4>& in, const std::array<std::uint32_t, 4>& out) {
    const auto [a, b, x, y] = std::tuple(in[0], in[1], out[0], out[1]);
    const Prism prism{{a, crossing(a, x), crossing(a, y)}, {b, crossing(b, x), crossing(b, y)}};
    // Place 0 is a's and b's; before place 1 where the diagonal ends at b.
    const bool before_x = first_of(a, b, x), before_y = first_of(a, b, y);
    std::array<std::array<int, 3>, 2> orders;
    if (before_x && before_y) orders = {{{0, 1, 2}, {0, 2, 1}}};
    if (!before_x && !before_y) orders = {{{1, 2, 0}, {2, 1, 0}}};
    if (before_x && !before_y) orders = {{{2, 0, 1}, {2, 0, 1}}};
    if (!before_x && before_y) orders = {{{1, 0, 2}, {1, 0, 2}}};
    const auto one = parts_of(prism, orders[0]), other = parts_of(prism, orders[1]);
    for (const Cell& part : smallest_angle(one) >= smallest_angle(other) ? one : other) add(part);
  }

  void drop_unused_points() {
    std::vector<std::uint32_t> number(body_.points.size());
    for (const Cell& cell : body_.cells)
      for (const std::uint32_t v : cell) number[v] = 1;
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < number.size(); ++i) {
      if (number[i] == 0) continue;
      body_.points[kept] = body_.points[i];
      body_.id[kept] = body_.id[i];
      body_.beside[kept] = body_.beside[i];
      number[i] = kept++;
    }
    body_.points.resize(kept);
    body_.id.resize(kept);
    body_.beside.resize(kept);
    for (Cell& cell : body_.cells)
      for (std::uint32_t& v : cell) v = number[v];
  }

  const Scaffold& scaffold_;
  const BodyBorder& border_;
  NearFractions near_;
  double touching_;  ///< m
  std::vector<Side> side_;
  const std::vector<char>& left_;  ///< points where they are
  std::vector<char> in_wall_;      ///< points that center_in_walls() has moved
  std::vector<CutEdge> edges_;     ///< sorted
  VolumeCells body_;
};

}  // namespace

VolumeCells stuffed(const Scaffold& scaffold, const BodyBorder& border, double radius,
                    const NearFractions& near) {
  std::vector<char> left(scaffold.points.size());
  for (;;) {
    Stuffing stuffing(scaffold, border, radius, near, left);
    const std::vector<std::uint32_t> flat = stuffing.moved_at_flat_cells();
    if (flat.empty()) return std::move(stuffing).result();
    for (const std::uint32_t point : flat) left[point] = 1;
  }
}

}  // namespace sinew
