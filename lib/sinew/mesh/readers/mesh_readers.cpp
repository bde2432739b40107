// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/mesh/readers/mesh_readers.h>

#include <cmath>
#include <limits>

#include <sinew/core/text.h>

namespace sinew {

Vec3 next_point(Words& words, const MeshFile& file) {
  Vec3 point;
  for (double& coordinate : point) {
    const std::string_view word = words.next();
    const auto number = number_in(word);
    if (!number || !std::isfinite(*number))
      throw file.broken(words.line(),
                        word.empty() ? "the vertex has fewer than 3 coordinates"
                                     : "the coordinate " + shown(word) + " is not a finite number",
                        "correct the line or export the mesh again");
    coordinate = *number;
  }
  return point;
}

void refuse_too_many_points(const MeshFile& file, std::size_t points) {
  if (points <= std::numeric_limits<int>::max()) return;
  throw file.broken(0, "there are " + std::to_string(points) + " points, more than 2147483647",
                    "reduce the number of triangles");
}

}  // namespace sinew
