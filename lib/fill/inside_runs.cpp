// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/inside_runs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "fill/depths.h"
#include "fill/open_winding.h"

namespace sinew {
namespace {

constexpr std::size_t rows_at_a_time = 64;
constexpr int samples = 4000;

/// What a piece of the rows came to.
struct Found {
  std::vector<Run> runs;
  std::vector<std::array<int, 2>> overlaps;  ///< components that share a site
  int deepest = 0;
};

/// Collects runs of one row and leaves out the sites on the surface.
class RowRuns {
 public:
  RowRuns(std::size_t row, const std::vector<RowSite>& on_surface, std::vector<Run>& runs)
      : row_(static_cast<std::int32_t>(row)),
        runs_(runs),
        next_(std::lower_bound(on_surface.begin(), on_surface.end(), RowSite{row_, 0})),
        end_(on_surface.end()) {}

  /// Sites first .. last - 1 lie inside. Calls come in the order of the sites.
  void add(int first, int last, int body) {
    while (next_ != end_ && next_->row == row_ && next_->site < last) {
      push(first, next_->site, body);
      first = std::max(first, next_->site + 1);
      ++next_;
    }
    push(first, last, body);
  }

 private:
  void push(int first, int last, int body) {
    if (first >= last) return;
    const bool follows = !runs_.empty() && runs_.back().row == row_ && runs_.back().last == first &&
                         runs_.back().body == body;
    follows ? void(runs_.back().last = last) : runs_.push_back({row_, first, last, body});
  }

  std::int32_t row_;
  std::vector<Run>& runs_;
  std::vector<RowSite>::const_iterator next_, end_;
};

class Sweep {
 public:
  Sweep(const Lattice& lattice, const Surface& surface)
      : lattice_(lattice),
        surface_(surface),
        crossings_(row_crossings(lattice, surface.triangles)),
        cap_crossings_(row_crossings(lattice, surface.caps)),
        winding_(lattice, surface.caps, cap_crossings_) {
    if (surface.closed() && surface.components > 1) owner_ = owners_of(surface, crossings_);
  }

  std::vector<RowSite> take_on_surface() { return std::move(crossings_.on_surface); }

  void closed_row(std::size_t row, Found& found) const {
    RowRuns runs(row, crossings_.on_surface, found.runs);
    Depths depths;
    int sum = 0, from = 0;
    for (const Crossing& one : crossings_.of(row)) {
      take(runs, from, one.site, sum, depths, found);
      from = one.site;
      sum += one.winding;
      if (!owner_.empty()) depths.cross(owner_[surface_.component[one.face]], one.winding);
    }
    take(runs, from, lattice_.rows[row].sites, sum, depths, found);
  }

  void open_row(std::size_t row, Found& found) const {
    RowRuns runs(row, crossings_.on_surface, found.runs);
    int sum = 0, from = 0;
    for (const Crossing& one : crossings_.of(row)) {
      smooth(row, from, one.site, sum, runs);
      found.deepest = std::max(found.deepest, sum);
      from = one.site;
      sum += one.winding;
    }
    smooth(row, from, lattice_.rows[row].sites, sum, runs);
  }

  double winding(std::size_t row, int site) const {
    int sum = 0;
    for (const Crossing& one : crossings_.of(row))
      if (one.site <= site) sum += one.winding;
    return sum + (winding_.none() ? 0 : winding_.share(row, site, {0.02, 1e9}).value);
  }

 private:
  static void take(RowRuns& runs, int first, int last, int sum, const Depths& depths,
                   Found& found) {
    if (first >= last || sum <= 0) return;
    found.deepest = std::max(found.deepest, sum);
    runs.add(first, last, depths.body(found.overlaps));
  }

  /// Between two crossings the winding number changes smoothly, faster near the surface: looked at
  /// in steps that double away from both ends, then between them where a doubt is left.
  void smooth(std::size_t row, int first, int last, int sum, RowRuns& runs) const {
    if (first >= last) return;
    std::vector<int> sites = {first, last - 1};
    for (int step = 1; step < (last - first) / 2; step *= 2) {
      sites.push_back(first + step);
      sites.push_back(last - 1 - step);
    }
    std::sort(sites.begin(), sites.end());
    sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
    const auto look = [&](int site) {
      const auto [value, clearance] = winding_.share(row, site, {0.001, 0.5 - sum});
      return Place{site, sum - 0.5 + value, clearance / (2 * lattice_.radius)};
    };
    Place before = look(sites[0]);
    if (before.margin > 0) runs.add(before.site, before.site + 1, 0);
    for (std::size_t i = 1; i < sites.size(); ++i) {
      const Place next = look(sites[i]);
      between(before, next, look, runs);
      if (next.margin > 0) runs.add(next.site, next.site + 1, 0);
      before = next;
    }
  }

