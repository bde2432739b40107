// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/vtk/detail/grids.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <unordered_map>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

using Sample = std::array<int, 3>;

/// The image with a layer of outside around it; inside is above 0.
class Padded {
 public:
  explicit Padded(const LevelSet& image) : image_(image) {
    std::size_t negative = 0, all = 0;
    for_each([&](const Sample& at, double value) {
      if (!on_border(at)) return;
      ++all;
      negative += value < 0;
    });
    if (2 * negative > all) sign_ = 1;
    for_each([&](const Sample& at, double) {
      const bool in = inside(at);
      inside_ += in;
      if (in) faces_ += neighbors_outside(at);
      cut_ += in && on_border(at);
    });
  }

  std::size_t faces() const { return faces_; }  ///< faces of the surface: edges that it crosses
  std::size_t samples_inside() const { return inside_; }
  std::size_t samples_cut() const { return cut_; }  ///< inside, and on the image's border
  int size(int axis) const { return image_.size[axis]; }

  bool contains(const Sample& at) const {
    bool within = true;
    for (int k = 0; k < 3; ++k) within = within && at[k] >= 0 && at[k] < image_.size[k];
    return within;
  }

  double value(const Sample& at) const { return sign_ * image_.values[index(at)]; }
  bool inside(const Sample& at) const { return contains(at) && value(at) > 0; }

  /// Returns the fraction of the way to the surface, from an inside sample to its neighbor outside.
  double crossing(const Sample& in, const Sample& out) const {
    return contains(out) ? value(in) / (value(in) - value(out)) : 0;
  }

  Vec3 place(const Vec3& at) const { return image_.origin + image_.axes * at; }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    std::size_t i = 0;
    for (int z = 0; z < image_.size[2]; ++z)
      for (int y = 0; y < image_.size[1]; ++y)
        for (int x = 0; x < image_.size[0]; ++x) visit(Sample{x, y, z}, image_.values[i++]);
  }

  std::size_t neighbors_outside(const Sample& at) const {
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Sample next = at;
        next[axis] += step;
        count += !inside(next);
      }
    return count;
  }

  bool on_border(const Sample& at) const {
    bool border = false;
    for (int k = 0; k < 3; ++k) border = border || at[k] == 0 || at[k] == image_.size[k] - 1;
    return border;
  }

  std::size_t index(const Sample& at) const {
    const auto x = static_cast<std::size_t>(at[0]), y = static_cast<std::size_t>(at[1]),
               z = static_cast<std::size_t>(at[2]);
    const auto nx = static_cast<std::size_t>(image_.size[0]),
               ny = static_cast<std::size_t>(image_.size[1]);
    return x + nx * (y + ny * z);
  }

  const LevelSet& image_;
  double sign_ = -1;
  std::size_t inside_ = 0, cut_ = 0, faces_ = 0;
};

/// Sample number `corner` of a cell: its bits are the steps along the axes.
Sample corner_of(const Sample& cell, int corner) {
  return {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)};
}

Vec3 as_vector(const Sample& at) { return {double(at[0]), double(at[1]), double(at[2])}; }

/// The mean of where the surface crosses the cell's edges.
Vec3 mean_crossing(const Padded& image, const Sample& cell) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      Sample a = corner_of(cell, corner), b = corner_of(cell, corner | 1 << axis);
      if (image.inside(a) == image.inside(b)) continue;
      if (!image.inside(a)) std::swap(a, b);
      sum += as_vector(a) + image.crossing(a, b) * (as_vector(b) - as_vector(a));
      ++count;
    }
  return sum / count;
}

/// The trilinear value at a place within the cell (0 to 1), and its gradient.
std::pair<double, Vec3> interpolated(const Padded& image, const Sample& cell, const Vec3& at) {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const double v = image.value(corner_of(cell, corner));
    Vec3 weight, slope;
    for (int k = 0; k < 3; ++k) {
      const bool far = corner >> k & 1;
      weight[k] = far ? at[k] : 1 - at[k];
      slope[k] = far ? 1 : -1;
    }
    value += v * weight.prod();
    gradient += v * Vec3(slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                         weight[0] * weight[1] * slope[2]);
  }
  return {value, gradient};
}

/// Where the cell's corner of the surface lies, in samples.
Vec3 surface_corner(const Padded& image, const Sample& cell) {
  constexpr int steps = 3;  // steps of Newton's method: the first is nearly exact
  Vec3 mean = mean_crossing(image, cell);
  if (!image.contains(cell) || !image.contains(corner_of(cell, 7))) return mean;
  Vec3 at = mean - as_vector(cell);
  for (int i = 0; i < steps; ++i) {
    const auto [value, gradient] = interpolated(image, cell, at);
    if (!(gradient.squaredNorm() > 0)) return mean;
    at -= value / gradient.squaredNorm() * gradient;
    if (!at.allFinite()) return mean;
    at = at.cwiseMax(0).cwiseMin(1);
  }
  return as_vector(cell) + at;
}

