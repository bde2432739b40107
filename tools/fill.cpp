// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-fill: fills a mesh, or the mesh of a scene, with closest-packed particles.

#include <cmath>
#include <filesystem>
#include <initializer_list>

#include "command.h"
#include "config/scene.h"
#include "mesh/read_surface.h"
#include "results.h"
#include "scene_body.h"

namespace {

using namespace sinew;

struct Options {
  std::string input, output = "body.vtu", packing = "fcc";
  std::optional<double> radius;
  std::optional<int> count;
  double density = MaterialSettings{}.density;
};

const CLI::Validator positive(
    [](std::string& text) {
      double value = 0;
      const bool fits = CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value);
      return fits ? std::string() : "is not a number above 0: " + text;
    },
    "");

void declare(CLI::App& app, Options& options) {
  app.add_option("INPUT", options.input, "Scene (YAML), or mesh (OBJ, OFF, STL, PLY)")->required();
  app.add_option("-o", options.output, "Where the filled body goes")
      ->type_name("FILE")
      ->capture_default_str();
  auto* radius = app.add_option("--radius", options.radius, "Particle radius, m (for a mesh)")
                     ->type_name("R")
                     ->check(positive);
  app.add_option("--count", options.count, "About how many particles (for a mesh)")
      ->type_name("N")
      ->check(positive)
      ->excludes(radius);
  app.add_option("--packing", options.packing, "fcc or hcp (for a mesh)")
      ->check(CLI::IsMember({"fcc", "hcp"}))
      ->capture_default_str();
  app.add_option("--density", options.density, "kg/m^3 (for a mesh)")
      ->check(positive)
      ->capture_default_str();
}

/// A mesh on the command line as the body of a scene.
Settings settings_for_mesh(const Options& options, const Common& common) {
  if (!common.overrides.empty())
    throw bad_input("--set is for scenes", "use --radius, --count, --packing or --density");
  if (!options.radius && !options.count)
    throw bad_input("a mesh needs --radius or --count",
                    "say how large the particles are, or how many; see sinew fill --help");
  Settings settings;
  settings.body = {options.input, options.radius, options.count,
                   options.packing == "hcp" ? Packing::hcp : Packing::fcc};
  settings.material.density = options.density;
  return settings;
}

Settings settings_for_scene(const Options& options, const Common& common) {
  if (options.radius || options.count)
    throw bad_input("--radius and --count are for meshes",
                    "use --set body.radius=R or --set body.count=N with a scene");
  return read_scene(options.input, common.overrides);
}

void refuse_to_overwrite(const std::string& output, std::initializer_list<std::string> inputs) {
  std::error_code missing;
  for (const std::string& input : inputs)
    if (std::filesystem::equivalent(output, input, missing))
      throw bad_input(Place{output}, "is what is to be filled",
                      "give the body another name with -o");
}

Exit fill(const Options& options, const Common& common) {
  const Settings settings = is_scene(options.input) ? settings_for_scene(options, common)
                                                    : settings_for_mesh(options, common);
  refuse_to_overwrite(options.output, {options.input, settings.body.mesh});
  const Surface surface = read_mesh(settings);
  const Filling filling = fill_body(settings, surface);
  write_body(options.output, body_file(filling, origin_of(settings)));
  Results results;
  for (const ReportRow& row : rows_of(filling.report))
    results.add(row.key, nlohmann::ordered_json::parse(row.value), row.unit);
  results.add("file", options.output);
  results.print(common.json);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"fill",
       "Fills a closed mesh with closest-packed particles.",
       {"sinew fill configs/box_bend.yaml", "sinew fill body.obj --radius 0.01 -o body.vtu",
        "sinew fill body.stl --count 100000 --packing hcp"}},
      [&](CLI::App& app) { declare(app, options); },
      [&](const Common& common) { return fill(options, common); });
}
