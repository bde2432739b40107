// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces exported as GLB move in VTK's own reader as they moved here.
#include <sinew/io/gltf/moving_surface.h>

#include <sinew/io/gltf/geometry.h>
#include <sinew/io/point_cache.h>
#include "io/gltf_rigs.h"

namespace sinew::moving_surface_test {

constexpr double interval = 0.25;  // s
constexpr double single = 1e-6;

/// A tetrahedron that grows, turns about z and moves, all along one line of moments.
class MovingSurface : public Scratch {
 protected:
  MovingSurface() {
    surface_.points = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {0, 0, 0}};
    surface_.faces = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  }

  Points at(double moment) const {
    const Mat3 turn = Eigen::AngleAxisd(0.7 * moment, Vec3::UnitZ()).toRotationMatrix();
    Points points;
    for (const Vec3& point : surface_.points)
      points.push_back((1 + moment) * (turn * point) + Vec3(moment, 0, 0));
    return points;
  }

  std::filesystem::path write(std::size_t samples) {
    PointCache cache(folder / "surface.pc2", surface_.points.size());
    for (std::size_t k = 0; k < samples; ++k) cache.add(at(static_cast<double>(k)));
    cache.close();
    write_moving_surface(folder / "surface.glb", surface_.faces, folder / "surface.pc2",
                         times_of(samples));
    return folder / "surface.glb";
  }

  static std::vector<double> times_of(std::size_t samples) {
    std::vector<double> times;
    for (std::size_t k = 0; k < samples; ++k) times.push_back(interval * static_cast<double>(k));
    return times;
  }

  /// The corners that VTK shows are those of `points`, turned to y up.
  void expect_shown(const std::filesystem::path& path, double time, const Points& points) const {
    const Points shown = gltf_files::vtk_corners(path, 0, time);
    ASSERT_EQ(shown.size(), 3 * surface_.faces.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const Vec3& point = points[static_cast<std::size_t>(surface_.faces[i / 3][i % 3])];
      EXPECT_LT((shown[i] - Vec3(point.y(), point.z(), point.x())).norm(),
                10 * single + 1e-7 * point.norm())
          << time;
    }
  }

  Triangles surface_;
};

TEST_F(MovingSurface, IsTheSurfaceAtEveryMomentInVtk) {
  const auto path = write(5);
  for (std::size_t k = 0; k < 5; ++k)
    expect_shown(path, interval * static_cast<double>(k), at(static_cast<double>(k)));
}

TEST_F(MovingSurface, GoesStraightFromMomentToMoment) {
  const auto path = write(3);
  Points middle = at(1);
  const Points after = at(2);
  for (std::size_t i = 0; i < middle.size(); ++i) middle[i] = (middle[i] + after[i]) / 2;
  expect_shown(path, 1.5 * interval, middle);
}

TEST_F(MovingSurface, BeginsAsAMeshThatWeReadAgain) {
  for (const std::size_t samples : {1, 4}) {
    const PolygonSoup soup = read_gltf(write(samples));
    ASSERT_EQ(soup.points.size(), surface_.points.size());
    EXPECT_EQ(soup.polygons.size(), surface_.faces.size());
    EXPECT_LT((soup.points[2] - Vec3(0, 3, 0)).norm(), single);
  }
}

TEST_F(MovingSurface, OfManyMomentsTakesSomeAndTheLast) {
  const auto path = write(1202);
  EXPECT_LT(std::filesystem::file_size(path), 2'000'000u);
  for (const double moment : {0.0, 300.0, 1200.0, 1201.0})
    expect_shown(path, interval * moment, at(moment));
}

TEST_F(MovingSurface, FarAwayIsExactFromItsOrigin) {
  for (const double far : {1e3, 403000.123, 1e7}) {
    const Vec3 origin(std::round(far), -std::round(far), 64);
    PointCache cache(folder / "surface.pc2", surface_.points.size(), 0, origin);
    for (const double moment : {0.0, 1.0}) {
      Points points = at(moment);
      for (Vec3& point : points) point += Vec3(far, -far, 64.25);
      cache.add(points);
    }
    cache.close();
    const auto told = nlohmann::json::parse(text_of(origin_file(folder / "surface.pc2")));
    EXPECT_EQ(told["origin"].get<std::vector<double>>(),
              (std::vector<double>{origin.x(), origin.y(), origin.z()}));
    const std::vector<float> places = CachedPoints(folder / "surface.pc2").sample(1);
    write_moving_surface(folder / "far.glb", surface_.faces, folder / "surface.pc2", times_of(2),
                         {}, origin);
    const PolygonSoup soup = read_gltf(folder / "far.glb");
    ASSERT_EQ(soup.points.size(), surface_.points.size());
    for (std::size_t i = 0; i < surface_.points.size(); ++i) {
      const Vec3 expected = at(0)[i] + Vec3(far, -far, 64.25);
      EXPECT_LT((soup.points[i] - Vec3(expected.y(), expected.z(), expected.x())).norm(),
                single + 1e-15 * far);
      const Vec3 moved = Vec3(places[3 * i], places[3 * i + 1], places[3 * i + 2]) + origin;
      EXPECT_LT((moved - at(1)[i] - Vec3(far, -far, 64.25)).norm(), 10 * single + 1e-15 * far);
    }
  }
}

TEST_F(MovingSurface, OfACacheThatIsNoneIsRefused) {
  put(folder / "surface.pc2", "POINTCACHE2");
  const auto write = [&] {
    write_moving_surface(folder / "a.glb", surface_.faces, folder / "surface.pc2", {});
  };
  EXPECT_EQ(error_of(write).exit(), Exit::bad_input);
}

}  // namespace sinew::moving_surface_test
