// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the present state of a simulation as one frame of each series, by a separate thread while
// the simulation continues. Also writes bones.csv, supports.csv, probes.csv, checksums.sfv
// and, where the scene
// requests them, the surface by skinning alone and its export for animators.
//
//     FrameWriter writer(folder, output, body, surface, obstacles);
//     writer.add(simulation, time);
//     writer.close();
#pragma once

#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <sinew/core/triangles.h>
#include <sinew/io/bone_table.h>
#include <sinew/io/checksums.h>
#include <sinew/io/point_cache.h>
#include <sinew/io/series.h>
#include <sinew/run/background.h>
#include <sinew/run/frame_data.h>
#include <sinew/run/probe_table.h>
#include <sinew/run/support_table.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/simulation.h>
#include <sinew/world/world.h>

namespace sinew {

class FrameWriter {
 public:
  /// `kept`: times (s) of frames already written. The body must outlive the writer. Throws not
  /// written, and bad input when one of those frames is missing.
  FrameWriter(const std::filesystem::path& folder, const OutputSettings& output, const Body& body,
              const FrameScene& scene, std::span<const double> kept = {},
              StrainInFrames strain = StrainInFrames::by_default);
  /// The same of a scene that begins.
  FrameWriter(const std::filesystem::path& folder, const OutputSettings& output,
              const Prepared& prepared);

  /// Takes the frame at `time` (s) from the simulation; waits until the frame before is written.
  /// `begun`: others have written its particles, see Series::finish(). Throws not
  /// written, also for an earlier frame: then nothing more is written.
  void add(Simulation& simulation, double time, bool begun = false);
  /// Whether others may write the particles of frames, each a piece of them.
  bool can_be_begun() const { return data_.is_plain(); }
  /// Runs the job that make() returns once all earlier frames are written, unless that fails.
  void then(const std::function<Background::Job()>& make) { writer_.hand(make); }
  /// Waits until all frames are written and named by the PVDs. Throws not written.
  void close();

  /// Nothing where the scene has no probes.
  const ProbeTable* probes() const { return probe_table_ ? &*probe_table_ : nullptr; }

  /// How long add() has waited for earlier frames to be written, s.
  double waited() const { return writer_.waited(); }

  /// Frames that are written.
  int written() const { return written_; }

 private:
  const Series* find(std::string_view series) const;
  void begin_export(const Triangles& surface, std::size_t kept, SurfaceLook look);
  void write(bool begun);
  void write_series(Series& series, bool begun);
  void write_supports();
  void write_probes(const FrameMoment& now);
  void begin_checksums();
  void list_new_frames();

  std::filesystem::path folder_;
  const Body& body_;
  FrameData data_;             ///< data of the frame that is being written
  std::size_t every_;          ///< number of frames of which one contains particles
  std::size_t taken_;          ///< frames so far
  std::deque<Series> series_;  ///< order of data_: particles, surface, ...
  BoneTable bone_table_;
  std::optional<SupportTable> support_table_;  ///< where the scene has some, or loads
  std::optional<ProbeTable> probe_table_;      ///< where the scene has some
  std::unique_ptr<PointCache> export_;
  Vec3 export_origin_ = Vec3::Zero();      ///< origin of its places, m
  SurfaceLook look_;                       ///< look of the exported surface
  std::vector<std::array<int, 3>> faces_;  ///< faces of the surface
  std::optional<Checksums> checksums_;
  std::vector<std::size_t> listed_;  ///< frames of each series whose checksums are
  std::atomic<int> written_ = 0;
  Background writer_{1};  ///< the last member: destroyed before the data it uses
};

}  // namespace sinew
