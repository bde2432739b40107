// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <system_error>

#include "core/error.h"

namespace sinew {

namespace fs = std::filesystem;

RunFolder run_folder(const fs::path& scene, const fs::path& chosen) {
  return {chosen.empty() ? fs::path("out") / scene.stem() : chosen};
}

void create(const RunFolder& folder) {
  std::error_code failed;
  fs::create_directories(folder.path, failed);
  if (failed)
    throw not_written(folder.path.string(), "cannot be created (" + failed.message() + ")",
                      "choose another folder with -o");
}

void remove_old_run(const RunFolder& folder) {
  static constexpr std::array names = {"scene.yaml",   "run.json",    "log.txt",    "particles.pvd",
                                       "surface.pvd",  "bones.pvd",   "frames.pvd", "particles",
                                       "surface",      "bones",       "frames",     "metrics.csv",
                                       "metrics.json", "report.html", "pictures",   "view.py"};
  std::error_code failed;
  for (const char* name : names) {
    fs::remove_all(folder.path / name, failed);
    if (failed)
      throw not_written((folder.path / name).string(),
                        "cannot be removed (" + failed.message() + ")",
                        "remove it by hand or choose another folder with -o");
  }
}

FolderLock::FolderLock(const RunFolder& folder) {
  const fs::path path = folder.path / ".lock";
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0)
    throw not_written(path.string(), std::string("cannot be made (") + std::strerror(errno) + ")",
                      "choose a folder you may write to with -o");
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(file_);
  throw bad_input(Place{folder.path.string()}, "another sinew is working in this folder",
                  "wait for it, or choose another folder with -o");
}

FolderLock::~FolderLock() { ::close(file_); }

}  // namespace sinew
