// SPDX-License-Identifier: GPL-3.0-or-later
// The closed list of errors, and their exit codes.
//
//     throw bad_input(place, "the radius is negative", "give a radius > 0");
#pragma once

#include <stdexcept>
#include <string>

namespace sinew {

/// The exit code of a command. Scripts rely on these numbers.
enum class Exit {
  done = 0,
  limit_passed = 1,   ///< a --fail-on limit was passed
  bad_input = 2,      ///< a file, a setting or the command line is wrong
  unstable = 3,       ///< the simulation became unstable
  not_written = 4,    ///< output could not be written
  interrupted = 130,  ///< stopped by the user
};

/// A place in a text file; line and column count from 1, 0 when unknown.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;

  /// "FILE:LINE:COLUMN", shorter where parts are unknown, "" for no file.
  std::string text() const;
};

/// One line for the user: where, what is wrong, and what to do about it.
class Error : public std::runtime_error {
 public:
  /// A NUL of the message, as names from damaged files may have, would end it: it becomes '?'.
  Error(Exit exit, const std::string& message);

  Exit exit() const { return exit_; }

  /// The same error with a `place` before it (a scene's line that names a bad mesh), unless it
  /// begins with a place in that file already.
  Error with_context(const Place& place) const;

  /// The key of the invalid value of a description, such as "bones[1].tail"; "" without one.
  const std::string& key() const { return key_; }
  Error about(std::string key) const;

 private:
  Exit exit_;
  std::string file_;  ///< file of the place before the message
  std::string key_;
};

/// "PLACE: what; cure", exit code 2.
Error bad_input(const Place& place, const std::string& what, const std::string& cure);
Error bad_input(const std::string& what, const std::string& cure);

/// An invalid value of a description, by its key: "what; cure", exit code 2.
Error bad_value(const std::string& key, const std::string& what, const std::string& cure);

/// "PATH: what; cure", exit code 4.
Error not_written(const std::string& path, const std::string& what, const std::string& cure);

}  // namespace sinew
