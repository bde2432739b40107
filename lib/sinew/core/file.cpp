// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

#include <sinew/core/error.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

const char* cure_for(int error) {
  if (error == ENOSPC || error == EDQUOT || error == EFBIG)
    return "free some space or choose another place for the results";
  if (error == ENOENT || error == ENOTDIR) return "create its folder first";
  return "choose a place you may write to";
}

Error refused(const fs::path& path, int error) {
  return not_written(path.string(), std::string("cannot be written: ") + std::strerror(error),
                     cure_for(error));
}

Error unreadable(const fs::path& path, int error) {
  return bad_input({path.string()}, std::string("cannot be read: ") + std::strerror(error),
                   "check the path and the permissions");
}

/// Calls sync (fsync, syncfs) on a folder. A file system that does not support it is no failure.
void sync_folder(const fs::path& folder, int (*sync)(int)) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;  // a folder that can be written but not read cannot be synced
  const int error = sync(file) == 0 ? 0 : errno;
  ::close(file);
  if (error != 0 && error != EINVAL && error != ENOSYS && error != EOPNOTSUPP)
    throw refused(folder, error);
}

/// The new name is an entry of its folder, which is synced separately.
void sync_folder_of(const fs::path& path) {
  sync_folder(path.has_parent_path() ? path.parent_path() : fs::path("."), ::fsync);
}

/// `place` bytes from the beginning.
void write_all(int file, const fs::path& path, const void* bytes, std::size_t count,
               std::uint64_t place) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::pwrite(file, next, count, static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw refused(path, errno);
    next += written;
    count -= static_cast<std::size_t>(written);
    place += static_cast<std::uint64_t>(written);
  }
}

/// Folders, pipes and devices stay.
void refuse_special(const fs::path& path) {
  std::error_code ignored;
  const auto there = fs::status(path, ignored);
  if (fs::exists(there) && !fs::is_regular_file(there))
    throw not_written(path.string(), "is there, and no regular file", "choose another name");
}

fs::path temporary_of(const fs::path& path) {
  std::string name = ".";
  name += path.filename().string();
  return path.parent_path() / (name += ".tmp");
}

}  // namespace

int create_file(const fs::path& path) {
  ::unlink(path.c_str());
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

int open_lock(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
  struct stat status;
  if (file < 0 || (::fstat(file, &status) == 0 && status.st_nlink <= 1)) return file;
  ::close(file);
  errno = EMLINK;
  return -1;
}

void create_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed)
    throw not_written(folder.string(), "cannot be created (" + failed.message() + ")",
                      "choose another place, which you may write to");
}

void create_inner_folder(const fs::path& folder) {
  refuse_link(folder);
  create_folder(folder);
}

void refuse_link(const fs::path& folder) {
  std::error_code unreachable;
  if (fs::is_symlink(fs::symlink_status(folder, unreachable)))
    throw bad_input({folder.string()}, "is a link to another folder, whose files would be replaced",
                    "remove the link, or choose another folder with -o");
}

NewFile::NewFile(fs::path path) : path_(std::move(path)), temporary_(temporary_of(path_)) {
  refuse_special(path_);
  file_ = create_file(temporary_);
  if (file_ < 0) throw refused(path_, errno);
}

NewFile::~NewFile() {
  if (file_ >= 0) ::close(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void NewFile::write(const void* bytes, std::size_t count) { write_at(extend(count), bytes, count); }

std::uint64_t NewFile::extend(std::uint64_t count) { return std::exchange(size_, size_ + count); }

void NewFile::write_at(std::uint64_t place, const void* bytes, std::size_t count) const {
  write_all(file_, path_, bytes, count, place);
}

void NewFile::finish(Durability durability) {
  if (durability == Durability::synced && ::fsync(file_) != 0) throw refused(path_, errno);
  // The close itself may report that the data did not arrive (network file systems).
  if (::close(std::exchange(file_, -1)) != 0 || ::rename(temporary_.c_str(), path_.c_str()) != 0)
    throw refused(path_, errno);
  temporary_.clear();
  if (durability == Durability::synced) sync_folder_of(path_);
}

void write_part(const fs::path& path, std::uint64_t place, std::string_view bytes) {
  const fs::path temporary = temporary_of(path);
  const int file = place == 0 ? create_file(temporary)
                              : ::open(temporary.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) throw refused(path, errno);
  try {
    write_all(file, path, bytes.data(), bytes.size(), place);
  } catch (const Error&) {
    ::close(file);
    throw;
  }
  if (::close(file) != 0) throw refused(path, errno);
}

void finish_parts(const fs::path& path, std::string_view last) {
  std::error_code failed;
  const auto size = fs::file_size(temporary_of(path), failed);
  if (failed) throw refused(path, failed.value());
  write_part(path, size, last);
  if (::rename(temporary_of(path).c_str(), path.c_str()) != 0) throw refused(path, errno);
}

namespace {

constexpr std::size_t bytes_per_read = 1 << 16;

/// A regular file, open for reading.
class RegularFile {
 public:
  // Not blocking: a pipe without a writer would block forever.
  explicit RegularFile(const fs::path& path)
      : path_(path), file_{::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)} {
    struct stat status;
    if (file_.number < 0 || ::fstat(file_.number, &status) != 0) throw unreadable(path_, errno);
    if (!S_ISREG(status.st_mode))
      throw bad_input({path_.string()}, "is not a regular file", "name a file");
    size_ = static_cast<std::uint64_t>(status.st_size);
  }

  std::uint64_t size() const { return size_; }  ///< size as fstat gives it; 0 for files of /proc

  /// Calls visit(piece) for what follows up to the end, or until there were `most` bytes.
  template <class Visit>
  void read(std::uint64_t most, const Visit& visit) const {
    std::string piece(bytes_per_read, '\0');
    while (most > 0) {
      const ssize_t count = ::read(file_.number, piece.data(), std::min(most, piece.size()));
      if (count == 0) return;
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) throw unreadable(path_, errno);
      visit(std::string_view(piece).substr(0, static_cast<std::size_t>(count)));
      most -= static_cast<std::uint64_t>(count);
    }
  }

  /// The bytes up to the end, or until there are `most`.
  std::string read(std::uint64_t most) const {
    std::string text;
    text.reserve(std::min(most, size_));
    read(most, [&](std::string_view piece) { text += piece; });
    return text;
  }

 private:
  struct Descriptor {
    int number;
    ~Descriptor() {
      if (number >= 0) ::close(number);
    }
  };

  const fs::path& path_;
  const Descriptor file_;
  std::uint64_t size_ = 0;
};

/// Gives the file at `path` a copy of its own, where it shares what it holds with other names.
void part_from_other_names(const fs::path& path) {
  std::error_code none;
  if (fs::is_symlink(path, none) || fs::hard_link_count(path, none) <= 1 || none) return;
  NewFile copy(path);
  read_through(path, [&](std::string_view piece) { copy.write(piece.data(), piece.size()); });
  copy.finish();
}

}  // namespace

