// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/particle_formats/formats.h>

#include <gtest/gtest.h>
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include <sinew/core/file.h>
#include <sinew/core/particles.h>
#include "support/expect_error.h"
#include "support/scratch.h"

namespace sinew::particle_formats_test {
namespace {

using test::expect_bad_input;

/// Two that touch and follow bones 0 and -1, and one by itself of another component.
BodyFile three() {
  BodyFile body;
  body.particles = particles_at({{0.1, 0, 0}, {0.3, 0, 0}, {2, -1, 0.5}}, 0.1, 0.25);
  body.neighbors = {1, 1, 0};
  body.component = {0, 0, 1};
  body.bone = {0, -1, 0};
  return body;
}

ParticleCloud cloud() {
  const std::vector<std::string> bones = {"up\nper"};
  ParticleCloud cloud = cloud_of(three(), 50, bones);
  cloud.bonds = touching_pairs(cloud.positions, cloud.radius);
  return cloud;
}

class ParticleFormats : public Scratch {
 protected:
  std::string written(const std::string& name, const ParticleCloud& cloud,
                      const std::string& file) {
    write_particles(folder / file, cloud, format_of(name, file));
    return read_file(folder / file);
  }
};

TEST_F(ParticleFormats, Regions) {
  const ParticleCloud three = cloud();
  EXPECT_EQ(three.region, (std::vector<std::int32_t>{1, 0, 1}));
  EXPECT_EQ(three.region_names, (std::vector<std::string>{"no bone", "bone up_per"}));
  EXPECT_DOUBLE_EQ(three.volume, 0.005);
  BodyFile of_materials = sinew::particle_formats_test::three();
  of_materials.bone.reset();
  of_materials.stiffness = {2, 2, 1};
  EXPECT_EQ(cloud_of(of_materials, 50).region, (std::vector<std::int32_t>{1, 1, 0}));
  EXPECT_EQ(cloud_of(of_materials, 50).region_names.front(), "stiffness 1");
}

TEST_F(ParticleFormats, TouchingPairsOfClosestPacking) {
  EXPECT_EQ(cloud().bonds, (std::vector<std::array<std::uint32_t, 2>>{{0, 1}}));
  Points sites;  // of FCC, half-planes sqrt(2) r apart
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j)
      for (int k = 0; k < 7; ++k)
        if ((i + j + k) % 2 == 0) sites.push_back(half_plane_spacing(0.01) * Vec3(i, j, k));
  std::vector<int> bonds(sites.size());
  for (const auto& [i, j] : touching_pairs(sites, 0.01)) ++bonds[i], ++bonds[j];
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vec3 place = sites[i] / half_plane_spacing(0.01);
    const bool inner = place.minCoeff() > 0.5 && place.maxCoeff() < 5.5;
    EXPECT_EQ(bonds[i] == 12, inner) << place.transpose();
  }
}

TEST_F(ParticleFormats, LammpsData) {
  const std::string text = written("lammps", cloud(), "three.data");
  EXPECT_NE(text.find("\n3 atoms\n2 atom types\n1 bonds\n1 bond types\n"), std::string::npos);
  EXPECT_NE(text.find("\n-0.1 2.2 xlo xhi\n-1.2 0.2 ylo yhi\n-0.2 0.7 zlo zhi\n"),
            std::string::npos);
  EXPECT_NE(text.find("\nMasses\n\n1 0.25 # no bone\n2 0.25 # bone up_per\n"), std::string::npos);
  EXPECT_NE(text.find("\nAtoms # bond\n\n1 1 2 0.1 0 0\n2 1 1 0.3 0 0\n3 2 2 2 -1 0.5\n"),
            std::string::npos);
  EXPECT_EQ(text.find("Velocities"), std::string::npos);
  EXPECT_TRUE(text.ends_with("\nBonds\n\n1 1 1 2\n"));
}

TEST_F(ParticleFormats, LammpsDataOfPartsAndMotion) {
  ParticleCloud moving = cloud();
  moving.id = {4, 7, 9};
  moving.velocities = {{1, 2, 3}, {0, 0, -0.5}, {0, 0, 0}};
  const std::string text = written("lammps", moving, "three.data");
  EXPECT_NE(text.find("\nVelocities\n\n5 1 2 3\n8 0 0 -0.5\n10 0 0 0\n"), std::string::npos);
  EXPECT_TRUE(text.ends_with("\nBonds\n\n1 1 5 8\n"));
}

