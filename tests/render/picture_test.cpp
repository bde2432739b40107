// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/picture.h>

#include <algorithm>
#include <limits>

#include "helpers.h"
#include "synthetic_run.h"

namespace sinew::picture_test {

PictureOptions options_for(const Snapshot& snapshot, View view, Finish finish = Finish::fine) {
  PictureOptions options{view, {}, 320, 240, 10, finish};
  options.camera.frame = seen(options.camera.view, snapshot);
  return options;
}

double scale_of(const PictureOptions& options) {
  return meters_per_pixel(options.camera.frame, options.width - 2 * options.margin,
                          options.height - 2 * options.margin);
}

/// Two spheres of 1 m, 10 m apart along the picture, of lowest and highest value.
Snapshot two_spheres(const Mat3& view) {
  Snapshot snapshot;
  snapshot.particles = {Vec3::Zero(), 10 * view.row(0).transpose()};
  snapshot.radius = 1;
  snapshot.values = {0, 1};
  return snapshot;
}

constexpr Finish finishes[] = {Finish::quick, Finish::fine};

TEST(Picture, has_the_size_asked_for_and_white_corners) {
  const Snapshot snapshot = synthetic_snapshot(0.8, 0);
  Painter painter(snapshot.surface, synthetic_scale());
  const auto check = [&](View view, Finish finish) {
    const Image image = painter.draw(snapshot, options_for(snapshot, view, finish));
    EXPECT_EQ(image.width, 320);
    EXPECT_EQ(image.height, 240);
    EXPECT_EQ(image.rgb.size(), 320U * 240 * 3);
    for (const int x : {0, 310})
      for (const int y : {0, 230}) EXPECT_EQ(painted(image, x, y, 10, 10), 0);
  };
  for (const View view : {View::surface, View::particles, View::both})
    for (const Finish finish : finishes) check(view, finish);
}

TEST(Picture, body_covers_its_projected_area) {
  Snapshot snapshot = synthetic_snapshot(0, 0);
  snapshot.bones.clear();
  Painter painter(snapshot.surface, synthetic_scale());
  PictureOptions options = options_for(snapshot, View::surface);
  const Vec3 size = bounds(snapshot.surface.points).sizes(), back = options.camera.view.row(2);
  const Vec3 sides(size.y() * size.z(), size.z() * size.x(), size.x() * size.y());
  const double pixels = sides.dot(back.cwiseAbs()) / std::pow(scale_of(options), 2);
  for (const Finish finish : finishes) {
    options.finish = finish;
    EXPECT_NEAR(painted(painter.draw(snapshot, options)) / (pixels / (320 * 240)), 1, 0.09);
  }
}

TEST(Picture, particles_are_spheres_of_their_true_radius) {
  const Snapshot snapshot = two_spheres(three_quarter_view());
  Painter painter({}, {"value", "", 0, 1});
  PictureOptions options = options_for(snapshot, View::particles);
  const double pixels = 2 * pi / std::pow(scale_of(options), 2);
  for (const Finish finish : finishes) {
    options.finish = finish;
    EXPECT_NEAR(painted(painter.draw(snapshot, options)) / (pixels / (320 * 240)), 1, 0.12);
  }
}

TEST(Picture, particles_show_their_values_in_the_colors_of_the_map) {
  const Snapshot snapshot = two_spheres(three_quarter_view());
  Painter painter({}, {"value", "", 0, 1});
  const Image image = painter.draw(snapshot, options_for(snapshot, View::particles));
  const int from_edge = 10 + 300 / 12;  // a radius of the 12 m wide frame
  const std::uint8_t* low = image.at(from_edge, 120);
  const std::uint8_t* high = image.at(320 - from_edge, 120);
  EXPECT_GT(low[2], low[0] + 40);    // indigo
  EXPECT_GT(high[0], high[2] + 40);  // yellow
}

TEST(Picture, bones_shine_through_the_skin) {
  Snapshot snapshot = synthetic_snapshot(0, 0);
  Painter painter(snapshot.surface, synthetic_scale());
  const PictureOptions options = options_for(snapshot, View::surface);
  const Image with = painter.draw(snapshot, options);
  snapshot.bones.clear();
  const Image without = painter.draw(snapshot, options);
  int darker = 0;
  for (std::size_t i = 0; i < with.rgb.size(); i += 3) darker += with.rgb[i] + 40 < without.rgb[i];
  EXPECT_GT(darker, 200);
}

TEST(Picture, one_painter_draws_the_same_again) {
  const Snapshot rest = synthetic_snapshot(0, 0), bent = synthetic_snapshot(1, 0);
  Painter painter(rest.surface, synthetic_scale());
  const PictureOptions options = options_for(rest, View::both);
  const Image first = painter.draw(rest, options);
  painter.draw(bent, options_for(bent, View::particles, Finish::quick));
  EXPECT_EQ(painter.draw(rest, options).rgb, first.rgb);
}

/// Fraction of the pixels that differ by more than rounding does.
double differing(const Image& a, const Image& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) count += std::abs(a.rgb[i] - b.rgb[i]) > 3;
  return static_cast<double>(count) / static_cast<double>(a.rgb.size());
}

