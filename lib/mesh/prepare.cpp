// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/prepare.h"

#include <algorithm>
#include <map>

#include "mesh/clean.h"
#include "mesh/repair.h"

namespace sinew {
namespace {

PolygonSoup soup_of(const Triangles& triangles) {
  PolygonSoup soup{triangles.points, {}};
  soup.polygons.reserve(triangles.faces.size());
  for (const auto& face : triangles.faces) soup.polygons.emplace_back(face.begin(), face.end());
  return soup;
}

/// Cleans again what a repair has made; what was done to the file is still told.
Surface cleaned_again(const Surface& before, const Triangles& repaired, FillRule rule) {
  Surface surface = clean(soup_of(repaired), {0, rule});
  const CleaningCounts again = surface.cleaning;
  surface.cleaning = before.cleaning;
  surface.cleaning.faces_doubled += again.faces_doubled;
  surface.cleaning.faces_collapsed += again.faces_collapsed;
  return surface;
}

/// A loose face is closed by its own back: both go, they enclose nothing.
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

double metres(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::m:
      return 1;
    case LengthUnit::dm:
      return 0.1;
    case LengthUnit::cm:
      return 0.01;
    case LengthUnit::mm:
      return 0.001;
    case LengthUnit::um:
      return 1e-6;
    case LengthUnit::inch:
      return 0.0254;
    case LengthUnit::foot:
      return 0.3048;
  }
  return 1;
}

Surface prepare(PolygonSoup soup, const BodySettings& body) {
  const double scale = metres(body.unit) * body.scale;
  if (scale != 1)
    for (Vec3& point : soup.points) point *= scale;
  Surface surface = clean(std::move(soup), {body.weld, body.rule});
  if (body.close_holes) surface = without_holes(surface, body.rule);
  if (body.wrap) surface = wrapped(surface, *body.wrap, body.rule);
  return surface;
}

}  // namespace sinew
