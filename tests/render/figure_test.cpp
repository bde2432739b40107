// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/figure.h>

#include <sinew/render/detail/keys.h>

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
      figure({body.panel(View::surface), body.panel(View::particles)}, body.options).pixels();
  EXPECT_EQ(image.width, 640);
  EXPECT_EQ(image.height, 360);
  EXPECT_GT(painted(image, 0, 0, 320, 280), 0.2);
  EXPECT_GT(painted(image, 320, 0, 320, 280), 0.2);
  EXPECT_GT(painted(image, 0, 300, 320, 60), 0.005);
  EXPECT_GT(painted(image, 320, 300, 320, 60), 0.05);
}

TEST(Figure, a_colored_skin_has_a_color_bar) {
  BentBody body;
  EXPECT_EQ(painted(figure({body.panel(View::surface)}, body.options).pixels(), 320, 320, 320, 40),
            0);
  body.snapshot.skin_values.assign(body.snapshot.surface.points.size(), 0.2);
  for (const View view : {View::surface, View::halves})
    EXPECT_GT(painted(figure({body.panel(view)}, body.options).pixels(), 320, 320, 320, 40), 0.05);
}

TEST(Figure, a_title_stands_above_its_panel) {
  BentBody body;
  const Image without = figure({body.panel(View::both)}, body.options).pixels();
  const Image with = figure({body.panel(View::both, "bonded")}, body.options).pixels();
  EXPECT_EQ(painted(without, 0, 0, 640, 12), 0);
  EXPECT_GT(painted(with, 0, 0, 640, 24), 0.01);
}

TEST(Figure, needs_a_panel) {
  EXPECT_EQ(error_of([] { figure({}, {}); }).exit(), Exit::bad_input);
}

/// The pixels of this color, y downward.
Eigen::AlignedBox2i box_of(const Image& image, const Color& color) {
  Eigen::AlignedBox2i box;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (std::equal(color.begin(), color.end(), image.at(x, y))) box.extend(Eigen::Vector2i(x, y));
  return box;
}

/// Whether a pixel of this color is in a rectangle of the image.
bool has(const Image& image, const Color& color, int x, int y, int width, int height) {
  for (int row = y; row < y + height; ++row)
    for (int column = x; column < x + width; ++column)
      if (std::equal(color.begin(), color.end(), image.at(column, row))) return true;
  return false;
}

TEST(Figure, shows_the_axes_in_a_corner_as_the_camera_sees_them) {
  Painter painter({}, {});
  FigureOptions options;
  options.width = 640, options.height = 360;
  options.camera.view = view_from({0, -1, 0});
  const Snapshot nothing;
  const auto draw = [&] {
    return figure({{&painter, &nothing, View::surface, ""}}, options).pixels();
  };
  EXPECT_EQ(painted(draw()), 0);
  options.axes = true;
  const Image image = draw();
  EXPECT_EQ(painted(image, 160, 0, 480, 360), 0);
  EXPECT_EQ(painted(image, 0, 0, 640, 180), 0);
  const auto& [red, green, blue] = palette::axes;
  const auto [x, along, up] =
      std::tuple(box_of(image, red), box_of(image, green), box_of(image, blue));
  EXPECT_GT(x.sizes().x(), 2 * x.sizes().y());    // X to the right
  EXPECT_GT(up.sizes().y(), 2 * up.sizes().x());  // Z upward
  EXPECT_LT(up.max().x(), x.center().x());
  EXPECT_LT(up.center().y(), x.min().y());
  EXPECT_LT(along.max().x(), x.center().x());  // Y away: only its letter
}

TEST(Figure, is_drawn_on_any_background_with_ink_that_is_read_there) {
  BentBody body;
  const Color navy{0, 0, 84};
  body.options.paper = paper_of(navy);
  const Image image = figure({body.panel(View::bones, "bent")}, body.options).pixels();
  for (const int x : {0, 639})
    for (const int y : {0, 359}) EXPECT_TRUE(has(image, navy, x, y, 1, 1));
  EXPECT_FALSE(has(image, palette::paper, 0, 0, 640, 360));
  int most = 0;
  for (int x = 0; x < 320; ++x)
    for (int y = 300; y < 360; ++y) most = std::max<int>(most, image.at(x, y)[1]);
  EXPECT_GT(most, 150);  // the caption
}

TEST(Figure, a_transparent_background_leaves_what_is_drawn) {
  BentBody body;
  const auto draw = [&](const Paper& paper) {
    body.options.paper = paper;
    return figure({body.panel(View::bones)}, body.options);
  };
  const Image image = without_background(palette::ink, draw), white = draw(Paper{}).pixels();
  ASSERT_EQ(image.alpha.size(), 640U * 360);
  EXPECT_TRUE(white.alpha.empty());
  EXPECT_EQ(image.alpha[0], 0);
  int worst = 0;  // laid on white it is the picture on white
  for (std::size_t i = 0; i < white.rgb.size(); ++i) {
    const int alpha = image.alpha[i / 3];
    const int laid = (alpha * image.rgb[i] + (255 - alpha) * 255 + 127) / 255;
    worst = std::max(worst, std::abs(laid - white.rgb[i]));
  }
  EXPECT_LE(worst, 3);
}

}  // namespace sinew::figure_test
