// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/sweep_runner.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <deque>
#include <filesystem>
#include <memory>
#include <numeric>
#include <thread>

#include <sinew/core/file.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/core/threads.h>
#include <sinew/scene/check/needs.h>
#include <sinew/scene/prepare.h>
#include <sinew/study/sweep/sweep_table.h>
#include "command/child.h"
#include "command/drawing.h"
#include "command/progress.h"
#include "command/results.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

/// The last line of what a program said, without its name.
std::string last_words(const fs::path& file) {
  constexpr std::uint64_t largest = std::uint64_t{1} << 24;
  constexpr std::string_view name = "sinew: ";
  std::string text = fs::exists(file) ? read_file(file, largest) : "";
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::string line = text.substr(text.rfind('\n') + 1);
  if (line.starts_with(name)) line.erase(0, name.size());
  return printable(line);
}

class Runner {
 public:
  Runner(const Sweep& sweep, const std::vector<std::size_t>& numbers,
         const std::vector<Foreseen>& foreseen, const RunnerOptions& how, const Common& common)
      : sweep_(sweep),
        foreseen_(foreseen),
        how_(how),
        waiting_(numbers.begin(), numbers.end()),
        count_(numbers.size()),
        line_(progress_style(common.quiet), stderr) {
    for (const std::size_t number : numbers) all_ += foreseen[number].seconds;
    // The longest first: none is left alone at the end.
    std::stable_sort(waiting_.begin(), waiting_.end(), [&](std::size_t a, std::size_t b) {
      return foreseen[a].seconds > foreseen[b].seconds;
    });
    if (how.together) stages_ = {"simulate"};
    if (draws && (sweep.file.pictures || sweep.file.movie))
      stages_.insert(stages_.begin() + 1, "render");
  }

  Exit run() {
    constexpr std::chrono::milliseconds pause{5};
    catch_stop_signals();
    while (!waiting_.empty() || !working_.empty()) {
      if (stop_requested()) end_all(Exit::interrupted);
      while (may_start() && start()) {
      }
      for (std::size_t k = 0; k < working_.size();) look_at(k);
      if (line_.style() == ProgressStyle::rewritten)
        line_.rewrite(progress(working_.size()), working_.empty());
      std::this_thread::sleep_for(pause);
    }
    return exit_;
  }

 private:
  struct Work {
    std::size_t number;
    std::size_t stage;
    std::unique_ptr<Helper> program;
    Stopwatch watch;
    double seconds = 0;
    bool is_late = false;
    bool anew = false;  ///< what lies there failed, is of other files, or lacks frames
  };

  const SweepRun& run_of(const Work& work) const { return sweep_.runs[work.number]; }
  fs::path folder_of(const Work& work) const { return sweep_.folder_of(run_of(work)).path; }
  fs::path errors_of(const Work& work) const { return folder_of(work) / ".sweep.err"; }

  bool may_start() const {
    if (exit_ != Exit::done || waiting_.empty()) return false;
    if (static_cast<int>(working_.size()) >= how_.jobs) return false;
    const auto memory = static_cast<double>(foreseen_[waiting_.front()].memory);
    return working_.empty() || memory_ + memory <= how_.memory;
  }

