// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-export: the particles and surfaces of a run's frames as files of other programs, and a
// scene's body as finite elements.
#include <algorithm>
#include <filesystem>
#include <optional>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/run/export_run.h>
#include <sinew/run/export_surfaces.h>
#include <sinew/run/run_folder.h>
#include <sinew/run/volume_frames.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/finite_elements.h>
#include <sinew/scene/rig.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/read_scene.h>
#include "command/child.h"
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Options {
  std::string folder, format, output, series = "surface";
  std::vector<double> times;
  ElementOptions elements;
};

constexpr const char* of_scenes = "calculix";  // not of particles
constexpr const char* of_cells = "volume";     // name of tetrahedra between them

/// "" where the surface is not what is asked for.
std::string surface_extension(const Options& options) {
  const std::string extension =
      options.format.empty() ? lower(std::filesystem::path(options.output).extension().string())
                             : '.' + options.format;
  return is_surface_file(extension) ? extension : "";
}

bool is_deck(const Options& options) {
  return options.format == of_scenes ||
         (options.format.empty() && options.output.ends_with(".inp"));
}

void declare(OptionList& list, Options& options) {
  list.add("DIR", options.folder, "Folder of the run; for calculix a scene (YAML)").required();
  list.add("--to", options.format,
           "Format, by default that of the file's name: " + help_of_formats() +
               ", volume (tetrahedra between the particles, a series of VTU files as of "
               "output.volume, by default in the run's folder), obj, ply, stl (the deformed "
               "surface, in m), calculix (of a scene: finite "
               "elements, an input deck of CalculiX, .inp)")
      .type_name("FORMAT");
  list.add("--times", options.times, "Times of the frames, s; all frames if not given")
      .comma_separated()
      .type_name("T,T,...");
  list.add("-o", options.output,
           "File, or folder of one file per frame where a format has no frames; by default named "
           "after the run")
      .type_name("FILE|DIR");
  list.add("--series", options.series,
           "obj, ply, stl: a series of triangles that the run has: surface, obstacles, skin_lbs, "
           "...")
      .type_name("NAME");
  list.add("--size", options.elements.size,
           "calculix: side of the elements, m; by default 4 radii of the particles")
      .type_name("LENGTH");
  list.add_flag("--linear", options.elements.linear,
                "calculix: equilibrium in the shape at rest, for small displacements");
  list.add("--frequency", options.elements.frequencies,
           "calculix: so many lowest modes of the body as it is held, instead of equilibria")
      .range(1, 1000)
      .type_name("N");
}

/// Whether the frames lie in a folder, one file each.
bool separate(const ParticleFormat& format, const std::vector<std::size_t>& frames) {
  return !format.many_frames && frames.size() > 1;
}

/// The path that is given, or one named after the run.
std::filesystem::path target_of(const Options& options, std::string_view format,
                                std::string_view extension, bool folder) {
  if (!options.output.empty()) return options.output;
  const auto run = std::filesystem::weakly_canonical(options.folder).filename().string();
  return run + (folder ? '_' + std::string(format) : std::string(extension));
}

/// Chooses by its name, or where frames go to one file by that of the file.
const ParticleFormat& chosen_format(const Options& options) {
  if (options.format.empty() && options.output.empty())
    throw bad_input("no format is given", "add --to FORMAT; see sinew export --help");
  return format_of(options.format, options.format.empty() ? options.output : "");
}

/// Whether a path that exists lies in the folder of the run, or is it.
bool is_of_the_run(const std::filesystem::path& target, const std::string& folder) {
  if (!std::filesystem::exists(target)) return false;
  const auto run = std::filesystem::canonical(folder), given = std::filesystem::canonical(target);
  return std::mismatch(run.begin(), run.end(), given.begin(), given.end()).first == run.end();
}

void refuse_target(const std::filesystem::path& target, const Options& options, bool folder) {
  if (is_of_the_run(target, options.folder))
    throw bad_input(Place{target.string()}, "is of the run itself, and would be replaced",
                    "give another name with -o");
  const bool is_folder = std::filesystem::is_directory(target);
  if (folder && !is_folder && std::filesystem::exists(target))
    throw bad_input(Place{target.string()}, "is no folder, and there is a file per frame",
                    "name a folder with -o, or one time with --times");
  if (!folder && is_folder)
    throw bad_input(Place{target.string()}, "is a folder", "name a file with -o");
  refuse_to_replace_scene(target);
  refuse_file_of_run(target);
}

void print(const ExportedFrames& done, const RunFiles& run, const std::vector<std::size_t>& frames,
           const std::filesystem::path& target, const Common& common) {
  Results results;
  results.add("particles", run.body.particles.size());
  results.add("frames", frames.size());
  results.add("files", done.files.size());
  results.add(done.files.size() > 1 ? "folder" : "file", target.string());
  results.print(common);
  if (done.broken_bonds > 0)
    say(common, "sinew: warning: up to " + std::to_string(done.broken_bonds) +
                    " broken bonds are written as whole; with output.bonds, they are left out");
}

