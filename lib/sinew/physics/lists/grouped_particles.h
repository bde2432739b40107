// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of particles (../hierarchy/groups.h) as neighbor lists see them.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <sinew/physics/lists/near_pieces.h>

namespace sinew {

/// Groups of particles, which are not always at their places (../hierarchy/groups.h).
struct GroupedParticles {
  /// Puts those of some pieces there.
  std::function<void(std::span<const std::uint32_t> pieces)> show = [](const auto&) {};
  std::span<const std::int32_t> of_piece = {};  ///< a piece's only group, or -1; empty: all are -1
  /// How a piece of one group moves.
  std::function<PieceNow(std::size_t piece)> piece_now = {};
  std::vector<Mat3> stretch = {};  ///< F of each group
};

/// How much longer distances in groups were than they are now, at most. Most pieces of a group have
/// been listed at the same moment.
class Shrinking {
 public:
  explicit Shrinking(const std::vector<Mat3>& stretch) {
    for (const Mat3& F : stretch) inverse_.push_back(F.inverse());
  }

  double since(const Mat3& before, std::int32_t group) {
    if (group == group_ && before == before_) return last_;
    group_ = group, before_ = before;
    const Mat3 back = before * inverse_[static_cast<std::size_t>(group)];
    last_ = std::sqrt(1 + (back.transpose() * back - Mat3::Identity()).norm());
    return last_;
  }

 private:
  std::vector<Mat3> inverse_;
  std::int32_t group_ = -1;
  Mat3 before_ = Mat3::Zero();
  double last_ = 1;
};

}  // namespace sinew
