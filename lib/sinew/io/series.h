// SPDX-License-Identifier: GPL-3.0-or-later
// A series of frames: DIR/NAME.pvd, with one row per time, DIR/NAME.vtu.series with the same rows
// as JSON, and DIR/NAME/NAME_000000.vtu and so on.
//
//     Series particles("out/bend", {.series = "particles"});
//     particles.add(frame);
//     particles.close();
#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <sinew/io/vtu.h>

namespace sinew {

struct PvdRow {
  double time = 0;   ///< s
  std::string file;  ///< relative to the PVD's folder
};

/// The rows of a PVD file. Throws bad input, naming the file, where it is not a PVD, a time is not
/// a number, or a row points outside the folder (an absolute path, or one with "..").
std::vector<PvdRow> read_pvd(const std::filesystem::path& path);

/// The text of a PVD with these rows.
std::string pvd_text(const std::vector<PvdRow>& rows);

/// The text of a .series file with these rows, which ParaView and PyVista read as well.
std::string series_text(const std::vector<PvdRow>& rows);

/// Files that list the frames of a series: "particles.pvd" and "particles.vtu.series".
std::array<std::string, 2> series_files(const std::string& series);

/// "particles/particles_000012.vtu".
std::string frame_name(const std::string& series, std::size_t number);

/// Makes `rows` all that an existing series has: other frames are removed, and without rows its
/// lists. Throws not written.
void keep_frames(const std::filesystem::path& folder, const std::string& series,
                 const std::vector<PvdRow>& rows);

/// Writes a series frame by frame. A concurrent reader finds complete files only: each frame is
/// written before the PVD and the .series file list it, and these are replaced at most once a
/// second.
class Series {
 public:
  /// Starts the series format.series in `folder`, which is created; an older one is removed except
  /// for its first frames, at the times `kept` (s), after which it continues. Throws not written,
  /// and bad input when one of these is missing or DIR/NAME is a link to another folder.
  Series(std::filesystem::path folder, VtuFormat format, std::span<const double> kept = {});
  /// Closes; errors are ignored: call close() to receive them.
  ~Series();
  Series(const Series&) = delete;
  Series& operator=(const Series&) = delete;

  /// Writes one frame, later than the one before. Throws not written, and Error (unstable) naming
  /// the array for a value that is not finite, or becomes so in Float32.
  void add(const Dataset& frame);
  /// The same of a frame whose points are in the file already, in several pieces: see finish_vtu().
  void finish(const Dataset& frame);
  /// Removes what others began of later frames. Once they do so no more.
  void drop_begun() const;
  /// Brings the lists of frames up to date. Throws not written.
  void close();

  const std::vector<PvdRow>& rows() const { return rows_; }
  const std::string& name() const { return format_.series; }

 private:
  void keep(std::span<const double> times);
  void add_row(double time, std::string file);
  void write_lists();

  std::filesystem::path folder_;
  VtuFormat format_;
  std::vector<PvdRow> rows_;
  std::size_t rows_listed_ = 0;
  std::chrono::steady_clock::time_point listed_{};
};

}  // namespace sinew
