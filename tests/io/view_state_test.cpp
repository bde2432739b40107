// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/paraview/view_state.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <sinew/io/detail/xml.h>
#include <sinew/io/series.h>
#include <sinew/io/single_files.h>
#include "support/expect_error.h"
#include "support/scratch.h"
#include "synthetic_run.h"

namespace sinew::view_state_test {

/// A run of so many frames, whose second bone turns by 90 degrees.
class ViewState : public Scratch {
 protected:
  void write_run(int count = 5, const Vec3& at = Vec3::Zero()) {
    const SyntheticRun run;
    BodyFile body = run.body();
    for (std::size_t i = 0; i < run.count(); ++i)
      body.particles.set_position(i, body.particles.position(i) + at);
    write_body(folder / "body.vtu", body);
    const auto format = [](const char* series) {
      return VtuFormat{Encoding::zlib, false, series, SyntheticRun::radius};
    };
    Series particles(folder, format("particles")), surface(folder, format("surface"));
    Series bones(folder, format("bones")), frames(folder, format("frames"));
    for (int k = 0; k < count; ++k) {
      const Moment moment{SyntheticRun::half_turn * k / std::max(1, count - 1), k};
      Dataset places = run.particles(moment);
      for (Vec3& point : places.points) point += at;
      particles.add(places);
      surface.add(run.surface(moment));
      bones.add(run.bones(moment));
      frames.add(run.frames(moment));
    }
    for (Series* series : {&particles, &surface, &bones, &frames}) series->close();
  }

  /// Adds a series of cells with the arrays of the particles, or without any.
  void write_cells(bool with_arrays = true) {
    const SyntheticRun run;
    Series cells(folder, {Encoding::zlib, false, "volume", SyntheticRun::radius});
    for (const int k : {0, 1}) {
      Dataset frame = evaluated(run.particles({SyntheticRun::half_turn * k, k}));
      frame.kind = CellKind::tetrahedron;
      frame.connectivity = {0, 1, 2, 3};
      frame.field_columns.clear();
      if (!with_arrays) frame.point_columns.clear();
      frame.cell_columns = {column("J", std::vector<double>{1}),
                            column("torn", std::vector<std::int32_t>{0})};
      cells.add(frame);
    }
    cells.close();
  }

  std::string state(const ViewOptions& options = {}) const {
    return view_state(shown_run(folder, options), options);
  }

