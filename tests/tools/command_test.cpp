// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "command/progress.h"
#include "command/results.h"
#include "command/settings_list.h"
#include "settings/small_scene.h"
#include "tools/run_program.h"

namespace sinew::command_test {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

/// One line, said by sinew.
testing::AssertionResult is_error_line(const std::string& text) {
  const bool one = std::count(text.begin(), text.end(), '\n') == 1 && text.back() == '\n';
  if (one && text.substr(0, 7) == "sinew: " && holds(text, "; "))
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << "not one error line: " << text;
}

struct CommandTest : testing::Test {
  Ran sample(const std::string& arguments) {
    return run(std::string(SAMPLE_COMMAND) + ' ' + arguments);
  }

  TempFolder folder;
  std::string scene = folder.write("scene.yaml", small_scene).string();
};

TEST_F(CommandTest, ResultsAreLinesOnStandardOutput) {
  const Ran ran = sample(scene + " --quiet");
  EXPECT_EQ(ran.exit, 0);
  EXPECT_TRUE(holds(ran.out, "\nbones: 1\nradius: 0.01\n")) << ran.out;
  EXPECT_EQ(ran.err, "");
}

TEST_F(CommandTest, JsonIsOneObjectWithNumbers) {
  const auto object = nlohmann::json::parse(sample(scene + " --json").out);
  EXPECT_EQ(object["bones"], 1);
  EXPECT_EQ(object["radius"], 0.01);
  EXPECT_TRUE(object["mesh"].is_string());
}

TEST_F(CommandTest, SetMayBeRepeated) {
  const Ran ran = sample(scene + " --set body.radius=0.02 --set=solver.gravity='[0, 0, -9.81]'");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_TRUE(holds(ran.out, "radius: 0.02\n")) << ran.out;
}

TEST_F(CommandTest, SetLeavesTheSceneToItsOwnOption) {
  EXPECT_EQ(sample("--set body.radius=0.02 " + scene).exit, 0);
}

TEST_F(CommandTest, ProgressAwayFromATerminalIsALineEveryTenth) {
  const Ran ran = sample(scene);
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 11) << ran.err;
  EXPECT_TRUE(holds(ran.err, "frame 2/20  time 0.2 s")) << ran.err;
  EXPECT_FALSE(holds(ran.err, "frame 3/20"));
  EXPECT_FALSE(holds(ran.err, "\x1b"));
}

TEST_F(CommandTest, ExitCodesAreThoseOfTheErrors) {
  EXPECT_EQ(sample(scene + " --fail limit").exit, 1);
  const Ran bad = sample(scene + " --set body.radius=-1");
  EXPECT_EQ(bad.exit, 2);
  EXPECT_TRUE(is_error_line(bad.err));
  const Ran write = sample(scene + " --fail write");
  EXPECT_EQ(write.exit, 4);
  EXPECT_EQ(write.err, "sinew: a.vtu: the disk is full; free some space\n");
  for (const char* way : {"memory", "surprise"}) {
    const Ran ran = sample(scene + " --fail " + way);
    EXPECT_EQ(ran.exit, 2);
    EXPECT_TRUE(is_error_line(ran.err));
  }
}

TEST_F(CommandTest, FullOutputIsNoticed) {
  const Ran ran = sample(scene + " --quiet >/dev/full");
  EXPECT_EQ(ran.exit, 4);
  EXPECT_TRUE(is_error_line(ran.err));
}

TEST_F(CommandTest, WrongUseIsOneLineWithAHint) {
  const std::pair<const char*, const char*> uses[] = {{"", "see sinew sample --help"},
                                                      {"a b", "one argument too many: 'b'"},
                                                      {"a --treads 2", "did you mean --threads?"},
                                                      {"a --quite=3", "did you mean --quiet?"},
                                                      {"a --zzzzzz", "unknown option '--zzzzzz'"},
                                                      {"a --threads -1", "see sinew sample --help"},
                                                      {"a --threads many", "see sinew"},
                                                      {"a --threads", "see sinew"},
                                                      {"a --set radius=1", "section.key=value"},
                                                      {"a --set", "see sinew"},
                                                      {"a -x", "unknown option '-x'"},
                                                      {"none.yaml", "No such file"}};
  for (const auto& [arguments, part] : uses) {
    const Ran ran = sample(arguments);
    EXPECT_EQ(ran.exit, 2) << arguments;
    EXPECT_TRUE(is_error_line(ran.err)) << arguments;
    EXPECT_TRUE(holds(ran.err, part)) << arguments << ": " << ran.err;
    EXPECT_EQ(ran.out, "") << arguments;
  }
}