GrowingFile::GrowingFile(fs::path path, std::uint64_t kept) : path_(std::move(path)), size_(kept) {
  refuse_special(path_);
  if (kept > 0) part_from_other_names(path_);
  file_ = kept == 0 ? create_file(path_)
                    : ::open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  if (file_ < 0) throw refused(path_, errno);
  struct stat status;
  int error = ::fstat(file_, &status) != 0 ? errno : 0;
  const bool shorter = error == 0 && static_cast<std::uint64_t>(status.st_size) < kept;
  if (error == 0 && !shorter && ::ftruncate(file_, static_cast<off_t>(kept)) != 0) error = errno;
  if (error == 0 && !shorter) return;
  ::close(file_);
  if (error != 0) throw refused(path_, error);
  throw bad_input({path_.string()},
                  "has " + std::to_string(status.st_size) + " bytes where " + std::to_string(kept) +
                      " were written",
                  "begin again with --force");
}

GrowingFile::~GrowingFile() {
  if (file_ >= 0) ::close(file_);
}

void GrowingFile::add(const void* bytes, std::size_t count) {
  try {
    write_all(file_, path_, bytes, count, size_);
  } catch (const Error&) {
    // No incomplete record stays. A file that becomes shorter needs no space.
    [[maybe_unused]] const int cut = ::ftruncate(file_, static_cast<off_t>(size_));
    throw;
  }
  size_ += count;
}

void GrowingFile::write_at(std::uint64_t place, const void* bytes, std::size_t count) {
  write_all(file_, path_, bytes, count, place);
}

void GrowingFile::close() {
  if (::close(std::exchange(file_, -1)) != 0) throw refused(path_, errno);
}

void sync_all(const fs::path& folder) { sync_folder(folder, ::syncfs); }

void write_file(const fs::path& path, std::string_view text) {
  NewFile file(path);
  file.write(text.data(), text.size());
  file.finish();
}

bool stays_below(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return !normal.empty() && normal.is_relative() && *normal.begin() != "..";
}

fs::path file_below(const fs::path& folder, const fs::path& name) {
  const fs::path below = name.lexically_normal();
  if (!stays_below(below)) return {};
  std::error_code failed;
  const fs::path home = fs::weakly_canonical(folder.empty() ? "." : folder, failed);
  const fs::path file = failed ? fs::path() : fs::weakly_canonical(home / below, failed);
  return !failed && stays_below(file.lexically_relative(home)) ? folder / below : fs::path();
}

std::string read_file(const fs::path& path, std::uint64_t limit) {
  const RegularFile file(path);
  // Its size is checked first: a file that is too large is not read.
  std::string text = file.size() > limit ? "" : file.read(limit + 1);
  if (std::max<std::uint64_t>(file.size(), text.size()) > limit)
    throw bad_input({path.string()}, "is larger than " + std::to_string(limit) + " bytes",
                    "check that this is the file you mean");
  return text;
}

void read_through(const fs::path& path, const std::function<void(std::string_view)>& visit) {
  RegularFile(path).read(std::numeric_limits<std::uint64_t>::max(), visit);
}

std::string read_head(const fs::path& path, std::uint64_t most) {
  return RegularFile(path).read(most);
}

}  // namespace sinew
