// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/surface.h>

#include <sinew/mesh/solids.h>

namespace sinew {

namespace {

/// The cap of the part of a loop from point `from` to point `to`; its chord belongs to the rest.
void cut_off(int first, int from, int to, Triangles& caps) {
  if (to - from < 2) return;
  const int middle = from + (to - from) / 2;
  caps.faces.push_back({first + to, first + middle, first + from});
  cut_off(first, from, middle, caps);
  cut_off(first, middle, to, caps);
}

}  // namespace

void add_cap(const Loop& loop, const Points& points, Triangles& caps) {
  const int first = static_cast<int>(caps.points.size());
  const int count = static_cast<int>(loop.points.size());
  for (const int point : loop.points) caps.points.push_back(points[point]);
  cut_off(first, 0, count - 1, caps);
}

Triangles caps_of(std::span<const Loop> loops, const Points& points) {
  Triangles caps;
  for (const Loop& loop : loops) add_cap(loop, points, caps);
  return caps;
}

namespace {

void append(Surface& all, const Surface& part) {
  all.first_face.push_back(all.triangles.faces.size());
  append(part.triangles, all.triangles);
  append(part.caps, all.caps);
  append(part.walls.triangles, all.walls.triangles);
  for (const auto& [behind, before] : part.walls.component)
    all.walls.component.push_back({all.components + behind, all.components + before});
  all.turned.insert(all.turned.end(), part.turned.begin(), part.turned.end());
  for (const int component : part.component) all.component.push_back(all.components + component);
  all.components += part.components;
  all.border.holes += part.border.holes;
  all.border.edges += part.border.edges;
  all.border.crowded_edges += part.border.crowded_edges;
  all.border.length += part.border.length;
  for (const NamedCount& row : cleaning_counts())
    all.cleaning.*row.count += part.cleaning.*row.count;
  all.seconds_reading += part.seconds_reading;
  all.seconds_cleaning += part.seconds_cleaning;
}

}  // namespace

Surface joined(std::vector<Surface> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  Surface all;
  for (const Surface& part : parts) append(all, part);
  return all;
}

std::vector<double> component_volumes(const Surface& surface) {
  std::vector<double> sums(surface.components);
  // Preserves precision far from the origin.
  const Vec3 middle = bounds(surface.triangles.points).center();
  for (std::size_t i = 0; i < surface.triangles.faces.size(); ++i)
    sums[surface.component[i]] +=
        volume_below(surface.triangles, surface.triangles.faces[i], middle);
  for (std::size_t i = 0; i < surface.walls.component.size(); ++i) {
    const Triangles& walls = surface.walls.triangles;
    const double below = volume_below(walls, walls.faces[i], middle);
    const auto& [behind, before] = surface.walls.component[i];
    sums[behind] += below;
    sums[before] -= below;
  }
  return sums;
}

std::span<const NamedCount> cleaning_counts() {
  using C = CleaningCounts;
  using Of = NamedCount::Of;
  static constexpr NamedCount table[] = {
      {"points_read", &C::points_read, Of::file},
      {"faces_read", &C::polygons_read, Of::file},
      {"polygons_cut", &C::polygons_cut, Of::cleaning},
      {"points_merged", &C::points_merged, Of::cleaning},
      {"points_unused", &C::points_unused, Of::cleaning},
      {"faces_collapsed", &C::faces_collapsed, Of::cleaning},
      {"faces_doubled", &C::faces_doubled, Of::cleaning},
      {"faces_shared", &C::faces_shared, Of::cleaning, "pairs, as solids share faces"},
      {"faces_flat", &C::faces_flat, Of::cleaning},
      {"faces_turned", &C::faces_turned, Of::cleaning},
      {"edges_twisted", &C::edges_twisted, Of::cleaning},
      {"holes_closed", &C::holes_closed, Of::repair},
      {"faces_added", &C::faces_added, Of::repair},
      {"faces_wrapped", &C::faces_wrapped, Of::repair},
  };
  return table;
}

}  // namespace sinew
