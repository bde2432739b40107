// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-view: starts ParaView on a state written here, or on sinew's own scripts. States and
// scripts in a run's folder are for other machines: nothing in a folder from elsewhere is executed.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/display/display.h>
#include <sinew/io/paraview/view_state.h>
#include <sinew/run/run_folder.h>
#include "command/command.h"

namespace {

using namespace sinew;
namespace fs = std::filesystem;

struct Options {
  std::string folder, picture;
  ViewOptions view;
  std::vector<int> size;
  bool live = false;
};

void declare(OptionList& list, Options& options) {
  list.add("DIR", options.folder, "Folder of the run").required();
  list.add_flag("--live", options.live, "Follow a run in progress");
  list.add("--array", options.view.array,
           "Array that colors body and skin, by default strain_eq, or displacement without it");
  list.add("--cut", options.view.cut, "Axis across which the body is cut open: x, y, z or none");
  list.add("--forces", options.view.forces,
           "Arrows of a force: force_pair if none is named, force_bone, force, ...")
      .expected(0, 1);
  list.add("--time", options.view.time, "Time to show, s; by default when the array is largest");
  list.add("--size", options.size, "Size of the picture, pixels")
      .expected(2)
      .type_name("W H")
      .range(64, 8192);
  list.add("--picture", options.picture, "Write a picture to this file instead of opening a window")
      .type_name("FILE.png");
}

/// The options of the script.
std::vector<std::string> words_of(const Options& options) {
  std::vector<std::string> words;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {name, value});
  };
  const ViewOptions& view = options.view;
  add("--array", view.array);
  add("--cut", view.cut);
  if (view.forces) words.push_back("--forces");
  if (view.forces && !view.forces->empty()) words.push_back(*view.forces);
  add("--picture", options.picture.empty() ? "" : fs::absolute(options.picture).string());
  if (view.time) add("--time", number_text(*view.time));
  if (!options.size.empty()) {
    words.push_back("--size");
    for (const int pixels : options.size) words.push_back(std::to_string(pixels));
  }
  return words;
}

/// A text that a shell would split into these words.
std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + shell_quoted(word);
  return text;
}

/// Empty where the environment lacks it.
std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

fs::path program_named(const std::string& name) {
  std::istringstream folders(from_environment("PATH"));
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / name).c_str(), X_OK) == 0) return fs::path(folder) / name;
  throw Error(Exit::not_written,
              name + " is not installed; install it with: apt-get install paraview");
}

/// Folders that may hold ParaView's Python: Debian's package of it cannot be installed beside
/// VTK's, which sinew is built with.
std::vector<fs::path> private_places() {
  const fs::path modules = "usr/lib/python3/dist-packages";
  std::vector<fs::path> places{this_program().parent_path().parent_path() / "paraview-python" /
                               modules};
  if (const std::string home = from_environment("HOME"); !home.empty())
    places.push_back(fs::path(home) / ".local/share/sinew/paraview-python" / modules);
  return places;
}

/// Whether pvbatch and live.py can run. Debian's ParaView has its Python in a separate package;
/// others include it.
bool find_python(const fs::path& program) {
  std::error_code none;
  const std::string given = from_environment("PYTHONPATH");
  std::istringstream folders(given);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (fs::exists(fs::path(folder) / "paraview", none)) return true;
  if (program.parent_path() != "/usr/bin" ||
      fs::exists("/usr/lib/python3/dist-packages/paraview", none))
    return true;
  for (const fs::path& place : private_places())
    if (fs::exists(place / "paraview", none)) {
      setenv("PYTHONPATH", (given.empty() ? place.string() : place.string() + ':' + given).c_str(),
             1);
      return true;
    }
  return false;
}

constexpr const char* how_to_get_python =
    "apt-get install python3-paraview, or beside VTK's: apt-get download python3-paraview && "
    "dpkg -x python3-paraview_*.deb ~/.local/share/sinew/paraview-python";

void check_screen() {
  if (from_environment("DISPLAY").empty() && from_environment("WAYLAND_DISPLAY").empty())
    throw Error(
        Exit::not_written,
        "there is no screen for ParaView's window; draw with --picture FILE.png or sinew render");
}

/// Both in the build and where sinew is installed.
fs::path own_script(const std::string& name) {
  const fs::path program = this_program();
  fs::path script = program.parent_path().parent_path() / "share/sinew" / name;
  if (!fs::exists(script))
    throw bad_input(Place{script.string()}, "is missing", "install all files of sinew");
  return script;
}

/// Returns only by throwing.
Exit become(const fs::path& program, std::vector<std::string> words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  throw bad_input(Place{program.string()},
                  "cannot be started (" + std::generic_category().message(errno) + ")",
                  "install ParaView anew");
}

void check(const Options& options, const RunFolder& folder) {
  if (!folder.used())
    throw bad_input(Place{options.folder}, "is not the folder of a run",
                    "give the folder that sinew run or sinew simulate writes");
  static constexpr std::array<std::string_view, 4> cuts = {"x", "y", "z", "none"};
  const std::string& cut = options.view.cut;
  if (std::find(cuts.begin(), cuts.end(), cut) == cuts.end())
    throw bad_input("--cut " + cut + " is no axis", suggestion(cut, cuts));
}

