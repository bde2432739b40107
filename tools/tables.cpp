// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-tables NAME: prints a table of the README as Markdown. For developers; not installed.
#include <string>

#include "command.h"
#include "results.h"
#include "settings_list.h"

int main(int argc, char** argv) {
  using namespace sinew;
  return run_told([&] {
    const std::string name = argc == 2 ? argv[1] : "";
    if (name != "settings")
      throw bad_input("no table is named '" + name + "'", "write sinew-tables settings");
    print_out(settings_markdown());
    return Exit::done;
  });
}
