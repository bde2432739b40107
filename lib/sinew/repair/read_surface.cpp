// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/repair/read_surface.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <sinew/core/error.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/mesh/clean.h>
#include <sinew/repair/repair.h>

namespace sinew {

Surface read_surface(const BodyOptions& body, std::span<const MeshFormat> more) {
  Stopwatch watch;
  PolygonSoup soup = read_polygons(body.mesh, more, body.level);
  const double reading = watch.lap();
  Surface surface = read_surface(std::move(soup), body);
  surface.seconds_reading = reading;
  return surface;
}

Surface read_surface(PolygonSoup soup, const BodyOptions& body) {
  Stopwatch watch;
  try {
    Surface surface = prepare(std::move(soup), body);
    surface.seconds_cleaning = watch.lap();
    return surface;
  } catch (const Error& error) {
    throw error.with_context({body.mesh});
  }
}

void place(PolygonSoup& soup, const BodyOptions& body) {
  const Placement placement = placement_of(body);
  if (!(placement.scale > 0) || !is_computable(placement.scale))
    throw bad_input("the scale is " + number_text(body.scale), "give a number above 0");
  if (placement.is_identity()) return;
  for (Vec3& point : soup.points) point = placement(point);
}

namespace {

/// Cleans the result of a repair again; keeps the counts of the first cleaning.
Surface cleaned_again(const Surface& before, const Triangles& repaired, FillRule rule) {
  Surface surface = clean(soup_of(repaired), {0, rule});
  const CleaningCounts again = surface.cleaning;
  surface.cleaning = before.cleaning;
  surface.cleaning.faces_doubled += again.faces_doubled;
  surface.cleaning.faces_collapsed += again.faces_collapsed;
  return surface;
}

/// A single face is closed by its own reverse: both are dropped, as they enclose nothing.
void drop_closed_sheets(HoleClosing& closing) {
  std::vector<std::array<int, 3>>& faces = closing.triangles.faces;
  std::map<std::array<int, 3>, int> uses;
  const auto corners = [](std::array<int, 3> face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  for (const auto& face : faces) ++uses[corners(face)];
  std::erase_if(faces, [&](const auto& face) { return uses[corners(face)] == 2; });
}

Surface without_holes(const Surface& surface, FillRule rule) {
  if (surface.closed()) return surface;
  HoleClosing closing = close_holes(surface.triangles);
  drop_closed_sheets(closing);
  if (closing.triangles.faces.empty())
    throw bad_input("all " + std::to_string(surface.triangles.faces.size()) +
                        " faces are loose, and closing their holes encloses nothing",
                    "weld their corners if they almost meet, or give a thickness instead");
  Surface closed = cleaned_again(surface, closing.triangles, rule);
  closed.cleaning.holes_closed = closing.holes_closed;
  closed.cleaning.faces_added = closing.faces_added;
  return closed;
}

Surface wrapped(const Surface& surface, double alpha, FillRule rule) {
  const Triangles skin = wrap(surface.triangles, alpha);
  Surface wrapped = cleaned_again(surface, skin, rule);
  wrapped.cleaning.faces_wrapped = skin.faces.size();
  return wrapped;
}

}  // namespace

Surface prepare(PolygonSoup soup, const BodyOptions& body) {
  check_soup(soup);
  place(soup, body);
  const std::string warning = std::move(soup.warning);
  Surface surface = clean(soup, {body.weld, body.rule});
  if (body.close_holes) surface = without_holes(surface, body.rule);
  if (body.wrap) surface = wrapped(surface, *body.wrap, body.rule);
  surface.warning = warning;
  return surface;
}

}  // namespace sinew
