// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/file.h>

#include <sys/stat.h>
#include <algorithm>

#include "support/scratch.h"

namespace sinew::file_test {

using File = Scratch;

TEST_F(File, ReadsBackWhatWasWritten) {
  const std::string text("a\0b\n", 4);
  write_file(folder / "f", "older and longer");
  write_file(folder / "f", text);
  EXPECT_EQ(read_file(folder / "f"), text);
  EXPECT_EQ(files(), 1u);
}

TEST_F(File, LeavesTheOlderFileWhenItIsNotFinished) {
  write_file(folder / "f", "older");
  {
    NewFile half(folder / "f");
    half.write("half", 4);
    EXPECT_EQ(files(), 2u);
  }
  EXPECT_EQ(read_file(folder / "f"), "older");
  EXPECT_EQ(files(), 1u);
}

TEST_F(File, GrowsAfterWhatIsKept) {
  write_file(folder / "f", "older and longer");
  {
    GrowingFile file(folder / "f", 5);
    file.add(" oak", 4);
    file.write_at(0, "O", 1);
    file.add("s", 1);
    EXPECT_EQ(read_file(folder / "f"), "Older oaks");
    file.close();
  }
  EXPECT_EQ(error_of([&] { GrowingFile(folder / "f", 11); }).exit(), Exit::bad_input);
  EXPECT_EQ(read_file(folder / "f"), "Older oaks");
  EXPECT_EQ(error_of([&] { GrowingFile(folder, 0); }).exit(), Exit::not_written);
  ::mkfifo((folder / "pipe").c_str(), 0600);
  EXPECT_EQ(error_of([&] { GrowingFile(folder / "pipe", 0); }).exit(), Exit::not_written);
}

TEST_F(File, NamesTheFileThatCannotBeWritten) {
  const Error error = error_of([&] { write_file(folder / "missing" / "f", "text"); });
  EXPECT_EQ(error.exit(), Exit::not_written);
  EXPECT_TRUE(contains(error.what(), "missing/f: cannot be written")) << error.what();
}

TEST_F(File, RefusesAFolderInItsPlace) {
  std::filesystem::create_directories(folder / "f" / "g");
  EXPECT_EQ(error_of([&] { write_file(folder / "f", "text"); }).exit(), Exit::not_written);
  EXPECT_EQ(files(), 1u);
}

/// Links that somebody planted in a folder, also to a file that a second name has.
TEST_F(File, WritesThroughNoLink) {
  const auto link = [&](const char* name, bool soft) {
    std::filesystem::remove(folder / name);
    if (soft)
      std::filesystem::create_symlink(folder / "mine", folder / name);
    else
      std::filesystem::create_hard_link(folder / "mine", folder / name);
  };
  put(folder / "mine", "precious");
  for (const bool soft : {true, false}) {
    for (const char* name : {"f", ".f.tmp", "g", ".g.tmp", "h"}) link(name, soft);
    write_file(folder / "f", "new");
    write_part(folder / "g", 0, "new");
    link(".i.tmp", true);
    EXPECT_THROW(write_part(folder / "i", 1, "new"), Error);
    finish_parts(folder / "g", "");
    GrowingFile(folder / "h", 0).add("new", 3);
    EXPECT_EQ(read_file(folder / "mine"), "precious");
    for (const char* name : {"f", "g", "h"}) {
      EXPECT_EQ(read_file(folder / name), "new");
      EXPECT_FALSE(std::filesystem::is_symlink(folder / name));
    }
  }
  link("h", true);
  EXPECT_THROW(GrowingFile(folder / "h", 3), Error);
  link("h", false);
  GrowingFile(folder / "h", 3).add("pared", 5);  // goes on with a copy
  EXPECT_EQ(read_file(folder / "h"), "prepared");
  for (const bool soft : {true, false}) {
    link("lock", soft);
    EXPECT_LT(open_lock(folder / "lock"), 0);
  }
  EXPECT_EQ(read_file(folder / "mine"), "precious");
}

TEST_F(File, FoldersWithinAreNoLinks) {
  std::filesystem::create_directory(folder / "away");
  std::filesystem::create_directory_symlink(folder / "away", folder / "link");
  EXPECT_EQ(error_of([&] { create_inner_folder(folder / "link"); }).exit(), Exit::bad_input);
  create_folder(folder / "link" / "below");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "away" / "below"));
  put(folder / "file", "");
  EXPECT_EQ(error_of([&] { create_folder(folder / "file"); }).exit(), Exit::not_written);
}

TEST_F(File, NamedByAnotherLiesBelowIt) {
  std::filesystem::create_directories(folder / "model" / "maps");
  put(folder / "model/maps/a.png", ""), put(folder / "secret.png", "");
  std::filesystem::create_symlink("../secret.png", folder / "model/out.png");
  std::filesystem::create_symlink("maps/a.png", folder / "model/in.png");
  const auto below = [&](const std::string& name) { return file_below(folder / "model", name); };
  EXPECT_EQ(below("maps/a.png"), folder / "model/maps/a.png");
  EXPECT_EQ(below("./maps/../maps/a.png"), folder / "model/maps/a.png");
  EXPECT_EQ(below("in.png"), folder / "model/in.png");
  for (const std::string name :
       {"", "../secret.png", "maps/../../secret.png", "out.png", "/", ".."})
    EXPECT_EQ(below(name), "") << name;
  EXPECT_EQ(below((folder / "model/maps/a.png").string()), "");
}

TEST_F(File, ReadsNoMoreThanTheLimit) {
  write_file(folder / "f", "12345");
  EXPECT_EQ(read_file(folder / "f", 5), "12345");
  EXPECT_EQ(error_of([&] { read_file(folder / "f", 4); }).exit(), Exit::bad_input);
}

TEST_F(File, ReadsThroughALargeFileInPieces) {
  std::string text(1 << 20, 'x'), read;
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * i >> 7);
  write_file(folder / "f", text);
  std::size_t largest = 0;
  read_through(folder / "f", [&](std::string_view piece) {
    read += piece;
    largest = std::max(largest, piece.size());
  });
  EXPECT_EQ(read, text);
  EXPECT_LT(largest, text.size() / 4);
}

TEST_F(File, ReadsOnlyRegularFiles) {
  ::mkfifo((folder / "pipe").c_str(), 0600);
  for (const char* name : {"absent", "pipe", "."}) {
    const Error error = error_of([&] { read_file(folder / name); });
    EXPECT_EQ(error.exit(), Exit::bad_input) << name;
    EXPECT_TRUE(contains(error.what(), name)) << error.what();
  }
}

}  // namespace sinew::file_test
