// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-fill: fills a mesh, or the mesh of a scene, with closest-packed particles.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>

#include <sinew/core/particles.h>
#include <sinew/fill/fill_warnings.h>
#include <sinew/io/cells/cell_formats.h>
#include <sinew/io/particle_formats/formats.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/filling.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/read_scene.h>
#include "command/body_options.h"
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

constexpr const char* of_cells = "tetrahedra";  // not of particles

struct Options {
  std::string input, output, format;
  bool verify = false;
  BodyFlags body;
};

void declare(OptionList& list, Options& options) {
  list.add("INPUT", options.input, "Scene (YAML), or mesh (" + mesh_formats() + ')').required();
  list.add("-o", options.output, "File of the filled body, by default body.vtu").type_name("FILE");
  list.add("--to", options.format,
           "Format, by default that of the file's name: " + help_of_formats() +
               ", tetrahedra (between the particles, up to the surface; into " +
               help_of_cell_files() + ", by default volume.vtu)")
      .type_name("FORMAT");
  list.add_flag("--verify", options.verify,
                "Check every site against CGAL's Side_of_triangle_mesh (closed meshes; slow)");
  options.body.declare(list);
}

Settings settings_for_mesh(const Options& options, const Common& common) {
  std::vector<Override> overrides = common.overrides;
  for (const Override& one : options.body.overrides()) overrides.push_back(one);
  const auto sizes = std::count_if(overrides.begin(), overrides.end(), [](const Override& one) {
    return one.path == "body.radius" || one.path == "body.count";
  });
  if (sizes > 1)
    throw bad_input("the size of the particles is given twice", "keep one of --radius and --count");
  if (sizes == 0)
    throw bad_input("a mesh needs --radius or --count",
                    "give the size or the number of particles; see sinew fill --help");
  return settings_of_mesh(options.input, overrides);
}

Settings settings_for_scene(const Options& options, const Common& common) {
  if (options.body.any())
    throw bad_input(options.body.overrides().front().given + " is for meshes",
                    "use --set body.KEY=VALUE with a scene");
  return read_scene(options.input, common.overrides);
}

void refuse_target(const Options& options, const Settings& settings) {
  refuse_output(options.output, {options.input, settings.body.mesh},
                std::filesystem::path(options.output).extension().string());
  refuse_file_of_run(options.output);
}

void print_with_warnings(Results& results, const FillReport& report, const Options& options,
                         const Common& common) {
  results.add("warnings", report.warnings);
  results.add("file", options.output);
  results.print(common);
  for (const std::string& warning : report.warnings) say(common, "sinew: warning: " + warning);
}

void print(const FillReport& report, const Options& options, const Common& common) {
  Results results;
  for (const auto& rows : {rows_of(report), times_of(report)})
    for (const ReportRow& row : rows)
      std::visit(
          [&](const auto& value) {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Vec3>)
              results.add(row.key, std::vector<double>(value.begin(), value.end()), row.unit);
            else
              results.add(row.key, value, row.unit);
          },
          row.value);
  print_with_warnings(results, report, options, common);
}

/// VTU has more columns for bodies than other formats.
void write(const Options& options, const ParticleFormat& format, const Settings& settings,
           BodyFile body) {
  if (!format.add) return write_body(options.output, std::move(body));
  ParticleCloud cloud = cloud_of(body, settings.material.density);
  if (format.bonds) cloud.bonds = touching_pairs(cloud.positions, cloud.radius);
  write_particles(options.output, cloud, format);
}

Settings settings_for(const Options& options, const Common& common) {
  return is_scene(options.input) ? settings_for_scene(options, common)
                                 : settings_for_mesh(options, common);
}

void print_cells(const VolumeCells& cells, FillReport report, const Surface& surface,
                 double seconds, const Options& options, const Common& common) {
  const CellQuality quality = quality_of(cells);
  if (const auto lost = cell_warning(quality.volume, report.volume, report.radius, surface))
    report.warnings.push_back(*lost);
  Results results;
  results.add("particles", report.particles);
  results.add("tetrahedra", cells.cells.size());
  results.add("points", cells.points.size());
  results.add("volume", quality.volume, "m^3");
  results.add("body_volume", report.volume, "m^3");
  results.add("smallest_angle", quality.angles.smallest, "degrees between two faces");
  results.add("largest_angle", quality.angles.largest, "degrees");
  results.add("seconds_cells", seconds, "s");
  print_with_warnings(results, report, options, common);
}

Exit fill_with_cells(Options options, const Common& common) {
  if (options.output.empty()) options.output = "volume.vtu";
  check_cell_file(options.output);
  const Settings settings = settings_for(options, common);
  refuse_target(options, settings);
  const Surface surface = read_mesh(settings);
  const Filling filling = fill_body(settings, surface, options.verify);
  const Points rest = positions_of(filling.particles);
  const auto start = std::chrono::steady_clock::now();
  const VolumeCells cells = cells_of_body(settings, surface, rest, filling.particles.radius);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  write_cells(options.output, dataset_of(cells));
  print_cells(cells, filling.report, surface, taken.count(), options, common);
  return Exit::done;
}

Exit fill(Options options, const Common& common) {
  if (options.format == of_cells) return fill_with_cells(options, common);
  if (options.output.empty() && options.format.empty()) options.format = "vtu";
  const ParticleFormat& format = format_of(options.format, options.output);
  if (options.output.empty()) options.output = "body" + std::string(format.extensions.front());
  const Settings settings = settings_for(options, common);
  refuse_target(options, settings);
  Filling filling = fill_body(settings, read_mesh(settings), options.verify);
  const FillReport report = filling.report;
  write(options, format, settings, body_file(std::move(filling), origin_of(settings)));
  print(report, options, common);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"fill",
       "Fills a mesh, or the mesh of a scene, with closest-packed particles.",
       {"sinew fill configs/box_bend.yaml",
        "sinew fill body.obj --radius 0.01 --to tetrahedra -o body.msh",
        "sinew fill body.stl --unit mm --count 100000 --packing hcp --verify"}},
      [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) { return fill(options, common); });
}
