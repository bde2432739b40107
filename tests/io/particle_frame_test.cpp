// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/particle_frame.h>

#include <gtest/gtest.h>

#include "synthetic_run.h"

namespace sinew::particle_frame_test {

using Counts = std::vector<std::int32_t>;

/// Three particles in another order than the written one; force and velocity grow with the id.
struct Shuffled {
  Particles now = particles_at({{2, 0, 0}, {0, 0, 0}, {1, 0, 0}}, 0.5, 1);
  Points rest = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0.5}};
  Points force = {{0, 2, 0}, {0, 0, 0}, {0, 1, 0}};
  Binding binding = one_bone_each({5, 6, 7}, 0.5);
  Counts neighbors = {12, 10, 11};

  Shuffled() {
    now.id = {2, 0, 1};
    now.u = {20, 0, 10};
  }
  ParticleFrame frame() const { return {now, rest, binding, force, force, force, neighbors, {}}; }
  Dataset written(const ParticleSelection& selection = {}) const {
    return evaluated(particles_dataset(frame(), positions_by_id(now), {3, 4}, selection));
  }
};

TEST(ParticlesDataset, PutsShuffledParticlesIntoTheWrittenOrder) {
  const Dataset data = Shuffled().written();
  const auto& columns = data.point_columns;
  EXPECT_EQ(data.points, (Points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(vectors(columns, "velocity"), (Points{{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}));
  EXPECT_EQ(vectors(columns, "displacement"), (Points{{0, 0, 0}, {1, 0, 0}, {2, 0, -0.5}}));
  EXPECT_EQ(vectors(columns, "force_bone"), (Points{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}));
  EXPECT_EQ(vectors(columns, "force"), (Points{{0, 0, 0}, {0, 3, 0}, {0, 6, 0}}));
  EXPECT_EQ(integers(columns, "neighbors"), (Counts{10, 11, 12}));
  EXPECT_EQ(integers(columns, "bone"), (Counts{5, 6, 7}));
  EXPECT_EQ(numbers(columns, "weight"), std::vector<double>(3, 0.5));
  EXPECT_EQ(integers(columns, "id"), (Counts{0, 1, 2}));
  EXPECT_EQ(data.time, 3);
  EXPECT_EQ(data.cycle, 4);
}

TEST(ParticlesDataset, HoldsTheParticlesAndArraysOfItsSelection) {
  const Dataset data = Shuffled().written({{0, 2}, {"velocity", "id"}});
  EXPECT_EQ(data.points, (Points{{0, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(data.connectivity, (Counts{0, 1}));
  ASSERT_EQ(data.point_columns.size(), 2U);
  EXPECT_EQ(integers(data.point_columns, "id"), (Counts{0, 2}));
  EXPECT_EQ(vectors(data.point_columns, "velocity"), (Points{{0, 0, 0}, {20, 0, 0}}));
}

TEST(ParticlesDataset, ComputesTheSameValuesWhereverAPieceBegins) {
  const Shuffled particles;
  const Dataset lazy = particles_dataset(particles.frame(), positions_by_id(particles.now), {});
  const Dataset whole = particles.written();
  for (std::size_t k = 0; k < lazy.computed.size(); ++k) {
    const auto* real = std::get_if<Computed<double>>(&lazy.computed[k].values);
    if (real == nullptr) continue;
    const auto& expected = std::get<std::vector<double>>(whole.point_columns[k].values);
    for (std::size_t begin = 0; begin < real->count; ++begin)
      for (std::size_t end = begin; end <= real->count; ++end) {
        std::vector<double> piece(end - begin);
        real->put(begin, end, piece.data());
        EXPECT_TRUE(
            std::equal(piece.begin(), piece.end(), expected.begin() + std::ptrdiff_t(begin)))
            << lazy.computed[k].name << ' ' << begin << ' ' << end;
      }
  }
}

TEST(ParticlesDataset, AddsTheForceOfTheWorldWhereThereIsOne) {
  const Shuffled particles;
  const Points world = {{0, 5, 0}, {0, 0, 0}, {0, 0, 0}};
  ParticleFrame frame = particles.frame();
  frame.force_world = world;
  const Dataset with = evaluated(particles_dataset(frame, positions_by_id(particles.now), {}));
  EXPECT_EQ(vectors(with.point_columns, "force")[2], Vec3(0, 11, 0));
  EXPECT_EQ(vectors(with.point_columns, "force_world")[2], Vec3(0, 5, 0));
  EXPECT_EQ(particles.written().point_columns.size() + 1, with.point_columns.size());
}

TEST(ParticlesDataset, TellsOfBrokenBondsWhereThereAreBonds) {
  const Shuffled particles;
  const Counts broken = {3, 5, 4};
  ParticleFrame frame = particles.frame();
  frame.broken_bonds = broken;
  EXPECT_EQ(
      integers(
          evaluated(particles_dataset(frame, positions_by_id(particles.now), {})).point_columns,
          "broken_bonds"),
      (Counts{5, 4, 3}));
}

TEST(ParticlesDataset, TakesTheDisplacementInDouble) {
  Shuffled particles;
  particles.rest[0] = Vec3(1000, 0, 0);
  particles.now.x[1] = 1000 + 1e-9;
  EXPECT_NEAR(vectors(particles.written().point_columns, "displacement")[0].x(), 1e-9, 1e-12);
}

TEST(ParticlesDataset, CarriesTheEnergies) {
  const Dataset data = SyntheticRun().particles({0.5, 7});
  EXPECT_EQ(numbers(data.field_columns, "kinetic_energy"), std::vector<double>{0.5});
  EXPECT_EQ(numbers(data.field_columns, "dissipation"), std::vector<double>{6});
}

}  // namespace sinew::particle_frame_test
