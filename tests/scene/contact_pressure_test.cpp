// SPDX-License-Identifier: GPL-3.0-or-later
// Pressures on the surface, beside closed forms and the forces of the contacts.
#include <gtest/gtest.h>

#include <numeric>

#include <sinew/core/file.h>
#include <sinew/mesh/refine.h>
#include <sinew/run/frame_data.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/read_scene.h>
#include <sinew/stepping/equilibrium.h>

#include "mesh/shapes.h"
#include "support/temp_folder.h"

namespace sinew::contact_pressure_test {

/// A box whose surface has points at most `apart` (m) from each other.
std::string box(const Vec3& low, const Vec3& high, double apart) {
  return obj_text(refined(shapes::triangles_of(shapes::box(low, high)), apart));
}

/// The first frame of a scene.
struct Frame {
  TempFolder folder;
  std::optional<Prepared> prepared;
  std::optional<Simulation> simulation;
  std::optional<FrameData> frame;
  Dataset surface;

  Frame(const std::string& block, const std::string& other, const std::string& scene) {
    folder.write("block.obj", block);
    folder.write("other.obj", other);
    prepared.emplace(prepare({read_scene(folder.write("scene.yaml", scene))}));
    simulation.emplace(start(*prepared));
    frame.emplace(*prepared);
    if (simulation->relaxation())
      while (simulation->relaxation()->moments() == 0) simulation->step();
    else
      simulation->advance(prepared->plan.steps_until(prepared->frames.count));
    frame->take(*simulation);
    surface = frame->surface();
  }

  const std::vector<double>& values(const char* name) const {
    return std::get<std::vector<double>>(find(surface.point_columns, name)->values);
  }
  /// Pressure times area, of the points that `counts` picks by their place at rest.
  template <class Counts>
  double force(const Counts& counts) const {
    const auto &pressure = values("contact_pressure"), &area = values("contact_area");
    double sum = 0;
    for (std::size_t v = 0; v < pressure.size(); ++v)
      if (counts(prepared->surface.triangles.points[v])) sum += pressure[v] * area[v];
    return sum;
  }
};

const auto everywhere = [](const Vec3&) { return true; };

/// The force, the area and the largest pressure of a ball on a block: of the force, Hertz's closed
/// forms give both. 13 planes across and 7 radii of contact are within 10 and 15 %.
TEST(ContactPressure, OfABallOnABlockIsHertzs) {
  constexpr double E = 1e5, nu = 0.25, R = 0.5, planes = 13, H = 0.1;
  const double r = H / planes / std::sqrt(2.0);
  const Frame found(box({-0.15, -0.15, 0}, {0.15, 0.15, H}, 0.01), "",
                    "body: {mesh: block.obj, radius: " + std::to_string(r) +
                        "}\nmaterial: {model: bonded, young_modulus: 1e5}\n"
                        "supports: [{name: below, facing: [0, 0, -1]}]\n"
                        "world: {obstacles: [{name: ball, shape: sphere, radius: 0.5, stiffness: "
                        "20, center: [0, 0, 0.599]}]}\n"
                        "solver: {method: static, duration: 0}\n"
                        "output: {skin: 'contact_pressure, contact_area'}\n");
  const double force = -found.frame->now().on_obstacles[0].force.z();
  const double reaction = std::abs(force);
  EXPECT_NEAR(found.force(everywhere), reaction,
              0.005 * reaction);  // normals are up to 4 degrees off
  const double stiffness = E / (1 - nu * nu), ball = R + r;
  const double radius = std::cbrt(3 * reaction * ball / (4 * stiffness));
  const double highest = 1.5 * reaction / (pi * radius * radius);
  const auto &pressure = found.values("contact_pressure"), &area = found.values("contact_area");
  const double touching = std::accumulate(area.begin(), area.end(), 0.0);
  EXPECT_NEAR(touching, pi * radius * radius, 0.1 * pi * radius * radius);
  EXPECT_NEAR(*std::max_element(pressure.begin(), pressure.end()), highest, 0.15 * highest);
  for (std::size_t v = 0; v < pressure.size(); ++v) {
    EXPECT_EQ(pressure[v] > 0, area[v] > 0);
    if (found.prepared->surface.triangles.points[v].z() < H / 2) {
      EXPECT_EQ(pressure[v], 0);
    }
  }
}

/// A block at rest on a floor, of a mesh with points at its corners alone.
TEST(ContactPressure, OfABlockOnAFloorIsItsWeight) {
  const Frame found(box({0, 0, 0}, {0.1, 0.1, 0.1}, 1), "",
                    "body: {mesh: block.obj, radius: 0.01}\n"
                    "material: {model: bonded, young_modulus: 1e5, damping: 2}\n"
                    "world: {obstacles: [{name: floor, shape: plane, point: [0, 0, 0]}]}\n"
                    "solver: {duration: 1.5, gravity: [0, 0, -9.81]}\n"
                    "output: {skin: 'contact_pressure, contact_area'}\n");
  const double weight = 0.001 * found.prepared->settings.material.density * 9.81;
  const double reaction = -found.frame->now().on_obstacles[0].force.z();
  EXPECT_NEAR(found.force(everywhere), reaction, 1e-3 * reaction);
  EXPECT_NEAR(reaction, weight, 0.02 * weight);
  const auto& area = found.values("contact_area");
  EXPECT_NEAR(std::accumulate(area.begin(), area.end(), 0.0), 0.01, 0.001);
}

TEST(ContactPressure, OfBodiesOnEachOtherIsTheLoadThatPressesThem) {
  const Frame found(
      box({0, 0, 0}, {0.1, 0.1, 0.1}, 0.02), box({0, 0, 0.13}, {0.1, 0.1, 0.23}, 0.02),
      "body: {mesh: block.obj, radius: 0.01}\n"
      "bodies: [{mesh: other.obj}]\n"
      "material: {model: bonded, young_modulus: 1e5, damping: 2}\n"
      "supports: [{name: below, high: [1, 1, 0.01], low: [-1, -1, -1]}]\n"
      "loads: [{name: above, low: [-1, -1, 0.22], high: [1, 1, 1], force: [0, 0, -5]}]\n"
      "world: {drag: 5}\nsolver: {duration: 3}\noutput: {skin: all}\n");
  const double lower = found.force([](const Vec3& place) { return place.z() < 0.115; });
  const double upper = found.force([](const Vec3& place) { return place.z() > 0.115; });
  EXPECT_NEAR(lower, upper, 0.05 * upper);
  EXPECT_NEAR(upper, 5, 0.25);
}

TEST(ContactPressure, IsOnTheSurfaceThatAsksForIt) {
  const std::string scene =
      "body: {mesh: block.obj, radius: 0.02}\nskeleton: {bones: [{name: a, head: [0.05, 0.05, 0], "
      "tail: [0.05, 0.05, 0.1]}]}\nsolver: {duration: 0}\noutput: {skin: ";
  const std::string block = box({0, 0, 0}, {0.1, 0.1, 0.1}, 1);
  EXPECT_FALSE(find(Frame(block, "", scene + "none}\n").surface.point_columns, "contact_area"));
  EXPECT_FALSE(find(Frame(block, "", scene + "all}\n").surface.point_columns, "contact_area"))
      << "nothing can touch the body";
  const Frame asked(block, "", scene + "contact_pressure}\n");
  EXPECT_EQ(asked.values("contact_pressure"), std::vector<double>(8, 0));
  EXPECT_FALSE(find(asked.surface.point_columns, "contact_area"));
}

}  // namespace sinew::contact_pressure_test
