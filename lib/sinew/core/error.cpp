// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/error.h>

#include <algorithm>
#include <utility>

namespace sinew {
namespace {

std::string without_nul(std::string text) {
  std::replace(text.begin(), text.end(), '\0', '?');
  return text;
}

}  // namespace

Error::Error(Exit exit, const std::string& message)
    : std::runtime_error(without_nul(message)), exit_(exit) {}

std::string Place::text() const {
  std::string text = file;
  if (!file.empty() && line > 0) text += ':' + std::to_string(line);
  if (!file.empty() && line > 0 && column > 0) text += ':' + std::to_string(column);
  return text;
}

Error Error::with_context(const Place& place) const {
  const std::string where = place.text();
  if (where.empty() || place.file == file_) return *this;
  Error error(exit_, where + ": " + what());
  error.file_ = place.file;
  return error;
}

Error Error::about(std::string key) const {
  Error error = *this;
  error.key_ = std::move(key);
  return error;
}

Error bad_input(const Place& place, const std::string& what, const std::string& cure) {
  return bad_input(what, cure).with_context(place);
}

Error bad_input(const std::string& what, const std::string& cure) {
  return Error(Exit::bad_input, what + "; " + cure);
}

Error bad_value(const std::string& key, const std::string& what, const std::string& cure) {
  return bad_input(what, cure).about(key);
}

Error not_written(const std::string& path, const std::string& what, const std::string& cure) {
  return Error(Exit::not_written, path + ": " + what + "; " + cure);
}

}  // namespace sinew
