// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a body is filled wrongly when its mesh is broken, against the whole mesh.
#include <gtest/gtest.h>

#include <sinew/core/particles.h>
#include <sinew/fill/filled_sites.h>
#include <sinew/fill/runs.h>
#include <sinew/mesh/clean.h>
#include <sinew/repair/read_surface.h>
#include "mesh/shapes.h"
#include "support/source_dir.h"

namespace sinew::broken_test {

PolygonSoup triangles_of(const PolygonSoup& soup) {
  const Triangles triangles = clean(soup).triangles;
  PolygonSoup cut{triangles.points, {}};
  for (const auto& face : triangles.faces) cut.polygons.emplace_back(face.begin(), face.end());
  return cut;
}

/// The winding number of a hole's rim is wrong within a fraction of the hole's size: what is lost
/// shrinks with the faces. So these have 100,000 of them.
std::vector<PolygonSoup> bodies() {
  const std::string creature = test::source_dir() + "/data/meshes/creature.ply";
  return {shapes::sphere(1, 7), triangles_of(shapes::torus(1, 0.4, 320, 160)),
          shapes::refined(read_polygons(creature), 100000)};
}

/// The fraction of the whole's inside that the other one takes wrongly, or leaves out.
double wrong_fraction(const PolygonSoup& whole, const PolygonSoup& broken) {
  const Surface truth = clean(whole);
  const Box box = bounds(truth.triangles.points);
  const Lattice lattice =
      lattice_in(box, Packing::fcc, std::cbrt(box.volume() / 1e5 / volume_per_particle(1)));
  const auto right = inside_runs(lattice, truth).runs;
  const auto found = inside_runs(lattice, clean(broken)).runs;
  const std::size_t wrong =
      count_of(runs_without(right, found)) + count_of(runs_without(found, right));
  return static_cast<double>(wrong) / static_cast<double>(count_of(right));
}

TEST(BrokenMesh, WithoutOneFaceInTwentyLosesATenThousandth) {
  for (const PolygonSoup& body : bodies())
    EXPECT_LE(wrong_fraction(body, shapes::without(body, 0.05)), 2e-4);
}

TEST(BrokenMesh, WithoutOneFaceInFiveLosesThreeThousandths) {
  for (const PolygonSoup& body : bodies())
    EXPECT_LE(wrong_fraction(body, shapes::without(body, 0.2)), 3e-3);
}

TEST(BrokenMesh, WithFlippedFacesLosesNothing) {
  for (const PolygonSoup& body : bodies())
    EXPECT_EQ(wrong_fraction(body, shapes::flipped(body, 0.1)), 0);
}

/// Faces without neighbors cannot be turned back: the winding number has to bear them.
TEST(BrokenMesh, OfLooseFlippedFacesLosesFewHundredths) {
  const auto body = shapes::sphere(1, 4);
  EXPECT_LE(wrong_fraction(body, shapes::torn(shapes::flipped(body, 0.1), 1e-9)), 2e-2);
}

TEST(BrokenMesh, ThatStillClosesLosesNothing) {
  for (const PolygonSoup& body : bodies())
    for (const auto& broken :
         {shapes::together(body, body), shapes::together(body, shapes::inverted(body)),
          shapes::inverted(body), shapes::torn(body, 0), shapes::torn(shapes::inverted(body), 0)})
      EXPECT_EQ(wrong_fraction(body, broken), 0);
}

}  // namespace sinew::broken_test
