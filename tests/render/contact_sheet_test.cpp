// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/figure.h>

#include <cmath>

#include "helpers.h"
#include "synthetic_run.h"

namespace sinew::contact_sheet_test {

std::vector<Snapshot> bending() {
  std::vector<Snapshot> snapshots{synthetic_snapshot(0, 0), synthetic_snapshot(0.8, 0),
                                  synthetic_snapshot(1.6, 0)};
  for (Snapshot& snapshot : snapshots) snapshot.caption = "bent\n1.00 s";
  return snapshots;
}

/// Runs of painted columns of pixels between rows y and y + height.
int groups(const Image& image, int y, int height) {
  int count = 0;
  for (int x = 1; x < image.width; ++x)
    count += painted(image, x, y, 1, height) > 0 && painted(image, x - 1, y, 1, height) == 0;
  return count;
}

TEST(ContactSheet, has_a_surface_above_particles_for_each_snapshot) {
  const std::vector<Snapshot> snapshots = bending();
  Painter painter(snapshots[0].surface, synthetic_scale());
  SheetOptions options;
  options.width = 800, options.row_height = 200;
  const Image sheet = contact_sheet(surface_above_particles(painter, snapshots), options).pixels();
  const int margin = 800 / 32;
  EXPECT_LE(sheet.width, 800);
  EXPECT_EQ(groups(sheet, margin, 200), 3);
  EXPECT_EQ(groups(sheet, 2 * margin + 200, 200), 3);
  EXPECT_GT(painted(sheet, 0, margin, sheet.width, 200), 0.2);
  EXPECT_GT(painted(sheet, 0, 2 * margin + 200, sheet.width, 200), 0.2);
  EXPECT_EQ(painted(sheet, 0, margin + 200, sheet.width, margin), 0);  // between the rows
}

TEST(ContactSheet, captions_and_color_scale_stand_below) {
  std::vector<Snapshot> snapshots = bending();
  Painter painter(snapshots[0].surface, synthetic_scale());
  const Image with = contact_sheet(surface_above_particles(painter, snapshots), {}).pixels();
  for (Snapshot& snapshot : snapshots) snapshot.caption.clear();
  const Image without = contact_sheet(surface_above_particles(painter, snapshots), {}).pixels();
  EXPECT_EQ(with.width, without.width);
  EXPECT_GT(with.height, without.height + 40);
  const Color high = mapped_color(1);
  int found = 0;
  for (int y = without.height - 120; y < without.height; ++y)
    for (int x = 0; x < without.width; ++x)
      found += std::equal(high.begin(), high.end(), without.at(x, y));
  EXPECT_GT(found, 10);
}

TEST(ContactSheet, without_snapshots_is_an_error) {
  Painter painter({}, {});
  EXPECT_EQ(error_of([&] { contact_sheet(surface_above_particles(painter, {}), {}); }).exit(),
            Exit::bad_input);
}

TEST(ContactSheet, has_a_row_for_each_way_of_looking) {
  const std::vector<Snapshot> snapshots = bending();
  Painter painter(snapshots[0].surface, synthetic_scale());
  SheetOptions options;
  options.width = 600, options.row_height = 120;
  const SheetRow row{&painter, &snapshots, View::both, ""};
  const int one = contact_sheet({row}, options).height();
  const Image three = contact_sheet({row, row, row}, options).pixels();
  EXPECT_GT(three.height, one + 2 * 100);
  EXPECT_EQ(groups(three, one, 100), 3);
}

TEST(ContactSheet, refuses_rows_that_differ_in_length) {
  const std::vector<Snapshot> three = bending(), two(three.begin(), three.begin() + 2);
  Painter painter(three[0].surface, synthetic_scale());
  const std::vector<SheetRow> rows{{&painter, &three, View::both, ""},
                                   {&painter, &two, View::both, ""}};
  EXPECT_EQ(error_of([&] { contact_sheet(rows, {}); }).exit(), Exit::bad_input);
}

}  // namespace sinew::contact_sheet_test
