// SPDX-License-Identifier: GPL-3.0-or-later
// An .mp4 (H.264, as browsers play it) made by the program ffmpeg from one picture after another.
#pragma once

#include <memory>
#include <string>

#include <sinew/render/image.h>

namespace sinew {

struct MovieOptions {
  int width = 1280, height = 720;  ///< even, pixels
  double frames_per_second = 30;
};

/// Appears at its path only once it is finished; given up before, it leaves nothing.
class Movie {
 public:
  /// Throws not written when ffmpeg is missing or the place cannot be written; bad input for a size
  /// that is odd or outside 16 .. 8192, or a rate outside 0.1 .. 240.
  Movie(const std::string& path, const MovieOptions& options);
  ~Movie();
  Movie(const Movie&) = delete;
  Movie& operator=(const Movie&) = delete;

  void add(const Image& frame);  ///< of the movie's size. Throws not written, bad input
  void finish();                 ///< throws not written, with what ffmpeg said

 private:
  struct Encoder;
  MovieOptions options_;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace sinew
