// SPDX-License-Identifier: GPL-3.0-or-later
// A body that a person poses while it moves. It steps through its own recording: what was done
// becomes keys at even times, and the recording, run as a scene, makes the same steps to the last
// bit.
//
//     Session session(scene, {folder});
//     session.hand().aim(bone, place, session.ahead());
//     session.advance();                       // to the next key
//     session.save("wave");                    // wave.yaml, wave.keys.csv
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sinew/play/hand.h>
#include <sinew/play/knobs.h>
#include <sinew/play/recording.h>
#include <sinew/run/particle_meter.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/settings.h>
#include <sinew/stepping/simulation.h>

namespace sinew {

struct SessionOptions {
  std::filesystem::path folder;       ///< folder of what is written
  std::string name = "session";       ///< name of the recording that goes on
  std::optional<BoneKeys> pose = {};  ///< in which it begins, held there; none: as the scene does
};

class Session {
 public:
  /// Throws bad input, with the scene's line, for scenes of the static method, groups of particles
  /// and clips that stretch bones.
  Session(const Settings& scene, SessionOptions options);

  const Skeleton& skeleton() const { return skeleton_; }
  const Surface& surface() const { return surface_; }
  /// Surfaces of the obstacles, as they are now.
  Triangles obstacles() const;
  Simulation& simulation() { return *simulation_; }
  ParticleMeter& meter() { return *meter_; }
  const Settings& recorded() const { return recording_->scene(); }
  const KeyGrid& grid() const { return recording_->grid(); }
  std::int64_t key() const { return key_; }          ///< number of the present key
  double time() const { return grid().time(key_); }  ///< s
  std::string hash() const;                          ///< hash of the state, as in run.json

  // Input acts from the next key on. In the past, it makes what came after forgotten.

  /// The bones at the last key that is determined.
  const BoneKeys& ahead() const;
  Hand& hand() { return settle(), *hand_; }
  Knobs& knobs() { return settle(), *knobs_; }
  const Knobs& knobs_now() const { return *knobs_; }
  const Hand& hand_now() const { return *hand_; }
  /// The bones at the present key.
  const BoneKeys& present() const;

  /// Steps to the next key. Throws unstable where a step fails: the body is then as it was not long
  /// before.
  void advance();

  // The past: some states in a second, of the last 20 s, and the first.

  double earliest() const;  ///< time of the first of the last 20 s, s
  double latest() const;    ///< time up to which it has gone, s
  /// Goes to the state nearest to a time (s).
  void go_to(double time);

  /// Writes NAME.yaml and NAME.keys.csv into the folder, which end now. Throws bad input for a
  /// name with other characters than letters, digits, - and _, for that of a recording that goes on
  /// or of a scene, and at the start; not written.
  std::filesystem::path save(const std::string& name) const;
  /// Brings the recording on disk up to date, whatever of the past is shown. Throws not written.
  void keep() {
    recording_->keep(options_.folder, options_.name, is_past() ? past_.back().key : key_);
  }

 private:
  struct Moment {
    std::int64_t key = 0;
    SimulationState state;
    Hand hand;
    Knobs::Targets targets;
    std::vector<BoneKeys> keys;  ///< bones at this key and the next
  };

  BoneKeys clip_at(std::int64_t key) const;
  bool is_past() const { return shown_ < past_.size(); }
  void settle();
  void remember();
  void show(std::size_t moment);

  SessionOptions options_;
  Skeleton skeleton_;
  Surface surface_;
  std::vector<Triangles> obstacles_;  ///< surfaces in their own frames
  Motion clip_;                       ///< the scene's own
  std::optional<Recording> recording_;
  std::optional<Hand> hand_;
  std::optional<Knobs> knobs_;
  std::optional<ParticleMeter> meter_;
  std::optional<Simulation> simulation_;
  std::int64_t key_ = 0;
  std::int64_t per_moment_ = 1;  ///< keys between moments
  std::deque<Moment> past_;      ///< ascending; the first of all is kept
  std::size_t shown_ = 0;        ///< index of the moment that is shown; past_.size(): the present
};

}  // namespace sinew
