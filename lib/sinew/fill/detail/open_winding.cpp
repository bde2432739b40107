// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/detail/open_winding.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sinew {

namespace {

// The rounding error of a solid angle is small farther than `near_corner` of the size from its
// corners, and not too near the triangle or its sides.
constexpr double near_corner = 1e-5, steep = 1e-3, rounding_doubt = 1e-6;

/// Distance of the origin from the segment a b.
double distance(const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double square = edge.squaredNorm();
  const double at = square > 0 ? std::clamp(-a.dot(edge) / square, 0.0, 1.0) : 0;
  return (a + at * edge).norm();
}

std::vector<CapCorners> turned(const RowFrame& frame, const Triangles& caps) {
  std::vector<CapCorners> result;
  for (const auto& [a, b, c] : caps.faces)
    result.push_back(
        {frame.turned(caps.points[a]), frame.turned(caps.points[b]), frame.turned(caps.points[c])});
  return result;
}

}  // namespace

struct OpenWinding::View {
  std::size_t row;
  int site;
  Vec3 site_at;
  Vec3 eye;  ///< the same in the frame of the rows, m
};

OpenWinding::OpenWinding(const Lattice& lattice, const Triangles& caps,
                         const RowCrossings& crossings)
    : lattice_(lattice),
      caps_(caps),
      crossings_(crossings),
      frame_(lattice),
      side_(lattice, largest_coordinate(lattice, caps.points)),
      tree_(turned(frame_, caps)) {
  for (const int face : tree_.order()) {
    Cap cap{{}, {}, 0, face};
    for (int corner = 0; corner < 3; ++corner)
      cap.corners[corner] = frame_.turned(caps.points[caps.faces[face][corner]]);
    for (int corner = 0; corner < 3; ++corner)
      cap.half_side =
          std::max(cap.half_side, (cap.corners[(corner + 1) % 3] - cap.corners[corner]).norm() / 2);
    sorted_.push_back(cap);
  }
  find_border();
}

/// A side that no other cap traverses in the other direction.
void OpenWinding::find_border() {
  std::vector<std::array<int, 2>> sides;
  for (const auto& face : caps_.faces)
    for (int i = 0; i < 3; ++i) sides.push_back({face[i], face[(i + 1) % 3]});
  std::sort(sides.begin(), sides.end());
  for (Cap& cap : sorted_)
    for (int i = 0; i < 3; ++i) {
      const auto& face = caps_.faces[cap.face];
      const std::array<int, 2> back = {face[(i + 1) % 3], face[i]};
      cap.border[i] = !std::binary_search(sides.begin(), sides.end(), back);
    }
}

OpenWinding::Contribution OpenWinding::contribution(std::size_t row, int site) const {
  const View from = view(row, site);
  Contribution all{0, std::numeric_limits<double>::infinity()};
  for (const Cap& cap : sorted_) {
    const Contribution one = strips(from, cap);
    all = {all.value + one.value, std::min(all.clearance, one.clearance)};
  }
  return all;
}

OpenWinding::Contribution OpenWinding::contribution(std::size_t row, int site,
                                                    const Enough& enough) const {
  const View from = view(row, site);
  double farness = 2;
  for (int attempt = 0; attempt < 5; ++attempt, farness *= 1.6) {
    double doubt = rounding_doubt;
    const Contribution found = sum(from, farness, doubt);
    if (doubt < enough.doubt || std::abs(found.value - enough.threshold) > 3 * doubt) return found;
  }
  return contribution(row, site);
}

OpenWinding::View OpenWinding::view(std::size_t row, int site) const {
  const Vec3 at = lattice_.site(lattice_.rows[row], site);
  return {row, site, at, frame_.turned(at)};
}

OpenWinding::Contribution OpenWinding::sum(const View& view, double farness, double& doubt) const {
  Contribution near{0, std::numeric_limits<double>::infinity()};
  const CapTree::FarField far = tree_.far_field(view.eye, farness, [&](int first, int last) {
    for (int i = first; i < last; ++i) add_near(view, i, near);
  });
  doubt += far.doubt;
  return {before(view) - far.winding + near.value, std::min(near.clearance, far.clearance)};
}

