// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/series.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include <sinew/core/arrays.h>
#include <sinew/core/file.h>
#include <sinew/io/series_table.h>
#include "support/scratch.h"
#include "synthetic_run.h"

namespace sinew::series_test {

using SeriesFiles = Scratch;

VtuFormat bones_format() { return {Encoding::zlib, false, "bones", 0.01}; }

TEST_F(SeriesFiles, PvdHasOneRowPerTimeInItsShortestText) {
  const SyntheticRun run;
  Series series(folder / "run", bones_format());
  for (const double time : {0.0, 0.1, 1.0 / 3}) series.add(run.bones({time, 0}));
  series.close();
  EXPECT_EQ(text_of(folder / "run" / "bones.pvd"),
            R"(<?xml version="1.0"?>
<VTKFile type="Collection" version="1.0" byte_order="LittleEndian">
  <Collection>
    <DataSet timestep="0" group="" part="0" file="bones/bones_000000.vtu"/>
    <DataSet timestep="0.1" group="" part="0" file="bones/bones_000001.vtu"/>
    <DataSet timestep="0.3333333333333333" group="" part="0" file="bones/bones_000002.vtu"/>
  </Collection>
</VTKFile>
)");
}

TEST_F(SeriesFiles, SeriesFileHasTheRowsOfThePvd) {
  const SyntheticRun run;
  Series series(folder / "run", bones_format());
  for (const double time : {0.0, 0.1, 1.0 / 3}) series.add(run.bones({time, 0}));
  series.close();
  EXPECT_EQ(text_of(folder / "run" / "bones.vtu.series"),
            R"({"file-series-version": "1.0", "files": [
  {"name": "bones/bones_000000.vtu", "time": 0},
  {"name": "bones/bones_000001.vtu", "time": 0.1},
  {"name": "bones/bones_000002.vtu", "time": 0.3333333333333333}
]}
)");
}

TEST_F(SeriesFiles, SeriesFileOfAnyTimesIsJson) {
  for (const std::vector<PvdRow>& rows :
       {std::vector<PvdRow>{},
        {{1e-300, "a/a_000000.vtu"}, {0.1 + 0.2, "a/a_000001.vtu"}, {1e22, "a/a_000002.vtu"}}}) {
    const auto read = nlohmann::json::parse(series_text(rows));
    EXPECT_EQ(read.at("file-series-version"), "1.0");
    ASSERT_EQ(read.at("files").size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(read.at("files")[i].at("name"), rows[i].file);
      EXPECT_EQ(read.at("files")[i].at("time").get<double>(), rows[i].time);
    }
  }
}

/// A run may have a million.
TEST_F(SeriesFiles, APvdOfAnyRunCanBeReadAgain) {
  constexpr std::size_t frames = 1'000'000;
  std::vector<PvdRow> rows;
  for (std::size_t i = 0; i <= frames; ++i)
    rows.push_back({static_cast<double>(i), frame_name("particles", i)});
  write_file(folder / "particles.pvd", pvd_text(rows));
  const auto read = read_pvd(folder / "particles.pvd");
  ASSERT_EQ(read.size(), rows.size());
  EXPECT_EQ(read.back().file, "particles/particles_1000000.vtu");
}

TEST_F(SeriesFiles, RowsLeadToTheFramesTheyName) {
  const SyntheticRun run;
  Series series(folder, bones_format());
  for (int i = 0; i < 3; ++i) series.add(run.bones({i / 3.0, i}));
  series.close();
  const auto rows = read_pvd(folder / "bones.pvd");
  ASSERT_EQ(rows.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const Dataset data = read_vtu(folder / rows[i].file);
    EXPECT_EQ(data.time, rows[i].time);
    EXPECT_EQ(data.cycle, i);
  }
}

std::vector<std::string> named_in_series(const std::filesystem::path& list) {
  std::vector<std::string> names;
  const auto read = nlohmann::json::parse(read_file(list));
  for (const auto& file : read.at("files")) names.push_back(file.at("name"));
  return names;
}

TEST_F(SeriesFiles, NoListNamesAFrameThatIsNotThere) {
  const SyntheticRun run;
  Series series(folder, bones_format());
  for (int i = 0; i < 20; ++i) {
    series.add(run.bones({i / 3.0, i}));
    for (const PvdRow& row : read_pvd(folder / "bones.pvd"))
      EXPECT_TRUE(std::filesystem::exists(folder / row.file));
    for (const std::string& file : named_in_series(folder / "bones.vtu.series"))
      EXPECT_TRUE(std::filesystem::exists(folder / file));
  }
}

TEST_F(SeriesFiles, TheLastFrameIsNamedEvenWhenTheSeriesIsOnlyDropped) {
  const SyntheticRun run;
  {
    Series series(folder, bones_format());
    series.add(run.bones({0, 0}));
    series.add(run.bones({1, 1}));
  }
  EXPECT_EQ(read_pvd(folder / "bones.pvd").size(), 2u);
}

