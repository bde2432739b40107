// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/dataset.h>

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace sinew::dataset_test {

using test::expect_bad_input;

const std::vector<Column> columns = {column("id", std::vector<std::int32_t>{4, 5}),
                                     column("mass", std::vector<double>{0.5, 1}),
                                     column("velocity", Points{{1, 2, 3}, {4, 5, 6}})};

TEST(Dataset, GivesBackWhatColumnsHold) {
  EXPECT_EQ(integers(columns, "id"), (std::vector<std::int32_t>{4, 5}));
  EXPECT_EQ(numbers(columns, "mass"), (std::vector<double>{0.5, 1}));
  EXPECT_EQ(vectors(columns, "velocity"), (Points{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(find(columns, "mass"), &columns[1]);
  EXPECT_EQ(find(columns, "Mass"), nullptr);
}

TEST(Dataset, NamesTheColumnThatIsMissing) {
  expect_bad_input([] { integers(columns, "bone"); }, {"'bone'", ";"});
  expect_bad_input([] { numbers({}, "mass"); }, {"'mass'"});
  expect_bad_input([] { vectors(columns, "force"); }, {"'force'"});
}

TEST(Dataset, RefusesAnotherShapeOrType) {
  expect_bad_input([] { numbers(columns, "velocity"); }, {"'velocity'", "1 component"});
  expect_bad_input([] { vectors(columns, "mass"); }, {"'mass'", "3 component"});
  expect_bad_input([] { numbers(columns, "id"); }, {"'id'", "numbers"});
  expect_bad_input([] { integers(columns, "mass"); }, {"'mass'", "whole numbers"});
}

TEST(Dataset, CountsCellsByTheirKind) {
  Dataset data;
  data.connectivity = {0, 1, 2, 3, 4, 5};
  for (const auto& [kind, cells] :
       {std::pair(CellKind::vertex, 6u), {CellKind::line, 3u}, {CellKind::triangle, 2u}}) {
    data.kind = kind;
    EXPECT_EQ(data.cells(), cells);
  }
  EXPECT_EQ(vertex_cells(3), (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_TRUE(vertex_cells(0).empty());
}

}  // namespace sinew::dataset_test