/// Subtracts the solid angle of a cap (van Oosterom and Strackee 1983); of one whose side rounding
/// might confuse, by its strips.
void OpenWinding::add_near(const View& view, int place, Contribution& sum) const {
  const Cap& cap = sorted_[place];
  const Vec3 a = cap.corners[0] - view.eye, b = cap.corners[1] - view.eye,
             c = cap.corners[2] - view.eye;
  const double la = a.norm(), lb = b.norm(), lc = c.norm(), size = la * lb * lc;
  const double turn = a.dot(b.cross(c));
  const double ahead = size + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  if (std::min({la, lb, lc}) > near_corner * side_.extent() &&
      std::abs(turn) + std::max(ahead, 0.0) > steep * size) {
    sum.value -= std::atan2(turn, ahead) / (2 * pi);
  } else {
    sum.value += strips(view, cap).value - before(view, cap.face);
  }
  if (std::min({la, lb, lc}) - cap.half_side < sum.clearance) {
    const CapCorners to = {a, b, c};
    for (int corner = 0; corner < 3; ++corner)
      if (cap.border[corner])
        sum.clearance = std::min(sum.clearance, distance(to[corner], to[(corner + 1) % 3]));
  }
}

/// Signed crossings of the row with all caps, up to the site.
int OpenWinding::before(const View& view) const {
  int sum = 0;
  for (const Crossing& one : crossings_.of(view.row))
    if (one.site <= view.site) sum += one.winding;
  return sum;
}

int OpenWinding::before(const View& view, int face) const {
  int sum = 0;
  for (const Crossing& one : crossings_.of(view.row))
    if (one.site <= view.site && one.face == face) sum += one.winding;
  return sum;
}

/// A corner relative to the site: along the row, across, up.
struct OpenWinding::Ray {
  Vec3 to;
  double length;
  double rest;  ///< length + to.x(), accurate also near cancellation
  bool on_row;  ///< the row meets the corner
};

/// A row that meets a corner is shifted infinitesimally across, and by much less up.
OpenWinding::Ray OpenWinding::ray(const View& view, const Vec3& corner) const {
  Ray ray{frame_.turned_between(view.site_at, corner), 0, 0, false};
  ray.length = ray.to.norm();
  if (ray.to.y() == 0 && ray.to.z() == 0) {
    ray.on_row = true;
    ray.to.y() = -frame_.handedness() * 1e-30 * ray.length;
    ray.to.z() = -1e-45 * ray.length;
  }
  const double aside = ray.to.y() * ray.to.y() + ray.to.z() * ray.to.z();
  ray.rest = ray.to.x() < 0 ? aside / (ray.length - ray.to.x()) : ray.length + ray.to.x();
  return ray;
}

OpenWinding::Contribution OpenWinding::strips(const View& view, const Cap& cap) const {
  const auto& face = caps_.faces[cap.face];
  std::array<Ray, 3> rays;
  for (int corner = 0; corner < 3; ++corner) rays[corner] = ray(view, caps_.points[face[corner]]);
  double sum = 0;
  for (int corner = 0; corner < 3; ++corner) {
    const Ray &a = rays[corner], &b = rays[(corner + 1) % 3];
    const double ahead = a.rest * b.rest + (a.to.y() * b.to.y() + a.to.z() * b.to.z());
    sum += std::atan2(turn(view, cap, corner, a, b), ahead);
  }
  double clearance = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 3; ++corner)
    if (cap.border[corner])
      clearance = std::min(clearance, distance(rays[corner].to, rays[(corner + 1) % 3].to));
  return {-sum / (2 * pi), clearance};
}