TEST(Picture, tiles_join_without_seams) {
  const Snapshot snapshot = synthetic_snapshot(0.8, 0);
  Painter painter(snapshot.surface, synthetic_scale());
  for (const View view : {View::surface, View::both, View::bones})
    for (const Finish finish : finishes) {
      PictureOptions options = options_for(snapshot, view, finish);
      const Image whole = painter.draw(snapshot, options);
      options.tile = 90;                                     // divides neither side
      const double most = view == View::both ? 1e-2 : 5e-4;  // edges of spheres round differently
      EXPECT_LT(differing(painter.draw(snapshot, options), whole), most);
    }
}

TEST(Picture, all_moments_have_lines_or_none_has) {
  const Snapshot rest = synthetic_snapshot(0, 0);
  Snapshot swollen = rest;
  for (Vec3& point : swollen.surface.points) point *= 1.1;
  Painter of_rest(rest.surface, synthetic_scale()), of_swollen(swollen.surface, synthetic_scale());
  PictureOptions options{View::surface, {}, 120, 240, 10, Finish::fine};
  const double cell = make_shading(rest.surface).mean_line;
  const auto differ = [&](double pixels) {  // pictures of cells that are so long at rest
    const Vec3 corner = cell / pixels * Vec3(50, 110, 1000);
    options.camera.frame = Box(-corner, corner);
    return differing(of_rest.draw(swollen, options), of_swollen.draw(swollen, options));
  };
  EXPECT_GT(differ(6.6), 0.05);  // lines closer than 7 pixels are left out
  EXPECT_EQ(differ(7.4), 0);
}

/// A square of 4 m across the viewer's direction, `away` from the origin towards the viewer.
Triangles square(const Mat3& view, double away) {
  const Vec3 right = 2 * view.row(0).transpose(), up = 2 * view.row(1).transpose(),
             middle = away * view.row(2).transpose();
  return {{middle - right - up, middle + right - up, middle + right + up, middle - right + up},
          {{0, 1, 2}, {0, 2, 3}}};
}

TEST(Picture, obstacles_are_seen_and_seen_through) {
  Snapshot snapshot;
  snapshot.particles = {Vec3::Zero()};
  snapshot.radius = 1;
  const PictureOptions options{
      View::particles, {three_quarter_view(), Box(Vec3(-4, -3, -4), Vec3(4, 3, 4))}, 320, 240, 0,
      Finish::fine};
  Painter painter({}, {});
  const auto at = [&](double away, int x) {
    snapshot.obstacles = away == 0 ? Triangles() : square(options.camera.view, away);
    const Vec3 far = Vec3::Constant(9);
    snapshot.obstacle_space = Box(-far, far);
    const Image image = painter.draw(snapshot, options);
    return Vec3(image.at(x, 120)[0], image.at(x, 120)[1], image.at(x, 120)[2]);
  };
  const int ball = 160, beside = 220;
  EXPECT_EQ(at(0, beside), Vec3(255, 255, 255));
  for (const double away : {-2.0, 2.0}) {
    EXPECT_LT(at(away, beside).x(), 235) << away;
    EXPECT_GT(at(away, beside).x(), 150) << away;
  }
  EXPECT_EQ(at(-2, ball), at(0, ball));  // hidden by the ball
  EXPECT_GT((at(2, ball) - at(0, ball)).norm(), 10);
  EXPECT_GT(at(2, ball).x() - at(2, ball).z(), 20);  // the ball's color through it
}