TEST_F(CommandTest, HelpShowsOptionsAndExamples) {
  const Ran ran = sample("--help");
  EXPECT_EQ(ran.exit, 0);
  for (const char* part : {"Reads a scene.", "--threads", "--set", "--json", "--quiet", "--version",
                           "sinew sample scene.yaml", "--help-settings"})
    EXPECT_TRUE(holds(ran.out, part)) << part;
  EXPECT_EQ(ran.err, "");
}

TEST_F(CommandTest, HelpOfSettingsHasThemAll) {
  const Ran ran = sample("--help-settings");
  EXPECT_EQ(ran.exit, 0);
  EXPECT_EQ(ran.out, settings_help());
  for (const char* part : {"young_modulus", "skeleton.bones[]", "bodies[]"})
    EXPECT_TRUE(holds(ran.out, part)) << part;
}

TEST_F(CommandTest, VersionIsThatOfTheProject) {
  EXPECT_EQ(sample("--version").out, "sinew " PROJECT_VERSION "\n");
}

struct FrontTest : testing::Test {
  FrontTest() {
    std::filesystem::copy_file(FRONT, front);
    folder.write("sinew-fill", "#!/bin/sh\nfor a in \"$@\"; do echo \"<$a>\"; done\nexit 3\n");
    std::filesystem::permissions(folder.path() / "sinew-fill", std::filesystem::perms::owner_all);
  }

  Ran sinew(const std::string& arguments) { return run(front + ' ' + arguments); }

  TempFolder folder;
  std::string front = (folder.path() / "sinew").string();
};

TEST_F(FrontTest, BecomesTheProgramBesideIt) {
  const Ran ran = sinew("fill 'a b' --set x=1 ''");
  EXPECT_EQ(ran.exit, 3);
  EXPECT_EQ(ran.out, "<a b>\n<--set>\n<x=1>\n<>\n");
}

TEST_F(FrontTest, IsFoundThroughALink) {
  const TempFolder other;
  std::filesystem::create_symlink(front, other.path() / "sinew");
  EXPECT_EQ(run((other.path() / "sinew").string() + " fill x").out, "<x>\n");
}

TEST_F(FrontTest, HelpOfACommandIsItsOwn) { EXPECT_EQ(sinew("help fill").out, "<--help>\n"); }

TEST_F(FrontTest, HelpListsTheCommands) {
  for (const char* help : {"--help", "-h", "help"}) {
    const Ran ran = sinew(help);
    EXPECT_EQ(ran.exit, 0);
    for (const char* name :
         {"new", "run", "check", "fill", "simulate", "measure", "render", "info"})
      EXPECT_TRUE(holds(ran.out, std::string("\n  ") + name + ' ')) << name;
  }
}

TEST_F(FrontTest, VersionIsThatOfTheProject) {
  EXPECT_EQ(sinew("--version").out, "sinew " PROJECT_VERSION "\n");
}

TEST_F(FrontTest, WrongUseIsOneLineWithAHint) {
  const std::pair<const char*, const char*> uses[] = {
      {"", "no command given"},
      {"simulat", "did you mean simulate?"},
      {"dance", "use one of new, run, check"},
      {"--quiet fill", "behind the command"},
      {"render", "sinew-render: cannot be started"}};
  for (const auto& [arguments, part] : uses) {
    const Ran ran = sinew(arguments);
    EXPECT_EQ(ran.exit, 2) << arguments;
    EXPECT_TRUE(is_error_line(ran.err)) << arguments;
    EXPECT_TRUE(holds(ran.err, part)) << arguments << ": " << ran.err;
  }
}

TEST(Results, NumbersThatAreNotFiniteBecomeNull) {
  Results results;
  results.add("worst", std::numeric_limits<double>::infinity());
  results.add("done", true);
  EXPECT_EQ(results.text(), "worst: inf\ndone: true\n");
  const auto object = nlohmann::json::parse(results.json());
  EXPECT_TRUE(object["worst"].is_null());
  EXPECT_EQ(object["done"], true);
}

