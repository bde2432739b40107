// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/detail/orient.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include <sinew/mesh/detail/patches.h>
#include <sinew/mesh/surface.h>

namespace sinew {

namespace {

/// The faces of each patch.
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

/// For each patch that decides, the next one around it; -1 for none.
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
  std::vector<int> order;  // nested boxes: a shell's box is larger than those in it
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

namespace {

constexpr std::size_t max_samples = 256;

bool holds(const Box& outer, const Box& inner) {
  return outer.contains(inner) && outer.sizes() != inner.sizes();
}

/// Sorts boxes by their start along x; of two with the same start the longer one is first.
std::vector<int> swept(std::span<const Box> boxes) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tuple(boxes[a].min().x(), -boxes[a].max().x(), a) <
           std::tuple(boxes[b].min().x(), -boxes[b].max().x(), b);
  });
  return order;
}

/// Calls visit(box, around) for each box with those that contain it, the smallest first.
template <class Visit>
void for_each_contained(std::span<const Box> boxes, Visit&& visit) {
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

}  // namespace

bool encloses(const Winding& outer, std::span<const Corners> faces) {
  bool within = false;
  const std::size_t count = std::min(faces.size(), max_samples);
  for (std::size_t i = 0; i < count; ++i) {
    const Corners& face = faces[i * faces.size() / count];
    const std::optional<int> winding = outer.around((face[0] + face[1] + face[2]) / 3);
    if (winding && *winding <= 0) return false;
    within = within || winding;
  }
  return within;
}

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
  for_each_contained(boxes, [&](int i, const std::vector<int>& around) {
    const Shell inner = shell_of(i);
    const auto found = std::find_if(around.begin(), around.end(), [&](int candidate) {
      return encloses(winding_of(candidate), inner.faces);
    });
    if (found != around.end()) outer[i] = *found;
  });
  return outer;
}

namespace {

/// Whether the volume enclosed by all faces is negative.
bool inside_out(const Triangles& surface, const Patches& patches) {
  const Box box = bounds(surface.points);
  double volume = 0;
  for (std::size_t i = 0; i < surface.faces.size(); ++i)
    volume += (patches.turned[i] ? -1 : 1) * volume_below(surface, surface.faces[i], box.center());
  return volume < -volume_rounding(area(surface), box);
}

/// Area of the reversed patches among those that decide, minus that of the others.
struct Vote {
  bool cast = false;
  double excess = 0;

  void add(bool turns, double area) {
    cast = true;
    excess += turns ? area : -area;
  }
};

/// Orients patches that do not decide like the others.
void follow(std::vector<bool>& turn, const Triangles& surface, const Patches& patches,
            const PatchShapes& shapes, const Components& components) {
  std::vector<int> component(patches.count);
  for (std::size_t i = 0; i < patches.of_face.size(); ++i)
    component[patches.of_face[i]] = components.of_face[i];
  Vote all;
  std::vector<Vote> vote(components.count);
  for (int patch = 0; patch < patches.count; ++patch) {
    if (!shapes.shape[patch].decides()) continue;
    all.add(turn[patch], shapes.shape[patch].area);
    vote[component[patch]].add(turn[patch], shapes.shape[patch].area);
  }
  const bool otherwise = all.cast ? all.excess > 0 : inside_out(surface, patches);
  for (int patch = 0; patch < patches.count; ++patch) {
    const Vote& nearby = vote[component[patch]];
    if (!shapes.shape[patch].decides()) turn[patch] = nearby.cast ? nearby.excess > 0 : otherwise;
  }
}

}  // namespace

std::vector<bool> faces_to_turn(const Triangles& surface, std::span<const EdgeUse> uses,
                                const Patches& patches, const Components& components,
                                FillRule rule) {
  const PatchShapes shapes = shapes_of(surface, uses, patches);
  const std::vector<bool> cavity = cavities_of(surface, patches, shapes, rule);
  std::vector<bool> turn(patches.count);
  for (int patch = 0; patch < patches.count; ++patch)
    turn[patch] = (shapes.shape[patch].volume < 0) != cavity[patch];
  follow(turn, surface, patches, shapes, components);

  std::vector<bool> turned(surface.faces.size());
  for (std::size_t i = 0; i < turned.size(); ++i)
    turned[i] = patches.turned[i] != turn[patches.of_face[i]];
  return turned;
}

}  // namespace sinew