TEST(Picture, obstacles_end_with_their_space) {
  Snapshot snapshot;
  snapshot.radius = 1;
  snapshot.obstacles = square(view_from({0, -1, 0}), 0);
  snapshot.obstacle_space = Box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const Box box = seen(view_from({0, -1, 0}), snapshot);
  EXPECT_NEAR((box.sizes() - Vec3(2, 2, 0)).norm(), 0, 1e-12);
  Painter painter({}, {});
  const PictureOptions options{
      View::both,  {view_from({0, -1, 0}), Box(Vec3(-4, -3, -4), Vec3(4, 3, 4))}, 320, 240, 0,
      Finish::fine};
  EXPECT_NEAR(painted(painter.draw(snapshot, options)), 4 / 48.0, 0.005);
}

TEST(Picture, what_is_left_out_is_pale_where_nothing_else_is) {
  Snapshot snapshot = synthetic_snapshot(0, 0);
  snapshot.bones.clear();
  const double middle = bounds(snapshot.surface.points).center().z();
  for (const Vec3& point : snapshot.surface.points)
    snapshot.skin_sides.push_back(point.z() - middle);
  snapshot.particles.clear(), snapshot.values.clear(), snapshot.marks.clear();
  for (const Finish finish : finishes) {
    PictureOptions options = options_for(snapshot, View::surface, finish);
    Painter painter(snapshot.surface, synthetic_scale());
    const Image half = painter.draw(snapshot, options);
    snapshot.opened = true;
    const Image opened = painter.draw(snapshot, options);
    snapshot.opened = false;
    EXPECT_GT(painted(opened), 1.6 * painted(half));
    int changed = 0, own = 0;
    for (int y = 2; y < half.height - 2; ++y)
      for (int x = 2; x < half.width - 2; ++x) {
        const auto is_painted = [&](int dx, int dy) {
          const auto* at = half.at(x + dx, y + dy);
          return at[0] < 250 || at[1] < 250 || at[2] < 250;
        };
        if (!(is_painted(0, 0) && is_painted(2, 0) && is_painted(-2, 0) && is_painted(0, 2) &&
              is_painted(0, -2)))
          continue;  // the edge is blended
        ++own;
        changed += !std::equal(half.at(x, y), half.at(x, y) + 3, opened.at(x, y));
      }
    EXPECT_GT(own, 1000);
    EXPECT_EQ(changed, 0);
  }
}

TEST(Picture, held_particles_keep_their_color_with_a_dark_dot) {
  Snapshot snapshot = two_spheres(three_quarter_view());
  snapshot.marks = {Mark::held, Mark::none};
  Painter painter({}, {"value", "", 0, 1});
  const Image image = painter.draw(snapshot, options_for(snapshot, View::particles));
  EXPECT_LT(image.at(35, 120)[2], 80);
  EXPECT_GT(image.at(35, 134)[2], 110);  // the lowest color, indigo
  snapshot.values.clear();
  EXPECT_LT(painter.draw(snapshot, options_for(snapshot, View::particles)).at(35, 134)[2], 80);
  snapshot.values = {0, 1};
  EXPECT_GT(image.at(285, 120)[0], 150);
  snapshot.marks.pop_back();
  EXPECT_EQ(error_of([&] { painter.draw(snapshot, options_for(snapshot, View::both)); }).exit(),
            Exit::bad_input);
}

TEST(Picture, an_empty_snapshot_is_white) {
  Painter painter({}, {});
  EXPECT_EQ(painted(painter.draw({}, {})), 0);
}

TEST(Picture, refuses_what_cannot_be_drawn) {
  Snapshot snapshot = synthetic_snapshot(0, 0);
  Painter painter(snapshot.surface, synthetic_scale());
  PictureOptions options = options_for(snapshot, View::both);
  const auto refused = [&] {
    return error_of([&] { painter.draw(snapshot, options); }).exit() == Exit::bad_input;
  };
  options.width = 8;
  EXPECT_TRUE(refused());
  options.width = 320;
  snapshot.values.pop_back();
  EXPECT_TRUE(refused());
  snapshot.values.clear();
  snapshot.surface.points.pop_back();
  EXPECT_TRUE(refused());
}

