// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/fill/pack.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <set>

#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/hash.h>
#include <sinew/core/parallel.h>
#include <sinew/core/particles.h>
#include <sinew/fill/detail/verify.h>
#include <sinew/fill/lattice.h>
#include <sinew/mesh/clean.h>
#include <sinew/repair/read_surface.h>
#include "mesh/mesh_files.h"
#include "mesh/shapes.h"
#include "support/source_dir.h"

namespace sinew::pack_test {

const std::string paper_box = test::source_dir() + "/data/meshes/box.obj";

Surface paper_box_surface() { return read_surface(mesh_files::body_at(paper_box)); }

PackOptions with_radius(double radius, Packing packing = Packing::fcc) {
  PackOptions options;
  options.packing = packing;
  options.radius = radius;
  return options;
}

PackOptions with_count(int count) {
  PackOptions options;
  options.count = count;
  return options;
}

std::string message_of(const std::function<void()>& job) {
  try {
    job();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::bad_input);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(Pack, FillsPolygonsAsTheSurfaceOfThem) {
  // A unit cube: 1 / (4 sqrt(2) r^3) particles, less a layer at the faces.
  const Points points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                         {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  const std::vector<std::vector<int>> quads = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  const Filling filling = fill(points, quads, with_radius(0.02));
  const double dense = 1 / (4 * std::sqrt(2.0) * std::pow(0.02, 3));
  EXPECT_NEAR(static_cast<double>(filling.particles.size()) / dense, 1, 0.06);
  EXPECT_EQ(filling.particles.x, pack(clean({points, quads}), with_radius(0.02)).particles.x);
  EXPECT_THROW(fill(points, {{0, 1, 8}}, with_radius(0.02)), Error);
}

TEST(Pack, GivesTheMeshsMassInAll) {
  const Surface surface = paper_box_surface();
  PackOptions options = with_radius(0.010);
  options.density = 1234;
  const Particles particles = pack(surface, options).particles;
  const double expected = 1234 * volume(surface.triangles);
  EXPECT_NEAR(particles.mass * static_cast<double>(particles.size()) / expected, 1, 1e-12);
}

TEST(Pack, HasInnerParticlesTouching12OthersAt2r) {
  for (const Packing packing : {Packing::fcc, Packing::hcp}) {
    const Filling filling = pack(clean(shapes::sphere(1, 4)), with_radius(0.05, packing));
    const auto lists = neighbors_within(positions_of(filling.particles), rest_neighbor_range(0.05));
    for (std::size_t i = 0; i < filling.particles.size(); ++i) {
      ASSERT_EQ(filling.neighbors[i], static_cast<int>(lists.of(i).size()));
      ASSERT_TRUE(filling.neighbors[i] == 12 || filling.particles.position(i).norm() > 0.85);
    }
    EXPECT_NEAR(filling.report.smallest_distance, 1, 1e-12);
    EXPECT_NEAR(filling.report.mean_distance, 1, 1e-12);
  }
}

/// Every site of the lattice against a rule that knows the answer; `unsure` sites are left out.
struct Truth {
  PolygonSoup body;
  std::function<bool(const Vec3&)> inside, unsure;
};

void compare(const Truth& truth, double radius, Packing packing) {
  const Surface surface = clean(truth.body);
  const Points found = positions_of(pack(surface, with_radius(radius, packing)).particles);
  const Lattice lattice = lattice_in(bounds(surface.triangles.points), packing, radius);
  std::size_t next = 0, sure = 0;
  for (const LatticeRow& row : lattice.rows)
    for (int n = 0; n < row.sites; ++n) {
      const Vec3 site = lattice.site(row, n);
      const bool taken = next < found.size() && found[next] == site;
      next += taken;
      if (truth.unsure(site)) continue;
      ++sure;
      ASSERT_EQ(taken, truth.inside(site)) << site.transpose();
    }
  EXPECT_EQ(next, found.size());
  EXPECT_GT(sure, 1000u);
}

void compare(const Truth& truth, double radius) {
  compare(truth, radius, Packing::fcc);
  compare(truth, radius, Packing::hcp);
}

TEST(Inside, AgreesWithATetrahedronsPlanes) {
  const auto depth = [](const Vec3& p) { return std::min(p.minCoeff(), 1 - p.sum()); };
  compare({shapes::tetrahedron(), [=](const Vec3& p) { return depth(p) > 0; },
           [=](const Vec3& p) { return std::abs(depth(p)) < 1e-12; }},
          0.02);
}

TEST(Inside, AgreesWithASphere) {
  const auto body = shapes::sphere(1, 5);  // the flats are less than 0.002 deep
  compare({body, [](const Vec3& p) { return p.norm() < 1; },
           [](const Vec3& p) { return p.norm() > 0.998 && p.norm() < 1; }},
          0.04);
}

TEST(Inside, AgreesWithATorus) {
  const auto distance = [](const Vec3& p) {
    return std::hypot(std::hypot(p.x(), p.y()) - 1, p.z());
  };
  compare({shapes::torus(1, 0.4, 96, 48), [=](const Vec3& p) { return distance(p) < 0.4; },
           [=](const Vec3& p) { return std::abs(distance(p) - 0.4) < 0.003; }},
          0.03);
}

TEST(Inside, CountsSitesOnTheSurfaceAsOutside) {
  const double r = 0.125;
  const Vec3 about = Vec3::Constant(4.1 * half_plane_spacing(r));
  const Vec3 half = 4 * lattice_in({-about, about}, Packing::fcc, r).unit;  // sites on all sides
  const Filling filling = pack(clean(shapes::box(-half, half)), with_radius(r));
  EXPECT_EQ(filling.particles.size(), (7u * 7 * 7 - 1) / 2);
  EXPECT_EQ(filling.report.ties, (9u * 9 * 9 + 1) / 2 - (7u * 7 * 7 - 1) / 2);
}

TEST(Inside, LeavesOutSitesThatRoundingWouldPutOnTheSurface) {
  for (const double r : {0.125, 0.1, 0.3, 0.017}) {
    const Vec3 half = Vec3::Constant(4 * half_plane_spacing(r));
    EXPECT_EQ(pack(clean(shapes::box(-half, half)), with_radius(r)).particles.size(),
              (7u * 7 * 7 - 1) / 2);
  }
}

TEST(Inside, IsNotAffectedByAFaceWithoutArea) {
  const double r = 0.125;
  const Vec3 half = Vec3::Constant(4 * half_plane_spacing(r));
  auto body = shapes::box(-half, half);
  const auto plain = pack(clean(body), with_radius(r));
  body.points.emplace_back(half.x(), half.y(), 0);  // on the edge from point 3 to point 7
  body.polygons[5] = {1, 3, 8, 7, 5};
  body.polygons.push_back({3, 7, 8});
  const Surface surface = clean(body);
  EXPECT_EQ(surface.cleaning.faces_flat, 1u);
  const auto filling = pack(surface, with_radius(r));
  EXPECT_EQ(state_hash(filling.particles), state_hash(plain.particles));
  EXPECT_EQ(filling.report.ties, plain.report.ties);
}

TEST(Inside, LeavesOutFacesWithoutArea) {
  Triangles body = clean(shapes::tetrahedron()).triangles;
  for (const double x : {0.1, 0.2, 0.3}) body.points.emplace_back(x, 0.1, 0.1);
  body.faces.push_back({4, 5, 6});
  EXPECT_EQ(SideOf(body).side(Vec3(0.25, 0.1, 0.1)), Side::inside);
}

TEST(Pack, FillsAnInvertedBodyTheSame) {
  const auto body = shapes::torus(1, 0.4);
  const Filling outward = pack(clean(body), with_radius(0.05));
  const Surface inverted = clean(shapes::inverted(body));
  EXPECT_GT(volume(inverted.triangles), 0);
  EXPECT_EQ(state_hash(pack(inverted, with_radius(0.05)).particles), state_hash(outward.particles));
}

TEST(Pack, IsTheSameForAnyNumberOfThreads) {
  const Surface surface = clean(shapes::together(
      shapes::sphere(1, 3), shapes::moved(shapes::torus(1, 0.4), Vec3(0.1, 0.2, 2))));
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3, 8})
    with_threads(threads, [&] {
      const Filling filling = pack(surface, with_radius(0.05));
      Hash hash;
      hash.add(filling.component.data(), filling.component.size() * sizeof(std::int32_t));
      hash.add(filling.neighbors.data(), filling.neighbors.size() * sizeof(std::int32_t));
      hashes.push_back(state_hash(filling.particles) ^ hash.value());
    });
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(Pack, KeepsItsSitesWhenTheBodyIsMovedByExactAmounts) {
  auto body = shapes::sphere(1, 4);
  for (Vec3& point : body.points)  // multiples of 1/1024, so that moving loses no digit
    for (double& x : point) x = std::round(x * 1024) / 1024;
  const Vec3 by(16, -32, 8);
  const Filling here = pack(clean(body), with_radius(0.06));
  const Filling there = pack(clean(shapes::moved(body, by)), with_radius(0.06));
  ASSERT_EQ(there.particles.size(), here.particles.size());
  for (std::size_t i = 0; i < here.particles.size(); ++i)
    ASSERT_LT((there.particles.position(i) - by - here.particles.position(i)).norm(), 1e-13);
}

TEST(Pack, SitesFarAwayAreEvenlySpaced) {
  const auto box = shapes::box(Vec3::Zero(), Vec3::Ones());
  const Vec3 by(std::ldexp(1.0, 23), 0, 0);
  const Filling here = pack(clean(box), with_radius(0.06));
  const Filling there = pack(clean(shapes::moved(box, by)), with_radius(0.06));
  ASSERT_EQ(there.particles.size(), here.particles.size());
  for (std::size_t i = 0; i < here.particles.size(); ++i)
    ASSERT_LT((there.particles.position(i) - by - here.particles.position(i)).norm(), 1e-7);
  std::set<double> across(there.particles.x.begin(), there.particles.x.end());
  const double gap = *std::next(across.begin()) - *across.begin();
  for (auto next = std::next(across.begin()); next != across.end(); ++next)
    EXPECT_EQ(*next - *std::prev(next), gap);
}

TEST(Pack, WarnsWhereNumbersTellPlacesTooCoarsely) {
  const auto told = [](double far) {
    const auto box = shapes::moved(shapes::box(Vec3::Zero(), Vec3::Ones()), Vec3(0, far, 0));
    const std::vector<std::string> all = pack(clean(box), with_radius(0.06)).report.warnings;
    return std::count_if(all.begin(), all.end(), [](const std::string& warning) {
      return warning.find("move it nearer (body.offset)") != std::string::npos;
    });
  };
  EXPECT_EQ(told(std::ldexp(1.0, 24)), 0);
  EXPECT_EQ(told(-std::ldexp(1.0, 40)), 1);
}

TEST(Pack, FindsTheRadiusForACount) {
  const Surface surface = clean(shapes::sphere(1, 4));
  const Filling filling = pack(surface, with_count(20000));
  EXPECT_NEAR(static_cast<double>(filling.particles.size()), 20000, 200);
  EXPECT_NEAR(volume_per_particle(filling.particles.radius) * 20000 / volume(surface.triangles), 1,
              1e-12);
}

/// The warning that names the count, or "".
std::string miss_told(const Filling& filling, int wanted) {
  for (const std::string& warning : filling.report.warnings)
    if (warning.find("the " + std::to_string(wanted) + " requested") != std::string::npos)
      return warning;
  return {};
}

TEST(Pack, TellsWhatKeptItFarFromACount) {
  const Surface cube = clean(shapes::box(Vec3::Zero(), Vec3::Ones()));
  PackOptions deep = with_count(100000);
  deep.clearance = 0.497;
  const std::string kept_out = miss_told(pack(cube, deep), 100000);
  EXPECT_NE(kept_out.find("1 particle "), std::string::npos) << kept_out;
  EXPECT_NE(kept_out.find("clearance"), std::string::npos) << kept_out;

  const Filling layered = pack(cube, with_count(2000));
  ASSERT_GT(std::abs(layered.particles.size() / 2000.0 - 1), 0.05);
  const std::string at_once = miss_told(layered, 2000);
  EXPECT_EQ(at_once.rfind(std::to_string(layered.particles.size()), 0), 0u) << at_once;
  EXPECT_NE(at_once.find("lattice_rotation"), std::string::npos) << at_once;
}

TEST(Pack, SaysNothingOfACountThatIsMet) {
  const Filling filling = pack(clean(shapes::sphere(1, 4)), with_count(20000));
  EXPECT_EQ(miss_told(filling, 20000), "");
}

TEST(Pack, RefusesToVerifyAnOpenSurfaceBeforeItLooksAtIt) {
  auto open = shapes::sphere(1, 3);
  open.polygons.resize(open.polygons.size() - 10);
  PackOptions options = with_radius(1e-9);  // more particles than memory holds: told later
  options.verify = true;
  const std::string message = message_of([&] { pack(clean(open), options); });
  EXPECT_NE(message.find("only closed surfaces"), std::string::npos) << message;
}

TEST(Pack, TellsBodiesApart) {
  const double r = 0.05;
  const auto far = shapes::moved(shapes::tetrahedron(), Vec3(3, 0, 0));
  const Filling filling = pack(clean(shapes::together(shapes::sphere(1, 3), far)), with_radius(r));
  EXPECT_EQ(filling.report.bodies.size(), 2u);
  for (std::size_t i = 0; i < filling.particles.size(); ++i)
    ASSERT_EQ(filling.component[i], filling.particles.x[i] > 2 ? 1 : 0);
}

CleaningOptions hollow() { return {0, FillRule::hollow}; }

TEST(Pack, LeavesACavityHollow) {
  const auto outer = shapes::sphere(1, 4), inner = shapes::sphere(0.5, 4);
  const auto into_the_cavity = shapes::together(outer, shapes::inverted(inner));
  for (const Surface& surface : {clean(into_the_cavity), clean(shapes::inverted(into_the_cavity)),
                                 clean(shapes::together(outer, inner), hollow())}) {
    EXPECT_NEAR(volume(surface.triangles),
                volume(clean(outer).triangles) - volume(clean(inner).triangles), 1e-12);
    const Filling filling = pack(surface, with_radius(0.05));
    EXPECT_EQ(filling.report.bodies.size(), 1u);
    EXPECT_EQ(filling.report.cavities, 1);
    for (std::size_t i = 0; i < filling.particles.size(); ++i)
      ASSERT_GT(filling.particles.position(i).norm(), 0.49);
    EXPECT_NEAR(filling.report.packed.volume / filling.report.mesh.volume, 1, 0.03);
  }
}

TEST(Pack, FillsNestedShellsThatTurnTheSameWay) {
  const auto outer = shapes::sphere(1, 4);
  const Filling both =
      pack(clean(shapes::together(outer, shapes::sphere(0.5, 4))), with_radius(0.05));
  const Filling alone = pack(clean(outer), with_radius(0.05));
  EXPECT_EQ(both.particles.x, alone.particles.x);
  EXPECT_EQ(both.report.deepest, 2);
  EXPECT_FALSE(both.report.volume_of_mesh);
}

TEST(Pack, FillsAHollowBodyWithinACavity) {
  const auto outer = shapes::together(shapes::sphere(1, 3), shapes::sphere(0.8, 3));
  const auto inner = shapes::together(shapes::sphere(0.3, 3), shapes::sphere(0.6, 3));
  const Filling filling = pack(clean(shapes::together(outer, inner), hollow()), with_radius(0.04));
  EXPECT_EQ(filling.report.bodies.size(), 2u);
  EXPECT_EQ(filling.report.cavities, 2);
  for (std::size_t i = 0; i < filling.particles.size(); ++i) {
    const double from_center = filling.particles.position(i).norm();
    ASSERT_TRUE(from_center > 0.79 || (from_center > 0.29 && from_center < 0.6));
    ASSERT_EQ(filling.component[i], from_center < 0.7 ? 1 : 0);
  }
}

TEST(Report, GivesTheSpheresCenterAndVolume) {
  const Vec3 center(1, 2, 3);
  const FillReport report = pack(clean(shapes::sphere(1, 5, center)), with_radius(0.05)).report;
  EXPECT_LT((report.mesh.center - center).norm(), 1e-12);
  EXPECT_LT((report.packed.center - center).norm(), 1e-12);
  EXPECT_NEAR(report.mesh.volume, 4 * pi / 3, 0.01);
  EXPECT_LT((report.box_size - Vec3::Constant(2)).norm(), 1e-12);
  EXPECT_EQ(rows_of(report)[0].key, "particles");
  EXPECT_EQ(rows_of(report)[0].value, ReportValue(report.particles));
}

std::optional<ReportRow> row_of(const FillReport& report, const std::string& key) {
  for (const ReportRow& row : rows_of(report))
    if (row.key == key) return row;
  return std::nullopt;
}

void expect_row(const FillReport& report, const std::string& key, const ReportValue& value,
                const std::string& unit) {
  const auto row = row_of(report, key);
  ASSERT_TRUE(row) << key;
  EXPECT_EQ(row->value, value) << key;
  EXPECT_EQ(row->unit, unit) << key;
}

TEST(Report, SaysZeroForACenterThatIsButRounding) {
  FillReport report = pack(clean(shapes::sphere(1, 3)), with_radius(0.1)).report;
  report.mesh.center = {-3.2e-19, 1e-14, 1e-9};
  report.packed.center = {0, 0, 1e-9};
  expect_row(report, "mesh_center_of_mass", Vec3(0, 0, 1e-9), "m");
  expect_row(report, "center_of_mass", Vec3(0, 0, 1e-9), "m");
  expect_row(report, "center_offset", 0.0, "m");
  expect_row(report, "smallest_distance", report.smallest_distance, "diameters");
}

TEST(Report, TellsRepairsOnlyWhereSomeWereDone) {
  FillReport report = pack(clean(shapes::sphere(1, 3)), with_radius(0.1)).report;
  expect_row(report, "faces_read", std::size_t{512}, "");
  EXPECT_FALSE(row_of(report, "holes_closed"));
  report.cleaning.holes_closed = 3;
  expect_row(report, "holes_closed", std::size_t{3}, "");
}

TEST(Report, HasTheTetrahedronsCenter) {
  const Surface surface = clean(shapes::moved(shapes::tetrahedron(), Vec3(100, 0, 0)));
  EXPECT_LT((moments_of(surface.triangles).center - Vec3(100.25, 0.25, 0.25)).norm(), 1e-12);
}

double radius_named_in(const std::string& message) {
  const std::size_t at = message.rfind("a radius of ");
  return at == std::string::npos ? 0 : std::stod(message.substr(at + 12));
}

TEST(Pack, RefusesMoreParticlesThanMemoryHoldsAndNamesARadius) {
  const Surface surface = paper_box_surface();
  const std::string message = message_of([&] { pack(surface, with_radius(1e-7)); });
  const double named = radius_named_in(message);
  EXPECT_GT(named, 1e-7) << message;
  EXPECT_LT(volume(surface.triangles) / volume_per_particle(named), 2147483647.0) << message;
}

/// The torus has no site in its hole's middle; in the box one lies at the center whatever the
/// radius.
TEST(Pack, RefusesARadiusThatFillsNothingAndNamesOneThatDoes) {
  const Surface torus = clean(shapes::torus(1, 0.4)), box = paper_box_surface();
  for (const auto& [surface, radius] : {std::pair(&torus, 0.75), std::pair(&torus, 3.0),
                                        std::pair(&box, 1.0), std::pair(&box, 1e300)}) {
    const std::string message = message_of([&] { pack(*surface, with_radius(radius)); });
    const double named = radius_named_in(message);
    EXPECT_LT(named, radius) << message;
    ASSERT_GT(named, 0) << message;
    EXPECT_GT(pack(*surface, with_radius(named)).particles.size(), 10u) << message;
  }
}

TEST(Pack, FillsASingleParticleWhenAskedForOne) {
  EXPECT_EQ(pack(clean(shapes::sphere(1, 3)), with_count(1)).particles.size(), 1u);
}

TEST(Pack, WantsEitherARadiusOrACount) {
  const Surface surface = clean(shapes::tetrahedron());
  PackOptions options;
  EXPECT_NE(message_of([&] { pack(surface, options); }).find("; "), std::string::npos);
  options.count = 10, options.radius = 0.1;
  EXPECT_NE(message_of([&] { pack(surface, options); }).find("; "), std::string::npos);
  for (const double radius : {0.0, -1.0, std::nan("")})
    EXPECT_NE(message_of([&] { pack(surface, with_radius(radius)); }).find("; "),
              std::string::npos);
}

}  // namespace sinew::pack_test
