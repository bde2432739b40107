// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/near/near_surface.h"

#include <algorithm>

#include "core/parallel.h"
#include "fill/near/dilated_triangle.h"
#include "fill/near/row_ranges.h"
#include "fill/near/site_ranges.h"

namespace sinew {
namespace {

constexpr int tile_edge = 16;  // layers, and rows of each
constexpr std::size_t faces_at_a_time = 1024, points_at_a_time = 8192;

/// Parts the rows into tiles, so that what is kept at a time stays small and each row has one
/// thread. All faces that a tile's rows may meet are put down to it first.
class Rasteriser {
 public:
  Rasteriser(const Lattice& lattice, const Triangles& surface, double distance)
      : lattice_(lattice),
        surface_(surface),
        rows_(lattice),
        distance_(distance),
        tiles_up_(tiles(static_cast<int>(lattice.layers.size()))),
        tiles_across_(tiles(most_rows(lattice))),
        points_(surface.points.size()) {
    turn_points();
    sort_into_tiles();
  }

  std::vector<Run> all_runs() const {
    std::vector<std::vector<Run>> found(first_.size() - 1);
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t tile = begin; tile < end; ++tile) found[tile] = runs_of(tile);
    });
    return in_order(found);
  }

 private:
  struct Meeting {
    int tile, face;
  };

  static int tiles(int rows) { return (rows + tile_edge - 1) / tile_edge; }
  static int most_rows(const Lattice& lattice) {
    int most = 0;
    for (const LatticeLayer& layer : lattice.layers) most = std::max(most, layer.rows);
    return most;
  }

  Corners corners(int face) const {
    const auto& [a, b, c] = surface_.faces[face];
    return {points_[a], points_[b], points_[c]};
  }

  void turn_points() {
    parallel_for(points_.size(), points_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) points_[i] = rows_.turned(surface_.points[i]);
    });
  }

  void sort_into_tiles() {
    const std::size_t faces = surface_.faces.size();
    std::vector<std::vector<Meeting>> meetings((faces + faces_at_a_time - 1) / faces_at_a_time);
    parallel_for(faces, faces_at_a_time, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        put_down(static_cast<int>(i), meetings[begin / faces_at_a_time]);
    });
    first_.assign(std::size_t(tiles_up_) * tiles_across_ + 1, 0);
    for (const auto& piece : meetings)
      for (const Meeting& one : piece) ++first_[one.tile + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    faces_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& piece : meetings)
      for (const Meeting& one : piece) faces_[next[one.tile]++] = one.face;
  }

  void put_down(int face, std::vector<Meeting>& meetings) const {
    const Corners at = corners(face);
    const IndexRange layers = rows_.layers(up_reach(at, distance_));
    for (int layer = layers.first; layer < layers.last;) {
      const int tile_up = layer / tile_edge, end = std::min((tile_up + 1) * tile_edge, layers.last);
      const Interval across = across_reach(at, distance_, rows_.up(layer), rows_.up(end - 1));
      const IndexRange rows = rows_.rows(lattice_.layers[layer], across);  // in the others one off
      const int last = std::min(rows.last / tile_edge, tiles_across_ - 1);
      for (int tile = std::max(0, rows.first - 1) / tile_edge; tile <= last; ++tile)
        meetings.push_back({tile_up * tiles_across_ + tile, face});
      layer = end;
    }
  }

  std::vector<Run> runs_of(std::size_t tile) const {
    std::vector<Run> runs;
    if (first_[tile] == first_[tile + 1]) return runs;
    const int layer = static_cast<int>(tile) / tiles_across_ * tile_edge,
              row = static_cast<int>(tile) % tiles_across_ * tile_edge;
    std::vector<SiteRanges> found(tile_edge * tile_edge);
    for (std::size_t i = first_[tile]; i < first_[tile + 1]; ++i)
      rasterise(corners(faces_[i]), layer, row, found);
    for (int i = 0; i < tile_edge * tile_edge; ++i) {
      const int l = layer + i / tile_edge;
      if (l < static_cast<int>(lattice_.layers.size()))
        found[i].append_to(runs, lattice_.layers[l].first_row + row + i % tile_edge);
    }
    return runs;
  }

  void rasterise(const Corners& at, int first_layer, int first_row,
                 std::vector<SiteRanges>& found) const {
    const DilatedTriangle body(at, distance_);
    const IndexRange layers = rows_.layers(up_reach(at, distance_));
    const int end = std::min(first_layer + tile_edge, layers.last);
    for (int layer = std::max(first_layer, layers.first); layer < end; ++layer) {
      const LatticeLayer& in = lattice_.layers[layer];
      const double up = rows_.up(layer);
      const IndexRange rows = rows_.rows(in, across_reach(at, distance_, up, up));
      const int last = std::min(first_row + tile_edge, rows.last);
      for (int row = std::max(first_row, rows.first); row < last; ++row)
        meet(body, lattice_.rows[in.first_row + row], rows_.across(in, row), up,
             found[(layer - first_layer) * tile_edge + row - first_row]);
    }
  }

  void meet(const DilatedTriangle& body, const LatticeRow& row, double across, double up,
            SiteRanges& found) const {
    const IndexRange most = rows_.sites(row, body.along_at_most(across, up));
    if (most.first >= most.last || found.has(most)) return;
    found.add(rows_.sites(row, body.along(across, up)));
  }

  /// Counts, then places: a row's runs all come from one tile.
  std::vector<Run> in_order(const std::vector<std::vector<Run>>& found) const {
    std::vector<std::size_t> next(lattice_.rows.size() + 1, 0);
    for (const auto& tile : found)
      for (const Run& run : tile) ++next[run.row + 1];
    for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
    std::vector<Run> runs(next.back());
    for (const auto& tile : found)
      for (const Run& run : tile) runs[next[run.row]++] = run;
    return runs;
  }

  const Lattice& lattice_;
  const Triangles& surface_;
  RowRanges rows_;
  double distance_;
  int tiles_up_, tiles_across_;
  Points points_;                   ///< of the surface, turned
  std::vector<std::size_t> first_;  ///< of each tile's faces, and one past the last's end
  std::vector<int> faces_;
};

}  // namespace

std::vector<Run> runs_near(const Lattice& lattice, const Triangles& surface, double distance) {
  return Rasteriser(lattice, surface, distance).all_runs();
}

}  // namespace sinew
