// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/paraview/view_script.h>

#include "support/scratch.h"

namespace sinew::view_script_test {

using ViewScript = Scratch;

TEST_F(ViewScript, KnowsTheFolderItWasLeftIn) {
  const auto odd = folder / "a \"run\" \\ of Ärms";
  std::filesystem::create_directories(odd);
  write_view_script(odd);
  for (const char* name : {"view.py", "live.py"}) {
    const std::string text = text_of(odd / name);
    EXPECT_TRUE(contains(text, "a \\\"run\\\" \\\\ of Ärms\"\n")) << name;
    EXPECT_TRUE(contains(text, "Point Gaussian")) << name;  // it is whole: what both share is there
    EXPECT_FALSE(contains(text, "from look")) << name;
  }
}

}  // namespace sinew::view_script_test