/// a x b along the row, with a sign that is right also where rounding cancels it.
double OpenWinding::turn(const View& view, const Cap& cap, int corner, const Ray& a,
                         const Ray& b) const {
  const double one = a.to.y() * b.to.z(), other = a.to.z() * b.to.y();
  const double found = one - other;
  if (a.on_row || b.on_row || std::abs(found) > 16 * rounding * (std::abs(one) + std::abs(other)))
    return found;
  const auto& face = caps_.faces[cap.face];
  const Vec3 &from = caps_.points[face[corner]], &to = caps_.points[face[(corner + 1) % 3]];
  const int exact = side_.exact(from, to, lattice_.rows[view.row]);
  const int sign = (exact != 0 ? exact : side_.shifted(from, to)) * frame_.handedness();
  return std::copysign(found, sign);
}

namespace {

/// An evaluated site.
struct Looked {
  int site;
  double margin;     ///< winding number minus one half
  double clearance;  ///< distance from the border, in sites
};

/// Away from the border the winding number is smooth: where two sites are no farther from each
/// other than from the border, and their margins differ by little, sites between have their sign.
bool smooth_between(const Looked& a, const Looked& b) {
  const double least = std::min(std::abs(a.margin), std::abs(b.margin));
  return std::abs(a.margin - b.margin) < least / 4 && b.site - a.site < a.clearance + b.clearance;
}

/// The sites between two, of which neither is the first or the last.
template <class Look>
void between(const Looked& a, const Looked& b, const Look& look, RowRuns& runs) {
  if (b.site - a.site < 2) return;
  if (smooth_between(a, b)) {
    if (a.margin > 0) runs.add(a.site + 1, b.site, 0);
    return;
  }
  const Looked middle = look(a.site + (b.site - a.site) / 2);
  between(a, middle, look, runs);
  if (middle.margin > 0) runs.add(middle.site, middle.site + 1, 0);
  between(middle, b, look, runs);
}

/// In steps that double, from both ends of first .. last - 1.
std::vector<int> doubling_from_both_ends(int first, int last) {
  std::vector<int> sites = {first, last - 1};
  for (int step = 1; step < (last - first) / 2; step *= 2) {
    sites.push_back(first + step);
    sites.push_back(last - 1 - step);
  }
  std::sort(sites.begin(), sites.end());
  sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
  return sites;
}

}  // namespace

OpenSweep::OpenSweep(const Lattice& lattice, const Surface& surface, const RowCrossings& crossings)
    : lattice_(lattice),
      crossings_(crossings),
      cap_crossings_(row_crossings(lattice, surface.caps)),
      winding_(lattice, surface.caps, cap_crossings_) {}

void OpenSweep::add_row(std::size_t row, SweptRows& found) const {
  RowRuns runs(row, crossings_.on_surface, found.runs);
  int sum = 0, from = 0;
  for (const Crossing& one : crossings_.of(row)) {
    add_between(row, from, one.site, sum, runs);
    from = one.site;
    sum += one.winding;
  }
  add_between(row, from, lattice_.rows[row].sites, sum, runs);
}

double OpenSweep::winding(std::size_t row, int site) const {
  int sum = 0;
  for (const Crossing& one : crossings_.of(row))
    if (one.site <= site) sum += one.winding;
  return sum + (winding_.none() ? 0 : winding_.contribution(row, site, {0.02, 1e9}).value);
}

/// Between two crossings the winding number varies smoothly, faster near the surface: it is
/// evaluated in steps that double from both ends, then between them where it remains undecided.
void OpenSweep::add_between(std::size_t row, int first, int last, int sum, RowRuns& runs) const {
  if (first >= last) return;
  const std::vector<int> sites = doubling_from_both_ends(first, last);
  const auto look = [&](int site) {
    const auto [value, clearance] = winding_.contribution(row, site, {0, 0.5 - sum});
    return Looked{site, sum - 0.5 + value, clearance / (2 * lattice_.radius)};
  };
  Looked before = look(sites[0]);
  if (before.margin > 0) runs.add(before.site, before.site + 1, 0);
  for (std::size_t i = 1; i < sites.size(); ++i) {
    const Looked next = look(sites[i]);
    between(before, next, look, runs);
    if (next.margin > 0) runs.add(next.site, next.site + 1, 0);
    before = next;
  }
}

}  // namespace sinew
