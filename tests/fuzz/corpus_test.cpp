// SPDX-License-Identifier: GPL-3.0-or-later
// Each target with its seeds and what fuzzing has found, and with pieces of them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "support/source_dir.h"
#include "targets.h"

namespace sinew::fuzz {
namespace {

class Corpus : public testing::TestWithParam<Target> {};

TEST_P(Corpus, IsSoundOrRefused) {
  const auto folder =
      std::filesystem::path(test::source_dir()) / "tests/fuzz/corpus" / GetParam().name;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ostringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    const std::string bytes = text.str();
    SCOPED_TRACE(entry.path());
    GetParam().try_one(bytes);
    for (std::size_t part = 0; part < 16; ++part)
      GetParam().try_one(std::string_view(bytes).substr(0, bytes.size() * part / 16));
    ++files;
  }
  EXPECT_GT(files, 0);
}

INSTANTIATE_TEST_SUITE_P(Of, Corpus, testing::ValuesIn(tried_targets()),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace sinew::fuzz
