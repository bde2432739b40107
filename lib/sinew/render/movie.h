// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a movie (.mp4, H.264, as browsers play it) frame by frame, with the program ffmpeg.
//
//     Movie movie("bend.mp4", {.frames_per_second = 30});
//     movie.add(frame);
//     movie.finish();
#pragma once

#include <memory>
#include <string>

#include <sinew/render/image.h>

namespace sinew {

struct MovieOptions {
  int width = 1280, height = 720;  ///< even, pixels
  double frames_per_second = 30;
};

/// The file is created by finish(); without it nothing is left.
class Movie {
 public:
  /// Throws not written where ffmpeg is missing or the path cannot be written; bad input for a size
  /// that is odd or outside 16 .. 8192, or a rate outside 0.1 .. 240.
  Movie(const std::string& path, const MovieOptions& options);
  ~Movie();
  Movie(const Movie&) = delete;
  Movie& operator=(const Movie&) = delete;

  void add(const Image& frame);  ///< frame of the movie's size. Throws not written, bad input
  void finish();                 ///< throws not written, with the message of ffmpeg

 private:
  struct Encoder;
  MovieOptions options_;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace sinew
