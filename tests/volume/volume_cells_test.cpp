// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of bodies as people have them: they are positive, share their faces, and have the volume of
// the mesh. SINEW_FIGURES=1 in the environment prints the figures of lib/sinew/volume/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>

#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/core/random.h>
#include <sinew/fill/fill_warnings.h>
#include <sinew/mesh/clean.h>
#include <sinew/repair/read_surface.h>
#include <sinew/volume/volume_cells.h>
#include "mesh/shapes.h"
#include "support/expect_error.h"
#include "support/source_dir.h"

namespace sinew::volume_cells_test {

PackOptions of_radius(double radius, Packing packing = Packing::fcc) {
  PackOptions options;
  options.packing = packing;
  options.radius = radius;
  return options;
}

PackOptions of_count(int count, Packing packing = Packing::fcc, int turned = 0) {
  PackOptions options;
  options.packing = packing;
  options.count = count;
  if (turned) options.lattice_axes = random_rotation(static_cast<std::uint64_t>(turned));
  return options;
}

struct Filled {
  Surface surface;
  PackOptions options;
  Points rest;
  VolumeCells cells;
  double seconds = 0;
};

Filled filled(const PolygonSoup& soup, PackOptions options) {
  Filled body{clean(soup), options, {}, {}};
  const Filling filling = pack(body.surface, options);
  body.options.radius = filling.particles.radius;
  body.options.count.reset();
  body.rest = positions_of(filling.particles);
  const auto start = std::chrono::steady_clock::now();
  body.cells = volume_cells(body.surface, body.options, body.rest);
  body.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return body;
}

PolygonSoup of_data(const char* name) {
  return read_polygons(std::string(test::source_dir() + "/data/meshes/") + name);
}

/// How many cells have each face.
std::map<std::array<std::uint32_t, 3>, int> faces_of(const VolumeCells& body) {
  std::map<std::array<std::uint32_t, 3>, int> faces;
  for (const Cell& cell : body.cells)
    for (int v = 0; v < 4; ++v) {
      std::array<std::uint32_t, 3> face = {cell[(v + 1) % 4], cell[(v + 2) % 4], cell[(v + 3) % 4]};
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  return faces;
}

TEST(VolumeCells, FillSpaceWithoutGaps) {
  for (const Packing packing : {Packing::fcc, Packing::hcp}) {
    const Filled body = filled(shapes::sphere(1, 5), of_radius(0.1, packing));
    for (const auto& [face, cells] : faces_of(body.cells)) {
      ASSERT_LE(cells, 2);
      if (cells == 2) continue;
      for (const std::uint32_t v : face) ASSERT_EQ(body.cells.id[v], -1) << "a hole inside";
    }
  }
}

/// Between particles all cells are alike: two tetrahedra and four quarters of an octahedron a site.
TEST(VolumeCells, HaveOneSixthOfAParticlesVolume) {
  for (const Packing packing : {Packing::fcc, Packing::hcp}) {
    PackOptions options = of_radius(0.1, packing);
    options.lattice_axes = random_rotation(3);
    const Filled body = filled(shapes::sphere(1, 5), options);
    std::size_t inner = 0;
    for (const Cell& cell : body.cells.cells) {
      if (std::any_of(cell.begin(), cell.end(),
                      [&](std::uint32_t v) { return body.cells.id[v] < 0; }))
        continue;
      ++inner;
      ASSERT_NEAR(volume_of(body.cells.points, cell), volume_per_particle(0.1) / 6, 1e-12);
    }
    EXPECT_GT(inner, 2 * body.rest.size());
  }
}

TEST(VolumeCells, HaveParticlesAtTheirExactPlaces) {
  PackOptions options = of_radius(0.1);
  options.lattice_axes = random_rotation(1);
  const Filled body = filled(shapes::moved(shapes::sphere(1, 4), Vec3(1e4, -3e3, 7)), options);
  std::set<std::int32_t> seen;
  for (std::size_t i = 0; i < body.cells.points.size(); ++i) {
    const std::int32_t id = body.cells.id[i];
    if (id < 0) continue;
    EXPECT_TRUE(seen.insert(id).second);
    EXPECT_EQ(body.cells.points[i], body.rest[id]);
  }
  EXPECT_GT(seen.size(), body.rest.size() / 2);
}

struct Case {
  const char* name;
  PolygonSoup soup;
  double volume;  ///< of the whole body, m^3
  int layers;     ///< across its thinnest part, roughly
  PackOptions options;
  double volume_error, smallest_angle;
};

/// The volume of the file's mesh, of bodies that share nothing.
double volume_of_soup(const PolygonSoup& soup) {
  double sum = 0;
  for (const double part : component_volumes(clean(soup))) sum += part;
  return sum;
}

std::vector<Case> whole_bodies() {
  std::vector<Case> cases;
  for (const char* name : {"box.obj", "arm.ply", "creature.ply", "tentacle.ply", "two_fingers.obj"})
    for (const Packing packing : {Packing::fcc, Packing::hcp})
      for (const int turned : {0, 1}) {
        const PolygonSoup soup = of_data(name);
        const PackOptions options = of_count(20000, packing, 4 * turned);
        cases.push_back({name, soup, volume_of_soup(soup), 20, options, 0.003, 8});
      }
  for (const double radius : {0.1, 0.05}) {
    const PolygonSoup ball = shapes::sphere(1, 6);
    const double limit = radius == 0.1 ? 0.01 : 0.003;
    cases.push_back({"ball", ball, volume_of_soup(ball), radius == 0.1 ? 10 : 20, of_radius(radius),
                     limit, 15});
    const PolygonSoup torus = shapes::torus(2, 1, 160, 80);
    cases.push_back({"torus", torus, volume_of_soup(torus), radius == 0.1 ? 10 : 20,
                     of_radius(radius), limit, 8});
    const PolygonSoup bumpy = shapes::bumpy_ball(6);
    cases.push_back({"bumpy ball", bumpy, volume_of_soup(bumpy), radius == 0.1 ? 10 : 20,
                     of_radius(radius), limit, 8});
  }
  return cases;
}

void check(const Case& given) {
  const Filled body = filled(given.soup, given.options);
  const CellQuality quality = quality_of(body.cells);
  const double error = quality.volume / given.volume - 1;
  if (std::getenv("SINEW_FIGURES"))
    std::printf("| %s | %s%s | %zu | %zu | %+.2f %% | %.1f | %.2f s |\n", given.name,
                given.options.packing == Packing::hcp ? "hcp" : "fcc",
                given.options.lattice_axes == Mat3::Identity() ? "" : ", turned", body.rest.size(),
                body.cells.cells.size(), 100 * error, quality.angles.smallest, body.seconds);
  EXPECT_GT(quality.smallest_volume, 0) << given.name;
  EXPECT_LE(std::abs(error), given.volume_error) << given.name;
  EXPECT_GE(quality.angles.smallest, given.smallest_angle) << given.name;
  for (const auto& [face, cells] : faces_of(body.cells)) ASSERT_LE(cells, 2) << given.name;
}

TEST(VolumeCells, HaveTheVolumeOfTheMesh) {
  for (const Case& one : whole_bodies()) check(one);
}

/// Inside is what the fill means by it.
TEST(VolumeCells, OfBrokenMeshesHaveTheVolumeOfTheWholeOne) {
  const PolygonSoup ball = shapes::sphere(1, 5), torus = shapes::torus(2, 1, 80, 40);
  const double V = volume_of_soup(ball), ring = volume_of_soup(torus);
  const PackOptions options = of_radius(0.07);
  const PolygonSoup far = shapes::sphere(1, 5, {2.1, 0, 0}),
                    near = shapes::sphere(1, 5, {0.5, 0, 0});
  const double lens = 2 * pi / 3 * 0.75 * 0.75 * (3 - 0.75) * V / (4 * pi / 3);
  for (const Case& one :
       {Case{"ball without 5 % of its faces", shapes::without(ball, 0.05), V, 14, options, 0.01, 5},
        Case{"ball without 20 %", shapes::without(ball, 0.2), V, 14, options, 0.02, 5},
        Case{"torus without 5 %", shapes::without(torus, 0.05), ring, 14, options, 0.01, 5},
        Case{"faces turned", shapes::flipped(ball, 0.1), V, 14, options, 0.01, 8},
        Case{"inside out", shapes::inverted(torus), ring, 14, options, 0.01, 8},
        Case{"single triangles", shapes::burst(ball), V, 14, options, 0.01, 8},
        Case{"torn by 0.02", shapes::torn(ball, 0.02), V, 14, options, 0.03, 5},
        Case{"two in one place", shapes::together(ball, ball), V, 14, options, 0.01, 8},
        Case{"two that overlap", shapes::together(ball, near), 2 * V - lens, 14, options, 0.01, 8},
        Case{"two that do not touch", shapes::together(ball, far), 2 * V, 14, options, 0.01, 8},
        Case{"ball with a cavity", shapes::together(ball, shapes::inverted(shapes::sphere(0.5, 5))),
             V * 7 / 8, 14, options, 0.01, 8}})
    check(one);
}

/// Bodies that are closer than the particles' spacing share no cell.
TEST(VolumeCells, KeepBodiesApart) {
  const PolygonSoup pair =
      shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({1.01, 0, 0}, {2.01, 1, 1}));
  const Filled body = filled(pair, of_radius(0.05));
  for (const Cell& cell : body.cells.cells) {
    int left = 0;
    for (const std::uint32_t v : cell) left += body.rest[body.cells.beside[v]].x() < 1.005;
    ASSERT_TRUE(left == 0 || left == 4);
  }
  EXPECT_NEAR(quality_of(body.cells).volume, 2, 0.01);
}

/// Solids that share a face are one body.
TEST(VolumeCells, JoinSolidsThatShareFaces) {
  const PolygonSoup pair =
      shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({1, 0, 0}, {2, 1, 1}));
  const Filled one = filled(shapes::box({0, 0, 0}, {2, 1, 1}), of_radius(0.07)),
               two = filled(pair, of_radius(0.07));
  EXPECT_EQ(two.rest, one.rest);
  EXPECT_EQ(two.cells.points, one.cells.points);
  EXPECT_EQ(two.cells.cells, one.cells.cells);
}

