// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/command.h"

#include <fcntl.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>

#include <sinew/core/parallel.h>
#include <sinew/core/text.h>
#include "command/child.h"
#include "command/results.h"
#include "command/settings_list.h"
#include "command/terminal.h"

namespace sinew {
namespace {

constexpr int max_threads = 1024;

struct HelpOfSettings {};  ///< thrown where it is asked for
struct Completions {};     ///< the same

/// The variables that options are parsed into.
struct Given {
  Common common;
  std::vector<std::string> sets;
};

std::string help_footer(const About& about) {
  std::string text = "\nExamples:\n";
  for (const std::string& example : about.examples) text += "  " + example + '\n';
  if (about.takes_scene)
    text += "\nKeys of a scene, for --set too: sinew " + about.name + " --help-settings\n";
  return text;
}

void declare_common(CLI::App& app, const About& about, Given& given) {
  app.set_help_flag("-h,--help", "Show this help and exit");
  app.set_version_flag("--version", "sinew " + version(), "Show the version and exit");
  OptionList list(app);
  list.add_flag("--quiet", given.common.quiet, "Print results only: no progress, no messages");
  list.add_flag("--json", given.common.json, "Print the results as one JSON object");
  list.add_flag("--verbose", given.common.verbose, "Print all results, with all their digits");
  list.add("--threads", given.common.threads, "Threads to use; 0: one per core")
      .type_name("N")
      .range(0, max_threads);
  app.add_flag_callback("--completions", [] { throw Completions(); })
      ->trigger_on_parse()
      ->group("");
  if (!about.takes_scene) return;
  app.add_flag_callback(
         "--help-settings", [] { throw HelpOfSettings(); }, "Show the keys of a scene and exit")
      ->trigger_on_parse();
  list.add("--set", given.sets, "Use this value instead of the scene's; may be repeated")
      .type_name("SECTION.KEY=VALUE")
      .repeatable();
}

/// Lists names of options that the help has.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

Error unknown_option(const CLI::App& app, const std::string& see_help) {
  const auto extras = app.remaining();
  const std::string extra = extras.empty() ? "" : extras.front();
  const std::string word = extra.substr(0, extra.find('='));
  if (word.empty() || word.front() != '-')
    return bad_input("one argument too many: " + shown(extra), see_help);
  const auto names = option_names(app);
  const std::string close =
      nearest(word, std::vector<std::string_view>(names.begin(), names.end()));
  return bad_input("unknown option " + shown(word),
                   close.empty() ? see_help : "did you mean " + close + "?");
}

/// CLI11 ends its sections with up to three empty lines.
std::string with_single_gaps(std::string text) {
  for (auto at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n", at))
    text.erase(at, 1);
  return text;
}

/// Parses the command line. Throws bad input; false where --help or --version was printed.
bool parse(CLI::App& app, int argc, char** argv, const std::string& see_help) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    const bool version_asked = dynamic_cast<const CLI::CallForVersion*>(&asked) != nullptr;
    print_out(version_asked ? std::string(asked.what()) + '\n' : with_single_gaps(app.help()));
    return false;
  } catch (const Completions&) {  // for the shells' scripts in tools/packaging
    for (const std::string& name : option_names(app)) print_out(name + '\n');
    for (const std::string& key : setting_keys()) print_out(key + "=\n");
    return false;
  } catch (const HelpOfSettings&) {
    print_out(settings_help());
    return false;
  } catch (const CLI::ExtrasError&) {
    throw unknown_option(app, see_help);
  } catch (const CLI::ParseError& error) {
    throw bad_input(error.what(), see_help);
  }
  return true;
}

/// Whether it says that it was stopped; of most parts of a run, the run does.
bool says_of_stops(const About& about) { return about.name == "simulate" || !is_part_of_another(); }

Exit parse_and_run(int argc, char** argv, const About& about,
                   const std::function<void(OptionList&)>& declare,
                   const std::function<Exit(const Common&)>& job) {
  CLI::App app(about.purpose, "sinew " + about.name);
  Given given;
  app.option_defaults()->always_capture_default(false);
  app.get_formatter()->column_width(34);
  OptionList list(app);
  declare(list);
  declare_common(app, about, given);
  app.footer(help_footer(about));
  if (!parse(app, argc, argv, "see sinew " + about.name + " --help")) return Exit::done;
  end_at_stop_signals(!given.common.quiet && says_of_stops(about));
  for (const std::string& set : given.sets) given.common.overrides.push_back(parse_override(set));
  Exit exit = Exit::done;
  with_threads(given.common.threads, [&] { exit = job(given.common); });
  return exit;
}

int tell(Exit exit, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  print_error(' ' + message, in_color(TextColor::red, "sinew:", stderr));
  return static_cast<int>(exit);
}

}  // namespace

void open_standard_streams() {
  int file = 0;
  do {
    file = ::open("/dev/null", O_RDWR);
  } while (file >= 0 && file <= STDERR_FILENO);
  if (file > STDERR_FILENO) ::close(file);
}

int run_reporting_errors(const std::function<Exit()>& job) {
  open_standard_streams();
  // SIGXFSZ must not end the program: exceeding a file size limit is an error of the write.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return static_cast<int>(job());
  } catch (const Error& error) {
    return tell(error.exit(), error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return tell(Exit::bad_input, error.path1().string() + ": cannot be reached (" +
                                     error.code().message() + "); check the path");
  } catch (const std::bad_alloc&) {
    return tell(Exit::bad_input, "not enough memory; use fewer particles or a larger machine");
  } catch (const std::exception& error) {
    return tell(Exit::bad_input, std::string("unforeseen: ") + error.what() +
                                     "; please report it with the command and its files");
  }
}

int run_command(int argc, char** argv, const About& about,
                const std::function<void(OptionList&)>& declare,
                const std::function<Exit(const Common&)>& job) {
  return run_reporting_errors([&] {
    end_at_stop_signals(says_of_stops(about));
    return parse_and_run(argc, argv, about, declare, job);
  });
}

void say(const Common& common, const std::string& line) {
  if (common.quiet) return;
  const std::string word = "warning:";
  const std::size_t at = line.find(word);
  if (at == 0 || line.starts_with("sinew: " + word))
    print_error(line.substr(at + word.size()),
                line.substr(0, at) + in_color(TextColor::yellow, word, stderr));
  else
    print_error(line);
}

}  // namespace sinew
