// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/detail/triangulate.h>

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include <sinew/core/error.h>

namespace sinew {

namespace {

using Vec2 = Eigen::Vector2d;

constexpr std::size_t max_corners = 1000;  // ear clipping takes up to corners^3 steps

/// Newell's normal: the mean over all corners, defined for bent polygons too.
Vec3 normal_of(const std::vector<int>& polygon, const Points& points) {
  Vec3 normal = Vec3::Zero();
  const Vec3& origin = points[polygon[0]];
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    normal += (points[polygon[i]] - origin).cross(points[polygon[i + 1]] - origin);
  return normal;
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

class EarCutter {
 public:
  EarCutter(const std::vector<int>& polygon, const Points& points) : left_(polygon) {
    const Vec3 normal = normal_of(polygon, points);
    int drop;  // the axis closest to the polygon's normal
    normal.cwiseAbs().maxCoeff(&drop);
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    for (const int corner : polygon) {
      const Vec3& p = points[corner];
      flat_.push_back(normal[drop] < 0 ? Vec2(p[v], p[u]) : Vec2(p[u], p[v]));
    }
  }

  std::vector<std::array<int, 3>> triangles() {
    if (left_.size() > max_corners) return halved();
    std::vector<std::array<int, 3>> result;
    while (left_.size() > 3) {
      const std::size_t ear = next_ear();
      result.push_back({left_[before(ear)], left_[ear], left_[after(ear)]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
      flat_.erase(flat_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    result.push_back({left_[0], left_[1], left_[2]});
    return result;
  }

 private:
  std::size_t before(std::size_t i) const { return i == 0 ? left_.size() - 1 : i - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == left_.size() ? 0 : i + 1; }
  double turn_at(std::size_t i) const { return turn(flat_[before(i)], flat_[i], flat_[after(i)]); }

  /// Corners that may lie in an ear: those that do not turn left.
  std::vector<std::size_t> blunt_corners() const {
    std::vector<std::size_t> blunt;
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (turn_at(i) <= 0) blunt.push_back(i);
    return blunt;
  }

  /// Cuts every other corner of a convex polygon, again and again: no corner is of many triangles,
  /// all of which would be near each other.
  std::vector<std::array<int, 3>> halved() const {
    if (!blunt_corners().empty())
      throw bad_input("a face that is not convex has " + std::to_string(left_.size()) + " corners",
                      "export the mesh as triangles");
    std::vector<std::array<int, 3>> result;
    for (std::vector<int> left = left_, kept; left.size() > 2; left = std::exchange(kept, {}))
      for (std::size_t i = 0; i < left.size(); i += 2) {
        kept.push_back(left[i]);
        if (i + 1 < left.size())
          result.push_back({left[i], left[i + 1], left[(i + 2) % left.size()]});
      }
    return result;
  }

  std::size_t next_ear() {
    const std::vector<std::size_t> blunt = blunt_corners();
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (turn_at(i) > 0 && empty(i, blunt)) return i;
    return 0;  // self-intersecting or without area: any cut is as good
  }

  bool empty(std::size_t ear, const std::vector<std::size_t>& blunt) const {
    const std::size_t a = before(ear), c = after(ear);
    for (const std::size_t i : blunt) {
      if (i == a || i == c || i == ear) continue;
      if (turn(flat_[a], flat_[ear], flat_[i]) >= 0 && turn(flat_[ear], flat_[c], flat_[i]) >= 0 &&
          turn(flat_[c], flat_[a], flat_[i]) >= 0)
        return false;
    }
    return true;
  }

  std::vector<int> left_;
  std::vector<Vec2> flat_;
};

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<int>& polygon, const Points& points) {
  if (polygon.size() == 3) return {{polygon[0], polygon[1], polygon[2]}};
  return EarCutter(polygon, points).triangles();
}

namespace {

std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t hash = 0;
  for (const double x : p) hash = mixed(hash, std::bit_cast<std::uint64_t>(x + 0.0));  // -0 is 0
  return hash;
}

std::vector<int> first_equal(const Points& points) {
  FirstOf first_of(points.size());
  std::vector<int> first(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    first[i] = first_of.find_or_add(hash_of(points[i]), static_cast<int>(i),
                                    [&](int other) { return points[other] == points[i]; });
  return first;
}

/// The points kept so far in cubes of twice the distance: eight of them contain all close ones, and
/// none contains many.
class KeptPoints {
 public:
  KeptPoints(const Points& points, double distance)
      : points_(points), distance_(distance), cells_(points.size()), next_(points.size(), -1) {
    double largest = 0;  // cell indices must not overflow
    for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    edge_ = std::max(2 * distance, largest * 1e-300);
  }

  /// The earliest kept point close to point i; -1 where there is none.
  int close_to(int i) const {
    int first = -1;
    const Vec3 home = cell_of(points_[i]);
    const Vec3 side = side_of(points_[i], home);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 cell = home + Vec3(corner & 1 ? side.x() : 0, corner & 2 ? side.y() : 0,
                                    corner & 4 ? side.z() : 0);
      for (int j = in_cell(cell); j >= 0; j = next_[j])
        if ((first < 0 || j < first) && (points_[j] - points_[i]).norm() < distance_) first = j;
    }
    return first;
  }

  void keep(int i) {
    const Vec3 cell = cell_of(points_[i]);
    const int head = cells_.find_or_add(hash_of(cell), i,
                                        [&](int other) { return cell_of(points_[other]) == cell; });
    if (head != i) next_[i] = std::exchange(next_[head], i);
  }

 private:
  Vec3 cell_of(const Vec3& p) const { return (p / edge_).array().floor(); }

  /// Toward the nearer neighbor along each axis: 1 or -1.
  Vec3 side_of(const Vec3& p, const Vec3& cell) const {
    const Vec3 within = p / edge_ - cell;
    return within.unaryExpr([](double x) { return x < 0.5 ? -1.0 : 1.0; });
  }

  int in_cell(const Vec3& cell) const {
    return cells_.find(hash_of(cell), [&](int other) { return cell_of(points_[other]) == cell; });
  }

  const Points& points_;
  double distance_, edge_;
  FirstOf cells_;          ///< the first kept point of each cell
  std::vector<int> next_;  ///< the others of its cell, as a linked list
};

}  // namespace

std::vector<int> first_within(const Points& points, double distance) {
  std::vector<int> first = first_equal(points);
  if (!(distance > 0)) return first;
  KeptPoints kept(points, distance);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int self = static_cast<int>(i);
    if (first[i] != self) {  // merged like its equal
      first[i] = first[first[i]];
      continue;
    }
    const int close = kept.close_to(self);
    if (close >= 0)
      first[i] = close;
    else
      kept.keep(self);
  }
  return first;
}

namespace {

using Face = std::array<int, 3>;

/// The same triangles for any first corner and orientation of the polygon, so that duplicate
/// polygons are cut into duplicate triangles.
std::vector<Face> cut_alike(std::vector<int> polygon, const Points& points) {
  const auto at = [&](int i) { return std::tie(points[i][0], points[i][1], points[i][2]); };
  std::rotate(
      polygon.begin(),
      std::min_element(polygon.begin(), polygon.end(), [&](int a, int b) { return at(a) < at(b); }),
      polygon.end());
  const bool turned = at(polygon.back()) < at(polygon[1]);
  if (turned) std::reverse(polygon.begin() + 1, polygon.end());
  std::vector<Face> parts = triangulate(polygon, points);
  for (Face& part : parts)
    if (turned) std::swap(part[1], part[2]);
  return parts;
}

/// 1. Cuts polygons into triangles.
std::vector<Face> cut(const PolygonSoup& soup, CleaningCounts& counts) {
  std::vector<Face> faces;
  faces.reserve(soup.polygons.size());
  for (const std::vector<int>& polygon : soup.polygons) {
    if (polygon.size() == 3) {
      faces.push_back({polygon[0], polygon[1], polygon[2]});
      continue;
    }
    ++counts.polygons_cut;
    for (const Face& part : cut_alike(polygon, soup.points)) faces.push_back(part);
  }
  return faces;
}

/// 2. Merges equal and close points.
void merge_points(std::vector<Face>& faces, const Points& points, double weld,
                  CleaningCounts& counts) {
  const std::vector<int> first = first_within(points, weld);
  for (std::size_t i = 0; i < first.size(); ++i)
    counts.points_merged += first[i] != static_cast<int>(i);
  for (Face& face : faces)
    for (int& corner : face) corner = first[corner];
}

/// 3. Drops faces that have lost a corner.
void drop_collapsed(std::vector<Face>& faces, CleaningCounts& counts) {
  counts.faces_collapsed = std::erase_if(
      faces, [](const Face& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
}

Face sorted(Face face) {
  if (face[0] > face[1]) std::swap(face[0], face[1]);
  if (face[1] > face[2]) std::swap(face[1], face[2]);
  if (face[0] > face[1]) std::swap(face[0], face[1]);
  return face;
}

/// Whether the corners are in ascending order, when counted from the lowest one.
bool ascends(const Face& face) {
  const auto lowest = std::min_element(face.begin(), face.end()) - face.begin();
  return face[(lowest + 1) % 3] < face[(lowest + 2) % 3];
}

/// 4. Keeps the first of faces with the same corners. Returns which have had opposite ones.
std::vector<bool> drop_doubled(std::vector<Face>& faces, CleaningCounts& counts) {
  FirstOf first_of(faces.size());
  std::vector<bool> opposed;
  int kept = 0;
  for (const Face& face : faces) {
    const Face corners = sorted(face);
    std::uint64_t hash = 0;
    for (const int corner : corners) hash = mixed(hash, static_cast<std::uint64_t>(corner));
    const int first = first_of.find_or_add(
        hash, kept, [&](int other) { return sorted(faces[other]) == corners; });
    if (first == kept) {
      faces[kept++] = face;
      opposed.push_back(false);
    } else if (ascends(face) != ascends(faces[first])) {
      opposed[first] = true;
    }
  }
  counts.faces_doubled = faces.size() - kept;
  faces.resize(kept);
  return opposed;
}

}  // namespace

Triangles used(const Points& points, std::vector<Face> faces) {
  std::vector<int> place(points.size(), -1);
  for (const Face& face : faces)
    for (const int corner : face) place[corner] = 0;
  Triangles triangles;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (place[i] < 0) continue;
    place[i] = static_cast<int>(triangles.points.size());
    triangles.points.push_back(points[i]);
  }
  for (Face& face : faces)
    for (int& corner : face) corner = place[corner];
  triangles.faces = std::move(faces);
  return triangles;
}

DistinctFaces distinct_faces(const PolygonSoup& soup, double weld, CleaningCounts& counts) {
  counts.points_read = soup.points.size();
  counts.polygons_read = soup.polygons.size();
  std::vector<Face> faces = cut(soup, counts);
  merge_points(faces, soup.points, weld, counts);
  drop_collapsed(faces, counts);
  std::vector<bool> opposed = drop_doubled(faces, counts);
  return {{soup.points, std::move(faces)}, std::move(opposed)};
}

}  // namespace sinew
