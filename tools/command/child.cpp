// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include <sinew/core/file.h>
#include <sinew/core/system.h>

namespace sinew {

namespace {

volatile std::sig_atomic_t requested = 0;  // the only state a signal handler may change

void remember(int) { requested = 1; }

struct {
  bool says = false;
  void (*release)() = nullptr;
} at_end;

void end_at_once(int) {
  constexpr std::string_view words = "sinew: stopped; give the same command again\n";
  if (at_end.release != nullptr) at_end.release();
  if (at_end.says && ::write(STDERR_FILENO, words.data(), words.size()) < 0) ::_exit(1);
  ::_exit(static_cast<int>(Exit::interrupted));
}

void change_mask(int how) {
  sigset_t stops;
  sigemptyset(&stops);
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) sigaddset(&stops, signal);
  pthread_sigmask(how, &stops, nullptr);
}

}  // namespace

void hold_stop_signals() { change_mask(SIG_BLOCK); }

void end_at_stop_signals(bool says, void (*release)()) {
  hold_stop_signals();
  at_end = {says, release};
  struct sigaction action {};
  action.sa_handler = end_at_once;
  for (const int signal : {SIGHUP, SIGINT, SIGTERM})
    if (signal != SIGHUP || !ignores_hangup()) sigaction(signal, &action, nullptr);
  change_mask(SIG_UNBLOCK);
}

bool is_part_of_another() {
  int with_parent = 0;
  return ::prctl(PR_GET_PDEATHSIG, &with_parent) == 0 && with_parent != 0;
}

bool ignores_hangup() {
  struct sigaction now {};
  return sigaction(SIGHUP, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

void catch_lost_reader() {
  struct sigaction action {};
  action.sa_handler = remember;
  sigaction(SIGPIPE, &action, nullptr);
}

void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = remember;
  // Both the kernel and the shell report a closed terminal: the second signal adds nothing.
  if (!ignores_hangup()) sigaction(SIGHUP, &action, nullptr);
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() { return requested != 0; }

namespace {

volatile pid_t child_of_signals = 0;  // to which a signal handler forwards signals

void pass_on(int signal, siginfo_t* origin, void*) {
  requested = 1;
  // The terminal sends Ctrl-C to all programs in the foreground, and forwarding it would end the
  // child by a second signal; a hangup may be sent to this process alone.
  const bool received_already = signal != SIGHUP && origin->si_code == SI_KERNEL;
  if (child_of_signals > 0 && !received_already) ::kill(child_of_signals, signal);
}

void pass_signals_on() {
  struct sigaction action {};
  action.sa_sigaction = pass_on;
  action.sa_flags = SA_RESTART | SA_SIGINFO;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  if (!ignores_hangup()) sigaction(SIGHUP, &action, nullptr);
}

[[noreturn]] void become(const std::string& program, const std::vector<char*>& arguments,
                         int output, const std::string& errors, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(1);  // the parent ended before it could be watched
  ::dup2(output, STDOUT_FILENO);
  if (!errors.empty()) {
    ::setpgid(0, 0);  // signals of the terminal go to the parent, which ends it
    ::dup2(create_file(errors), STDERR_FILENO);
  }
  ::execv(program.c_str(), arguments.data());
  ::_exit(127);
}

std::string read_all(int from) {
  std::string text;
  std::array<char, 4096> part;
  while (true) {
    const ssize_t got = ::read(from, part.data(), part.size());
    if (got > 0)
      text.append(part.data(), static_cast<std::size_t>(got));
    else if (got == 0 || errno != EINTR)
      return text;
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

namespace {

struct Child {
  pid_t process = 0;
  int output = -1;  ///< to be read
};

Child start_child(const std::string& command, const std::vector<std::string>& arguments,
                  const std::string& errors = "") {
  const auto folder = this_program().parent_path();
  std::string program = (folder / ("sinew-" + command)).string();
  const Error cannot_start =
      bad_input(Place{program}, "cannot be started", "build or install all programs of sinew");
  if (::access(program.c_str(), X_OK) != 0) throw cannot_start;
  std::vector<char*> words{program.data()};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw cannot_start;
  const pid_t parent = ::getpid();
  hold_stop_signals();  // the child is ready for them later
  const pid_t child = ::fork();
  if (child == 0) become(program, words, pipe[1], errors, parent);
  change_mask(SIG_UNBLOCK);
  ::close(pipe[1]);
  if (child < 0) throw cannot_start;
  return {child, pipe[0]};
}

}  // namespace

Exit exit_of(const std::string& command, const ChildEnd& end) {
  for (const Exit known : {Exit::done, Exit::limit_passed, Exit::bad_input, Exit::unstable,
                           Exit::not_written, Exit::interrupted})
    if (end.exit == static_cast<int>(known)) return known;
  for (const int stop : {SIGHUP, SIGINT, SIGTERM})
    if (end.exit == 128 + stop) return Exit::interrupted;
  throw bad_input("sinew-" + command + " ended with code " + std::to_string(end.exit) +
                      (end.exit > 128 ? ", by signal " + std::to_string(end.exit - 128) : ""),
                  "see whether memory ran out; run sinew " + command + " by itself");
}

ChildEnd run_child(const std::string& command, const std::vector<std::string>& arguments) {
  pass_signals_on();  // exec resets the handlers in the child
  if (stop_requested()) return {static_cast<int>(Exit::interrupted), ""};
  const Child child = start_child(command, arguments);
  child_of_signals = child.process;
  if (stop_requested()) ::kill(child.process, SIGTERM);  // since it was asked
  ChildEnd end;
  end.output = read_all(child.output);
  ::close(child.output);
  end.exit = wait_for(child.process);
  child_of_signals = 0;
  return end;
}

Helper::Helper(const std::string& command, const std::vector<std::string>& arguments,
               const std::string& errors) {
  const Child child = start_child(command, arguments, errors);
  process_ = child.process;
  output_ = child.output;
}

Helper::~Helper() {
  if (process_ == 0) return;
  ::close(output_);
  ::kill(process_, SIGTERM);
  wait_for(process_);
}

bool Helper::read(std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t got = ::read(output_, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  return true;
}

std::optional<ChildEnd> Helper::ended() {
  int status = 0;
  if (::waitpid(process_, &status, WNOHANG) != process_) return std::nullopt;
  process_ = 0;
  ChildEnd end{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_all(output_)};
  ::close(output_);
  return end;
}

void Helper::end(int signal) {
  if (process_ != 0) ::kill(process_, signal);
}

void Helper::yield() { ::setpriority(PRIO_PROCESS, static_cast<id_t>(process_), 5); }

ChildEnd Helper::wait(const std::function<bool(const std::string& line)>& taken) {
  pass_signals_on();
  child_of_signals = process_;
  if (stop_requested()) ::kill(process_, SIGTERM);
  ChildEnd end;
  std::FILE* lines = ::fdopen(output_, "r");
  std::string line;
  for (int c = lines ? std::fgetc(lines) : EOF; c != EOF; c = std::fgetc(lines)) {
    line += static_cast<char>(c);
    if (c != '\n') continue;
    if (!taken(line)) end.output += line;
    line.clear();
  }
  end.output += line;
  if (lines) std::fclose(lines);
  end.exit = wait_for(std::exchange(process_, 0));
  child_of_signals = 0;
  return end;
}

}  // namespace sinew
