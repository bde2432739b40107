// SPDX-License-Identifier: GPL-3.0-or-later
// What VTK would print on the console, caught for the calling thread.
#pragma once

#include <string>

namespace sinew {

/// From construction to destruction the errors and warnings VTK raises in this thread are kept
/// here.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  bool failed() const { return !first_error_.empty(); }
  /// The first error in one line, without VTK's file names and addresses; "" when there was none.
  const std::string& first_error() const { return first_error_; }
  void add_error(const std::string& text);

 private:
  std::string first_error_;
  VtkMessages* outer_;
};

}  // namespace sinew