/// Collects the surface: corners by cell, one face per edge that it crosses.
class Contour {
 public:
  explicit Contour(const Padded& image) : image_(image) {}

  PolygonSoup soup() {
    for (int z = 0; z < image_.size(2); ++z)
      for (int y = 0; y < image_.size(1); ++y)
        for (int x = 0; x < image_.size(0); ++x)
          if (image_.inside({x, y, z})) add_faces_around({x, y, z});
    return std::move(soup_);
  }

 private:
  void add_faces_around(const Sample& in) {
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Sample out = in;
        out[axis] += step;
        if (!image_.inside(out)) add_face(in, axis, step);
      }
  }

  /// Through the four cells around the edge, counter-clockwise seen from outside.
  void add_face(const Sample& in, int axis, int step) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Sample cell = in;
    cell[axis] += std::min(step, 0);
    std::vector<int> face;
    for (const auto& [du, dv] : {std::pair{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}) {
      Sample around = cell;
      around[u] += du, around[v] += dv;
      face.push_back(corner_in(around));
    }
    if (step < 0) std::reverse(face.begin(), face.end());
    soup_.polygons.push_back(std::move(face));
  }

  int corner_in(const Sample& cell) {
    std::int64_t key = 0;
    for (int k = 2; k >= 0; --k) key = key * (image_.size(k) + 1) + cell[k] + 1;
    const auto [found, added] = corners_.emplace(key, static_cast<int>(soup_.points.size()));
    if (added) soup_.points.push_back(image_.place(surface_corner(image_, cell)));
    return found->second;
  }

  const Padded& image_;
  PolygonSoup soup_;
  std::unordered_map<std::int64_t, int> corners_;
};

void check(const LevelSet& image) {
  for (const int size : image.size)
    if (size < 2)
      throw bad_input("the image has " + std::to_string(size) + " samples along an axis",
                      "give one with at least two along each");
  for (const double value : image.values)
    if (!std::isfinite(value))
      throw bad_input("the image has values that are not finite", "write it again without them");
}

/// A quadrilateral takes some 310 bytes of memory.
void check_faces(const Padded& image, std::size_t bytes) {
  const std::size_t faces = image.faces(), max_faces = 500'000 + bytes / 26;
  if (faces > max_faces)
    throw bad_input("its surface has " + std::to_string(faces) + " faces, more than " +
                        std::to_string(max_faces) + ", as of noise",
                    "smooth the image, or set another body.level");
}

/// Shifts the values so that the surface is at zero; returns what is said of it, or "".
std::string with_level(LevelSet& image, std::optional<double> level) {
  const auto [lowest, highest] = std::minmax_element(image.values.begin(), image.values.end());
  const double low = *lowest, high = *highest, halfway = low + (high - low) / 2;
  if (level && !(low < *level && *level < high))
    throw bad_input("no surface is at the level of " + number_text(*level) +
                        ": the image's values reach from " + three_digits(low) + " to " +
                        three_digits(high),
                    "give a level between them");
  const bool has_zero = low < 0 && high >= 0, has_halfway = low < halfway && halfway < high;
  if (!level && (has_zero || !has_halfway)) return {};
  for (double& value : image.values) value -= level.value_or(halfway);
  if (level) return {};
  return "all values of the image are from " + three_digits(low) + " to " + three_digits(high) +
         ": the surface is halfway, at " + three_digits(halfway) +
         "; set body.level if it is elsewhere";
}

}  // namespace

Error no_surface(double low, double high) {
  return bad_input("no surface is in the image: its values reach from " + three_digits(low) +
                       " to " + three_digits(high) + " and do not change their sign",
                   "give distances that are negative on one side, or set body.level");
}

Error no_image() {
  return bad_input("it holds no image, which a level needs", "leave out body.level");
}

void move_to_cells(LevelSet& image) {
  for (int& size : image.size) --size;
  image.origin += image.axes * Vec3::Constant(0.5);
}

PolygonSoup level_surface(LevelSet image, std::optional<double> level) {
  check(image);
  const std::string told = with_level(image, level);
  const Padded padded(image);
  if (padded.samples_inside() == 0) {
    const auto [low, high] = std::minmax_element(image.values.begin(), image.values.end());
    throw no_surface(*low, *high);
  }
  check_faces(padded, image.bytes);
  PolygonSoup soup = Contour(padded).soup();
  soup.warning = told;
  if (padded.samples_cut() > 0)
    soup.warning += std::string(told.empty() ? "" : "; ") +
                    "the body reaches the border of its image, at " +
                    std::to_string(padded.samples_cut()) +
                    " samples, and is cut off and closed there; give a larger image if it goes on";
  return soup;
}

}  // namespace sinew
