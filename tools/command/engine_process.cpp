// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/engine_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr int asked_every = 50, patience = 15000;  // ms
// Seconds after which mpirun gives up a host that does not answer: 4 + 3 x 2; its own are 480.
constexpr std::array<std::array<const char*, 2>, 3> watch_over_hosts = {
    {{"oob_tcp_keepalive_time", "4"},
     {"oob_tcp_keepalive_intvl", "2"},
     {"oob_tcp_keepalive_probes", "3"}}};

fs::path program_of_engine() { return this_program().parent_path() / "sinew-lammps"; }

bool is_in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

/// What mpirun, or the prterun behind it, says of each signal that it passes on.
constexpr std::string_view forwarding = ": Forwarding signal";

/// Whether a job of a cluster says where the ranks go.
bool is_managed() {
  for (const char* job : {"SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID", "PE_HOSTFILE"})
    if (std::getenv(job) != nullptr) return true;
  return false;
}

std::vector<std::string> mpirun_words(const EngineOptions& options, int ranks,
                                      const fs::path& folder) {
  std::vector<std::string> words{"mpirun", "-n", std::to_string(ranks)};
  for (const auto& [name, value] : watch_over_hosts)
    words.insert(words.end(), {"--mca", name, value});
  if (::geteuid() == 0) words.push_back("--allow-run-as-root");
  if (!options.hosts.empty()) {
    words.insert(words.end(), {"--hostfile", options.hosts});
  } else if (!is_managed()) {  // beside other programs of this machine
    words.insert(words.end(), {"--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"});
    if (ranks > static_cast<int>(std::thread::hardware_concurrency()))
      words.push_back("--oversubscribe");
  }
  words.insert(words.end(), {program_of_engine().string(), folder.string()});
  return words;
}

/// In the child: nothing of the terminal reaches mpirun, which would end on Ctrl-C at once.
[[noreturn]] void become(const std::vector<std::string>& words, int output, int errors,
                         pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(1);
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::execvp(arguments[0], arguments.data());
  ::_exit(127);
}

/// The first line of a file that contains `part`, from there on; "" for none.
std::string line_with(const fs::path& file, const std::string& part) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (const auto at = line.find(part); at != std::string::npos) return line.substr(at);
  return "";
}

/// The sentence from `part` on: mpirun breaks its lines and frames them by dashes; "" for none.
std::string sentence_with(const fs::path& file, const std::string& part) {
  std::ifstream lines(file);
  std::string words;
  for (std::string line; std::getline(lines, line);) {
    const auto at = words.empty() ? line.find(part) : 0;
    if (at == std::string::npos) continue;
    if (line.find_first_not_of("- ") == std::string::npos) break;
    words += (words.empty() ? "" : " ") + line.substr(at);
  }
  return words;
}

/// The first line that says anything, with the one after it.
std::string first_words(const fs::path& file) {
  std::ifstream lines(file);
  std::string words, line;
  while (std::getline(lines, line) && (words.empty() || !line.empty()))
    if (line.find_first_not_of("- ") != std::string::npos &&
        line.find(forwarding) == std::string::npos)
      words += (words.empty() ? "" : " ") + line;
  return words.substr(0, words.find(':'));
}

class EngineProcess {
 public:
  explicit EngineProcess(const EngineOptions& options, int ranks)
      : options_(options), ranks_(ranks) {}
  ~EngineProcess() {
    if (process_ == 0) return;
    ::kill(process_, SIGTERM);
    wait();
  }
  EngineProcess(const EngineProcess&) = delete;
  EngineProcess& operator=(const EngineProcess&) = delete;

  void start(const EngineFolder& folder) {
    folder_ = {fs::absolute(folder.path)};
    std::array<int, 2> pipe{};
    const auto words = mpirun_words(options_, ranks_, folder_.path);
    const pid_t parent = ::getpid();
    const bool piped = ::pipe2(pipe.data(), O_CLOEXEC) == 0;
    const int complaints = create_file(errors());
    const pid_t child = piped ? ::fork() : -1;
    if (child == 0) become(words, pipe[1], complaints, parent);
    if (piped) ::close(pipe[1]);
    if (complaints >= 0) ::close(complaints);
    if (child < 0) {
      if (piped) ::close(pipe[0]);
      throw bad_input("mpirun cannot be started", "free some memory");
    }
    process_ = child;
    output_ = pipe[0];
  }

  EngineStatus next(const std::function<Interruption()>& wanted) {
    Interruption asked = Interruption::none;
    while (true) {
      if (const auto line = take_line()) {
        if (const auto news = news_of(*line)) return *news;
        listens_ |= *line == engine_begins;
        continue;
      }
      const Interruption now = listens_ ? wanted() : Interruption::none;
      if (now > asked) ::kill(process_, now == Interruption::stop ? SIGUSR1 : SIGUSR2);
      asked = std::max(asked, now);
      if (!read_more()) throw failure();
    }
  }

  void finish() {
    if (process_ == 0) return;  // happens after a failure; a signal to 0 would reach sinew itself
    ::kill(process_, listens_ ? SIGUSR1 : SIGTERM);  // where there is more to do
    while (read_more()) {
    }
    wait();
  }

 private:
  fs::path errors() const { return folder_.path / "errors.txt"; }