void check_deck_options(const Options& options) {
  if (!is_scene(options.folder))
    throw bad_input(Place{options.folder}, "is no scene",
                    "give a scene (.yaml) for calculix; that of a run is DIR/scene.yaml");
  if (!options.times.empty())
    throw bad_input("--times is for the frames of a run", "set output.interval of the scene");
  if (options.elements.size && !(*options.elements.size > 0))
    throw bad_input("--size is " + number_text(*options.elements.size), "give a length above 0");
}

void print(const Deck& deck, const std::filesystem::path& target, const Common& common) {
  Results results;
  const bool boxes = is_hexahedron(deck.mesh.elements.front().kind);
  results.add("elements", deck.mesh.elements.size());
  results.add("kind", boxes ? "C3D20 (hexahedra)" : "C3D10 (tetrahedra)");
  results.add("nodes", deck.mesh.nodes.size());
  results.add("steps", deck.steps.size());
  results.add("file", target.string());
  results.print(common);
}

Exit export_scene(const Options& options, const Common& common) {
  check_deck_options(options);
  const std::filesystem::path scene = options.folder;
  const std::filesystem::path target =
      options.output.empty() ? scene.stem().string() + ".inp" : options.output;
  const Settings settings = with_fit(read_scene(scene, common.overrides));
  refuse_output(target.string(), {options.folder, settings.body.mesh}, target.extension().string());
  refuse_file_of_run(target);
  const Deck deck = deck_of(settings, read_mesh(settings), options.elements);
  write_deck(target, deck);
  print(deck, target, common);
  return Exit::done;
}

void refuse_deck_options(const Options& options, const Common& common) {
  if (is_scene(options.folder))
    throw bad_input(Place{options.folder}, "is a scene: particles are exported from a run",
                    "name the folder of the run, or use sinew fill --to for the body at rest");
  if (options.elements.size || options.elements.linear || options.elements.frequencies > 0)
    throw bad_input("--size, --linear and --frequency are for finite elements",
                    "add --to calculix");
  if (!common.overrides.empty())
    throw bad_input("--set is for scenes", "leave it out, or add --to calculix");
}

Exit export_cells(const Options& options, const Common& common) {
  const RunFiles run = open_run({options.folder});
  const std::vector<std::size_t> frames = frames_at(run, options.times);
  const std::filesystem::path target = options.output.empty() ? options.folder : options.output;
  const bool own = options.output.empty();
  if (!own && is_of_the_run(target, options.folder))
    throw bad_input(Place{target.string()}, "is of the run itself",
                    "leave -o out, or give another name with it");
  std::optional<FolderLock> lock;
  end_at_stop_signals(!common.quiet, FolderLock::release_held);
  if (own) lock.emplace(run.folder);
  if (!own) refuse_file_of_run(target / "volume.pvd"), create_folder(target);
  const ExportedVolume done = export_volume(run, frames, target);
  Results results;
  results.add("particles", run.body.particles.size());
  results.add("tetrahedra", done.cells);
  results.add("frames", done.frames);
  results.add("file", done.pvd.string());
  results.print(common);
  if (done.warning) say(common, "sinew: warning: " + *done.warning);
  return Exit::done;
}

Exit export_surface(const Options& options, const std::string& extension, const Common& common) {
  const RunFiles run = open_run({options.folder});
  const std::vector<std::size_t> frames = frames_at(run, options.times);
  const bool folder = frames.size() > 1;
  const auto target = target_of(options, extension.substr(1), extension, folder);
  refuse_target(target, options, folder);
  const ExportedSurfaces done = export_surfaces(run, {options.series, extension}, frames, target);
  Results results;
  results.add("frames", frames.size());
  results.add("files", done.files.size());
  if (const Vec3& at = done.origin; !at.isZero(0))
    results.add("origin", {at.x(), at.y(), at.z()}, "m, from which the file counts");
  results.add(folder ? "folder" : "file", target.string());
  results.print(common);
  return Exit::done;
}

Exit export_run(const Options& options, const Common& common) {
  refuse_deck_options(options, common);
  if (const std::string extension = surface_extension(options); !extension.empty())
    return export_surface(options, extension, common);
  if (options.series != "surface")
    throw bad_input("--series is for surfaces", "add --to obj, ply or stl");
  if (options.format == of_cells) return export_cells(options, common);
  const ParticleFormat& format = chosen_format(options);
  const RunFiles run = open_run({options.folder});
  const std::vector<std::size_t> frames = frames_at(run, options.times);
  const bool folder = separate(format, frames);
  const auto target = target_of(options, format.name, format.extensions.front(), folder);
  refuse_target(target, options, folder);
  print(export_frames(run, format, frames, target), run, frames, target, common);
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  About about{
      "export",
      "Writes the particles or surface of a run, or the body of a scene, for other programs.",
      {"sinew export out/box_bend --to xyz -o box_bend.xyz",
       "sinew export out/box_bend --to lammps --times 1 -o bent.data",
       "sinew export out/box_bend --to obj --times 1.2 -o bent.obj",
       "sinew export out/box_bend --to bgeo -o frames", "sinew export out/box_bend --to volume",
       "sinew export beam.yaml --to calculix -o beam.inp",
       "sinew export beam.yaml --to calculix --frequency 6 -o modes.inp"}};
  return run_command(
      argc, argv, about, [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) {
        return is_deck(options) ? export_scene(options, common) : export_run(options, common);
      });
}
