// SPDX-License-Identifier: GPL-3.0-or-later
// Work that other threads of Python need not wait for.
//
//     const WithoutGil free;       // in a block: the lock is taken again at its end
//     simulation.step();
//
// Python leaves while threads of its own may still be at work here. One that then takes the lock is
// ended by Python in the midst of C++, which aborts: after the interpreter has begun to leave, a
// thread that would take it waits instead for the end of the process.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

namespace sinew::python {

namespace py = pybind11;

/// Whether Python has begun to leave.
inline std::atomic<bool> leaving = false;

class WithoutGil {
 public:
  WithoutGil() {
    ++at_work;
    released_.emplace();
  }
  ~WithoutGil() {  // NOLINT(bugprone-exception-escape): waiting and taking the lock throw nothing
    if (leaving) stay();
    released_.reset();
    --at_work;
  }
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

  /// Returns once all threads at work have come back to Python or stay here.
  static void let_all_end() {
    leaving = true;
    const py::gil_scoped_release release;
    while (at_work > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

 private:
  [[noreturn]] static void stay() {
    --at_work;
    while (true) std::this_thread::sleep_for(std::chrono::hours(1));
  }

  inline static std::atomic<int> at_work = 0;
  std::optional<py::gil_scoped_release> released_;
};

/// What long work without the lock asks Python meanwhile: whether Ctrl-C was pressed, and a
/// callback of progress, which may end the work by an exception.
class Listener {
 public:
  explicit Listener(py::object progress = py::none()) : progress_(std::move(progress)) {
    const auto main = py::module_::import("threading").attr("main_thread")().attr("ident");
    hears_signals_ = main.cast<unsigned long>() == PyThread_get_thread_ident();
  }

  /// Whether the work is to end; asked after every step.
  bool ended() {
    const auto now = std::chrono::steady_clock::now();
    if (leaving || failed_) return true;
    if (!hears_signals_ || now - asked_ < std::chrono::milliseconds(50)) return false;
    asked_ = now;
    const py::gil_scoped_acquire acquire;
    return failed_ = PyErr_CheckSignals() != 0;
  }
  void report(std::size_t done, std::size_t of) {
    if (leaving || failed_ || progress_.is_none()) return;
    const py::gil_scoped_acquire acquire;
    try {
      progress_(done, of);
    } catch (py::error_already_set& thrown) {
      thrown.restore();
      failed_ = true;
    }
  }
  /// Raises the exception that has ended the work, if one has. The caller holds the lock.
  void raise() const {
    if (failed_) throw py::error_already_set();
  }

 private:
  py::object progress_;
  bool hears_signals_ = false, failed_ = false;
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

}  // namespace sinew::python
