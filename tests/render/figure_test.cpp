// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/figure.h>

#include "helpers.h"
#include "synthetic_run.h"

namespace sinew::figure_test {

struct BentBody {
  Snapshot snapshot = synthetic_snapshot(1.6, 0);
  Painter painter{snapshot.surface, synthetic_scale()};
  FigureOptions options;

  BentBody() {
    snapshot.caption = "1.00 s";
    options.width = 640, options.height = 360;
    options.camera.frame = seen(options.camera.view, snapshot);
  }
  Panel panel(View view, std::string title = "") { return {&painter, &snapshot, view, title}; }
};

TEST(Figure, shows_its_panels_side_by_side_above_the_caption_and_the_colors) {
  BentBody body;
  const Image image =
      figure({body.panel(View::surface), body.panel(View::particles)}, body.options);
  EXPECT_EQ(image.width, 640);
  EXPECT_EQ(image.height, 360);
  EXPECT_GT(painted(image, 0, 0, 320, 280), 0.2);
  EXPECT_GT(painted(image, 320, 0, 320, 280), 0.2);
  EXPECT_GT(painted(image, 0, 300, 320, 60), 0.005);
  EXPECT_GT(painted(image, 320, 300, 320, 60), 0.05);
}

TEST(Figure, a_title_stands_above_its_panel) {
  BentBody body;
  const Image without = figure({body.panel(View::both)}, body.options);
  const Image with = figure({body.panel(View::both, "bonded")}, body.options);
  EXPECT_EQ(painted(without, 0, 0, 640, 12), 0);
  EXPECT_GT(painted(with, 0, 0, 640, 24), 0.01);
}

TEST(Figure, needs_a_panel) {
  EXPECT_EQ(error_of([] { figure({}, {}); }).exit(), Exit::bad_input);
}

}  // namespace sinew::figure_test