/// Plates that no layer of the lattice is parallel to. Sites in the middle of thin ones keep cells.
TEST(VolumeCells, OfThinPlatesKeepWhatTheParticlesHaveOfThem) {
  struct Wall {
    double radii, volume;  ///< thickness, and the least share of the volume
  };
  const Mat3 turn = Quat(0.9, 0.2, 0.3, 0.1).normalized().toRotationMatrix();
  for (const auto& [radii, least] :
       {Wall{4, 0.995}, {2.5, 0.99}, {2, 0.98}, {1.5, 0.93}, {1, 0.55}}) {
    PolygonSoup wall = shapes::box(Vec3::Zero(), Vec3(1, 0.8, 0.03 * radii));
    for (Vec3& point : wall.points) point = turn * point;
    const Filled body = filled(wall, of_radius(0.03));
    const CellQuality quality = quality_of(body.cells);
    EXPECT_GT(quality.volume / volume(body.surface.triangles), least) << radii;
    EXPECT_LT(quality.volume / volume(body.surface.triangles), 1.01) << radii;
    EXPECT_GT(quality.smallest_volume, 0) << radii;
    EXPECT_GT(quality.angles.smallest, 5) << radii;
    for (const auto& [face, cells] : faces_of(body.cells)) ASSERT_LE(cells, 2) << radii;
    const auto warning =
        cell_warning(quality.volume, volume(body.surface.triangles), 0.03, body.surface);
    EXPECT_EQ(warning.has_value(), radii < 2) << radii;
  }
}