TEST_F(SeriesFiles, AValueThatIsNotFiniteIsNeverWritten) {
  const SyntheticRun run;
  Series series(folder, {Encoding::zlib, false, "particles", 0.01});
  series.add(run.particles({0, 0}));
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), inf, -inf, 1e39}) {
    Dataset frame = run.particles({1, 1});
    Column& force = *std::find_if(frame.point_columns.begin(), frame.point_columns.end(),
                                  [](const Column& one) { return one.name == "force"; });
    std::get<std::vector<double>>(force.values)[7] = bad;
    const Error error = error_of([&] { series.add(frame); });
    EXPECT_EQ(error.exit(), Exit::unstable);
    EXPECT_TRUE(contains(error.what(), "at 1 s: particles force ")) << error.what();
    if (std::isfinite(bad)) continue;  // points so far away are Float64
    frame = run.particles({1, 1});
    frame.points.back().z() = bad;
    EXPECT_TRUE(contains(error_of([&] { series.add(frame); }).what(), "Points"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "particles/particles_000001.vtu"));
}

TEST_F(SeriesFiles, GoesOnAfterTheFramesThatAreKept) {
  const SyntheticRun run;
  const std::vector<double> times = {0, 0.5};
  {
    Series series(folder, bones_format());
    for (int i = 0; i < 4; ++i) series.add(run.bones({i / 2.0, i}));
  }
  {
    Series series(folder, bones_format(), times);
    EXPECT_EQ(read_pvd(folder / "bones.pvd").size(), 2u);  // at once: the others are gone
    EXPECT_EQ(named_in_series(folder / "bones.vtu.series").size(), 2u);
    EXPECT_FALSE(std::filesystem::exists(folder / "bones/bones_000002.vtu"));
    series.add(run.bones({1, 2}));
  }
  const auto rows = read_pvd(folder / "bones.pvd");
  ASSERT_EQ(rows.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rows[i].time, i / 2.0);
  EXPECT_EQ(named_in_series(folder / "bones.vtu.series").size(), 3u);
  std::filesystem::remove(folder / "bones/bones_000001.vtu");
  const Error error = error_of([&] { Series(folder, bones_format(), times); });
  EXPECT_EQ(error.exit(), Exit::bad_input);
  EXPECT_TRUE(contains(error.what(), "bones_000001.vtu")) << error.what();
}

TEST_F(SeriesFiles, AStartRemovesTheOlderSeriesAndNothingElse) {
  std::filesystem::create_directories(folder / "bones");
  for (const char* ours : {"bones_000007.vtu", ".bones_000008.vtu.tmp"})
    put(folder / "bones" / ours, "");
  put(folder / "bones" / "notes.txt", "kept");
  for (const std::string& list : series_files("bones")) put(folder / list, "older");
  Series series(folder, bones_format());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "bones"), {}), 1);
  EXPECT_TRUE(std::filesystem::exists(folder / "bones" / "notes.txt"));
  for (const std::string& list : series_files("bones"))
    EXPECT_FALSE(std::filesystem::exists(folder / list));
}

TEST_F(SeriesFiles, RemovesFramesAndTheirBeginningsByTheirWholeName) {
  const std::vector<std::string> ours = {"bones_000007.vtu", ".bones_000007.vtu.tmp",
                                         "bones_1234567.vtu"};
  const std::vector<std::string> others = {
      "bones_00007.vtu",          "bones_000007.vtk",   "_000007.vtu",        "bones_000007x.vtu",
      "bones_000007.vtu.tmp.bak", "..bones_000007.vtu", "my_bones_000007.vtu"};
  std::filesystem::create_directories(folder / "bones");
  for (const auto* names : {&ours, &others})
    for (const std::string& name : *names) write_file(folder / "bones" / name, "x");
  const Series series(folder, bones_format());
  for (const std::string& name : ours)
    EXPECT_FALSE(std::filesystem::exists(folder / "bones" / name)) << name;
  for (const std::string& name : others)
    EXPECT_TRUE(std::filesystem::exists(folder / "bones" / name)) << name;
}

TEST_F(SeriesFiles, AFileInTheFoldersPlaceIsNamed) {
  put(folder / "run", "");
  const Error error = error_of([&] { Series(folder / "run", bones_format()); });
  EXPECT_EQ(error.exit(), Exit::not_written);
  EXPECT_TRUE(contains(error.what(), "run/bones")) << error.what();
}

