// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/converted.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <thread>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/blender_script.h>
#include <sinew/io/gltf/document.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr int not_found = 127;           // exit code, as in shells
constexpr std::size_t max_reason = 300;  // bytes
constexpr const char* other_way = "export it as GLB from the program that made it";

/// Where Blender works. Names there are plain: whatever the file is called, Blender opens it.
class WorkFolder {
 public:
  explicit WorkFolder(const fs::path& source)
      : name_("input" + lower(source.extension().string())) {
    std::string folder = (fs::temp_directory_path() / "sinew-blender-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr)
      throw not_written(folder, "a folder for Blender cannot be made", "free some space");
    folder_ = folder;
    fs::create_symlink(fs::absolute(source), input());
  }
  ~WorkFolder() {
    std::error_code left;
    fs::remove_all(folder_, left);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  fs::path input() const { return folder_ / name_; }
  fs::path output() const { return folder_ / "output.glb"; }
  fs::path reason() const { return folder_ / "reason.txt"; }

 private:
  std::string name_;
  fs::path folder_;
};

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  all.reserve(words.size() + 1);
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

/// Variables of this process, with the system's programs first: where `python3` is another one
/// (conda, pyenv), Debian's Blender looks for its modules there.
std::vector<std::string> environment_of_blender() {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) all.emplace_back(*entry);
  std::string path = "PATH=/usr/bin:/bin";
  std::erase_if(all, [&](const std::string& entry) {
    const bool is_path = entry.starts_with("PATH=");
    if (is_path) path += ':' + entry.substr(5);
    return is_path;
  });
  all.push_back(path);
  return all;
}

[[noreturn]] void become(const std::vector<char*>& words, const std::vector<char*>& environment,
                         pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // the parent ended before it could be watched
  const int null = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null, stream);
  ::execvpe(words.front(), words.data(), environment.data());
  ::_exit(not_found);
}

/// Its status as waitpid() has it; none where it took too long, and was ended.
std::optional<int> status_of(std::vector<std::string> words, double patience) {
  std::vector<std::string> environment = environment_of_blender();
  const std::vector<char*> arguments = pointers(words), variables = pointers(environment);
  const pid_t parent = ::getpid(), child = ::fork();
  if (child == 0) become(arguments, variables, parent);
  if (child < 0) return W_EXITCODE(not_found, 0);
  const Stopwatch watch;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (watch.seconds() > patience) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      return std::nullopt;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return status;
}

/// The first line of it.
std::string reason_in(const fs::path& file) {
  std::error_code missing;
  const std::string text = fs::exists(file, missing) ? read_head(file, max_reason) : "";
  return text.substr(0, text.find('\n'));
}

/// The error that a conversion without a GLB is.
Error failure(std::optional<int> status, const std::string& reason, const BlenderOptions& options) {
  if (!status)
    return bad_input("Blender has not converted it in " + three_digits(options.patience) + " s",
                     other_way);
  if (WIFSIGNALED(*status))
    return bad_input("Blender crashed on it, by signal " + std::to_string(WTERMSIG(*status)),
                     other_way);
  if (WEXITSTATUS(*status) == not_found || reason.find("numpy") != std::string::npos)
    return bad_input("Blender and its numpy are needed to read it",
                     "install them with: apt-get install blender python3-numpy");
  return bad_input("Blender cannot convert it: " + (reason.empty() ? "no reason given" : reason),
                   other_way);
}

std::string converted(const fs::path& path, const BlenderOptions& options) {
  const WorkFolder work(path);
  const std::optional<int> status = status_of(
      {options.program, "-b", "--factory-startup", "--python-exit-code", "3", "--python-expr",
       blender_script, "--", work.input().string(), work.output().string(), work.reason().string()},
      options.patience);
  std::error_code missing;
  if (status != 0 || !fs::exists(work.output(), missing))
    throw failure(status, reason_in(work.reason()), options);
  return read_file(work.output(), max_gltf_bytes);
}

fs::path user_cache() {
  const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
  if (cache != nullptr && *cache == '/') return fs::path(cache) / "sinew";
  return (home != nullptr && *home == '/' ? fs::path(home) / ".cache" : fs::temp_directory_path()) /
         "sinew";
}

/// The file's content and how it is converted.
std::string hash_of(const fs::path& path) {
  Hash hash;
  hash.add(blender_script);
  read_through(path, [&](std::string_view piece) { hash.add(piece); });
  return hash_text(hash.value());
}

fs::path cached(const fs::path& path, const BlenderOptions& options) {
  const std::string end = hash_of(path) + ".glb";
  fs::path beside = path.parent_path() / (path.filename().string() + '.' + end);
  fs::path elsewhere = user_cache() / end;
  std::error_code missing;
  for (const fs::path& there : {beside, elsewhere})
    if (fs::exists(there, missing)) return there;
  const std::string glb = converted(path, options);
  try {
    write_file(beside, glb);
    return beside;
  } catch (const Error&) {  // a folder of someone else's, or a name that grows too long
    create_folder(elsewhere.parent_path());
    write_file(elsewhere, glb);
    return elsewhere;
  }
}

}  // namespace

bool is_gltf(const fs::path& path) {
  const std::string kind = lower(path.extension().string());
  return kind == ".gltf" || kind == ".glb" || kind == ".vrm" || needs_blender(path);
}

bool needs_blender(const fs::path& path) {
  const std::string kind = lower(path.extension().string());
  return kind == ".fbx" || kind == ".dae";
}

fs::path gltf_of(const fs::path& path, const BlenderOptions& options) {
  if (!needs_blender(path)) return path;
  try {
    return cached(path, options);
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  }
}

}  // namespace sinew