  std::optional<std::string> take_line() {
    const auto end = text_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }

  /// Waits a moment for output; false at its end.
  bool read_more() {
    pollfd ready{output_, POLLIN, 0};
    if (::poll(&ready, 1, asked_every) <= 0) return true;  // a signal, too, is a reason to ask
    std::array<char, 4096> part;
    const ssize_t got = ::read(output_, part.data(), part.size());
    if (got > 0) text_.append(part.data(), static_cast<std::size_t>(got));
    return got > 0 || (got < 0 && errno == EINTR);
  }

  /// Its exit code. Ranks that mpirun does not get to end lose it, and end by that.
  int wait() {
    int status = 0;
    for (int waited = 0; ::waitpid(process_, &status, WNOHANG) == 0; ++waited) {
      if (waited == patience / asked_every) ::kill(process_, SIGKILL);
      ::usleep(1000 * asked_every);
    }
    ::close(output_);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  /// Why the ranks have ended: their own words, LAMMPS's, or mpirun's.
  Error failure() {
    const int code = wait();
    const std::string own = line_with(errors(), "sinew: ");
    if (!own.empty()) {
      const bool known = code == static_cast<int>(Exit::not_written);
      return Error(known ? Exit::not_written : Exit::bad_input, own.substr(7));
    }
    std::string why = line_with(folder_.log(), "ERROR");
    if (why.empty()) why = sentence_with(errors(), "process rank");
    if (why.empty() && listens_ && !line_with(errors(), "RTE ").empty())  // ORTE, or PRTE
      why = "a host, or the network to it, does not answer any more";
    if (why.empty()) why = first_words(errors());
    if (why.empty()) why = "mpirun ended with code " + std::to_string(code);
    while (!why.empty() && (why.back() == '.' || why.back() == ' ')) why.pop_back();
    return bad_input("LAMMPS ended before the run did: " + why,
                     "go on with --resume; " + folder_.path.string() + " has what it said");
  }

  EngineOptions options_;
  int ranks_;
  EngineFolder folder_;
  pid_t process_ = 0;  ///< never below: a signal to -1 reaches all processes
  int output_ = -1;
  std::string text_;
  bool listens_ = false;  ///< to signals, which would end it before
};

void check_installed() {
  if (::access(program_of_engine().c_str(), X_OK) != 0)
    throw bad_input(Place{program_of_engine().string()},
                    "was not built, because LAMMPS was missing",
                    "install it (Debian: apt-get install liblammps-dev) and build again");
  if (!is_in_path("mpirun"))
    throw bad_input("mpirun is not installed", "install it (Debian: apt-get install openmpi-bin)");
}

/// Checks the memory of ranks on this machine, each of which is a process with LAMMPS in it.
void check_memory(int ranks, int cores) {
  constexpr double bytes_per_rank = 60e6;
  const double needed = ranks * bytes_per_rank, available = available_memory();
  if (needed > available)
    throw bad_input(std::to_string(ranks) + " ranks on this machine take about " +
                        bytes_text(needed) + " of memory, " + bytes_text(available) + " are free",
                    "give one for each of its " + std::to_string(cores) +
                        " cores, or more machines with --hosts");
}

}  // namespace

void declare(OptionList& list, EngineOptions& options) {
  list.add("--engine", options.engine, "Who makes the steps: built-in, or lammps on many machines")
      .type_name("NAME");
  list.add("--ranks", options.ranks, "Processes of --engine lammps; by default one per core")
      .type_name("N")
      .positive();
  list.add("--hosts", options.hosts, "Hosts of the ranks, as a host file of mpirun")
      .type_name("FILE");
  list.add_flag("--gather", options.gather,
                "Particles of a frame in one file, not in one of each rank");
}

std::vector<std::string> words_of(const EngineOptions& options) {
  std::vector<std::string> words;
  if (options.chosen()) words.insert(words.end(), {"--engine", options.engine});
  if (options.ranks > 0) words.insert(words.end(), {"--ranks", std::to_string(options.ranks)});
  if (!options.hosts.empty()) words.insert(words.end(), {"--hosts", options.hosts});
  if (options.gather) words.push_back("--gather");
  return words;
}

std::optional<Engine> engine_of(const EngineOptions& options) {
  if (!options.chosen()) {
    if (options.ranks > 0 || !options.hosts.empty() || options.gather)
      throw bad_input("--ranks, --hosts and --gather are of --engine lammps",
                      "add it, or leave them out");
    return std::nullopt;
  }
  if (options.engine != "lammps")
    throw bad_input("there is no engine " + shown(options.engine), "choose built-in or lammps");
  if (!options.hosts.empty() && !fs::exists(options.hosts))
    throw bad_input(Place{options.hosts}, "is missing",
                    "write a line 'HOST slots=CORES' for each host into it");
  check_installed();
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int ranks = options.ranks > 0 ? options.ranks : cores;
  if (options.hosts.empty() && !is_managed()) check_memory(ranks, cores);
  const auto process = std::make_shared<EngineProcess>(options, ranks);
  return Engine{options.engine,
                ranks,
                options.gather,
                [process](const EngineFolder& folder) { process->start(folder); },
                [process](const auto& wanted) { return process->next(wanted); },
                [process] { process->finish(); }};
}

}  // namespace sinew
