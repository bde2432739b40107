// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <sinew/core/file.h>
#include <sinew/io/calculix/deck.h>
#include <sinew/io/calculix/frd.h>
#include "support/expect_error.h"
#include "support/scratch.h"

namespace sinew::calculix_test {
namespace {

using test::expect_bad_input;

std::string padded(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string columns(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%12.5E", value);
  return text;
}

std::string row(int node, const std::vector<double>& values) {
  std::string line = " -1" + padded(std::to_string(node), 10);
  for (const double value : values) line += columns(value);
  return line + '\n';
}

std::string result(const std::string& name, const std::string& time,
                   const std::function<std::vector<double>(int)>& values) {
  std::string text =
      "  100CL  101 " + time + "           4                     0    1           1\n";
  text += " -4  " + name + "        4    1\n -5  D1          1    2    1    0\n";
  for (int node = 1; node <= 4; ++node) text += row(10 * node, values(node));
  return text + " -3\n";
}

/// One tetrahedron, as ccx writes it, its nodes 10, 20, 30, 40 at rest and at two moments.
std::string tetrahedron() {
  std::string text =
      "    1C\n    2C                             4                                     1\n";
  text += row(10, {0, 0, 0}) + row(20, {1, 0, 0}) + row(30, {0, 1, 0}) + row(40, {0, 0, -2.5}) +
          " -3\n";
  text += "    3C                             1                                     1\n";
  text += " -1         7    3    0    1\n -2        10        20        30        40\n -3\n";
  for (const std::string time : {"0.00000E+00", "1.500000000"}) {
    text += "    1PSTEP                         1           1           1\n";
    text += result("DISP", time, [](int node) {
      return std::vector<double>{0.1 * node, 0, -1.0 * node};
    });
    text += result("STRESS", time,
                   [](int node) { return std::vector<double>{1.0 * node, 2, 3, 4, 5, 6}; });
    text += result("FORC", time, [](int node) { return std::vector<double>{0, 2.0 * node, 0}; });
  }
  return text + " 9999\n";
}

class Calculix : public Scratch {
 protected:
  FrdResult read(const std::string& text) {
    write_file(folder / "a.frd", text);
    return read_frd(folder / "a.frd");
  }

  void expect_refused(std::string text, const std::string& what, const std::string& instead,
                      const std::vector<std::string>& parts) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), instead);
    std::vector<std::string> all = parts;
    all.push_back("a.frd");
    expect_bad_input([&] { read(text); }, all);
  }
};

TEST_F(Calculix, ResultsAreReadWithTheirTimes) {
  const FrdResult result = read(tetrahedron());
  ASSERT_EQ(result.mesh.nodes.size(), 4u);
  EXPECT_EQ(result.mesh.nodes[3], Vec3(0, 0, -2.5));
  ASSERT_EQ(result.mesh.elements.size(), 1u);
  EXPECT_EQ(result.mesh.elements[0].kind, ElementKind::tetrahedron4);
  EXPECT_EQ(result.mesh.elements[0].nodes[3], 3u);
  ASSERT_EQ(result.steps.size(), 2u);
  EXPECT_EQ(result.steps[1].time, 1.5);
  EXPECT_LT((result.steps[1].displacement[2] - Vec3(0.3, 0, -3)).norm(), 1e-12);
  EXPECT_EQ(result.steps[0].force[2], Vec3(0, 6, 0));
  EXPECT_EQ(result.steps[0].stress[3], (StressComponents{4, 2, 3, 4, 5, 6}));
}

/// CalculiX GraphiX lists the upright edges before those of the upper face.
TEST_F(Calculix, NodesOfHexahedraAreReadInTheOrderOfDecks) {
  std::string text = "    2C                            20                                     1\n";
  for (int node = 1; node <= 20; ++node) text += row(node, {1.0 * node, 0, 0});
  text +=
      " -3\n    3C                             1                                     1\n -1        "
      " 1    4    0    1\n -2";
  for (const int node : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) text += padded(std::to_string(node), 10);
  text += "\n -2";
  for (const int node : {11, 12, 17, 18, 19, 20, 13, 14, 15, 16})
    text += padded(std::to_string(node), 10);
  text +=
      "\n -3\n  100CL  101 1.000000000          20                     0    1           1\n -4  "
      "DISP        4    1\n";
  for (int node = 1; node <= 20; ++node) text += row(node, {0, 0, 0});
  const FrdResult result = read(text + " -3\n 9999\n");
  for (std::uint32_t k = 0; k < 20; ++k) EXPECT_EQ(result.mesh.elements[0].nodes[k], k);
}

TEST_F(Calculix, DamagedResultsAreRefusedWithTheirLine) {
  const std::string good = tetrahedron();
  expect_refused(good, "        40\n -3", "        41\n -3", {"a.frd:10", "no node 41"});
  expect_refused(good, "         7    3", "         7    7", {"type 7", "tetrahedra of 4 or 10"});
  expect_refused(good, "                            4                                     1",
                 "                            4                                     2",
                 {"not ASCII", "*NODE FILE"});
  expect_refused(good, " 1.00000E+00", " 1.0zzzzE+00", {"is no number"});
  expect_refused(good, "1.500000000", "-1.50000000", {"time runs backward"});
  expect_refused(good, row(20, {1, 0, 0}), row(10, {1, 0, 0}), {"node 10 is there twice"});
  expect_refused(good, row(30, {0.3, 0, -3}), "", {"lacks displacements"});
  expect_refused(good, " 9999", good.substr(0, good.find("    3C")) + " 9999",
                 {"nodes come after results"});
  expect_refused(good, row(30, {0, 1, 0}), " -1        30         inf 0.00000E+00 0.00000E+00\n",
                 {"too large or not finite"});
  expect_refused(good, "        10        20        30        40",
                 "        10        20        20        40", {"a.frd:10", "same node twice"});
  expect_refused(good, row(30, {0.3, 0, -3}), " -1        30 1.00000E-01\n", {"is no number"});
  expect_bad_input([&] { read(good.substr(0, good.rfind(" -3"))); }, {"ends within a block"});
  expect_bad_input([&] { read("nothing"); }, {"holds no elements"});
  expect_bad_input([&] { read(good.substr(0, good.find("    1PSTEP"))); },
                   {"no displacements", "*NODE FILE"});
}