  /// Programs of a sweep that was killed finish their frames: whoever still works in a folder is
  /// waited for, and the next run is tried.
  bool is_free(const RunFolder& folder) const {
    try {
      const FolderLock lock(folder);
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  /// Returns whether the first of those that wait was started, or else put behind the others.
  bool start() {
    Work work{waiting_.front(), 0, nullptr, {}};
    waiting_.pop_front();
    if (fs::exists(folder_of(work)) && !is_free({folder_of(work)})) {
      waiting_.push_back(work.number);
      return false;
    }
    work.anew = how_.force || state_of(sweep_, run_of(work)).status != RunStatus::missing ||
                (!how_.together && lacks_frames(sweep_.folder_of(run_of(work))));
    forget_state(sweep_, run_of(work));
    memory_ += static_cast<double>(foreseen_[work.number].memory);
    create_folder(folder_of(work));
    begin(work);
    working_.push_back(std::move(work));
    return true;
  }

  void begin(Work& work) {
    const std::string& command = stages_[work.stage];
    std::vector<std::string> words = {"--quiet", "--threads", std::to_string(how_.threads)};
    if (command == "simulate") {
      const RunFolder folder = sweep_.folder_of(run_of(work));
      for (const Override& one : run_of(work).overrides)
        words.insert(words.end(), {"--set", one.path + '=' + one.value});
      if (folder.used()) words.push_back(work.anew ? "--force" : "--resume");
      words.insert(words.end(), {"-o", folder.path.string(), "--", sweep_.file.scene.string()});
    } else {
      if (command == "render" && !sweep_.file.movie) words.push_back("--no-movie");
      if (command == "render" && !sweep_.file.pictures) words.push_back("--no-pictures");
      words.insert(words.end(), {"--", folder_of(work).string()});
    }
    work.program = std::make_unique<Helper>(command, words, errors_of(work).string());
  }

  void look_at(std::size_t& k) {
    Work& work = working_[k];
    work.seconds += work.watch.lap();
    if (how_.timeout > 0 && work.seconds > how_.timeout && !work.is_late) {
      work.is_late = true;
      work.program->end(SIGKILL);
    }
    const auto end = work.program->ended();
    if (!end) return void(++k);
    if (end->exit == 0 && work.stage + 1 < stages_.size() && exit_ == Exit::done) {
      ++work.stage;
      return begin(work);
    }
    conclude(work, end->exit);
    memory_ -= static_cast<double>(foreseen_[work.number].memory);
    working_.erase(working_.begin() + static_cast<std::ptrdiff_t>(k));
  }

  void conclude(const Work& work, int exit) {
    const auto is = [exit](Exit one) { return exit == static_cast<int>(one); };
    if (exit_ != Exit::done &&
        (is(Exit::interrupted) || exit >= 128 || work.stage + 1 < stages_.size()))
      return;  // it goes on next time
    if (is(Exit::not_written) || (how_.together && exit != 0)) {
      const Exit code = exit_of("simulate", {exit, ""});
      print_error("sinew: " + reason_of(work, exit));
      fs::remove(errors_of(work));
      return end_all(code);
    }
    RunState state{RunStatus::finished, "", work.seconds, run_of(work).files, version()};
    if (exit != 0) state = {RunStatus::failed, reason_of(work, exit), work.seconds, "", version()};
    fs::remove(errors_of(work));
    if (!how_.together) write_state(sweep_, run_of(work), state);
    if (exit == 0 && sweep_.file.keep != KeptFrames::all)
      remove_frames(sweep_.folder_of(run_of(work)), KeptFrames::last);
    tell(work, state);
  }

  std::string reason_of(const Work& work, int exit) const {
    if (work.is_late) return "took over " + number_text(how_.timeout) + " s";
    if (exit == 128 + SIGKILL) return "was killed: memory may have run out";
    if (exit > 128) return "was ended by signal " + std::to_string(exit - 128);
    const std::string words = last_words(errors_of(work));
    return words.empty() ? "ended with code " + std::to_string(exit) : words;
  }

  std::string progress(std::size_t running) {
    elapsed_ += watch_.lap();
    std::string text = std::to_string(done_) + " of " + std::to_string(count_) + " runs done, " +
                       std::to_string(running) + " running";
    if (failed_ > 0) text += ", " + std::to_string(failed_) + " failed";
    const double left = told_ > 0 ? elapsed_ * (all_ - told_) / told_ : how_.seconds - elapsed_;
    if (left > 0) text += "  " + duration_text(left) + " left";
    return text;
  }

  void tell(const Work& work, const RunState& state) {
    ++(state.status == RunStatus::finished ? done_ : failed_);
    told_ += foreseen_[work.number].seconds;
    const std::string text = progress(working_.size() - 1);
    log(run_of(work).name + ": " + std::string(word_of(state.status)) + ' ' + state.reason);
    log(text);
    if (line_.style() == ProgressStyle::lines) line_.add(text);
    if (state.status == RunStatus::failed && line_.style() != ProgressStyle::none)
      line_.add("failed: " + run_of(work).name + ": " + state.reason);
  }

  /// Appends a line to sweep.log, which runs that belong together have not.
  void log(const std::string& line) const {
    if (how_.together) return;
    const fs::path path = sweep_.folder / "sweep.log";
    std::error_code none;
    const auto size = fs::file_size(path, none);
    GrowingFile file(path, none ? 0 : size);
    const std::string text =
        sinew::time_text("%Y-%m-%d %H:%M:%S", Zone::local) + "  " + line + '\n';
    file.add(text.data(), text.size());
    file.close();
  }

  void end_all(Exit exit) {
    if (exit_ != Exit::done) return;
    exit_ = exit;
    waiting_.clear();
    for (Work& work : working_) work.program->end(SIGTERM);
  }

  const Sweep& sweep_;
  const std::vector<Foreseen>& foreseen_;
  RunnerOptions how_;
  std::vector<std::string> stages_ = {"simulate", "measure"};
  std::deque<std::size_t> waiting_;
  std::vector<Work> working_;
  std::size_t count_, done_ = 0, failed_ = 0;
  double memory_ = 0, all_ = 0, told_ = 0, elapsed_ = 0;
  Stopwatch watch_;
  ProgressLine line_;
  Exit exit_ = Exit::done;
};

/// Sums up the largest ones of some values.
double sum_of_largest(std::vector<double> values, std::size_t count) {
  std::sort(values.rbegin(), values.rend());
  values.resize(std::min(values.size(), count));
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Wall time of runs, the longest first, on so many threads each.
double foreseen_end(std::vector<double> seconds, int jobs, int threads) {
  constexpr double gain = 0.8;  // exponent: two threads are as fast as 1.7 runs
  std::sort(seconds.rbegin(), seconds.rend());
  std::vector<double> ends(static_cast<std::size_t>(jobs));
  for (const double one : seconds)
    *std::min_element(ends.begin(), ends.end()) += one / std::pow(threads, gain);
  return *std::max_element(ends.begin(), ends.end());
}

}  // namespace

Foreseen Forecast::of(Settings settings) {
  settings.material.damping_ratio.reset();  // modes, for which it asks, take longer than runs
  constexpr double of_run = 0.6, of_frame = 0.015, of_measuring = 2e-6;  // s
  constexpr std::size_t max_bodies = 16;                                 // held in memory
  const std::string origin = origin_of(settings);
  const auto known = bodies_.find(origin);
  const bool is_known = known != bodies_.end();
  const Prepared prepared =
      prepare({settings, is_known ? std::optional(known->second) : std::nullopt});
  if (!is_known && bodies_.size() == max_bodies) bodies_.clear();
  if (!is_known) bodies_.emplace(origin, prepared.filled);
  const Needs needs = needs_of(prepared);
  Foreseen out;
  out.particles = prepared.filled.particles.size();
  out.steps = prepared.plan.steps_until(prepared.frames.count);
  out.memory = needs.memory, out.disk = needs.disk;
  const auto particles = static_cast<double>(out.particles);
  out.seconds = of_run +
                static_cast<double>(out.steps) * particles /
                    speed_in_motion(prepared, usual_speed(stepper_choice(settings.solver))) +
                prepared.frames.count * (of_frame + of_measuring * particles);
  return out;
}

RunnerOptions packed(const Sweep& sweep, const std::vector<Foreseen>& runs, const Common& common,
                     int jobs, double memory) {
  constexpr double part = 0.8;
  const int cores = common.threads > 0 ? common.threads : threads_allowed();
  std::vector<double> needs, seconds, disk;
  for (const Foreseen& one : runs) {
    needs.push_back(static_cast<double>(one.memory)), seconds.push_back(one.seconds);
    disk.push_back(static_cast<double>(one.disk));
  }
  RunnerOptions best;
  best.memory = memory > 0 ? memory : part * available_memory();
  const int most = std::clamp(static_cast<int>(runs.size()), 1, cores);
  for (int at_once = std::max(1, jobs); at_once <= std::max(most, jobs); ++at_once) {
    RunnerOptions how{at_once, std::max(1, cores / at_once), best.memory};
    const auto together = static_cast<std::size_t>(at_once);
    how.needed = sum_of_largest(needs, together);
    how.seconds = foreseen_end(seconds, std::min(at_once, cores), how.threads);
    how.disk = sum_of_largest(disk, sweep.file.keep == KeptFrames::all ? runs.size() : together);
    const bool first = best.seconds == 0;
    if (first || (how.needed <= how.memory && how.seconds < best.seconds)) best = how;
    if (jobs > 0) break;
  }
  return best;
}

std::string plan_text(const Sweep& sweep, std::size_t runs, const RunnerOptions& how) {
  return std::to_string(runs) + " runs of " + std::to_string(sweep.runs.size()) +
         " to do: " + duration_text(how.seconds) + " with " + std::to_string(how.jobs) +
         " at a time, " + bytes_text(how.needed) + " of memory, " + bytes_text(how.disk) +
         " of disk";
}

Exit run_all(const Sweep& sweep, const std::vector<std::size_t>& numbers,
             const std::vector<Foreseen>& foreseen, const RunnerOptions& how,
             const Common& common) {
  return Runner(sweep, numbers, foreseen, how, common).run();
}

}  // namespace sinew
