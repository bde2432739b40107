// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/figure.h>

#include <cmath>

#include "helpers.h"
#include "synthetic_run.h"

namespace sinew {
namespace {

std::vector<Shot> bending() {
  std::vector<Shot> shots{synthetic_shot(0, 0), synthetic_shot(0.8, 0), synthetic_shot(1.6, 0)};
  for (Shot& shot : shots) shot.caption = "bent\n1.00 s";
  return shots;
}

/// Runs of painted columns of pixels between rows y and y + height.
int groups(const Image& image, int y, int height) {
  int count = 0;
  for (int x = 1; x < image.width; ++x)
    count += painted(image, x, y, 1, height) > 0 && painted(image, x - 1, y, 1, height) == 0;
  return count;
}

TEST(ContactSheet, has_a_surface_above_particles_for_each_shot) {
  const std::vector<Shot> shots = bending();
  Painter painter(shots[0].surface, synthetic_scale());
  SheetOptions options;
  options.width = 800, options.row_height = 200;
  const Image sheet = contact_sheet(painter, shots, options);
  const int margin = 800 / 32;
  EXPECT_LE(sheet.width, 800);
  EXPECT_EQ(groups(sheet, margin, 200), 3);
  EXPECT_EQ(groups(sheet, 2 * margin + 200, 200), 3);
  EXPECT_GT(painted(sheet, 0, margin, sheet.width, 200), 0.2);
  EXPECT_GT(painted(sheet, 0, 2 * margin + 200, sheet.width, 200), 0.2);
  EXPECT_EQ(painted(sheet, 0, margin + 200, sheet.width, margin), 0);  // between the rows
}

TEST(ContactSheet, captions_and_colour_scale_stand_below) {
  std::vector<Shot> shots = bending();
  Painter painter(shots[0].surface, synthetic_scale());
  const Image with = contact_sheet(painter, shots, {});
  for (Shot& shot : shots) shot.caption.clear();
  const Image without = contact_sheet(painter, shots, {});
  EXPECT_EQ(with.width, without.width);
  EXPECT_GT(with.height, without.height + 40);
  const Colour high = mapped_colour(1);
  int found = 0;
  for (int y = without.height - 120; y < without.height; ++y)
    for (int x = 0; x < without.width; ++x)
      found += std::equal(high.begin(), high.end(), without.at(x, y));
  EXPECT_GT(found, 10);
}

TEST(ContactSheet, without_shots_is_an_error) {
  Painter painter({}, {});
  EXPECT_EQ(error_of([&] { contact_sheet(painter, {}, {}); }).exit(), Exit::bad_input);
}

TEST(ContactSheet, has_a_row_for_each_way_of_looking) {
  const std::vector<Shot> shots = bending();
  Painter painter(shots[0].surface, synthetic_scale());
  SheetOptions options;
  options.width = 600, options.row_height = 120;
  const SheetRow row{&painter, &shots, View::both, ""};
  const int one = contact_sheet({row}, options).height;
  const Image three = contact_sheet({row, row, row}, options);
  EXPECT_GT(three.height, one + 2 * 100);
  EXPECT_EQ(groups(three, one, 100), 3);
}

TEST(ContactSheet, refuses_rows_that_differ_in_length) {
  const std::vector<Shot> three = bending(), two(three.begin(), three.begin() + 2);
  Painter painter(three[0].surface, synthetic_scale());
  const std::vector<SheetRow> rows{{&painter, &three, View::both, ""},
                                   {&painter, &two, View::both, ""}};
  EXPECT_EQ(error_of([&] { contact_sheet(rows, {}); }).exit(), Exit::bad_input);
}

}  // namespace
}  // namespace sinew
