// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/movie.h>

#include <cstdlib>

#include "helpers.h"

namespace sinew::movie_test {

void add_frames(Movie& movie, int count, int width, int height) {
  for (int i = 0; i < count; ++i) {
    Image frame(width, height);
    fill(frame, 2 * i, 10, 20, 20, {200, 40, 40});
    movie.add(frame);
  }
}

/// Other programs cannot be found while this lives.
class EmptyPath {
 public:
  explicit EmptyPath(const Folder& folder) { setenv("PATH", folder.file("missing").c_str(), 1); }
  ~EmptyPath() { setenv("PATH", before_.c_str(), 1); }

 private:
  const std::string before_ = std::getenv("PATH");
};

TEST(Movie, is_h264_with_all_frames_in_the_size_and_rate_asked_for) {
  const Folder folder;
  Movie movie(folder.file("a.mp4"), {96, 64, 24});
  add_frames(movie, 30, 96, 64);
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.mp4")));
  movie.finish();
  const std::string probe =
      "ffprobe -v error -count_frames -select_streams v -of csv=p=0 -show_entries "
      "stream=codec_name,width,height,pix_fmt,avg_frame_rate,nb_read_frames ";
  std::string found;
  ASSERT_EQ(run(probe + folder.file("a.mp4"), &found), 0);
  EXPECT_EQ(found, "h264,96,64,yuv420p,24/1,30\n");
}

TEST(Movie, given_up_leaves_nothing) {
  const Folder folder;
  {
    Movie movie(folder.file("a.mp4"), {96, 64, 30});
    add_frames(movie, 3, 96, 64);
  }
  EXPECT_TRUE(folder.empty());
}

TEST(Movie, without_ffmpeg_says_what_to_install) {
  const Folder folder;
  const EmptyPath path(folder);
  const Error error = error_of([&] { Movie(folder.file("a.mp4"), {}); });
  EXPECT_EQ(error.exit(), Exit::not_written);
  EXPECT_NE(std::string(error.what()).find("apt-get install ffmpeg"), std::string::npos);
  EXPECT_TRUE(folder.empty());
}

TEST(Movie, in_a_missing_folder_is_an_error) {
  const Folder folder;
  const std::string place = folder.file("missing/a.mp4");
  const Error error = error_of([&] { Movie(place, {}); });
  EXPECT_EQ(error.exit(), Exit::not_written);
  EXPECT_NE(std::string(error.what()).find(place), std::string::npos);
}

TEST(Movie, tells_what_ffmpeg_complained_about) {
  const Folder folder;
  std::filesystem::create_directory(folder.file("bin"));
  run("printf '#!/bin/sh\\necho disk is full >&2\\nexit 1\\n' > " + folder.file("bin/ffmpeg") +
      " && chmod +x " + folder.file("bin/ffmpeg"));
  const std::string before = std::getenv("PATH");
  setenv("PATH", folder.file("bin").c_str(), 1);
  const Error error = error_of([&] {
    Movie movie(folder.file("a.mp4"), {96, 64, 30});
    add_frames(movie, 500, 96, 64);
    movie.finish();
  });
  setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(error.exit(), Exit::not_written);
  EXPECT_NE(std::string(error.what()).find("disk is full"), std::string::npos);
}

TEST(Movie, refuses_sizes_h264_has_not_and_frames_that_do_not_fit) {
  const Folder folder;
  EXPECT_EQ(error_of([&] { Movie(folder.file("a.mp4"), {95, 64, 30}); }).exit(), Exit::bad_input);
  EXPECT_EQ(error_of([&] { Movie(folder.file("a.mp4"), {96, 64, 0}); }).exit(), Exit::bad_input);
  Movie movie(folder.file("a.mp4"), {96, 64, 30});
  EXPECT_EQ(error_of([&] { movie.add(Image(64, 96)); }).exit(), Exit::bad_input);
}

}  // namespace sinew::movie_test
