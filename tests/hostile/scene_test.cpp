// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of mistake in a scene ends with exit code 2 and one line that names file, line, column
// and cure; never with a crash.
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>
#include <sinew/settings/read_scene.h>

#include <gtest/gtest.h>

#include <random>

#include <sinew/rig/motion.h>
#include <sinew/settings/table.h>
#include "hostile/scenes.h"
#include "settings/small_scene.h"
#include "support/scratch.h"
#include "support/temp_folder.h"

namespace sinew::scene_test {

/// What reading the file and building its rig says; "" when nothing is wrong.
std::string verdict(const std::filesystem::path& file) {
  try {
    const Settings settings = read_scene(file);
    motion_of(settings, skeleton_of(settings));
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::bad_input);
    return error.what();
  }
  return "";
}

void expect_one_line(const std::string& message, const std::string& file) {
  EXPECT_EQ(message.substr(0, file.size() + 1), file + ':');
  EXPECT_NE(message.find("; "), message.npos) << message;
  EXPECT_LT(message.size(), file.size() + 400) << message;
  for (const char c : message) EXPECT_FALSE(std::iscntrl(static_cast<unsigned char>(c))) << message;
}

class HostileScene : public testing::TestWithParam<Hostile> {};

TEST_P(HostileScene, IsRefusedInOneLine) {
  const TempFolder folder;
  const auto file = folder.write("scene.yaml", GetParam().text);
  const std::string message = verdict(file);
  expect_one_line(message, file.string());
  const std::string& place = GetParam().place;
  EXPECT_NE(message.find(GetParam().part), message.npos) << message;
  if (!place.empty()) {
    EXPECT_EQ(message.substr(0, message.find(": ")), file.string() + ':' + place) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(All, HostileScene, testing::ValuesIn(scenes),
                         [](const auto& scene) { return std::string(scene.param.name); });

TEST(HostileScenes, MissingFileAndFolderAreNamed) {
  const TempFolder folder;
  expect_one_line(verdict(folder.path() / "none.yaml"), (folder.path() / "none.yaml").string());
  expect_one_line(verdict(folder.path()), folder.path().string());
  expect_one_line(verdict("/dev/zero"), "/dev/zero");
}

/// Filling may take minutes; this mesh cannot even be filled.
TEST(HostileScenes, FilesAreReadBeforeTheBodyIsFilled) {
  const TempFolder folder;
  folder.write("box.obj",
               "v 0 0 0\nv 0.001 0 0\nv 0 0.001 0\nv 0 0 0.001\n"
               "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const auto message_with = [&](const std::string& more) {
    const Settings settings = read_scene(folder.write("scene.yaml", small_scene + more));
    return std::string(error_of([&] { prepare({settings}); }).what());
  };
  EXPECT_EQ(message_with("").find("none."), std::string::npos) << message_with("");
  for (const char* more : {"motion:\n  file: none.bvh\n",
                           "world:\n  obstacles: [{name: rock, shape: mesh, mesh: none.obj}]\n"}) {
    const std::string message = message_with(more);
    EXPECT_NE(message.find("none."), std::string::npos) << message;
  }
}

TEST(HostileScenes, EverySettingRefusesWhatIsNoValueOfIt) {
  const TempFolder folder;
  for (const auto& row : settings_table())
    for (const char* value : {".nan", "[.nan, .nan, .nan]", "{a: 1}", "", "[]", "1e999", "\"\""}) {
      const bool word = row.kind == FieldKind::text || row.kind == FieldKind::path;
      if (word && (value == std::string(".nan") || value == std::string("1e999"))) continue;
      const std::string section(row.section), name(row.name);
      const std::string rest =
          section == "body" ? small_scene.substr(small_scene.find("skeleton")) : small_scene;
      const auto file =
          folder.write("scene.yaml", section + ":\n  " + name + ": " + value + "\n" + rest);
      SCOPED_TRACE(section + '.' + name + ": " + value);
      expect_one_line(verdict(file), file.string());
    }
}

TEST(HostileScenes, RandomDamageIsReadOrRefused) {
  const TempFolder folder;
  const std::string whole =
      motion("      keys:\n        - {time: 0}\n        - {time: 1, twist: 9}\n");
  const std::string pieces = "[]{}:,-?*&!|>'\"%@`#~ \n\t\\0a.\xff";
  std::mt19937 random(7);
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  for (int i = 0; i < 1000; ++i) {
    std::string text = whole;
    for (std::size_t k = 0; k <= below(4); ++k) {
      const std::size_t at = below(text.size());
      if (below(2) == 0)
        text[at] = pieces[below(pieces.size())];
      else
        text.insert(at, 1, pieces[below(pieces.size())]);
    }
    const auto file = folder.write("scene.yaml", text);
    const std::string message = verdict(file);
    if (!message.empty()) expect_one_line(message, file.string());
    if (testing::Test::HasFailure()) FAIL() << text;
  }
}

}  // namespace sinew::scene_test
