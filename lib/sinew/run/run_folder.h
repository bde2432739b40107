// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of a run: the paths of its files, the lock of the process that works in it, and the
// removal of an older run.
//
//     const RunFolder folder = run_folder("configs/box_bend.yaml", "");
//     create(folder);
//     const FolderLock lock(folder);
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace sinew {

struct RunFolder {
  std::filesystem::path path;

  std::filesystem::path scene() const { return path / "scene.yaml"; }
  std::filesystem::path record() const { return path / "run.json"; }
  std::filesystem::path log() const { return path / "log.txt"; }
  std::filesystem::path old_record() const { return path / ".run.json.old"; }
  std::filesystem::path blowup() const { return path / "blowup.vtu"; }
  std::filesystem::path body() const { return path / "body.vtu"; }
  std::filesystem::path checkpoints() const { return path / "checkpoint"; }
  /// What an engine in another program is told and says.
  std::filesystem::path engine() const { return path / ".engine"; }
  /// A state of ParaView that shows the run.
  std::filesystem::path view() const { return path / "view.pvsm"; }
  /// Meshes that the scene held itself.
  std::filesystem::path meshes() const { return path / "meshes"; }
  std::filesystem::path pictures() const { return path / "pictures"; }

  /// Whether a run has begun here.
  bool used() const {
    std::error_code unreachable;
    return std::filesystem::exists(record(), unreachable) ||
           std::filesystem::exists(old_record(), unreachable);
  }
};

/// out/NAME-OF-SCENE below the current directory, or the folder chosen with -o.
RunFolder run_folder(const std::filesystem::path& scene, const std::filesystem::path& chosen);

/// Creates the folder. Returns the outermost of the folders that were not there; "" for none.
/// Throws not written.
std::filesystem::path create(const RunFolder& folder);

/// Removes the files of an older run and nothing else; body and meshes are kept, since the next
/// scene may name them. If killed in between, it leaves a folder that it can be applied to again.
/// Throws not written.
void remove_old_run(const RunFolder& folder);

/// Throws bad input where a folder that no run has used holds files, hidden ones and a body
/// excepted, and where one of the folders within is a link: files elsewhere would be replaced.
void refuse_foreign_files(const RunFolder& folder);

/// Throws bad input where a file to be written is named as one of the run in whose folder it lies.
void refuse_file_of_run(const std::filesystem::path& file);

/// Bytes that remove_old_run would free.
std::uint64_t size_of_old_run(const RunFolder& folder);

/// Lock while pictures are drawn into a folder. The first one removes what killed programs have
/// left unfinished there.
class PicturesLock {
 public:
  explicit PicturesLock(const std::filesystem::path& folder);
  ~PicturesLock();
  PicturesLock(const PicturesLock&) = delete;
  PicturesLock& operator=(const PicturesLock&) = delete;

 private:
  int folder_ = -1;
};

/// Lock while a run works in its folder; the kernel releases it however the program ends. DIR/.lock
/// names the process that holds it. Where nothing else has come into the folder, the file is
/// removed at the end, and the folders from `created` on.
class FolderLock {
 public:
  /// Throws bad input, naming the process, where another one holds the lock, and not written where
  /// the lock cannot be created.
  explicit FolderLock(const RunFolder& folder, const std::filesystem::path& created = {});
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// The process that had it before and ended without releasing it; "" for none.
  const std::string& left_by() const { return left_by_; }

  /// Leaves nothing of the lock that this process holds, if any: for a signal handler that ends the
  /// program before anything else has come into the folder.
  static void release_held() noexcept;

 private:
  bool is_alone() const;
  void release() const noexcept;

  static std::atomic<const FolderLock*> held;
  std::filesystem::path path_;
  std::vector<std::filesystem::path> created_;  ///< to be removed, the innermost first
  int file_ = -1;
  std::string left_by_;
};

}  // namespace sinew