/// Two balls along the picture with a line of each end of the colors above and below them.
Snapshot with_lines(const Mat3& view) {
  Snapshot snapshot = two_spheres(view);
  snapshot.values.clear();
  const Vec3 right = 10 * view.row(0).transpose(), up = 2 * view.row(1).transpose();
  snapshot.lines = {{up, up + right, 0}, {-up, right - up, 1}};
  return snapshot;
}

TEST(Picture, lines_show_their_values) {
  const Snapshot snapshot = with_lines(three_quarter_view());
  Painter painter({}, {"strain", "", 0, 1});
  const PictureOptions options{
      View::lines, {three_quarter_view(), Box(Vec3(-1, -3, -9), Vec3(11, 3, 9))}, 240, 120, 0,
      Finish::fine};
  const Image image = painter.draw(snapshot, options);
  EXPECT_EQ(painted(image, 0, 30, 240, 60), 0);  // no particles
  const auto color_in_row = [&](int middle) {
    Vec3 darkest(255, 255, 255);
    for (int y = middle - 3; y <= middle + 3; ++y) {
      const Vec3 color(image.at(120, y)[0], image.at(120, y)[1], image.at(120, y)[2]);
      if (color.sum() < darkest.sum()) darkest = color;
    }
    return darkest;
  };
  const Vec3 low = color_in_row(20), high = color_in_row(100);
  EXPECT_GT(low.z(), low.x() + 40);
  EXPECT_GT(high.x(), high.z() + 40);
}

TEST(Picture, traces_are_drawn_over_the_body_up_to_their_particle) {
  Snapshot snapshot = synthetic_snapshot(0, 0);
  Painter painter(snapshot.surface, synthetic_scale());
  const PictureOptions options = options_for(snapshot, View::surface);
  const Image without = painter.draw(snapshot, options);
  const Vec3 center = bounds(snapshot.surface.points).center();
  snapshot.traces = {{{center, center, center + Vec3(0, 0, 0.1)}, ""}};
  const Image with = painter.draw(snapshot, options);
  int red = 0, changed = 0;
  for (std::size_t i = 0; i < with.rgb.size(); i += 3) {
    const bool here = with.rgb[i] != without.rgb[i] || with.rgb[i + 1] != without.rgb[i + 1];
    changed += here;
    red += here && with.rgb[i] > with.rgb[i + 1] + 60;
  }
  EXPECT_GT(red, 40);
  EXPECT_GT(red, changed * 4 / 5);
  snapshot.traces[0].label = "2964";
  EXPECT_GT(differing(painter.draw(snapshot, options), with), 1e-4);
}

TEST(Picture, a_camera_sees_the_whole_of_a_trace) {
  Snapshot snapshot;
  snapshot.traces = {{{{-1, 0, 0}, {5, 0, 0}}, "1"}};
  const Box box = seen(view_from({0, -1, 0}), snapshot);
  EXPECT_NEAR(box.sizes().x(), 6, 1e-12);
}

/// Its skin colored by the height, without bones.
Snapshot with_colored_skin() {
  Snapshot snapshot = synthetic_snapshot(0, 0);
  snapshot.bones.clear();
  const Box box = bounds(snapshot.surface.points);
  for (const Vec3& point : snapshot.surface.points)
    snapshot.skin_values.push_back(0.5 * (point.z() - box.min().z()) / box.sizes().z());
  return snapshot;
}

TEST(Picture, skin_shows_its_values_in_the_colors_of_the_map) {
  const Snapshot snapshot = with_colored_skin();
  Painter painter(snapshot.surface, synthetic_scale());
  PictureOptions options = options_for(snapshot, View::surface);
  options.camera.view = view_from({0, -1, 0});
  options.camera.frame = seen(options.camera.view, snapshot);
  const Image image = painter.draw(snapshot, options);
  const std::uint8_t *low = image.at(160, 222), *high = image.at(160, 18);
  EXPECT_GT(low[2], low[0] + 40);    // indigo
  EXPECT_GT(high[0], high[2] + 40);  // yellow
}

TEST(Picture, skin_without_a_value_is_gray) {
  Snapshot snapshot = with_colored_skin();
  std::fill(snapshot.skin_values.begin(), snapshot.skin_values.end(),
            std::numeric_limits<double>::quiet_NaN());
  Painter painter(snapshot.surface, synthetic_scale());
  const Image image = painter.draw(snapshot, options_for(snapshot, View::surface));
  const std::uint8_t* middle = image.at(160, 120);
  EXPECT_LT(*std::max_element(middle, middle + 3) - *std::min_element(middle, middle + 3), 12);
}