/// Refuses a picture that cannot be written, before ParaView is started.
void check_picture(const std::string& picture) {
  if (picture.empty()) return;
  if (fs::path(picture).extension() != ".png")
    throw bad_input("--picture " + shown(picture) + " is no picture that ParaView writes here",
                    "give it a name that ends with .png");
  if (fs::is_directory(picture))
    throw not_written(picture, "is a folder", "give the picture another name");
  const NewFile can_be_written(picture);
}

/// A folder of its own below the system's for temporary files, for a run that cannot be written to.
fs::path temporary_folder() {
  std::string folder = (fs::temp_directory_path() / "sinew-view-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr)
    throw Error(Exit::not_written, folder + ": " + std::generic_category().message(errno) +
                                       "; set TMPDIR to a folder that can be written to");
  return folder;
}

/// Chooses by "paraview version 5.11.0", which the program prints.
CameraLinks links_for(const fs::path& program) {
  const std::string command = shell_quoted(program.string()) + " --version 2>/dev/null";
  std::FILE* said = ::popen(command.c_str(), "r");
  if (said == nullptr) return CameraLinks::none;
  int major = 0, minor = 0;
  const int numbers = std::fscanf(said, "paraview version %d.%d", &major, &minor);
  while (std::fgetc(said) != EOF) continue;  // to its end, or it would be killed while it prints
  ::pclose(said);
  if (numbers != 2) return CameraLinks::none;
  if (major == 5 && minor <= 11) return CameraLinks::until_5_11;
  return major > 5 || minor >= 13 ? CameraLinks::from_5_13 : CameraLinks::none;
}

/// Writes the state that is opened: in place of that of the run, unless ParaView has saved another
/// one there or the folder cannot be written to.
fs::path write_state(const RunFolder& folder, const ViewOptions& options, CameraLinks links,
                     const Common& common) {
  const std::string text = view_state(shown_run(folder.path, options), options, links);
  std::string why;
  try {
    if (is_foreign_state(folder.view()))
      why = folder.view().string() + " was saved by ParaView (paraview --state=FILE opens it)";
    else
      return write_file(folder.view(), text), folder.view();
  } catch (const Error& error) {
    if (error.exit() != Exit::not_written) throw;
    why = error.what();
  }
  const fs::path file = temporary_folder() / "view.pvsm";
  write_file(file, text);
  say(common, why + "; showing " + file.string());
  return file;
}

/// Opens a state, which ParaView does without its Python.
Exit open_window(const RunFolder& folder, const Options& options, const Common& common) {
  const fs::path program = program_named("paraview");
  check_screen();
  const fs::path state = write_state(folder, options.view, links_for(program), common);
  return become(program, {program.string(), "--state=" + fs::absolute(state).string()});
}

Exit follow(const Options& options) {
  const bool window = options.picture.empty();
  const fs::path program = program_named(window ? "paraview" : "pvbatch");
  if (!find_python(program))
    throw Error(Exit::not_written,
                std::string("a live view needs ParaView's Python; install it with: ") +
                    how_to_get_python + "; or look at the frames so far: sinew view " +
                    shell_quoted(options.folder));
  const fs::path script = own_script("live.py");
  std::vector<std::string> words = words_of(options);
  if (!window) {
    ensure_display();
    unsetenv("SINEW_VIEW");
    words.insert(words.begin(), {program.string(), script.string()});
    return become(program, words);
  }
  check_screen();
  setenv("SINEW_VIEW", quoted(words).c_str(), 1);
  return become(program, {program.string(), script.string()});
}

Exit draw(const RunFolder& folder, const Options& options) {
  const fs::path program = program_named("pvbatch");
  if (!find_python(program))
    throw Error(Exit::not_written,
                "ParaView draws pictures with its Python only; draw with: sinew render " +
                    shell_quoted(options.folder) + ", or install it with: " + how_to_get_python);
  shown_run(folder.path,
            options.view);  // refuses what cannot be shown, in fewer words than scripts
  ensure_display();
  unsetenv("SINEW_VIEW");
  std::vector<std::string> words = words_of(options);
  words.insert(words.begin(), {program.string(), own_script("view.py").string()});
  return become(program, words);
}

Exit view(const Options& options, const Common& common) {
  const RunFolder folder{options.folder};
  check(options, folder);
  check_picture(options.picture);
  if (!options.picture.empty()) refuse_file_of_run(options.picture);
  setenv("SINEW_RUN", fs::absolute(folder.path).c_str(), 1);
  if (options.live) return follow(options);
  return options.picture.empty() ? open_window(folder, options, common) : draw(folder, options);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  About about{
      "view",
      "Opens a run in ParaView: left the body cut open (its cells, if the run has the series "
      "volume, or its particles), right its bones within the skin, in the same colors.",
      {"sinew view out/box_bend", "sinew view --live out/box_bend",
       "sinew view out/box_bend --array velocity --forces force_pair",
       "sinew view out/box_bend --picture bent.png --time 1"}};
  about.takes_scene = false;
  return run_command(
      argc, argv, about, [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) { return view(options, common); });
}
