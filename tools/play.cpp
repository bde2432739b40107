// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-play: a body that is posed by hand, in a page of the browser.
#include <sinew/play/play.h>

#include <fcntl.h>
#include <unistd.h>
#include <filesystem>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/run/run_folder.h>
#include <sinew/scene/new/new_scene.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/read_scene.h>

#include "command/child.h"
#include "command/command.h"
#include "command/results.h"

namespace {

using namespace sinew;
namespace fs = std::filesystem;

struct Options {
  std::string scene, rig, folder;
  int port = 0;
  bool no_browser = false;
};

void declare(OptionList& list, Options& options) {
  list.add("SCENE", options.scene, "Scene (.yaml); or a mesh, of which sinew new makes one")
      .required();
  list.add("RIG", options.rig, "Skeleton and clip for a mesh, as sinew new takes them");
  list.add("-o", options.folder, "Folder of recordings; by default out/NAME_play").type_name("DIR");
  list.add("--port", options.port, "Port of the page on 127.0.0.1; by default any that is free")
      .type_name("N");
  list.add_flag("--no-browser", options.no_browser, "Print the address alone");
}

/// Where there is no desktop, nothing happens: the address has been printed.
void open_in_browser(const std::string& address) {
  const pid_t child = fork();
  if (child != 0) return;
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
  setsid();
  execlp("xdg-open", "xdg-open", address.c_str(), nullptr);
  _exit(0);
}

constexpr int particles_in_real_time = 5'000;

/// The scene itself, or one that is made of a mesh beside the recordings.
fs::path scene_of(const Options& options, const fs::path& folder, const Common& common) {
  if (is_scene(options.scene)) {
    if (!options.rig.empty())
      throw bad_input("a scene has its rig", "leave out " + shell_quoted(options.rig));
    return options.scene;
  }
  fs::path scene = folder / (fs::path(options.scene).stem().string() + ".yaml");
  if (fs::exists(scene)) {
    say(common, "sinew: plays " + scene.string() + ", which is there");
    return scene;
  }
  NewSceneWish wish;
  wish.mesh = options.scene;
  wish.rig = options.rig;
  wish.scene = scene.string();
  wish.count = particles_in_real_time;
  create_folder(folder);
  const WrittenScene written = write_new_scene(wish);
  say(common, "sinew: wrote " + written.path);
  return written.path;
}

Exit play_scene(const Options& options, const Common& common) {
  if (options.port < 0 || options.port > 65535)
    throw bad_input("--port " + std::to_string(options.port) + " is no port",
                    "give a number up to 65535");
  const fs::path folder =
      options.folder.empty() ? fs::path("out") / (fs::path(options.scene).stem().string() + "_play")
                             : fs::path(options.folder);
  const fs::path scene = scene_of(options, folder, common);
  end_at_stop_signals(!common.quiet, FolderLock::release_held);
  PlayOptions how;
  how.folder = folder;
  how.port = options.port;
  how.read = [&](const std::vector<Override>& more) {
    std::vector<Override> all = common.overrides;
    all.insert(all.end(), more.begin(), more.end());
    return read_scene(scene.string(), all);
  };
  how.ready = [&](const std::string& address) {
    catch_stop_signals();
    print_out("address: " + address + '\n');
    if (!options.no_browser) open_in_browser(address);
  };
  how.message = [&](const std::string& line) { say(common, "sinew: " + line); };
  how.stop_requested = stop_requested;
  play(how);
  say(common, "sinew: recordings are in " + folder.string());
  return Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"play",
       "Poses a body by hand in the browser, and records what was done as a scene.",
       {"sinew play configs/box_bend.yaml", "sinew play fox.glb --no-browser --port 8000"}},
      [&](OptionList& list) { declare(list, options); },
      [&](const Common& common) { return play_scene(options, common); });
}
