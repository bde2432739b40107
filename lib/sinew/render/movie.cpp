// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/movie.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>

namespace sinew {
namespace {

/// The child writes the open file: by its name, it might create it again once it was removed.
constexpr int its_file = 3;

std::vector<std::string> command(const MovieOptions& options, const std::string& path) {
  std::ostringstream rate, size;
  rate << options.frames_per_second;
  size << options.width << 'x' << options.height;
  return {"ffmpeg",
          "-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pixel_format",
          "rgb24",
          "-video_size",
          size.str(),
          "-framerate",
          rate.str(),
          "-i",
          "pipe:0",
          "-vf",
          "scale=out_color_matrix=bt709:out_range=tv",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-color_range",
          "tv",
          "-c:v",
          "libx264",
          "-preset",
          "veryfast",
          "-crf",
          "18",
          "-pix_fmt",
          "yuv420p",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "file:" + path};
}

void check(const MovieOptions& options) {
  const auto fits = [](int size) { return size >= 16 && size <= 8192 && size % 2 == 0; };
  if (!fits(options.width) || !fits(options.height))
    throw bad_input("a movie cannot have that size", "choose even numbers of 16 to 8192 pixels");
  if (!(options.frames_per_second >= 0.1 && options.frames_per_second <= 240))
    throw bad_input("a movie cannot have that frame rate", "choose 0.1 to 240 frames per second");
}

}  // namespace

/// The child process, which reads frames from `input` and writes errors to `complaints`.
struct Movie::Encoder {
  std::string path;
  NewFile file;
  std::FILE* complaints = std::tmpfile();
  pid_t process = 0;
  int input = -1;

  explicit Encoder(const std::string& target) : path(target), file(target) {}
  ~Encoder();
  void start(const MovieOptions& options);
  void spawn(const std::vector<std::string>& words, int its_end);
  void send(const std::vector<std::uint8_t>& bytes);
  bool wait();
  std::string last_complaint();
  [[noreturn]] void fail(const std::string& what, const std::string& cure);
};

Movie::Encoder::~Encoder() {
  wait();
  if (complaints) std::fclose(complaints);
}

void Movie::Encoder::start(const MovieOptions& options) {
  int ends[2];  // a socket, not a pipe: writing to an ended child is an error, not a signal
  if (!complaints || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    fail(std::strerror(errno), "free some space or memory");
  input = ends[0];
  spawn(command(options, "/dev/fd/" + std::to_string(its_file)), ends[1]);
}

void Movie::Encoder::spawn(const std::vector<std::string>& words, int its_end) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, its_end, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(complaints), STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&actions, file.descriptor(), its_file);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const int failed = posix_spawnp(&process, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(its_end);
  if (failed == 0) return;
  process = 0;
  fail(std::string("ffmpeg cannot be started (") + std::strerror(failed) + ")",
       "install it with: apt-get install ffmpeg");
}

void Movie::Encoder::send(const std::vector<std::uint8_t>& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count = ::send(input, &bytes[sent], bytes.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      wait();
      fail("ffmpeg gave up: " + last_complaint(), "mend that and draw again");
    }
    sent += static_cast<std::size_t>(count);
  }
}

/// Ends the input and waits for the child; returns whether it succeeded.
bool Movie::Encoder::wait() {
  if (input >= 0) close(std::exchange(input, -1));
  if (process == 0) return false;
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  process = 0;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string Movie::Encoder::last_complaint() {
  std::string last = "no reason given", line;
  std::rewind(complaints);
  for (int c = std::fgetc(complaints); c != EOF; c = std::fgetc(complaints)) {
    if (c != '\n') line += static_cast<char>(c);
    if (c == '\n' && !line.empty()) last = std::exchange(line, "");
  }
  return line.empty() ? last : line;
}

void Movie::Encoder::fail(const std::string& what, const std::string& cure) {
  throw not_written(path, what, cure);
}

Movie::Movie(const std::string& path, const MovieOptions& options) : options_(options) {
  check(options);
  encoder_ = std::make_unique<Encoder>(path);
  encoder_->start(options);
}

Movie::~Movie() = default;

void Movie::add(const Image& frame) {
  if (frame.width != options_.width || frame.height != options_.height)
    throw bad_input("a frame has not the movie's size", "draw all frames alike");
  encoder_->send(frame.rgb);
}

void Movie::finish() {
  if (!encoder_->wait())
    encoder_->fail("ffmpeg failed: " + encoder_->last_complaint(), "mend that and draw again");
  encoder_->file.finish();
}

}  // namespace sinew