/// In halves, skin is on the one side and particles are on the other; both to the same scale.
TEST(Picture, halves_show_skin_on_one_side_and_particles_on_the_other) {
  Snapshot snapshot = with_colored_skin();
  const PictureOptions options = options_for(snapshot, View::halves);
  const Vec3 right = options.camera.view.row(0);
  const double middle = right.dot(bounds(snapshot.surface.points).center());
  for (const Vec3& point : snapshot.surface.points)
    snapshot.skin_sides.push_back(right.dot(point) - middle);
  Painter painter(snapshot.surface, synthetic_scale());
  const Image whole = painter.draw(snapshot, options);
  snapshot.particles.clear(), snapshot.values.clear();
  const Image skin = painter.draw(snapshot, options);
  EXPECT_GT(painted(skin, 110, 20, 45, 200), 0.5);
  EXPECT_LT(painted(skin, 165, 20, 155, 200), 0.01);
  EXPECT_GT(painted(whole, 165, 20, 45, 200), 0.5);
}

TEST(Picture, refuses_values_that_are_not_one_per_point_of_the_skin) {
  Snapshot snapshot = with_colored_skin();
  Painter painter(snapshot.surface, synthetic_scale());
  const PictureOptions options = options_for(snapshot, View::surface);
  snapshot.skin_values.pop_back();
  EXPECT_EQ(error_of([&] { painter.draw(snapshot, options); }).exit(), Exit::bad_input);
}

/// A cube of 2 m about the origin, as its skin and as six tetrahedra around a diagonal, cut in the
/// middle by the plane y = 0; the value is x.
Snapshot cut_cube() {
  Snapshot snapshot;
  SnapshotCut& cut = snapshot.cut;
  for (int i = 0; i < 8; ++i)
    cut.points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  for (const Vec3& point : cut.points) cut.values.push_back(point.x());
  for (const auto& [a, b] : {std::pair(1U, 3U), {3U, 2U}, {2U, 6U}, {6U, 4U}, {4U, 5U}, {5U, 1U}})
    cut.cells.push_back({0U, a, b, 7U});
  cut.point = Vec3::Zero(), cut.normal = -Vec3::UnitY();
  snapshot.surface.points = cut.points;
  snapshot.surface.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                            {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const Vec3& point : cut.points) snapshot.skin_sides.push_back(-point.y());
  return snapshot;
}

TEST(Picture, a_cut_is_flat_and_has_exactly_the_colors_of_its_values) {
  const Snapshot snapshot = cut_cube();
  const ColorScale scale{"x", "m", -1, 1};
  Painter painter(snapshot.surface, scale);
  PictureOptions options{View::cut, {}, 300, 300, 10, Finish::fine};
  options.camera.view = view_from({0, -1, 0});
  options.camera.frame = seen(options.camera.view, snapshot);
  const Image image = painter.draw(snapshot, options);
  for (const int y : {60, 150, 240})
    for (const int x : {60, 100, 150, 200, 240}) {
      const Color color = scale.color((x + 0.5 - 150) / 140);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(image.at(x, y)[c], color[c], 3) << x;
    }
}

TEST(Picture, far_from_the_origin_is_the_same) {
  Snapshot near = synthetic_snapshot(0.8, 0.2);
  near.obstacles = {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  near.obstacle_space = bounds(near.particles);
  near.traces.push_back({{near.particles.front(), near.particles.back()}, "7"});
  const double size = bounds(near.particles).diagonal().norm();
  Painter painter(near.surface, synthetic_scale());
  const Image there = painter.draw(near, options_for(near, View::both));
  for (const int power : {10, 17, 23}) {
    const Vec3 by(std::ldexp(size, power), -std::ldexp(size, power - 1), 0);
    Snapshot far = near;
    shift(far, by);
    far.obstacle_space.translate(by);
    const Image image = painter.draw(far, options_for(far, View::both));
    double off = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
      off += std::abs(image.rgb[i] - there.rgb[i]) / static_cast<double>(image.rgb.size());
    EXPECT_LT(off, 1) << power;
  }
}

}  // namespace sinew::picture_test
