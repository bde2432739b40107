// SPDX-License-Identifier: GPL-3.0-or-later
// A disk that becomes full, for a program that loads this before the C library (LD_PRELOAD): from
// the n-th request on, all that need space below a folder fail as on a full disk.
//   SINEW_DISK      the folder
//   SINEW_FULL_AT   n; 0 or none: never
//   SINEW_FULL_ONCE set: only the n-th fails
//   SINEW_REQUESTS  a file that gets the number of requests when the program ends
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

std::atomic<long> requests{0};

template <class Function>
Function* next_of(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

bool is_on_disk(const std::string& path) {
  static const std::string disk = from_environment("SINEW_DISK") + '/';
  return disk.size() > 1 && (path + '/').compare(0, disk.size(), disk) == 0;
}

bool is_on_disk(int file) {
  std::array<char, PATH_MAX> path{};
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t size = ::readlink(link.c_str(), path.data(), path.size() - 1);
  return size > 0 && is_on_disk(std::string(path.data(), static_cast<std::size_t>(size)));
}

/// Counts a request that needs space; whether there is none.
bool is_full() {
  static const long full_at = std::atol(from_environment("SINEW_FULL_AT").c_str());
  static const bool once = std::getenv("SINEW_FULL_ONCE") != nullptr;
  const long number = ++requests;
  const bool full = full_at > 0 && (once ? number == full_at : number >= full_at);
  if (full) errno = ENOSPC;
  return full;
}

template <class Where>
bool refuses(const Where& where) {
  return is_on_disk(where) && is_full();
}

struct TellAtTheEnd {
  ~TellAtTheEnd() {
    const std::string path = from_environment("SINEW_REQUESTS");
    if (path.empty()) return;
    const std::string text = std::to_string(requests) + '\n';
    const auto file = static_cast<int>(
        ::syscall(SYS_openat, AT_FDCWD, path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644));
    ::syscall(SYS_write, file, text.data(), text.size());
    ::syscall(SYS_close, file);
  }
} tell_at_the_end;

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : mode_t{0};
  va_end(rest);
  if ((flags & O_CREAT) != 0 && refuses(std::string(path))) return -1;
  return next_of<int(const char*, int, ...)>("open")(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa") != nullptr && refuses(std::string(path))) return nullptr;
  return next_of<FILE*(const char*, const char*)>("fopen")(path, mode);
}

ssize_t write(int file, const void* bytes, size_t count) {
  if (refuses(file)) return -1;
  return next_of<ssize_t(int, const void*, size_t)>("write")(file, bytes, count);
}

ssize_t pwrite(int file, const void* bytes, size_t count, off_t place) {
  if (count > 0 && refuses(file)) return -1;
  return next_of<ssize_t(int, const void*, size_t, off_t)>("pwrite")(file, bytes, count, place);
}

ssize_t writev(int file, const iovec* parts, int count) {
  if (refuses(file)) return -1;
  return next_of<ssize_t(int, const iovec*, int)>("writev")(file, parts, count);
}

size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file) {
  if (refuses(fileno(file))) return 0;
  return next_of<size_t(const void*, size_t, size_t, FILE*)>("fwrite")(bytes, size, count, file);
}

int fflush(FILE* file) {
  if (file != nullptr && refuses(fileno(file))) return EOF;
  return next_of<int(FILE*)>("fflush")(file);
}

int fsync(int file) {
  if (refuses(file)) return -1;
  return next_of<int(int)>("fsync")(file);
}

int rename(const char* from, const char* to) {
  if (refuses(std::string(to))) return -1;
  return next_of<int(const char*, const char*)>("rename")(from, to);
}

int mkdir(const char* path, mode_t mode) {
  if (refuses(std::string(path))) return -1;
  return next_of<int(const char*, mode_t)>("mkdir")(path, mode);
}
}
