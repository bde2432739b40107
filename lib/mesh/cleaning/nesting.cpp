// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cleaning/nesting.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <tuple>

namespace sinew {
namespace {

constexpr std::size_t most_samples = 256;

bool holds(const Box& outer, const Box& inner) {
  return outer.contains(inner) && outer.sizes() != inner.sizes();
}

/// By where boxes begin along x; of two that begin at the same place the longer one comes first.
std::vector<int> swept(std::span<const Box> boxes) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tuple(boxes[a].min().x(), -boxes[a].max().x(), a) <
           std::tuple(boxes[b].min().x(), -boxes[b].max().x(), b);
  });
  return order;
}

/// Calls visit(box, around) for each box with those that hold it, the smallest first.
template <class Visit>
void for_each_held(std::span<const Box> boxes, Visit&& visit) {
  std::vector<int> open, around;
  for (const int i : swept(boxes)) {
    std::erase_if(open, [&](int other) { return boxes[other].max().x() < boxes[i].min().x(); });
    around.clear();
    std::copy_if(open.begin(), open.end(), std::back_inserter(around),
                 [&](int other) { return holds(boxes[other], boxes[i]); });
    std::sort(around.begin(), around.end(), [&](int a, int b) {
      return std::pair(boxes[a].volume(), a) < std::pair(boxes[b].volume(), b);
    });
    if (!around.empty()) visit(i, around);
    open.push_back(i);
  }
}

Points samples_of(const Shell& shell) {
  Points samples;
  const std::size_t count = std::min(shell.faces.size(), most_samples);
  for (std::size_t i = 0; i < count; ++i) {
    const Corners& face = shell.faces[i * shell.faces.size() / count];
    samples.push_back((face[0] + face[1] + face[2]) / 3);
  }
  return samples;
}

bool encloses(const Winding& outer, const Points& samples) {
  bool within = false;
  for (const Vec3& sample : samples) {
    const std::optional<int> winding = outer.around(sample);
    if (winding && *winding <= 0) return false;
    within = within || winding;
  }
  return within;
}

}  // namespace

std::vector<int> next_outer(std::span<const Box> boxes, const std::function<Shell(int)>& shell_of) {
  std::vector<std::optional<Winding>> winding(boxes.size());
  const auto winding_of = [&](int i) -> const Winding& {
    if (!winding[i]) {
      Shell shell = shell_of(i);
      shell.faces.insert(shell.faces.end(), shell.caps.begin(), shell.caps.end());
      winding[i].emplace(std::move(shell.faces));
    }
    return *winding[i];
  };
  std::vector<int> outer(boxes.size(), -1);
  for_each_held(boxes, [&](int i, const std::vector<int>& around) {
    const Points samples = samples_of(shell_of(i));
    const auto found = std::find_if(around.begin(), around.end(), [&](int candidate) {
      return encloses(winding_of(candidate), samples);
    });
    if (found != around.end()) outer[i] = *found;
  });
  return outer;
}

}  // namespace sinew
