// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/image.h>

#include <sinew/core/file.h>
#include <sinew/render/detail/text.h>
#include "helpers.h"

namespace sinew::image_test {

TEST(Image, halving_takes_the_mean_of_four) {
  Image image(4, 2, {0, 0, 0});
  fill(image, 0, 0, 1, 2, {200, 100, 40});
  const Image half = halved(image);
  ASSERT_EQ(half.width, 2);
  ASSERT_EQ(half.height, 1);
  EXPECT_EQ(half.at(0, 0)[0], 100);
  EXPECT_EQ(half.at(0, 0)[2], 20);
  EXPECT_EQ(half.at(1, 0)[0], 0);
}

TEST(Image, what_lies_outside_is_cut_off) {
  Image image(10, 10);
  paste(image, Image(6, 6, palette::ink), -3, 7);
  EXPECT_NEAR(painted(image), 0.09, 1e-12);
  fill(image, 8, -5, 100, 6, palette::ink);
  EXPECT_NEAR(painted(image), 0.11, 1e-12);
}

TEST(Image, png_holds_its_size_and_colors) {
  const Folder folder;
  Image image(30, 20, {200, 10, 60});
  fill(image, 0, 0, 30, 10, {1, 2, 3});
  write_png(image, folder.file("a.png"));
  const std::string decode = "ffmpeg -loglevel error -i " + folder.file("a.png") +
                             " -f rawvideo -pix_fmt rgb24 - < /dev/null";
  std::string bytes;
  ASSERT_EQ(run(decode, &bytes), 0);
  EXPECT_EQ(bytes, std::string(image.rgb.begin(), image.rgb.end()));
}

TEST(Image, png_in_a_missing_folder_is_an_error_with_a_cure) {
  const Folder folder;
  const std::string place = folder.file("missing/a.png");
  const Error error = error_of([&] { write_png(Image(20, 20), place); });
  EXPECT_EQ(error.exit(), Exit::not_written);
  EXPECT_NE(std::string(error.what()).find(place), std::string::npos);
}

TEST(Image, png_that_cannot_replace_leaves_nothing_behind) {
  const Folder folder;
  std::filesystem::create_directory(folder.file("taken"));
  EXPECT_EQ(error_of([&] { write_png(Image(20, 20), folder.file("taken")); }).exit(),
            Exit::not_written);
  std::filesystem::remove(folder.file("taken"));
  EXPECT_TRUE(folder.empty());
}

TEST(Text, stands_where_it_is_aligned) {
  Image image(300, 60);
  write_text(image, "90\u00b0", 150, 10, {24, palette::ink, Align::right});
  EXPECT_GT(painted(image, 90, 0, 60, 60), 0.03);
  EXPECT_EQ(painted(image, 151, 0, 149, 60), 0);
  write_text(image, "90\u00b0", 150, 10, {24, palette::ink, Align::left});
  EXPECT_GT(painted(image, 151, 0, 60, 60), 0.03);
}

TEST(Image, is_cut_out_of_white_and_black) {
  const auto drawn_on = [](const Color& background) {  // nothing, half of a red, all of it
    Image image(3, 1, background);
    for (int c = 0; c < 3; ++c) {
      const int red = c == 0 ? 200 : 20;
      image.at(1, 0)[c] = static_cast<std::uint8_t>((red + background[c]) / 2);
      image.at(2, 0)[c] = static_cast<std::uint8_t>(red);
    }
    return image;
  };
  const Image image = cut_out(drawn_on({255, 255, 255}), drawn_on({0, 0, 0}));
  EXPECT_EQ(image.alpha[0], 0);
  EXPECT_NEAR(image.alpha[1], 128, 1);
  EXPECT_EQ(image.alpha[2], 255);
  for (const int x : {1, 2}) {
    EXPECT_NEAR(image.at(x, 0)[0], 200, 2);
    EXPECT_NEAR(image.at(x, 0)[1], 20, 2);
  }
  EXPECT_EQ(error_of([] { cut_out(Image(3, 1), Image(1, 3)); }).exit(), Exit::bad_input);
}

TEST(Image, a_png_has_transparency_where_the_image_has_it) {
  const Folder folder;
  Image image(4, 4);
  write_png(image, folder.file("opaque.png"));
  image.alpha.assign(16, 100);
  write_png(image, folder.file("glass.png"));
  const auto color_type = [&](const char* name) { return read_file(folder.file(name)).at(25); };
  EXPECT_EQ(color_type("opaque.png"), 2);  // RGB
  EXPECT_EQ(color_type("glass.png"), 6);   // RGBA
}

}  // namespace sinew::image_test
