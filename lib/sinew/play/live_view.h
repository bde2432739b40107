// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of a session sees: the body once, as the report's playback has it, and then frames,
// with what is shown alone.
//
//     LiveView view(session);
//     server.send(view.scene_text(session));
//     server.send_frame(view.frame(session, status));
//
// A frame has, one after the other: the bytes of the header (32 bits, lowest first), the header, in
// JSON and up to a multiple of 4 bytes, places of bones, skin, particles, and obstacles where they
// have moved, as 16-bit fractions of a cube that the header gives, and levels of the color, 8 bits
// for each particle, 255 for none.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/value_range.h>
#include <sinew/metrics/report/playback.h>
#include <sinew/play/session.h>
#include <sinew/rig/skin.h>

namespace sinew {

/// A number of particles that the page can show in color.
struct LiveField {
  std::string_view name, unit, label;
  double least = 0;          ///< width of the narrowest range: below it there is rounding alone
  bool is_measured = false;  ///< whether it takes time
};
std::span<const LiveField> live_fields();

/// What the page asks for.
struct LiveWish {
  bool particles = false, skin = true;
  std::string field = "strain_eq";  ///< name of a live field; "": none
  bool holds_range = false;         ///< else it follows the values
  bool exact = false;               ///< else what is measured may be a tenth of a second old
};

class LiveView {
 public:
  explicit LiveView(Session& session);

  LiveWish wish;

  /// The body, its bones, fields and colors, as JSON.
  std::string scene_text(Session& session);
  /// The present moment, with these members in the header. Measures where something is asked for
  /// that has to be measured.
  std::string frame(Session& session, nlohmann::ordered_json header);

  /// Smallest J and the share of particles that are inverted.
  struct Volumes {
    double J_min = 1, inverted = 0;
  };
  static Volumes volumes(Session& session);

 private:
  std::vector<double> values_of(Session& session, const Points& places) const;
  void find_levels(Session& session, const Points& places);

  Playback plan_;
  Skin skin_;
  Points rest_;
  Points obstacles_;  ///< corners of their triangles, as they were sent last
  ValueRange range_ = {};
  std::string ranged_;  ///< field of the range, and of the levels
  std::string levels_;
  std::chrono::steady_clock::time_point measured_;  ///< when they were found
};

}  // namespace sinew
