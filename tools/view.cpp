// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-view: starts ParaView on a state written here. States in a run's folder are for other
// machines: nothing in a folder from elsewhere is opened or executed.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/display/display.h>
#include <sinew/io/paraview/view_state.h>
#include <sinew/run/run_folder.h>
#include <sinew/run/run_record.h>
#include "command/command.h"

namespace {

using namespace sinew;
namespace fs = std::filesystem;

struct Options {
  std::string folder, picture;
  ViewOptions view;
  std::vector<int> size = {1920, 1000};
  std::vector<double> range;
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
  list.add("--range", options.range,
           "Values of the lowest and highest color; by default those of the run's other pictures")
      .comma_separated()
      .type_name("LOW,HIGH");
  list.add("--time", options.view.time, "Time to show, s; by default when the array is largest");
  list.add("--size", options.size, "Size of the picture, pixels")
      .expected(2)
      .type_name("W H")
      .range(64, 8192);
  list.add("--picture", options.picture, "Write a picture to this file instead of opening a window")
      .type_name("FILE.png");
}

/// Empty where the environment lacks it.
std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Puts a folder in front of those that a variable lists.
void add_place(const char* variable, const fs::path& folder) {
  const std::string given = from_environment(variable);
  setenv(variable, (given.empty() ? folder.string() : folder.string() + ':' + given).c_str(), 1);
}

fs::path program_named(const std::string& name) {
  std::istringstream folders(from_environment("PATH"));
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / name).c_str(), X_OK) == 0) return fs::path(folder) / name;
  throw Error(Exit::not_written,
              name + " is not installed; install it with: apt-get install paraview libqt5svg5");
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

/// Whether pvbatch and plugins in Python can run. Debian's ParaView has its Python in a separate
/// package; others include it.
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
      add_place("PYTHONPATH", place);
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

/// Both in the build and where sinew-paraview is installed.
fs::path folder_of_plugin() {
  fs::path folder = this_program().parent_path().parent_path() / "share/sinew/paraview";
  std::error_code none;
  if (!fs::exists(folder / "sinew_paraview.py", none))
    throw Error(Exit::bad_input,
                "a live view needs sinew's plugin for ParaView; install it with: apt-get install "
                "./sinew-paraview_*.deb");
  return folder;
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

/// A folder of its own below the system's for temporary files.
fs::path temporary_folder() {
  std::string folder = (fs::temp_directory_path() / "sinew-view-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr)
    throw Error(Exit::not_written, folder + ": " + std::generic_category().message(errno) +
                                       "; set TMPDIR to a folder that can be written to");
  return folder;
}

/// The same, removed at the end.
class Workplace {
 public:
  Workplace() : path_(temporary_folder()) {}
  ~Workplace() {
    std::error_code failed;
    fs::remove_all(path_, failed);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

pid_t running = 0;  // for a handler of signals

/// Runs a program to its end; returns whether it has ended well. SIGTERM and SIGHUP end it, and
/// the caller goes on.
bool run_program(const fs::path& program, std::vector<std::string> words) {
  words.insert(words.begin(), program.string());
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    become(program, words);
  }
  running = child;
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C ends the child, after which the workplace is removed
  for (const int by : {SIGTERM, SIGHUP})
    std::signal(by, [](int signal) {
      if (running > 0) ::kill(running, signal);
    });
  int status = 0;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  running = 0;
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
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

void refuse_without_python(const fs::path& program, Exit exit, const std::string& what) {
  if (!find_python(program)) throw Error(exit, what + how_to_get_python);
}

/// Waits for the state that a run leaves beside its first frame.
void wait_for_first_frame(const RunFolder& folder) {
  constexpr int patience = 600;  // tenths of a second
  std::error_code none;
  for (int waited = 0; !fs::exists(folder.view(), none); ++waited) {
    if (waited == patience || status_of(folder) != "running") return refuse_without_frames(folder);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// Opens the newest frame, which is replaced as soon as there is another.
Exit follow(const RunFolder& folder, Options options) {
  const fs::path program = program_named("paraview");
  refuse_without_python(program, Exit::bad_input,
                        "a live view needs ParaView's Python; look at the frames so far: sinew "
                        "view " +
                            shell_quoted(options.folder) + "; or install it with: ");
  const fs::path plugin = folder_of_plugin();
  check_screen();
  wait_for_first_frame(folder);
  options.view.live = true;
  const Workplace work;
  write_file(work / "live.pvsm",
             view_state(shown_run(folder.path, options.view), options.view, links_for(program)));
  add_place("PYTHONPATH", plugin / "debian12");
  add_place("PV_PLUGIN_PATH", plugin);
  const bool is_well = run_program(program, {"--state=" + (work / "live.pvsm").string()});
  return is_well ? Exit::done : Exit::bad_input;
}

constexpr const char* drawing = R"(import sys
from paraview.simple import *
state, picture, width, height = sys.argv[1:]
LoadState(state)
SaveScreenshot(picture, GetLayout(), ImageResolution=[int(width), int(height)], SeparatorWidth=0)
)";

Exit draw(const RunFolder& folder, Options options) {
  const fs::path program = program_named("pvbatch");
  refuse_without_python(program, Exit::not_written,
                        "ParaView draws pictures with its Python only; draw with: sinew render " +
                            shell_quoted(options.folder) + ", or install it with: ");
  if (options.live) {
    wait_for_first_frame(folder);
    options.view.time = std::numeric_limits<double>::max();
  }
  options.view.aspect = options.size[0] / 2.0 / options.size[1];
  const Workplace work;
  write_file(work / "view.pvsm", view_state(shown_run(folder.path, options.view), options.view));
  write_file(work / "draw.py", drawing);
  ensure_display();
  const fs::path drawn = work / "drawn.png";
  if (!run_program(program,
                   {(work / "draw.py").string(), (work / "view.pvsm").string(), drawn.string(),
                    std::to_string(options.size[0]), std::to_string(options.size[1])}) ||
      !fs::exists(drawn))
    throw not_written(options.picture, "ParaView has drawn nothing",
                      "draw with: sinew render " + shell_quoted(options.folder));
  write_file(options.picture, read_file(drawn));
  return Exit::done;
}

/// The range of colors that is asked for, and those known of the run.
void choose_ranges(Options& options, const RunFolder& folder) {
  options.view.ranges = recorded_ranges(folder);
  if (!options.range.empty()) options.view.range = color_range(options.range);
}

Exit view(Options options, const Common& common) {
  const RunFolder folder{options.folder};
  check(options, folder);
  choose_ranges(options, folder);
  check_picture(options.picture);
  if (!options.picture.empty()) refuse_file_of_run(options.picture);
  if (!options.picture.empty()) return draw(folder, options);
  return options.live ? follow(folder, options) : open_window(folder, options, common);
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
