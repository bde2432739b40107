// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a command. CLI11 parses them; only option_list.cpp and command.cpp include it,
// because every source that does takes seconds longer to compile.
//
//     options.add("--threads", threads, "Threads to use").type_name("N").range(0, 64);
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sinew {

/// One option, whose functions say more about it.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_(&option) {}

  CommandOption& required();
  CommandOption& type_name(const std::string& name);    ///< names its value, in --help
  CommandOption& group(const std::string& heading);     ///< in --help; "" hides it
  CommandOption& show_default();                        ///< in --help
  CommandOption& excludes(const CommandOption& other);  ///< not both may be given
  CommandOption& range(int lowest, int highest);        ///< limits its value
  CommandOption& positive();                            ///< its value is
  CommandOption& expected(int count);                   ///< so many values
  CommandOption& expected(int fewest, int most);        ///< so many values
  CommandOption& comma_separated();                     ///< its values are one argument
  CommandOption& repeatable();                          ///< with one value each time

  bool given() const;

 private:
  CLI::Option* option_;
};

/// What an option's value is stored in.
using OptionTarget =
    std::variant<std::string*, int*, double*, std::vector<std::string>*, std::vector<double>*,
                 std::vector<int>*, std::optional<std::string>*, std::optional<double>*>;

class OptionList {
 public:
  explicit OptionList(CLI::App& app) : app_(&app) {}

  /// Named "--radius", or "FILE" for a positional argument. The target must outlive the parsing.
  template <typename T>
  CommandOption add(const std::string& name, T& target, const std::string& help = "") {
    return add_target(name, &target, help);
  }

  CommandOption add_flag(const std::string& name, bool& target, const std::string& help);
  /// Without a target: see CommandOption::given().
  CommandOption add_flag(const std::string& name, const std::string& help);

 private:
  CommandOption add_target(const std::string& name, OptionTarget target, const std::string& help);

  CLI::App* app_;
};

}  // namespace sinew
