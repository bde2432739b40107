// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/option_list.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>

#include <sinew/core/text.h>

namespace sinew {

CommandOption& CommandOption::required() {
  option_->required();
  return *this;
}

CommandOption& CommandOption::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

CommandOption& CommandOption::group(const std::string& heading) {
  option_->group(heading);
  return *this;
}

CommandOption& CommandOption::show_default() {
  option_->capture_default_str();
  return *this;
}

CommandOption& CommandOption::excludes(const CommandOption& other) {
  option_->excludes(other.option_);
  return *this;
}

CommandOption& CommandOption::range(int lowest, int highest) {
  option_->check(CLI::Range(lowest, highest));
  return *this;
}

CommandOption& CommandOption::positive() {
  option_->check(
      [](const std::string& text) {
        double value = 0;
        const char* const end = text.data() + text.size();
        const auto read = std::from_chars(text.data(), end, value);
        const bool good = read.ec == std::errc() && read.ptr == end && value > 0 && value <= 1e300;
        return good ? "" : shown(text) + " is no positive number";
      },
      "POSITIVE");
  return *this;
}

CommandOption& CommandOption::expected(int count) {
  option_->expected(count);
  return *this;
}

CommandOption& CommandOption::expected(int fewest, int most) {
  option_->expected(fewest, most);
  return *this;
}

CommandOption& CommandOption::comma_separated() {
  option_->delimiter(',')->allow_extra_args(false);
  return *this;
}

CommandOption& CommandOption::repeatable() {
  option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

bool CommandOption::given() const { return option_->count() > 0; }

CommandOption OptionList::add_target(const std::string& name, OptionTarget target,
                                     const std::string& help) {
  return std::visit(
      [&](auto* value) { return CommandOption(*app_->add_option(name, *value, help)); }, target);
}

CommandOption OptionList::add_flag(const std::string& name, bool& target, const std::string& help) {
  return CommandOption(*app_->add_flag(name, target, help));
}

CommandOption OptionList::add_flag(const std::string& name, const std::string& help) {
  return CommandOption(*app_->add_flag_function(
      name, [](std::int64_t) {}, help));
}

}  // namespace sinew
