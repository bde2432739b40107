// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/inspection/mesh_info.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/fill/fill_warnings.h>
#include <sinew/repair/diagnosis.h>

namespace sinew {
namespace {

nlohmann::ordered_json as_list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

void add_counts(const Surface& surface, Findings& results) {
  results.add("points", surface.triangles.points.size());
  results.add("triangles", surface.triangles.faces.size());
  results.add("components", surface.components);
  results.add("closed", surface.closed());
  results.add("holes", surface.border.holes);
  results.add("open_edges", surface.border.edges);
  results.add("border_length", surface.border.length, "m");
  results.add("crowded_edges", surface.border.crowded_edges);
}

void add_cleaning(const CleaningCounts& counts, Findings& results) {
  for (const NamedCount& one : cleaning_counts())
    if (one.of != NamedCount::Of::repair || counts.*one.count > 0)
      results.add(std::string(one.name), counts.*one.count, std::string(one.unit));
}

void add_radii(double inside, const Diagnosis& diagnosis, Findings& results) {
  for (const int power : {3, 4, 5, 6}) {
    const double radius = radius_for_count(inside, std::pow(10, power));
    const std::string name = "1e" + std::to_string(power);
    results.add("radius_for_" + name, radius, "m");
    if (diagnosis.thinnest)
      results.add("thinnest_part_at_" + name, *diagnosis.thinnest / radius, "radii");
  }
  if (diagnosis.thinnest)
    results.add("radius_for_thinnest_part", *diagnosis.thinnest / surely_filled_thickness(1), "m");
}

/// One number per face: its worst defect.
std::int32_t face_defect(const Defects& defects, std::size_t face) {
  if (defects.flat[face]) return 6;
  if (!defects.intersecting.empty() && defects.intersecting[face]) return 5;
  return defects.turned[face] ? 4 : 0;
}

void warn_of_defects(const Surface& surface, std::vector<std::string>& warnings) {
  const Border& border = surface.border;
  const CleaningCounts& counts = surface.cleaning;
  if (!surface.closed())
    warnings.push_back("the surface is open: " + counted(border.holes, "hole", "holes") +
                       " with a border of " + three_digits(border.length) +
                       " m; close them by body.close_holes, or repair the mesh by body.wrap");
  if (counts.faces_turned > 0)
    warnings.push_back(std::to_string(counts.faces_turned) + " of " +
                       counted(surface.triangles.faces.size(), "face", "faces") +
                       " pointed against those beside them or inward, and are turned here; turn "
                       "them in the file for other programs");
  if (const auto edges = border.crowded_edges + counts.edges_twisted; edges > 0)
    warnings.push_back(counted(edges, "edge has", "edges have") +
                       " more than two faces, or two that no direction suits; wrap the mesh by "
                       "body.wrap where its inside is not the one meant");
}

std::vector<std::string> mesh_warnings(const Surface& surface, double ambiguous, double inside) {
  std::vector<std::string> warnings;
  if (!surface.warning.empty()) warnings.push_back(surface.warning);
  const double size = bounds(surface.triangles.points).sizes().maxCoeff();
  if (const auto odd = size_warning(size)) warnings.push_back(*odd);
  if (ambiguous > max_ambiguous)
    warnings.push_back("the surface has no inside (" + three_digits(100 * ambiguous) +
                       " % of its box is ambiguous): close its holes, or fill it with a thickness");
  else if (!(inside > 0))
    warnings.push_back("the surface encloses no volume: fill it with a thickness");
  warn_of_defects(surface, warnings);
  return warnings;
}

}  // namespace

MeshInfo inspect_mesh(const Surface& surface) {
  MeshInfo info;
  Findings& results = info.findings;
  const Diagnosis diagnosis = diagnose(surface);
  const double ambiguous = ambiguous_fraction(surface);
  const auto [inside, exact] = volume_inside(surface);
  add_counts(surface, results);
  results.add("self_intersections", diagnosis.intersections.pairs,
              diagnosis.intersections.complete ? "" : "at least");
  add_cleaning(surface.cleaning, results);
  results.add("volume", inside,
              exact              ? "m^3"
              : surface.closed() ? "m^3, about, of parts that overlap"
                                 : "m^3, about");
  results.add("area", area(surface.triangles), "m^2");
  const Box box = bounds(surface.triangles.points);
  results.add("box_low", as_list(box.min()), "m");
  results.add("box_size", as_list(box.sizes()), "m");
  results.add("ambiguous_share", ambiguous);
  if (diagnosis.thinnest) results.add("thinnest_part", *diagnosis.thinnest, "m");
  if (ambiguous <= max_ambiguous && inside > 0) add_radii(inside, diagnosis, results);
  info.defects = defects_of(surface, diagnosis);
  info.warnings = mesh_warnings(surface, ambiguous, inside);
  return info;
}

DefectsFile drawing_of(const Surface& surface, const Defects& defects) {
  DefectsFile file;
  file.surface = surface.triangles;
  for (std::size_t i = 0; i < surface.triangles.faces.size(); ++i)
    file.defect.push_back(face_defect(defects, i));
  file.component.assign(surface.component.begin(), surface.component.end());
  file.hole.assign(file.defect.size(), -1);
  for (const DefectiveEdge& edge : defects.edges) {
    file.edges.push_back({edge.a, edge.b});
    file.defect.push_back(1 + static_cast<int>(edge.defect));
    file.component.push_back(-1);
    file.hole.push_back(edge.hole);
  }
  return file;
}

}  // namespace sinew