TEST(VolumeCells, OfAShellHaveItsThickness) {
  PackOptions options = of_radius(0.02);
  options.thickness = 0.2;
  const Filled body = filled(shapes::sphere(1, 5), options);
  const double shell = 4 * pi / 3 * (std::pow(1.1, 3) - std::pow(0.9, 3));
  const CellQuality quality = quality_of(body.cells);
  EXPECT_NEAR(quality.volume / shell, 1, 0.01);
  EXPECT_GT(quality.smallest_volume, 0);
}

/// Particles kept away from the surface are inside; the border is at the surface all the same.
TEST(VolumeCells, ReachTheSurfaceWhereParticlesDoNot) {
  PackOptions options = of_radius(0.07);
  options.keep = Keep::sphere;
  const Filled body = filled(shapes::sphere(1, 5), options);
  EXPECT_NEAR(quality_of(body.cells).volume, volume(body.surface.triangles), 0.02);
}

TEST(VolumeCells, OfIrregularPackingsFillTheMeshToo) {
  for (const Packing packing : {Packing::random, Packing::conformal}) {
    const Filled body = filled(shapes::sphere(1, 5), of_radius(0.1, packing));
    const CellQuality quality = quality_of(body.cells);
    EXPECT_GT(quality.smallest_volume, 0);
    EXPECT_NEAR(quality.volume / volume(body.surface.triangles), 1, 0.01);
  }
}

TEST(VolumeCells, AreTheSameForAnyNumberOfThreads) {
  const PolygonSoup soup = of_data("arm.ply");
  const Filled one = filled(soup, of_count(3000));
  for (const int threads : {1, 3})
    with_threads(threads, [&] {
      const Filled other = filled(soup, of_count(3000));
      EXPECT_EQ(one.cells.cells, other.cells.cells);
      EXPECT_EQ(one.cells.points, other.cells.points);
    });
}

TEST(VolumeCells, NeedParticles) {
  const Surface surface = clean(shapes::sphere(1, 3));
  test::expect_bad_input([&] { volume_cells(surface, of_radius(0.1), {}); },
                         {"the body has no particles", "make its radius smaller"});
}

}  // namespace sinew::volume_cells_test
