// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-tables NAME: prints a table of the README as Markdown. For developers; not installed.
#include <string>

#include "command.h"
#include "io/arrays.h"
#include "metrics/table.h"
#include "results.h"
#include "settings_list.h"

namespace {

using namespace sinew;

std::string arrays_markdown() {
  std::string text =
      "| series | on | array | components | unit | meaning |\n|---|---|---|---|---|---|\n";
  for (const WrittenArray& array : written_arrays()) {
    std::string components;
    const std::string place(place_text(array.place));
    for (const std::string_view name : array.components)
      components += (components.empty() ? "" : " ") + std::string(name);
    for (const std::string_view cell : {array.series, std::string_view(place), array.name,
                                        std::string_view(components), array.unit, array.help})
      text.append("| ").append(cell).append(" ");
    text += "|\n";
  }
  return text;
}

std::string table_named(const std::string& name) {
  if (name == "settings") return settings_markdown();
  if (name == "arrays") return arrays_markdown();
  if (name == "metrics") return metrics_markdown();
  throw bad_input("no table is named '" + name + "'",
                  "write sinew-tables settings, arrays or metrics");
}

}  // namespace

int main(int argc, char** argv) {
  return run_told([&] {
    print_out(table_named(argc == 2 ? argv[1] : ""));
    return Exit::done;
  });
}