  /// Values of the property of the first object of that type.
  static std::vector<std::string> values(const std::string& text, std::string_view type,
                                         std::string_view property) {
    std::vector<std::string> found;
    bool of_type = false, of_property = false;
    for (const XmlElement& element : xml_elements(text)) {
      if (element.path == "ServerManagerState/Proxy") {
        if (of_type && !found.empty()) break;
        of_type = element.attribute("type") == type;
      }
      if (element.path == "ServerManagerState/Proxy/Property")
        of_property = of_type && element.attribute("name") == property;
      if (element.path == "ServerManagerState/Proxy/Property/Element" && of_property)
        found.emplace_back(element.attribute("value"));
    }
    return found;
  }
};

std::size_t count_of(const std::string& text, std::string_view part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(ViewState, ShowsABodyFarAwayFromAPointNearIt) {
  write_run(2, {-1048576, 0, 0});
  const std::string text = state();
  const std::vector<std::string> function = values(text, "Calculator", "Function");
  ASSERT_EQ(function.size(), 1u);
  EXPECT_EQ(function[0], "coords-((-1048576)*iHat+(0)*jHat+(0)*kHat)");
  for (const std::string& place : values(text, "RenderView", "CameraFocalPoint"))
    EXPECT_LT(std::abs(std::stod(place)), 1);
  EXPECT_EQ(values(text, "RenderView", "CameraFocalPoint").size(), 3u);
}

TEST_F(ViewState, NamesEverySeriesByItsWholePath) {
  write_run();
  const std::string text = state();
  for (const char* name : {"particles", "surface", "bones", "frames"})
    EXPECT_TRUE(contains(text, "\"" + (folder / name).string() + ".pvd\"")) << name;
  EXPECT_FALSE(contains(text, "obstacles.pvd"));
}

TEST_F(ViewState, RefersOnlyToObjectsThatAreThere) {
  write_run();
  std::set<std::string, std::less<>> made, meant;
  for (const XmlElement& element : xml_elements(state({.forces = ""}))) {
    if (element.path == "ServerManagerState/Proxy") made.emplace(element.attribute("id"));
    if (element.path == "ServerManagerState/Proxy/Property/Proxy")
      meant.emplace(element.attribute("value"));
    if (element.path == "ServerManagerState/ProxyCollection/Item")
      meant.emplace(element.attribute("id"));
  }
  EXPECT_GT(meant.size(), 20u);
  for (const std::string& id : meant) EXPECT_TRUE(made.contains(id)) << id;
}

TEST_F(ViewState, TakesAnyNameOfAFolder) {
  folder /= "a \"run\" & <more> of Ärms";
  std::filesystem::create_directories(folder);
  write_run(2);
  EXPECT_EQ(values(state(), "PVDReader", "FileName").at(0), (folder / "particles.pvd").string());
  std::filesystem::rename(folder, folder.parent_path() / "away");
  folder = folder.parent_path();
}

TEST_F(ViewState, BeginsWhenTheArrayIsLargestOrWhenItIsAskedTo) {
  write_run();
  EXPECT_EQ(values(state(), "AnimationScene", "AnimationTime").at(0), "1");
  EXPECT_EQ(values(state({.time = 0.3}), "AnimationScene", "AnimationTime").at(0), "0.25");
}

TEST_F(ViewState, ColorsTheArrayAskedForWithItsUnit) {
  write_run();
  EXPECT_TRUE(contains(state(), "\"displacement (m)\""));
  EXPECT_TRUE(contains(state({.array = "velocity"}), "\"velocity (m/s)\""));
  test::expect_bad_input([&] { state({.array = "velocty"}); },
                         {"no array 'velocty'; did you mean velocity?"});
}

/// The second bone turns about its head by 90 degrees: its far end moves by sqrt(2) times its
/// length.
TEST_F(ViewState, TheScaleEndsWhereAllButHalfAPercentOfTheValuesDo) {
  write_run();
  const SyntheticRun run;
  const auto points = values(state(), "PVLookupTable", "RGBPoints");
  ASSERT_EQ(points.size(), 68u);  // 17 colors
  EXPECT_EQ(points[0], "0");
  const double farthest = std::sqrt(2.0) * run.skeleton.bones[1].length;
  EXPECT_LT(std::stod(points[64]), 1.5 * farthest);
  EXPECT_GT(std::stod(points[64]), 0.7 * farthest);
}

TEST_F(ViewState, TheScaleIsTheRunsOrTheOneAskedFor) {
  write_run();
  const auto ends = [&](const ViewOptions& options) {
    const auto points = values(state(options), "PVLookupTable", "RGBPoints");
    return points.at(0) + " " + points.at(64);
  };
  const ValueRanges known = {{"displacement", {0.5, 3}}, {"speed", {0, 7}}};
  EXPECT_EQ(ends({.ranges = known}), "0.5 3");
  EXPECT_EQ(ends({.array = "velocity", .ranges = known}), "0 7");
  EXPECT_EQ(ends({.range = ValueRange{0, 1e-10}, .ranges = known}), "0 1e-10");
}

TEST_F(ViewState, ABodyAtRestHasAScaleThatGrows) {
  write_run(1);
  EXPECT_EQ(values(state(), "PVLookupTable", "AutomaticRescaleRangeMode").at(0), "1");
  write_run(2);
  EXPECT_EQ(values(state(), "PVLookupTable", "AutomaticRescaleRangeMode").at(0), "-1");
}

TEST_F(ViewState, CutsAcrossTheAxisAskedForOrNone) {
  write_run();
  EXPECT_EQ(values(state({.cut = "z"}), "Calculator", "Function").at(0), "coordsZ-displacement_Z");
  EXPECT_TRUE(values(state({.cut = "none"}), "Calculator", "Function").empty());
}

TEST_F(ViewState, CellsAreCutOpenAndTheParticlesHidden) {
  write_run();
  EXPECT_FALSE(contains(state(), "untorn cells"));
  write_cells();
  const std::string text = state();
  for (const char* name : {"volume.pvd", "untorn cells", "cut-away body", "cut-away particles"})
    EXPECT_TRUE(contains(text, name)) << name;
  EXPECT_EQ(values(text, "Clip", "SelectInputScalars").back(), "place at rest");
  EXPECT_EQ(values(text, "UnstructuredGridRepresentation", "Visibility").at(0), "0");
  EXPECT_EQ(values(text, "GeometryRepresentation", "Visibility").at(0), "1");
  EXPECT_EQ(values(text, "GeometryRepresentation", "ColorArrayName").back(), "displacement");
  EXPECT_FALSE(contains(state({.cut = "none"}), "\"Clip\""));
}

TEST_F(ViewState, CellsWithoutTheArrayAreLeftOut) {
  write_run();
  write_cells(false);
  const std::string text = state();
  EXPECT_FALSE(contains(text, "volume.pvd"));
  EXPECT_EQ(values(text, "UnstructuredGridRepresentation", "Visibility").at(0), "1");
}

/// The skin has displacements, but no velocity.
TEST_F(ViewState, TheSkinHasTheColorsOfTheBodyIfItHasTheArray) {
  write_run();
  const auto colored = [&](const char* array) {
    const std::string text = state({.array = array});
    return text.find("\"" + std::string(array) + "\"", text.find("SelectNormalArray") - 1500) <
           text.find("SelectNormalArray");
  };
  EXPECT_TRUE(colored("displacement"));
  EXPECT_FALSE(colored("velocity"));
}

TEST_F(ViewState, ArrowsOfForcesAreThereAndShownOnDemand) {
  write_run();
  EXPECT_FALSE(contains(state(), "the longest arrow"));
  EXPECT_TRUE(contains(state({.forces = ""}), "force_pair: the longest arrow at any time is"));
  EXPECT_TRUE(contains(state({.forces = "force_bone"}), "force_bone: the longest arrow"));
  test::expect_bad_input([&] { state({.forces = "push"}); }, {"no array 'push'"});
}

TEST_F(ViewState, WhatParaViewHasSavedIsForeign) {
  const auto file = folder / "view.pvsm";
  EXPECT_FALSE(is_foreign_state(file));
  write_run(2);
  write_view_state(folder, file);
  EXPECT_FALSE(is_foreign_state(file));
  put(file, "<GenericParaViewApplication>\n</GenericParaViewApplication>\n");
  EXPECT_TRUE(is_foreign_state(file));
  std::filesystem::remove(file);
  std::filesystem::create_symlink(folder / "missing", file);
  EXPECT_TRUE(is_foreign_state(file));
}

TEST_F(ViewState, CamerasAreLinkedAsTheVersionOfParaViewWritesIt) {
  write_run(2);
  const auto text = [&](CameraLinks links) { return view_state(shown_run(folder, {}), {}, links); };
  EXPECT_FALSE(contains(text(CameraLinks::none), "CameraLink"));
  EXPECT_TRUE(contains(text(CameraLinks::until_5_11), "<CameraLink"));
  EXPECT_FALSE(contains(text(CameraLinks::until_5_11), "exceptionBehavior"));
  EXPECT_TRUE(contains(text(CameraLinks::from_5_13), "exceptionBehavior"));
}

TEST_F(ViewState, SeriesThatAreMissingAreLeftOut) {
  write_run();
  for (const char* name : {"surface.pvd", "bones.pvd", "frames.pvd"})
    std::filesystem::remove(folder / name);
  const std::string text = state();
  EXPECT_TRUE(contains(text, "particles.pvd"));
  EXPECT_FALSE(contains(text, "FeatureEdges"));
  put(folder / "bones.pvd", pvd_text({}));
  EXPECT_FALSE(contains(state(), "TubeFilter"));
}

TEST_F(ViewState, AFolderWithoutFramesIsRefused) {
  test::expect_bad_input([&] { shown_run(folder, {}); }, {"particles.pvd"});
}

TEST_F(ViewState, ALiveViewFollowsTheSeriesInPlaceOfReadingThem) {
  write_run(1);
  const ViewOptions live{.forces = "", .live = true};
  const std::string text = state(live);
  EXPECT_FALSE(contains(text, "PVDReader"));
  EXPECT_EQ(values(text, "SinewSeries", "FileName").at(0), (folder / "run.json").string());
  EXPECT_EQ(values(text, "SinewSeries", "Series").at(0), "particles");
  EXPECT_EQ(values(text, "SinewSeries", "Vectors").at(0), "force_pair");
  EXPECT_EQ(values(text, "Glyph", "ScaleFactor").at(0), "1");
  EXPECT_EQ(values(text, "SinewSeries", "Colors").at(0), "displacement");
  const auto distance = [&](const std::string& of) {
    const auto eye = values(of, "RenderView", "CameraPosition");
    const auto focus = values(of, "RenderView", "CameraFocalPoint");
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k)
      squared += std::pow(std::stod(eye.at(k)) - std::stod(focus.at(k)), 2);
    return std::sqrt(squared);
  };
  EXPECT_GT(distance(text), 1.15 * distance(state()));  // there is room to bend
}

/// Here the series of skinning alone.
TEST_F(ViewState, SeriesWithoutALookAreOpenedAndHidden) {
  write_run(2);
  const std::size_t shown = count_of(state(), "Representation\"");
  const SyntheticRun run;
  Series skin(folder, {Encoding::zlib, false, "skin_lbs", SyntheticRun::radius});
  for (const int k : {0, 1}) skin.add(run.surface({SyntheticRun::half_turn * k, k}));
  skin.close();
  const std::string text = state();
  EXPECT_TRUE(contains(text, "/skin_lbs.pvd"));
  EXPECT_EQ(count_of(text, "Representation\""), shown);
}

}  // namespace sinew::view_state_test
