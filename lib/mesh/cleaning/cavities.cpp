// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cleaning/cavities.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "mesh/cleaning/nesting.h"

namespace sinew {
namespace {

/// Which of the faces are of which patch.
class Grouped {
 public:
  Grouped(const std::vector<int>& group_of, int groups)
      : end_(groups + 1), items_(group_of.size()) {
    for (const int group : group_of) ++end_[group + 1];
    std::partial_sum(end_.begin(), end_.end(), end_.begin());
    for (std::size_t i = 0; i < group_of.size(); ++i)
      items_[end_[group_of[i]]++] = static_cast<int>(i);
  }

  std::span<const int> of(int group) const {
    const std::size_t begin = group > 0 ? end_[group - 1] : 0;
    return {items_.data() + begin, end_[group] - begin};
  }

 private:
  std::vector<std::size_t> end_;
  std::vector<int> items_;
};

Corners corners_of(const Triangles& triangles, int face, bool turned) {
  const auto& [a, b, c] = triangles.faces[face];
  return {triangles.points[a], triangles.points[turned ? c : b], triangles.points[turned ? b : c]};
}

/// For each patch that decides the next one around it; -1 for none.
std::vector<int> outer_patches(const Triangles& surface, const Patches& patches,
                               const PatchShapes& shapes) {
  std::vector<int> patch_of;  // each shell's
  std::vector<Box> boxes;
  for (int patch = 0; patch < patches.count; ++patch) {
    if (!shapes.shape[patch].decides()) continue;
    patch_of.push_back(patch);
    boxes.push_back(shapes.shape[patch].box);
  }
  std::vector<int> outer(patches.count, -1);
  if (boxes.size() < 2) return outer;
  const Grouped faces(patches.of_face, patches.count), caps(shapes.patch_of_cap, patches.count);
  const auto shell_of = [&](int i) {
    const bool inward = shapes.shape[patch_of[i]].volume < 0;
    Shell shell;
    for (const int face : faces.of(patch_of[i]))
      shell.faces.push_back(corners_of(surface, face, patches.turned[face] != inward));
    for (const int face : caps.of(patch_of[i]))
      shell.caps.push_back(corners_of(shapes.caps, face, inward));
    return shell;
  };
  const std::vector<int> found = next_outer(boxes, shell_of);
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] >= 0) outer[patch_of[i]] = patch_of[found[i]];
  return outer;
}

}  // namespace

std::vector<bool> cavities_of(const Triangles& surface, const Patches& patches,
                              const PatchShapes& shapes, FillRule rule) {
  const std::vector<int> outer = outer_patches(surface, patches, shapes);
  std::vector<int> order;  // those within others: a shell's box is larger than those in it
  for (std::size_t patch = 0; patch < outer.size(); ++patch)
    if (outer[patch] >= 0) order.push_back(static_cast<int>(patch));
  const auto size = [&](int patch) { return shapes.shape[patch].box.volume(); };
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(-size(a), a) < std::pair(-size(b), b); });
  std::vector<bool> cavity(outer.size(), false);
  for (const int patch : order) {
    const bool opposed =
        (shapes.shape[patch].volume < 0) != (shapes.shape[outer[patch]].volume < 0);
    cavity[patch] = cavity[outer[patch]] != (rule == FillRule::hollow || opposed);
  }
  return cavity;
}

}  // namespace sinew
