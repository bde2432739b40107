// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstring>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

#include "core/error.h"

namespace sinew {

namespace fs = std::filesystem;

namespace {

/// Names a run writes below its folder; in DIR/NAME/ only what is numbered as a run numbers it.
bool written_by_a_run(const fs::path& relative) {
  static const std::regex ours(
      "(scene\\.yaml|run\\.json|log\\.txt|view\\.py|report\\.html|metrics\\.(csv|json)|"
      "\\.?(bones\\.csv|surface\\.(obj|pc2|glb))(\\.tmp)?|"
      "(particles|surface|bones|frames|obstacles|skin_lbs|skin_dqs)\\.pvd|"
      "(particles|surface|bones|frames|obstacles|skin_lbs|skin_dqs)/\\.?[a-z_]+_[0-9]{6,}\\.vtu(\\.tmp)?|"
      "pictures/(body_[0-9]{6,}\\.png|contact_sheet\\.png|\\.?movie\\.mp4(\\.tmp)?))");
  return std::regex_match(relative.generic_string(), ours);
}

std::vector<fs::path> files_of_run(const RunFolder& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const char* part :
       {"", "particles", "surface", "bones", "frames", "obstacles", "skin_lbs", "skin_dqs", "pictures"})
    for (const auto& entry : fs::directory_iterator(folder.path / part, failed))
      if (!entry.is_directory(failed) &&
          written_by_a_run(entry.path().lexically_relative(folder.path / "")))
        files.push_back(entry.path());
  return files;
}

}  // namespace

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
  std::error_code failed;
  for (const fs::path& file : files_of_run(folder)) {
    fs::remove(file, failed);
    if (failed)
      throw not_written(file.string(), "cannot be removed (" + failed.message() + ")",
                        "remove it by hand or choose another folder with -o");
  }
}

void refuse_foreign_files(const RunFolder& folder) {
  for (const fs::path& file : files_of_run(folder))
    throw bad_input(Place{file.string()}, "is there, but no run.json of a run beside it",
                    "choose another folder with -o, or move the file away");
}

std::uint64_t size_of_old_run(const RunFolder& folder) {
  std::uint64_t bytes = 0;
  std::error_code failed;
  for (const fs::path& file : files_of_run(folder)) {
    const auto size = fs::file_size(file, failed);
    if (!failed) bytes += size;
  }
  return bytes;
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