TEST(Progress, TextLeavesOutWhatIsUnknown) {
  EXPECT_EQ(progress_text(30, 90, 1, 1234.4, 52), "frame 30/90  time 1 s  1234 steps/s  0:52 left");
  EXPECT_EQ(progress_text(30, 90, 1, 0, 3725), "frame 30/90  time 1 s  1:02:05 left");
  EXPECT_EQ(progress_text(90, 90, 3, 0, 0), "frame 90/90  time 3 s");
  EXPECT_EQ(progress_text(30, 90, 1, 0, 0, 0.314),
            "frame 30/90  time 1 s  31 % spent waiting for frames to be written");
  EXPECT_EQ(progress_text(30, 90, 1, 0, 0, 0.04), "frame 30/90  time 1 s");
  EXPECT_EQ(iterations_text(1, 2, 0.5, 3000, 0.0012),
            "frame 1/2  time 0.5 s  3000 iterations, residual 0.0012");
}

TEST(Progress, OnATerminalOneLineIsRewrittenAndEnded) {
  const TempFolder folder;
  const auto file = folder.path() / "err";
  std::FILE* out = std::fopen(file.c_str(), "w");
  {
    Progress progress(4, ProgressStyle::rewritten, out);
    for (int frame = 0; frame <= 4; ++frame) progress.frame(frame, frame, frame);
  }
  std::fclose(out);
  const std::string text = content(file);
  EXPECT_EQ(text.front(), '\r');
  EXPECT_TRUE(holds(text, "\rframe 4/4"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_EQ(text.back(), '\n');
}

TEST(Progress, QuietSaysNothing) {
  const TempFolder folder;
  const auto file = folder.path() / "err";
  std::FILE* out = std::fopen(file.c_str(), "w");
  {
    Progress progress(4, ProgressStyle::none, out);
    for (int frame = 0; frame <= 4; ++frame) progress.frame(frame, frame, frame);
  }
  std::fclose(out);
  EXPECT_EQ(content(file), "");
}

TEST(Progress, OfALongStageTellsTheTimeLeft) {
  const TempFolder folder;
  const auto file = folder.path() / "err";
  std::FILE* out = std::fopen(file.c_str(), "w");
  {
    StageProgress progress("measuring", ProgressStyle::rewritten, out);
    progress.at(1, 4);  // too early to be shown
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    progress.at(2, 4), progress.at(4, 4);
  }
  std::fclose(out);
  EXPECT_EQ(content(file), "\rmeasuring 50 %  0:03 left\rmeasuring 100 %          \n");
}

TEST(Progress, OfAStageThatIsReadLateTellsTheTimeLeftFromThereOn) {
  const TempFolder folder;
  const auto file = folder.path() / "err";
  std::FILE* out = std::fopen(file.c_str(), "w");
  {
    StageProgress progress("movie", ProgressStyle::rewritten, out);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    for (std::size_t done = 1; done <= 50; ++done) progress.at(done, 100);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    progress.at(55, 100);
  }
  std::fclose(out);
  EXPECT_EQ(content(file), "\rmovie 55 %  0:03 left\n");
}

TEST(Progress, CountsWhatIsWaitedFromItsFirstFrameOn) {
  const TempFolder folder;
  const auto file = folder.path() / "err";
  std::FILE* out = std::fopen(file.c_str(), "w");
  {
    Progress progress(4, ProgressStyle::lines, out);
    progress.frame(0, 0, 0, 9);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    progress.frame(2, 2, 2, 9);
    progress.frame(4, 4, 4, 19);
  }
  std::fclose(out);
  const std::string text = content(file);
  EXPECT_EQ(text.find("waiting"), text.find("waiting for frames", text.find("frame 4/4"))) << text;
  EXPECT_TRUE(holds(text, "  100 % spent waiting")) << text;
}

TEST(Progress, OfWhatCannotBeForetoldCountsSeconds) {
  const TempFolder folder;
  const auto file = folder.path() / "err";
  std::FILE* out = std::fopen(file.c_str(), "w");
  { const Waiting short_one("looking", ProgressStyle::rewritten, out); }
  {
    const Waiting waiting("looking", ProgressStyle::rewritten, out);
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  }
  std::fclose(out);
  EXPECT_TRUE(content(file).starts_with("\rlooking  1 s")) << content(file);
}

TEST(Tables, SettingsAreMarkdown) {
  const Ran ran = run(std::string(TABLES) + " settings");
  EXPECT_EQ(ran.exit, 0);
  EXPECT_EQ(ran.out, settings_markdown());
  EXPECT_TRUE(holds(ran.out, "| `radius` | auto | m | a number > 0 |")) << ran.out;
  EXPECT_EQ(run(std::string(TABLES) + " nonsense").exit, 2);
}

}  // namespace sinew::command_test
