// SPDX-License-Identifier: GPL-3.0-or-later
// The frames of a run as snapshots to be drawn, with the values that color particles and skin.
//
//     const DrawnRun run("out/bend", {.presets = {view_preset_named("body")}});
//     const Snapshot last = run.snapshot(run.files().frames() - 1, run.view_presets().front());
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sinew/figures/drawn_plane.h>
#include <sinew/figures/drawn_values.h>
#include <sinew/figures/drawn_volume.h>
#include <sinew/figures/key_moments.h>
#include <sinew/figures/view_presets.h>
#include <sinew/render/snapshot.h>
#include <sinew/run/drawn_bonds.h>
#include <sinew/run/drawn_pulls.h>
#include <sinew/run/run_files.h>
#include <sinew/run/world_shown.h>

namespace sinew {

/// `angle` of the bones, for the caption, rad. Bones have their lengths in the frame.
Snapshot snapshot_of(const RunFiles& run, FrameState frame, double angle);

// A run as snapshots, and the quantities over all frames that the first picture needs.

/// A view preset applied to a run.
struct DrawnView {
  ViewPreset preset;
  DrawnValues values;
  std::optional<DrawnSkin> skin;    ///< where the skin is colored
  std::optional<DrawnBonds> bonds;  ///< where the preset's view is of lines: colored instead
  std::optional<DrawnPulls> pulls;  ///< where it is of the binding
  std::shared_ptr<const DrawnVolume> volume = nullptr;  ///< where it is of the volume
  ValueRange range = {};  ///< range of what is colored or drawn as arrows, over all frames

  /// Key in the ranges of a run; "": of what is drawn here alone.
  std::string quantity() const;
  /// The largest force is drawn as the longest arrow; false where all are rounding.
  bool is_pulled() const { return pulls && range.high > pulls->negligible(); }
  const std::string& name() const { return bonds ? bonds->name() : values.name(); }
  const std::string& unit() const { return bonds ? bonds->unit() : values.unit(); }
};

struct RunOverview {
  std::vector<double> angle;     ///< per frame: largest turn of a bone since rest, rad
  std::vector<double> shift;     ///< per frame: quadratic mean of the displacements of particles, m
  std::vector<double> farthest;  ///< per frame: the largest of these, m
  /// Per frame: the same mean of distances from the first frame, both about their means, m.
  std::vector<double> from_start = {};
  std::string turned = {};  ///< name of the bone that turns most
  /// Per frame: how far the camera has followed the body over the ground, m; empty: it stays.
  std::vector<Vec3> travel;
  /// Near the body, m: what is drawn is relative to it, so that runs far apart are compared.
  Vec3 origin = Vec3::Zero();
  Box frame;                ///< around the body at all times, in the camera's directions
  Cylinder around;          ///< the upright axis through its middle at rest, at all times
  Box obstacle_space = {};  ///< around it, m
  std::optional<DrawnPlane> plane = {};  ///< plane by which views cut the body open
  std::vector<Points> paths;             ///< paths of the traced particles, one point per frame, m
};

struct DrawnRunOptions {
  std::vector<ViewPreset> presets;
  std::string array;  ///< shown in color instead of each preset's own, or empty
  Mat3 view = three_quarter_view();
  std::vector<std::string> bones;      ///< names: these alone are drawn; the particles of
                                       ///< others are gray, without arrows; empty: all
  std::vector<int> traced;             ///< ids of the particles whose paths are drawn
  std::optional<CutPlane> plane = {};  ///< none: through the joint that turns most
  bool follows = true;                 ///< the camera, a body that leaves the place where it began
  bool by_front = false;  ///< `view` is of a figure that looks along -y: turned to where it looks
  bool ahead = true;      ///< reads frames in another thread
};

class DrawnRun {
 public:
  /// Reads all frames once. Throws bad input, also for bones and particles that the run lacks, and
  /// where none of the presets can be drawn.
  DrawnRun(const std::string& folder, DrawnRunOptions options);
  DrawnRun(const DrawnRun&) = delete;
  DrawnRun& operator=(const DrawnRun&) = delete;

  const RunFiles& files() const { return run_; }
  const RunOverview& overview() const { return overview_; }
  const std::vector<DrawnView>& view_presets() const { return views_; }
  /// A preset of several that cannot be drawn of this run, and why: they are not among the views.
  struct LeftOut {
    std::string preset, why;
  };
  const std::vector<LeftOut>& left_out() const { return left_out_; }
  /// Ranges of quantities: those that the run has recorded, and those found for its views.
  const ValueRanges& ranges() const { return ranges_; }
  std::string name() const;  ///< name of its folder
  const Mat3& view() const { return options_.view; }

  /// The frame nearest in time.
  std::size_t frame_at(double time) const;
  /// The force of a support or a load that the longest arrow at any time stands for, N; 0: none.
  double strongest_force() const { return forces_->strongest(); }
  std::vector<KeyMoment> key_moments() const;
  std::string return_in_words() const;  ///< see key_moments.h

  Snapshot snapshot(std::size_t index, const DrawnView& drawn) const;
  /// The same moment's body, cut open in the colors of its view. Throws as DrawnVolume does.
  DrawnView cut_open(const DrawnView& body) const;

 private:
  /// What the camera has to show.
  struct Extent {
    Box frame;
    Cylinder around;
    void extend(const Mat3& view, const Snapshot& snapshot);
  };

  void apply_presets();
  DrawnView applied(const ViewPreset& preset) const;
  void select_bones();
  void face_front();
  Vec3 travel(std::size_t index) const;
  struct Walk;
  void read_overview();
  void add(Walk& walk, std::size_t index, FrameState frame);
  void add_extent(Walk& walk, FrameState frame);
  void add_surroundings(Extent extent);
  void check_plane(const Box& body) const;
  std::vector<double> colored(std::size_t index, const FrameState& frame,
                              const DrawnView& drawn) const;
  double strongest_pull(const FrameState& frame, const DrawnView& drawn) const;
  bool is_selected(std::size_t particle) const;
  void show_selected(Snapshot& snapshot) const;
  void add_traces(Snapshot& snapshot, std::size_t index) const;
  void add_bonds(Snapshot& snapshot, std::size_t index, const DrawnView& drawn) const;
  void add_pulls(Snapshot& snapshot, const std::vector<DrawnPull>& pulls,
                 const DrawnView& drawn) const;
  void keep(Snapshot& snapshot, const std::function<bool(std::size_t i)>& is_kept) const;
  std::shared_ptr<const DrawnVolume> volume() const;
  void hide_bones(Snapshot& snapshot,
                  const std::function<bool(std::size_t bone)>& is_left_out) const;
  void show_section(Snapshot& snapshot) const;
  void halve(Snapshot& snapshot) const;
  void open_skin(Snapshot& snapshot, const CutPlane& plane) const;
  void color_skin(Snapshot& snapshot, std::vector<double> values) const;
  void add_obstacles(Snapshot& snapshot, std::size_t index) const;
  void add_arrows(Snapshot& snapshot, std::size_t index, const DrawnView& drawn,
                  const CutPlane& plane) const;

  RunFiles run_;
  DrawnRunOptions options_;
  std::vector<DrawnView> views_;
  std::vector<LeftOut> left_out_;
  ValueRanges ranges_;
  RunOverview overview_;
  std::optional<ShownForces> forces_;
  std::vector<bool> selected_;  ///< bones; empty: all
  std::vector<Mark> marks_;     ///< marks of the written particles; empty: none
  mutable std::shared_ptr<const DrawnVolume> volume_;  ///< made where it is asked for first
};

}  // namespace sinew
