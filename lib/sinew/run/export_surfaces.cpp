// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/export_surfaces.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/text.h>
#include <sinew/io/series_table.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/mesh_formats.h>
#include <sinew/mesh/refine.h>
#include <sinew/run/export_run.h>
#include <sinew/run/measure_run.h>

namespace sinew {
namespace {

/// 80 bytes that do not begin with "solid", the number of triangles, and of each its normal, its
/// corners from `origin` on and two bytes.
std::string stl_text(const Triangles& surface, const Vec3& origin) {
  static_assert(std::endian::native == std::endian::little);
  std::string text = "binary STL of sinew, in meters";
  if (!origin.isZero(0))
    text = "STL of sinew, m from " + number_text(origin.x()) + ' ' + number_text(origin.y()) + ' ' +
           number_text(origin.z());
  text.resize(80, ' ');
  const auto append = [&](const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(static_cast<std::uint32_t>(surface.faces.size()));
  for (const auto& [a, b, c] : surface.faces) {
    const Points& p = surface.points;
    for (const Vec3& row : {Vec3((p[b] - p[a]).cross(p[c] - p[a]).normalized()),
                            Vec3(p[a] - origin), Vec3(p[b] - origin), Vec3(p[c] - origin)})
      for (const double x : row) append(static_cast<float>(x));
    append(std::uint16_t{0});
  }
  return text;
}

constexpr std::array<std::string_view, 3> extensions = {".obj", ".ply", ".stl"};

std::string text_of(const Triangles& surface, std::string_view extension, const Vec3& origin) {
  if (extension == ".stl") return stl_text(surface, origin);
  return extension == ".obj" ? obj_text(surface) : ply_text(soup_of(surface));
}

/// Names of the series of triangles.
std::vector<std::string_view> series_of_surfaces() {
  std::vector<std::string_view> names;
  for (const SeriesRow& row : series_table())
    if (row.cells == CellKind::triangle) names.push_back(row.name);
  return names;
}

/// The rows of a series at the times of the run's frames.
std::vector<PvdRow> rows_of(const RunFiles& run, const std::string& series) {
  const auto names = series_of_surfaces();
  if (std::find(names.begin(), names.end(), series) == names.end())
    throw bad_input("there is no surface " + shown(series), suggestion(series, names));
  const auto there = series_in(run.folder.path);
  if (std::find(there.begin(), there.end(), series) == there.end()) {
    const std::string asked_by(find_series(series)->asked_by);
    throw bad_input(Place{run.folder.path.string()}, "has not written " + series,
                    asked_by.empty() ? "give another series" : "run the scene with " + asked_by);
  }
  std::vector<PvdRow> rows = read_pvd(run.folder.path / (series + ".pvd"));
  std::erase_if(rows, [&](const PvdRow& row) {
    return std::none_of(run.particle_rows.begin(), run.particle_rows.end(),
                        [&](const PvdRow& frame) { return frame.time == row.time; });
  });
  return rows;
}

}  // namespace

bool is_surface_file(std::string_view extension) {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

ExportedSurfaces export_surfaces(const RunFiles& run, const SurfaceExport& as,
                                 const std::vector<std::size_t>& frames,
                                 const std::filesystem::path& target) {
  const std::vector<PvdRow> rows = rows_of(run, as.series);
  if (frames.size() > 1) create_folder(target);
  ExportedSurfaces done;
  if (as.extension == ".stl" && !rows.empty())
    done.origin =
        local_origin(bounds(read_surface_frame(run.folder.path / rows.front().file).points));
  for (const std::size_t frame : frames) {
    if (frame >= rows.size())
      throw bad_input(Place{run.folder.path.string()},
                      "has no frame " + std::to_string(frame) + " of " + as.series,
                      "give earlier --times");
    const Triangles surface = read_surface_frame(run.folder.path / rows[frame].file);
    done.files.push_back(frames.size() > 1 ? numbered(target, as.series, frame, as.extension)
                                           : target);
    write_file(done.files.back(), text_of(surface, as.extension, done.origin));
  }
  return done;
}

}  // namespace sinew