TEST_F(ParticleFormats, FramesOfADumpFollowEachOther) {
  ParticleCloud one = cloud();
  NewFile file(folder / "three.dump");
  const ParticleFormat& format = format_of("", "three.dump");
  ASSERT_TRUE(format.many_frames);
  format.add(file, one);
  one.time = 0.25, one.frame = 1, one.velocities = {{1, 2, 3}, {0, 0, 0}, {0, 0, 0}};
  format.add(file, one);
  file.finish();
  const std::string text = read_file(folder / "three.dump");
  EXPECT_TRUE(text.starts_with(
      "ITEM: TIME\n0\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS ff ff ff\n"
      "-0.1 2.2\n-1.2 0.2\n-0.2 0.7\nITEM: ATOMS id mol type mass radius x y z\n"
      "1 1 2 0.25 0.1 0.1 0 0\n"));
  EXPECT_NE(text.find("ITEM: TIME\n0.25\nITEM: TIMESTEP\n1\n"), std::string::npos);
  EXPECT_NE(text.find(" radius x y z vx vy vz\n1 1 2 0.25 0.1 0.1 0 0 1 2 3\n"), std::string::npos);
}

TEST_F(ParticleFormats, Tables) {
  EXPECT_EQ(written("xyz", cloud(), "three.xyz"),
            "3\nProperties=species:S:1:pos:R:3:id:I:1:radius:R:1:mass:R:1:component:I:1:region:I:1 "
            "pbc=\"F F F\" units=\"m kg s\" Time=0\n"
            "X 0.1 0 0 0 0.1 0.25 0 1\nX 0.3 0 0 1 0.1 0.25 0 0\nX 2 -1 0.5 2 0.1 0.25 1 1\n");
  EXPECT_EQ(written("csv", cloud(), "three.csv"),
            "id,x,y,z,radius,mass,volume,component,region,bone\n0,0.1,0,0,0.1,0.25,0.005,0,1,0\n"
            "1,0.3,0,0,0.1,0.25,0.005,0,0,-1\n2,2,-1,0.5,0.1,0.25,0.005,1,1,0\n");
}

TEST_F(ParticleFormats, YadeTakesTheMassFromTheDensityOfSpheres) {
  const std::string text = written("yade", cloud(), "three.txt");
  const std::string head = "#format x_y_z_r_matId\n# density of the materials, kg/m^3: ";
  ASSERT_TRUE(text.starts_with(head));
  EXPECT_DOUBLE_EQ(std::strtod(text.c_str() + head.size(), nullptr) * 4 / 3 * pi * 0.001, 0.25);
  EXPECT_TRUE(
      text.ends_with("\n# matId 0 is no bone\n# matId 1 is bone up_per\n"
                     "0.1 0 0 0.1 1\n0.3 0 0 0.1 0\n2 -1 0.5 0.1 1\n"));
}

TEST_F(ParticleFormats, PeridigmWithNodeSets) {
  EXPECT_EQ(written("peridigm", cloud(), "mesh.txt"),
            "#header: x y z block_id volume\n# block_id 1 is no bone\n# block_id 2 is bone up_per\n"
            "0.1 0 0 2 0.005\n0.3 0 0 1 0.005\n2 -1 0.5 2 0.005\n");
  EXPECT_EQ(read_file(folder / "mesh_block_1.txt"), "#header: global_id\n# no bone\n2\n");
  EXPECT_EQ(read_file(folder / "mesh_block_2.txt"), "#header: global_id\n# bone up_per\n1\n3\n");
}

TEST_F(ParticleFormats, Bgeo) {
  const std::string bytes = written("bgeo", cloud(), "three.bgeo");
  const std::string head("BgeoV\0\0\0\5\0\0\0\3\0\0\0\0", 17);
  EXPECT_TRUE(bytes.starts_with(head));
  const std::size_t names = 5 * (2 + 2 + 4 + 4) + std::strlen("idpscalemasscomponentregion");
  EXPECT_EQ(bytes.size(), 41 + names + 3 * 36 + 2);
  const std::string first("\x3d\xcc\xcc\xcd\0\0\0\0\0\0\0\0\x3f\x80\0\0", 16);  // 0.1 0 0 1
  EXPECT_EQ(bytes.substr(41 + names, 16), first);
}

