// SPDX-License-Identifier: GPL-3.0-or-later
// A limit on the size of files stands for the full disk: writes beyond it fail with an error.
#include <signal.h>
#include <sys/resource.h>

#include <sinew/core/file.h>
#include <sinew/io/series.h>
#include "support/scratch.h"
#include "synthetic_run.h"

namespace sinew::full_disk_test {

class FullDisk : public Scratch {
 protected:
  FullDisk() {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
  }
  ~FullDisk() override { limit(before_.rlim_cur); }

  void limit(rlim_t bytes) const {
    rlimit wanted = before_;
    wanted.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &wanted);
  }

 private:
  rlimit before_{};
};

TEST_F(FullDisk, TextIsNotWrittenAndLeavesNothing) {
  limit(1000);
  const Error error = error_of([&] { write_file(folder / "f", std::string(5000, 'x')); });
  EXPECT_EQ(error.exit(), Exit::not_written);
  EXPECT_EQ(files(), 0u);
}

TEST_F(FullDisk, VtuIsNotWrittenWhereverTheSpaceEnds) {
  const Dataset data = SyntheticRun().particles({});
  for (const Encoding encoding : {Encoding::zlib, Encoding::lz4, Encoding::raw, Encoding::none}) {
    const VtuFormat format{encoding, false, "particles", 0.01};
    write_vtu(folder / "whole.vtu", data, format);
    const auto size = std::filesystem::file_size(folder / "whole.vtu");
    for (const std::uintmax_t space :
         {std::uintmax_t{0}, std::uintmax_t{100}, size / 2, size - 1}) {
      limit(space);
      testing::internal::CaptureStderr();
      const Error error = error_of([&] { write_vtu(folder / "f.vtu", data, format); });
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
      EXPECT_EQ(error.exit(), Exit::not_written);
      EXPECT_TRUE(contains(error.what(), "f.vtu")) << error.what();
      EXPECT_EQ(files(), 1u) << space;
      limit(RLIM_INFINITY);
    }
  }
}

TEST_F(FullDisk, GrowingFileKeepsItsWholeRecords) {
  GrowingFile file(folder / "f", 0);
  file.add("12345", 5);
  limit(8);
  EXPECT_EQ(error_of([&] { file.add("67890", 5); }).exit(), Exit::not_written);
  EXPECT_EQ(text_of(folder / "f"), "12345");
  limit(RLIM_INFINITY);
  file.add("abc", 3);
  EXPECT_EQ(text_of(folder / "f"), "12345abc");
}

TEST_F(FullDisk, SeriesKeepsTheFramesItHas) {
  const SyntheticRun run;
  Series series(folder, {Encoding::raw, false, "bones", 0.01});
  series.add(run.bones({0, 0}));
  limit(500);
  EXPECT_EQ(error_of([&] { series.add(run.bones({1, 1})); }).exit(), Exit::not_written);
  limit(RLIM_INFINITY);
  series.close();
  EXPECT_EQ(read_pvd(folder / "bones.pvd").size(), 1u);
}

TEST_F(FullDisk, ListsOfASeriesStayWhole) {
  const SyntheticRun run;
  const VtuFormat format{Encoding::raw, false, "bones", 0.01};
  std::vector<double> times;
  {
    Series series(folder, format);
    for (int i = 0; i < 60; ++i) series.add(run.bones({i / 60.0, i}));
  }
  for (int i = 0; i < 40; ++i) times.push_back(i / 60.0);
  const auto expect_last = [&](const char* last, const char* later) {
    for (const std::string& list : series_files("bones")) {
      EXPECT_TRUE(contains(text_of(folder / list), last)) << list;
      EXPECT_FALSE(contains(text_of(folder / list), later)) << list;
    }
  };
  limit(1000);
  EXPECT_EQ(error_of([&] { Series(folder, format, times); }).exit(), Exit::not_written);
  limit(RLIM_INFINITY);
  expect_last("000059", "000060");
  Series(folder, format, times);
  expect_last("000039", "000040");
}

}  // namespace sinew::full_disk_test
