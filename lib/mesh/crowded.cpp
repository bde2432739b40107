// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/crowded.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace sinew {
namespace {

constexpr int most_rounds = 8;     // one is the rule; each makes the border shorter
constexpr double relevant = 1e-9;  // a gain below that of the lengths is rounding

/// A patch at a crowded edge.
struct Meeting {
  int patch, edge;
  int count;  ///< how much more often it goes along the edge than back, before it turns
};

class Crowd {
 public:
  Crowd(const Triangles& surface, std::span<const EdgeUse> uses, const Patches& patches,
        const std::vector<bool>& turn) {
    for_each_edge(uses, [&](std::span<const EdgeUse> use) {
      if (use.size() < 3) return;
      const int edge = static_cast<int>(length_.size());
      length_.push_back((surface.points[use[0].low] - surface.points[use[0].high]).norm());
      net_.push_back(0);
      for_each_border(use, patches, [&](int patch, int count) {
        meetings_.push_back({patch, edge, count});
        net_.back() += turn[patch] ? -count : count;
      });
    });
    std::stable_sort(meetings_.begin(), meetings_.end(),
                     [](const Meeting& a, const Meeting& b) { return a.patch < b.patch; });
  }

  /// The meetings of each patch that has any.
  std::vector<std::span<const Meeting>> patches() const {
    std::vector<std::span<const Meeting>> result;
    for (std::size_t begin = 0, end = 0; begin < meetings_.size(); begin = end) {
      while (end < meetings_.size() && meetings_[end].patch == meetings_[begin].patch) ++end;
      result.emplace_back(meetings_.data() + begin, end - begin);
    }
    return result;
  }

  /// Turns the patch of these meetings where that makes the border shorter.
  bool turn_if_shorter(std::span<const Meeting> meetings, std::vector<bool>& turn) {
    const int sign = turn[meetings[0].patch] ? -1 : 1;
    double gain = 0, length = 0;
    for (const Meeting& at : meetings) {
      const int turned = net_[at.edge] - 2 * sign * at.count;
      gain += length_[at.edge] * (std::abs(net_[at.edge]) - std::abs(turned));
      length += length_[at.edge];
    }
    if (!(gain > relevant * length)) return false;
    for (const Meeting& at : meetings) net_[at.edge] -= 2 * sign * at.count;
    turn[meetings[0].patch] = !turn[meetings[0].patch];
    return true;
  }

 private:
  std::vector<double> length_;  ///< of each crowded edge, m
  std::vector<int> net_;        ///< of each, over all its patches as they turn
  std::vector<Meeting> meetings_;
};

}  // namespace

void shorten_border(const Triangles& surface, std::span<const EdgeUse> uses, const Patches& patches,
                    const PatchShapes& shapes, std::vector<bool>& turn) {
  Crowd crowd(surface, uses, patches, turn);
  auto order = crowd.patches();
  std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    return std::abs(shapes.shape[a[0].patch].volume) < std::abs(shapes.shape[b[0].patch].volume);
  });
  bool changed = true;
  for (int round = 0; changed && round < most_rounds; ++round) {
    changed = false;
    for (const auto& meetings : order) changed |= crowd.turn_if_shorter(meetings, turn);
  }
}

}  // namespace sinew