TEST_F(ParticleFormats, BgeoOfABodyFarAwayTellsItsOrigin) {
  const std::string near = written("bgeo", cloud(), "near.bgeo");
  ParticleCloud far = cloud();
  far.origin = {8388608, -4096, 2};
  for (Vec3& place : far.positions) place += far.origin;
  const std::string bytes = written("bgeo", far, "far.bgeo");
  const std::string origin("\x4b\0\0\0\xc5\x80\0\0\x40\0\0\0", 12);
  const std::size_t names = near.size() - 2 - 3 * 36, more = 2 + 6 + 2 + 4 + 12;
  ASSERT_EQ(bytes.size(), near.size() + more + 3 * 12);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string point = bytes.substr(names + more + 48 * i, 48);
    EXPECT_EQ(point.substr(36), origin);
    EXPECT_EQ(point.substr(12, 24), near.substr(names + 36 * i + 12, 24));
  }
  EXPECT_EQ(bytes.substr(names + more + 4, 8), near.substr(names + 4, 8));
}

TEST_F(ParticleFormats, GltfPointsNearTheirMiddle) {
  ParticleCloud far = cloud();
  for (Vec3& place : far.positions) place.x() += 1e7;
  const std::string bytes = written("gltf", far, "three.glb");
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  const auto json = nlohmann::json::parse(bytes.substr(20, size));
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["mode"], 0);
  const auto move = json["nodes"][0]["translation"].get<std::vector<double>>();
  for (std::size_t i = 0; i < 3; ++i) {
    float yzx[3];
    std::memcpy(yzx, bytes.data() + 28 + size + 12 * i, 12);
    EXPECT_NEAR(yzx[2] + move[2], far.positions[i].x(), 1e-7);
    EXPECT_NEAR(yzx[0] + move[0], far.positions[i].y(), 1e-7);
    EXPECT_NEAR(yzx[1] + move[1], far.positions[i].z(), 1e-7);
  }
}

TEST_F(ParticleFormats, GltfRangeIsThatOfTheRoundedPlaces) {
  ParticleCloud third = cloud();
  for (Vec3& place : third.positions) place /= 3;
  const std::string bytes = written("gltf", third, "three.glb");
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  const auto accessor = nlohmann::json::parse(bytes.substr(20, size))["accessors"][0];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<float> values(3);
    for (std::size_t i = 0; i < 3; ++i)
      std::memcpy(&values[i], bytes.data() + 28 + size + 12 * i + 4 * axis, 4);
    EXPECT_EQ(accessor["min"][axis].get<double>(), *std::min_element(values.begin(), values.end()));
    EXPECT_EQ(accessor["max"][axis].get<double>(), *std::max_element(values.begin(), values.end()));
  }
}

TEST_F(ParticleFormats, NumbersReadBackAsTheyWere) {
  ParticleCloud crooked = cloud();
  crooked.positions[1] = {1.0 / 3, -0.1 - 0.2, 1e-300};
  const std::string text = written("csv", crooked, "three.csv");
  EXPECT_NE(text.find("\n1,0.3333333333333333,-0.30000000000000004,1e-300,"), std::string::npos);
}

TEST_F(ParticleFormats, RowsOfManyPiecesStayInOrder) {
  const std::size_t count = 300000;  // more than are formatted at a time
  Points places(count);
  for (std::size_t i = 0; i < count; ++i) places[i] = {static_cast<double>(i), 0, 0};
  BodyFile body;
  body.particles = particles_at(places, 0.1, 1);
  body.component.assign(count, 0);
  const std::string text = written("peridigm", cloud_of(body, 1), "many.txt");
  std::size_t at = text.find("\n0 0 0 1 1\n") + 1, lines = 0;
  for (; at < text.size(); at = text.find('\n', at) + 1, ++lines)
    ASSERT_EQ(std::strtod(text.c_str() + at, nullptr), static_cast<double>(lines));
  EXPECT_EQ(lines, count);
}

TEST_F(ParticleFormats, AreFoundByNameAndExtension) {
  EXPECT_EQ(format_of("", "a.XYZ").name, "xyz");
  EXPECT_EQ(format_of("peridigm", "a.txt").name, "peridigm");
  EXPECT_EQ(format_of("gltf", "").name, "gltf");
  expect_bad_input([] { format_of("", "a.txt"); }, {"yade", "peridigm", "--to"});
  expect_bad_input([] { format_of("", "a.foo"); }, {"a.foo", "lammps, dump"});
  expect_bad_input([] { format_of("lamps", "a.data"); }, {"lamps", "lammps?"});
  for (const char* any : {"a.obj", "a", ".b", "a.csv.txt"})
    EXPECT_EQ(format_of("csv", any).name, "csv") << any;
}

}  // namespace
}  // namespace sinew::particle_formats_test
