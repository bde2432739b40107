// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/run_folder.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/series_table.h>

namespace sinew {

namespace fs = std::filesystem;

namespace {

/// Names that a run writes in its folder; in DIR/NAME/ only files numbered as a run numbers them.
bool written_by_a_run(const fs::path& relative) {
  static const std::string of_series = series_names("|");
  static const std::regex ours(
      "\\.?(scene\\.yaml|run\\.json|log\\.txt|(view|live)\\.py|view\\.pvsm|checksums\\.sfv|"
      "report\\.html|"
      "metrics(_bones)?\\.(csv|json)|(bones|probes|sections|supports)\\.csv|surface\\.(obj|pc2|"
      "pc2\\.origin\\.json|glb)"
      "|blowup\\.vtu|"
      "(" +
      of_series +
      ")\\.(pvd|vtu\\.series))(\\.tmp)?|"
      "(" +
      of_series +
      ")/"
      "\\.?[a-z_]+_[0-9]{6,}\\.vtu(\\.tmp)?|"
      "checkpoint/\\.?[ab]\\.bin(\\.tmp)?|"
      "pictures/\\.?((compare_)?(body|surface|particles|section|strain|forces|bones)"
      "_([0-9]{6,}|sheet)\\.png|(contact_sheet|scene)\\.png|(movie|(compare_)?(body|surface|"
      "particles|"
      "section|strain|forces|bones))\\.mp4)(\\.tmp)?");
  return std::regex_match(relative.generic_string(), ours);
}

/// Folders within that of a run, and the run's own. Checkpoints first: without them a partly
/// removed run cannot be resumed.
std::vector<std::string_view> run_parts() {
  std::vector<std::string_view> parts = {"checkpoint", ""};
  for (const SeriesRow& series : series_table()) parts.push_back(series.name);
  parts.insert(parts.end(), {"pictures", "meshes"});
  return parts;
}

std::vector<fs::path> files_of_run(const RunFolder& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const std::string_view part : run_parts())
    for (const auto& entry : fs::directory_iterator(folder.path / part, failed))
      if (!entry.is_directory(failed) &&
          written_by_a_run(entry.path().lexically_relative(folder.path / "")))
        files.push_back(entry.path());
  return files;
}

/// Hidden files and those of a body filled beforehand are no obstacle. Meshes are: a run may write
/// its own in their place.
void refuse_others(const RunFolder& folder) {
  std::error_code none;
  const auto parts = run_parts();
  for (const auto& entry : fs::directory_iterator(folder.path, none)) {
    const std::string name = entry.path().filename().string();
    const bool part =
        name != "meshes" && std::find(parts.begin(), parts.end(), name) != parts.end();
    if (name.front() == '.' || name == "body.vtu" || (part && entry.is_directory(none))) continue;
    throw bad_input(Place{folder.path.string()},
                    "holds files that are of no run, " + shown(name) + " for one",
                    "choose a folder that is empty or does not exist, with -o");
  }
}

}  // namespace

RunFolder run_folder(const fs::path& scene, const fs::path& chosen) {
  return {chosen.empty() ? fs::path("out") / scene.stem() : chosen};
}

fs::path create(const RunFolder& folder) {
  std::error_code failed;
  fs::path created;
  for (fs::path path = fs::absolute(folder.path / "").parent_path();
       !fs::exists(path, failed) && path.has_relative_path(); path = path.parent_path())
    created = path;
  create_folder(folder.path);
  return created;
}

void remove_old_run(const RunFolder& folder) {
  std::error_code failed;
  const auto give_up = [&](const fs::path& file) {
    throw not_written(file.string(), "cannot be removed (" + failed.message() + ")",
                      "remove it by hand or choose another folder with -o");
  };
  // Until all files are removed, something marks them as a run's. Renaming needs no disk space.
  if (fs::exists(folder.record(), failed)) fs::rename(folder.record(), folder.old_record(), failed);
  if (failed) give_up(folder.record());
  for (const fs::path& file : files_of_run(folder)) {
    fs::remove(file, failed);
    if (failed) give_up(file);
  }
  fs::remove(folder.old_record(), failed);
  if (failed) give_up(folder.old_record());
}