/// Records are as wide as their values: with exponents of three digits more than twelve columns.
TEST_F(Calculix, ValuesOfThreeDigitExponentsAreReadAsTheyArePrinted) {
  const std::vector<double> samples = {0, 1, -2.5e-100, 3.25e-150, -4.5e-3, 1e99, -1e-310, -6.75e2};
  const auto values = [&](int node, int component) {
    return samples[static_cast<std::size_t>(5 * node + 3 * component) % samples.size()];
  };
  for (int turn = 0; turn < 2; ++turn) {
    std::string text = tetrahedron();
    text.resize(text.find("    1PSTEP"));
    text += result("DISP", "1.00000E-100", [&](int node) {
      return std::vector<double>{values(node, turn), values(node, turn + 1),
                                 values(node, turn + 2)};
    });
    text += result("STRESS", "1.00000E-100", [&](int node) {
      std::vector<double> stress;
      for (int k = 0; k < 6; ++k) stress.push_back(values(node, turn + k));
      return stress;
    });
    const FrdResult found = read(text + " 9999\n");
    EXPECT_EQ(found.steps.at(0).time, 1e-100);
    for (int node = 0; node < 4; ++node) {
      for (int k = 0; k < 3; ++k)
        EXPECT_EQ(found.steps[0].displacement[node][k], values(node + 1, turn + k));
      for (int k = 0; k < 6; ++k)
        EXPECT_EQ(found.steps[0].stress[node][k], values(node + 1, turn + k));
    }
  }
}

/// Many results of few nodes take memory as if they were of all.
TEST_F(Calculix, EmptyResultsTakeNoMemory) {
  std::string text = "    2C                         50000                                     1\n";
  for (int node = 1; node <= 50'000; ++node) text += row(node, {1.0 * node, 0, 0});
  text +=
      " -3\n    3C                             1                                     1\n -1        "
      " 1    3    0    1\n -2         1         2         3         4\n -3\n";
  for (int k = 0; k < 2000; ++k)
    text += "  100CL  101 " + columns(k).substr(1) +
            "       50000                     0    1           1\n -4  DISP        4    1\n -3\n";
  expect_bad_input([&] { read(text); }, {"many results of few nodes"});
}

Deck deck() {
  Deck deck;
  deck.title = "two\nlines";
  deck.mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1.0 / 3}};
  deck.mesh.elements = {{ElementKind::tetrahedron4, {0, 1, 2, 3}}};
  deck.materials = {{"flesh", 1e5, 0.25, 1000, {0}}};
  deck.sets = {{"clamp", {0, 1}}};
  deck.steps = {{0.5, {{0, 2, -1.0 / 3}}, {{3, {0, 2, 0}}}, {{{0, 1}, 7}}}, {2, {}, {}, {}}};
  return deck;
}

TEST_F(Calculix, DecksHoldEveryStepAndNumbersThatCcxCanRead) {
  write_deck(folder / "a.inp", deck());
  const std::string text = text_of(folder / "a.inp");
  for (const char* part :
       {"*NODE, NSET=ALL", "4,0.00000000000e+00,0.00000000000e+00,-3.33333333333e-01",
        "TYPE=C3D4\n1,1,2,3,4\n", "*ELASTIC\n1.00000000000e+05,2.50000000000e-01",
        "TOTAL TIME AT START=0.00000000000e+00\n1.25000000000e-01,5.00000000000e-01",
        "*BOUNDARY, OP=NEW\n1,3,3,-3.33333333333e-01\n*CLOAD, OP=NEW\n4,2,2.00000000000e+00\n",
        "*DLOAD, OP=NEW\n1,P2,7.00000000000e+00\n", "*STATIC\n3.75000000000e-01,1.50000000000e+00",
        "** clamp\n*NSET, NSET=SUPPORT_0\n1,2,\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
  EXPECT_NE(text.find("two?lines\n"), std::string::npos);
  Deck far = deck();
  far.mesh.nodes[3] = {403000.123456789, -8388608.1234567895, 1.0 / 3};
  far.origin = {402992, 0, 0};
  write_deck(folder / "from.inp", far);
  const std::string from = text_of(folder / "from.inp");
  EXPECT_NE(from.find("** meters from 402992 0 0\n*NODE"), std::string::npos);
  EXPECT_NE(from.find("\n4,8.12345678"), std::string::npos);
  far.origin.setZero();
  write_deck(folder / "far.inp", far);
  EXPECT_NE(text_of(folder / "far.inp")
                .find("\n4,403000.123456789,-8388608.12345679,3.33333333333e-01\n"),
            std::string::npos);
}

}  // namespace
}  // namespace sinew::calculix_test