  struct Place {
    int site;
    double margin;     ///< of the winding number above one half
    double clearance;  ///< from the border, in sites
  };

  /// Away from the border the winding number is smooth: where two places are no farther from each
  /// other than from the border, and their margins differ by little, those between have their sign.
  static bool smooth_between(const Place& a, const Place& b) {
    const double least = std::min(std::abs(a.margin), std::abs(b.margin));
    return std::abs(a.margin - b.margin) < least / 4 && b.site - a.site < a.clearance + b.clearance;
  }

  /// The sites between two, of which neither is the first or the last.
  template <class Look>
  static void between(const Place& a, const Place& b, const Look& look, RowRuns& runs) {
    if (b.site - a.site < 2) return;
    if (smooth_between(a, b)) {
      if (a.margin > 0) runs.add(a.site + 1, b.site, 0);
      return;
    }
    const Place middle = look(a.site + (b.site - a.site) / 2);
    between(a, middle, look, runs);
    if (middle.margin > 0) runs.add(middle.site, middle.site + 1, 0);
    between(middle, b, look, runs);
  }

  const Lattice& lattice_;
  const Surface& surface_;
  RowCrossings crossings_, cap_crossings_;
  OpenWinding winding_;
  std::vector<int> owner_;  ///< of each component, where there are several
};

int root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Joins overlapping components and numbers what encloses a volume by its first component.
void number_bodies(const std::vector<Found>& found, const Surface& surface, InsideRuns& inside) {
  std::vector<int> parent(surface.components);
  std::iota(parent.begin(), parent.end(), 0);
  for (const Found& piece : found)
    for (const auto& [a, b] : piece.overlaps) {
      const auto [low, high] = std::minmax({root(parent, a), root(parent, b)});
      parent[high] = low;
    }
  const std::vector<double> volumes = component_volumes(surface);
  inside.body_of.assign(surface.components, -1);
  for (int i = 0; i < surface.components; ++i) {
    if (volumes[i] <= 0) continue;
    int& first = inside.body_of[root(parent, i)];
    if (first < 0) first = inside.bodies++;
    inside.body_of[i] = first;
  }
  for (Run& run : inside.runs) run.body = inside.body_of[run.body];
}

template <class Row>
std::vector<Found> for_all_rows(std::size_t rows, const Row& row) {
  std::vector<Found> found((rows + rows_at_a_time - 1) / rows_at_a_time);
  parallel_for(rows, rows_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) row(i, found[begin / rows_at_a_time]);
  });
  return found;
}

}  // namespace

InsideRuns inside_runs(const Lattice& lattice, const Surface& surface) {
  Sweep sweep(lattice, surface);
  const bool closed = surface.closed();
  const auto found = for_all_rows(lattice.rows.size(), [&](std::size_t row, Found& piece) {
    closed ? sweep.closed_row(row, piece) : sweep.open_row(row, piece);
  });
  InsideRuns inside;
  for (const Found& piece : found) {
    inside.runs.insert(inside.runs.end(), piece.runs.begin(), piece.runs.end());
    inside.deepest = std::max(inside.deepest, piece.deepest);
  }
  inside.on_surface = sweep.take_on_surface();
  if (closed) number_bodies(found, surface, inside);
  return inside;
}

double ambiguous_share(const Lattice& lattice, const Surface& surface) {
  if (surface.closed()) return 0;
  const Sweep sweep(lattice, surface);
  const std::uint64_t step = std::max<std::uint64_t>(1, lattice.sites() / samples);
  std::vector<RowSite> chosen;
  std::uint64_t next = step / 2, before = 0;
  for (std::size_t row = 0; row < lattice.rows.size(); ++row) {
    for (; next < before + lattice.rows[row].sites; next += step)
      chosen.push_back({static_cast<std::int32_t>(row), static_cast<std::int32_t>(next - before)});
    before += lattice.rows[row].sites;
  }
  const double unsure =
      parallel_sum(chosen.size(), rows_at_a_time, [&](std::size_t i, std::size_t end) {
        double count = 0;
        for (; i < end; ++i) {
          const double w = sweep.winding(chosen[i].row, chosen[i].site);
          count += std::abs(w - std::round(w)) > 0.1;
        }
        return count;
      });
  return chosen.empty() ? 0 : unsure / static_cast<double>(chosen.size());
}

}  // namespace sinew
