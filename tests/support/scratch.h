// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of its own for each test, and small looks into files.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <sinew/core/error.h>

#include "support/temp_folder.h"

namespace sinew {

class Scratch : public testing::Test {
 protected:
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
  }

 private:
  TempFolder own_;

 protected:
  std::filesystem::path folder = own_.path();
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void put(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A file of that size which begins with `text`, followed by zeros that take no space on the disk.
inline void put_sparse(const std::filesystem::path& path, const std::string& text,
                       std::uintmax_t size) {
  put(path, text);
  std::filesystem::resize_file(path, size);
}

/// Returns how much `job` has raised the largest memory of this process so far, bytes.
template <class Job>
double raised_memory(Job&& job) {
  const auto peak = [] {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
  };
  const double before = peak();
  job();
  return peak() - before;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The error `job` throws; fails the test when it throws none.
template <class Job>
Error error_of(Job&& job) {
  try {
    job();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error was thrown";
  return {Exit::done, ""};
}

}  // namespace sinew
