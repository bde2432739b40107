// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/arrays.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include <sinew/io/single_files.h>
#include "synthetic_run.h"

namespace sinew::arrays_test {

void expect_listed(const std::string& series, ArrayPlace place,
                   const std::vector<Column>& columns) {
  for (const Column& column : columns) {
    const WrittenArray* row = find_written(series, place, column.name);
    ASSERT_TRUE(row) << series << ' ' << column.name;
    EXPECT_EQ(column.components, row->components.empty() ? 1 : row->components.size())
        << column.name;
    EXPECT_EQ(column.values.index() == 0, row->numbers == ArrayNumbers::whole) << column.name;
  }
}

void expect_listed(const std::string& series, const Dataset& data) {
  ASSERT_TRUE(find_written(series, ArrayPlace::point, "Points")) << series;
  expect_listed(series, ArrayPlace::point, data.point_columns);
  expect_listed(series, ArrayPlace::cell, data.cell_columns);
  expect_listed(series, ArrayPlace::field, data.field_columns);
  const auto rows = written_arrays();
  const auto on_request = [](std::string_view name) {
    const auto in = [name](auto names) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    return in(measured_arrays()) || in(stepped_arrays()) || in(contact_arrays());
  };
  const auto listed = std::count_if(rows.begin(), rows.end(), [&](const WrittenArray& row) {
    return row.series == series && row.name != "Points" && !on_request(row.name);
  });
  EXPECT_EQ(listed,
            data.point_columns.size() + data.cell_columns.size() + data.field_columns.size())
      << series;
}

TEST(WrittenArrays, AreExactlyThoseThatTheSeriesHold) {
  const SyntheticRun run;
  expect_listed("particles", run.particles({}));
  expect_listed("surface", run.surface({}));
  expect_listed("bones", run.bones({}));
  expect_listed("frames", run.frames({}));
  expect_listed("obstacles", run.obstacles({}));
  const SupportFrame grip{};
  expect_listed("supports", supports_dataset({&grip, 1}, {}));
  const Particles some = particles_at(run.rest, run.radius, 1);
  const std::vector<Offence> offence(run.count(), Offence::none);
  const std::vector<double> moved(run.count());
  expect_listed("blowup", blowup_dataset({some, run.rest, run.bone, offence, moved}, {}));
  BodyFile body = run.body();
  body.stiffness = body.density = body.volume_stiffness = std::vector<double>(run.count(), 1);
  expect_listed("body", body_dataset(body));
}

TEST(WrittenArrays, AreThoseOnRequestTooWithTheirComponents) {
  for (const char* series : {"particles", "values"})
    for (const std::string_view name : measured_arrays())
      EXPECT_TRUE(find_written(series, ArrayPlace::point, name)) << series << ' ' << name;
  for (const std::string_view name : stepped_arrays())
    EXPECT_TRUE(find_written("particles", ArrayPlace::point, name)) << name;
}

TEST(WrittenArrays, HaveANameOfTheirOwnAUnitAndHelp) {
  std::set<std::tuple<std::string_view, ArrayPlace, std::string_view>> names;
  for (const WrittenArray& row : written_arrays()) {
    EXPECT_TRUE(names.insert({row.series, row.place, row.name}).second) << row.name;
    EXPECT_FALSE(row.unit.empty()) << row.name;
    EXPECT_FALSE(row.help.empty()) << row.name;
  }
}

TEST(WrittenArrays, ActiveOnesOfTheParticlesAreBoneAndDisplacement) {
  EXPECT_EQ(find_written("particles", ArrayPlace::point, "bone")->role, ArrayRole::scalars);
  EXPECT_EQ(find_written("particles", ArrayPlace::point, "displacement")->role, ArrayRole::vectors);
}

}  // namespace sinew::arrays_test