void refuse_foreign_files(const RunFolder& folder) {
  for (const std::string_view part : run_parts())
    if (!part.empty()) refuse_link(folder.path / part);
  if (folder.used()) return;
  for (const fs::path& file : files_of_run(folder)) {
    // Remains of a run killed before it had written its record.
    if (file.filename().string().front() == '.' && file.extension() == ".tmp") continue;
    throw bad_input(Place{file.string()}, "exists, but no run.json of a run beside it",
                    "choose another folder with -o, or move the file away");
  }
  refuse_others(folder);
}

void refuse_file_of_run(const fs::path& file) {
  std::error_code failed;
  fs::path relative = file.filename();
  RunFolder folder{fs::weakly_canonical(fs::absolute(file).parent_path(), failed)};
  for (int depth = 0; depth < 2; ++depth) {
    if (folder.used() &&
        (written_by_a_run(relative) || relative == "body.vtu" || *relative.begin() == "meshes"))
      throw bad_input(Place{file.string()}, "is of the run in this folder, and would be replaced",
                      "give another name");
    relative = folder.path.filename() / relative;
    folder.path = folder.path.parent_path();
  }
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

namespace {

/// What a program that was killed has left of its pictures.
void remove_unfinished(const fs::path& pictures) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(pictures, failed)) {
    const fs::path name = entry.path().filename();
    const bool unfinished = name.string().front() == '.' && name.extension() == ".tmp";
    if (unfinished && written_by_a_run("pictures" / name)) fs::remove(entry.path(), failed);
  }
}

}  // namespace

PicturesLock::PicturesLock(const fs::path& folder)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (folder_ < 0) return;  // then nothing can be written there either
  if (::flock(folder_, LOCK_EX | LOCK_NB) == 0) remove_unfinished(folder);
  ::flock(folder_, LOCK_SH);
}

PicturesLock::~PicturesLock() {
  if (folder_ >= 0) ::close(folder_);
}

namespace {

std::string this_process() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(::getpid()) + " on " + host.data();
}

/// The holder named in a lock: one line of printable characters.
std::string holder_of(int lock) {
  std::array<char, 400> text{};
  const ssize_t size = ::pread(lock, text.data(), text.size(), 0);
  std::string holder(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  holder = holder.substr(0, holder.find('\n'));
  std::replace_if(
      holder.begin(), holder.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return holder;
}

bool put_holder(int lock, std::string_view holder) {
  return ::ftruncate(lock, 0) == 0 &&
         ::pwrite(lock, holder.data(), holder.size(), 0) == static_cast<ssize_t>(holder.size());
}

}  // namespace

std::atomic<const FolderLock*> FolderLock::held = nullptr;

FolderLock::FolderLock(const RunFolder& folder, const fs::path& created)
    : path_(folder.path / ".lock") {
  if (!created.empty())
    for (fs::path path = fs::absolute(folder.path / ""); path != created; created_.push_back(path))
      path = path.parent_path();
  const auto cannot_be_made = [&] {
    const std::string why = std::strerror(errno);
    if (file_ >= 0) ::close(file_);
    return not_written(path_.string(), "cannot be made (" + why + ")",
                       "make space, or choose a folder you may write to with -o");
  };
  file_ = open_lock(path_);
  if (file_ < 0) throw cannot_be_made();
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const std::string holder = holder_of(file_);
    ::close(file_);
    throw bad_input(
        Place{folder.path.string()},
        "another sinew is working in this folder" + (holder.empty() ? "" : ": " + holder),
        "wait for it, or choose another folder with -o");
  }
  left_by_ = holder_of(file_);
  if (!put_holder(file_, this_process() + '\n')) throw cannot_be_made();
  held = this;
}

bool FolderLock::is_alone() const {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(path_.parent_path(), failed))
    if (entry.path().filename() != ".lock") return false;
  return !failed;
}

/// Makes only calls that POSIX permits in signal handlers.
void FolderLock::release() const noexcept {
  put_holder(file_, {});
  if (!created_.empty()) ::unlink(path_.c_str());
  for (const fs::path& folder : created_)
    if (::rmdir(folder.c_str()) != 0) return;
}

void FolderLock::release_held() noexcept {
  if (const FolderLock* lock = held) lock->release();
}

FolderLock::~FolderLock() {
  held = nullptr;
  if (!is_alone()) created_.clear();
  release();
  ::close(file_);
}

}  // namespace sinew