TEST_F(SeriesFiles, APvdThatLeadsElsewhereIsRefused) {
  for (const char* file : {"/etc/passwd", "../f.vtu", "a/../../f.vtu", "..\\f.vtu", ""}) {
    write_file(folder / "f.pvd", pvd_text({{0, file}}));
    const Error error = error_of([&] { read_pvd(folder / "f.pvd"); });
    EXPECT_EQ(error.exit(), Exit::bad_input);
    EXPECT_TRUE(contains(error.what(), "f.pvd: ")) << error.what();
  }
}

TEST_F(SeriesFiles, APvdThatIsNoneIsRefusedInSilence) {
  const std::string row = "<DataSet timestep=\"0\" file=\"f.vtu\"/>";
  const auto pvd = [](const std::string& rows) {
    return "<VTKFile><Collection>" + rows + "</Collection></VTKFile>";
  };
  put(folder / "f.pvd", pvd(row));
  EXPECT_EQ(read_pvd(folder / "f.pvd").size(), 1u);
  for (const std::string& text :
       {std::string(), std::string("text"), std::string("<VTKFile/>"), std::string("<A><B>"),
        pvd(row).substr(0, 60), pvd("<DataSet timestep=\"0\"/>"), pvd("<DataSet file=\"f.vtu\"/>"),
        pvd("<DataSet timestep=\"soon\" file=\"f.vtu\"/>"),
        pvd("<DataSet timestep=\"nan\" file=\"f.vtu\"/>")}) {
    put(folder / "f.pvd", text);
    testing::internal::CaptureStderr();
    EXPECT_EQ(error_of([&] { read_pvd(folder / "f.pvd"); }).exit(), Exit::bad_input) << text;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }
}

/// Reads the PVD again and again until `job`, in a thread of its own, is done; how often.
template <class Check, class Job>
int reads_during(const std::filesystem::path& pvd, Check&& check, Job&& job) {
  std::atomic<bool> over = false;
  std::thread writer([&] { job(), over = true; });
  int reads = 0;
  while (!over || reads < 1000) {
    check(read_pvd(pvd));
    ++reads;
  }
  writer.join();
  return reads;
}

TEST_F(SeriesFiles, AThousandReadsOfAGrowingRunFindWholeFilesOnly) {
  const SyntheticRun run;
  Series series(folder, bones_format());
  series.add(run.bones({0, 0}));
  std::size_t before = 0;
  const auto check = [&](const std::vector<PvdRow>& rows) {
    ASSERT_GE(rows.size(), std::max<std::size_t>(1, before));
    if (rows.size() == before) return;
    before = rows.size();
    EXPECT_EQ(rows.back().time, static_cast<double>(rows.size() - 1));
    for (const PvdRow& row : rows)
      ASSERT_EQ(read_vtu(folder / row.file).time, row.time);  // none is named before it is there
  };
  const int reads = reads_during(folder / "bones.pvd", check, [&] {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(2300);
    for (int i = 1; std::chrono::steady_clock::now() < end; ++i) {
      series.add(run.bones({static_cast<double>(i), i}));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  series.close();
  EXPECT_GE(reads, 1000);
  EXPECT_GT(before, 10U);
}

TEST_F(SeriesFiles, APvdReplacedWithoutPauseIsNeverTorn) {
  std::vector<PvdRow> rows;
  const auto pvd = folder / "bones.pvd";
  write_file(pvd, pvd_text(rows));
  std::size_t before = 0;
  const auto check = [&](const std::vector<PvdRow>& read) {
    ASSERT_GE(read.size(), before);
    before = read.size();
    if (!read.empty()) {
      ASSERT_EQ(read.back().time, static_cast<double>(read.size() - 1));
    }
  };
  reads_during(pvd, check, [&] {
    for (int i = 0; i < 1500; ++i) {
      rows.push_back({static_cast<double>(i), "bones/bones_" + std::to_string(i) + ".vtu"});
      write_file(pvd, pvd_text(rows));
    }
  });
  EXPECT_GT(before, 0U);
}

TEST(SeriesTable, EveryRowHasANameOfItsOwnAndArrays) {
  for (const SeriesRow& row : series_table()) {
    EXPECT_EQ(find_series(row.name), &row);
    EXPECT_NE(find_written(row.name, ArrayPlace::point, "Points"), nullptr) << row.name;
  }
  EXPECT_EQ(series_table().front().name, "particles");
  EXPECT_EQ(find_series("body"), nullptr);
}

TEST_F(SeriesFiles, AFolderHasTheSeriesWhoseListsAreThere) {
  EXPECT_TRUE(series_in(folder / "nowhere").empty());
  for (const char* name : {"skin_lbs.pvd", "bones.pvd", "mine.pvd", "surface.vtu.series"})
    write_file(folder / name, pvd_text({}));
  std::filesystem::create_directory(folder / "volume.pvd");
  EXPECT_EQ(series_in(folder), (std::vector<std::string_view>{"bones", "skin_lbs"}));
}

}  // namespace sinew::series_test
