// SPDX-License-Identifier: GPL-3.0-or-later
// Which sites of a lattice are inside a mesh of 102,400 triangles: rows of sinew beside CGAL's and
// VTK's test of single points. `points/s` are sites of the mesh's box; `inside` shows that the
// answers agree.
//
//   cmake --build build --target benches
//   build/bench/fill_bench --benchmark_enable_random_interleaving=true --benchmark_repetitions=5

#include <benchmark/benchmark.h>
#include <algorithm>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/fill/detail/verify.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/fill/inside_runs.h>
#include <sinew/mesh/clean.h>

#include "bench/vtk_inside.h"
#include "mesh/shapes.h"

namespace {

using namespace sinew;

/// A torus: much of its box is outside.
const Surface& closed_mesh() {
  static const Surface surface = clean(shapes::torus(1, 0.45, 320, 160));
  return surface;
}

/// The same without a patch whose border has about 300 edges.
const Surface& open_mesh() {
  static const Surface surface = [] {
    PolygonSoup soup = shapes::torus(1, 0.45, 320, 160);
    std::erase_if(soup.polygons, [&](const auto& polygon) {
      const int i = polygon[0] / 160, j = polygon[0] % 160;
      return i < 90 && j < 60;
    });
    return clean(soup);
  }();
  return surface;
}

/// 8,192 triangles, each apart from its neighbors: every edge is open.
const Surface& separate_triangles() {
  static const Surface surface = clean(shapes::burst(shapes::sphere(0.45, 5), 0.9));
  return surface;
}

/// About `sites` in the box.
Lattice lattice_of(double sites) {
  const Box box = bounds(closed_mesh().triangles.points);
  return lattice_in(box, Packing::fcc, std::cbrt(box.volume() / sites / volume_per_particle(1)));
}

template <class Job>
void run(benchmark::State& state, double sites, const Job& job) {
  const auto threads = static_cast<int>(state.range(0));
  const Lattice lattice = lattice_of(sites);
  closed_mesh(), open_mesh(), separate_triangles();
  std::size_t inside = 0;
  with_threads(threads, [&] {
    for (auto _ : state) inside = job(lattice);
  });
  state.counters["inside"] = static_cast<double>(inside);
  state.counters["points/s"] = benchmark::Counter(
      static_cast<double>(lattice.sites() * state.iterations()), benchmark::Counter::kIsRate);
}

void rows(benchmark::State& state, double sites) {
  run(state, sites,
      [](const Lattice& lattice) { return count_of(inside_runs(lattice, closed_mesh()).runs); });
}

void rows_and_positions(benchmark::State& state, double sites) {
  run(state, sites, [](const Lattice& lattice) {
    return positions_of(lattice, inside_runs(lattice, closed_mesh()).runs).size();
  });
}

void rows_of_open_mesh(benchmark::State& state, double sites) {
  run(state, sites, [](const Lattice& lattice) {
    return positions_of(lattice, inside_runs(lattice, open_mesh()).runs).size();
  });
}

void rows_of_separate_triangles(benchmark::State& state, double sites) {
  run(state, sites, [](const Lattice& lattice) {
    return positions_of(lattice, inside_runs(lattice, separate_triangles()).runs).size();
  });
}

/// Every site by itself; the search tree is built beforehand.
void cgal(benchmark::State& state, double sites) {
  const SideOf side_of(closed_mesh().triangles);
  run(state, sites, [&](const Lattice& lattice) {
    return static_cast<std::size_t>(
        parallel_sum(lattice.rows.size(), 8, [&](std::size_t row, std::size_t end) {
          double count = 0;
          for (; row < end; ++row)
            for (int n = 0; n < lattice.rows[row].sites; ++n)
              count += side_of.side(lattice.site(lattice.rows[row], n)) == Side::inside;
          return count;
        }));
  });
}

void vtk(benchmark::State& state, double sites) {
  run(state, sites, [](const Lattice& lattice) {
    Points points;
    for (const LatticeRow& row : lattice.rows)
      for (int n = 0; n < row.sites; ++n) points.push_back(lattice.site(row, n));
    return inside_by_vtk(closed_mesh().triangles, points);
  });
}

}  // namespace

#define SINEW_FILL_BENCH(job, name, sites) \
  BENCHMARK_CAPTURE(job, name, sites)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond)

SINEW_FILL_BENCH(rows, 1e6, 1e6);
SINEW_FILL_BENCH(rows, 1e8, 1e8);
SINEW_FILL_BENCH(rows_and_positions, 1e6, 1e6);
SINEW_FILL_BENCH(rows_and_positions, 1e8, 1e8);
SINEW_FILL_BENCH(rows_of_open_mesh, 1e6, 1e6);
SINEW_FILL_BENCH(rows_of_separate_triangles, 1e6, 1e6);
SINEW_FILL_BENCH(cgal, 1e6, 1e6);
SINEW_FILL_BENCH(vtk, 1e5, 1e5);

BENCHMARK_MAIN();
