// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/paraview/detail/view_pipeline.h>

#include <algorithm>

#include <sinew/core/text.h>

namespace sinew {
namespace {

// Numbers of ParaView's enumerations.
constexpr double above_upper = 2, every_nth_point = 1, all_points = 0;

constexpr double crease = 40;  ///< degrees: flatter edges of the body are shaded smoothly

constexpr std::size_t max_arrows = 1500;  // more would hide each other
constexpr double bone_fraction = 0.009;   // radius of a bone's tube in the size of the body

class Pipeline {
 public:
  Pipeline(StateFile& state, const ShownRun& run, const ViewOptions& options)
      : state_(state), run_(run), options_(options) {}

  ViewPipeline made() {
    open_series();
    made_.particles = &cut_particles();
    if (run_.has_cells) made_.body = &cut_cells();
    if (run_.has("surface")) made_.edges = &feature_edges();
    if (run_.has_bones) {
      made_.bones = &tubes_of("bone", 0, 0, bone_radius(run_));
      made_.axes = &tubes_of("axes", 1, 3, 1.25 * bone_radius(run_));
    }
    if (!run_.forces.empty()) made_.forces = &force_arrows();
    if (run_.has("supports")) made_.machine = {&machine_arrows(false), &machine_arrows(true)};
    made_.time = &time_note();
    if (options_.forces && made_.forces != nullptr) made_.note = &arrow_note();
    return std::move(made_);
  }

 private:
  StateProxy& source(const char* group, const char* type, const std::string& name) {
    StateProxy& made = state_.add(group, type, "sources", name);
    made_.all.push_back(&made);
    return made;
  }

  StateProxy& filter(const char* type, const std::string& name, const StateProxy& input) {
    return source("filters", type, name).refer("Input", {&input});
  }

  void open_series() {
    for (const std::string& name : run_.series) made_.series[name] = &near_body(name, opened(name));
  }

  StateProxy& opened(const std::string& name) {
    if (!options_.live)
      return source("sources", "PVDReader", name)
          .text("FileName", {(run_.folder / (name + ".pvd")).string()});
    StateProxy& live = source("sources", "SinewSeries", name)
                           .text("FileName", {(run_.folder / "run.json").string()})
                           .text("Series", {name});
    if (name == "particles") live.text("Colors", {run_.array});
    if (name == "particles" && !run_.grows)
      live.numbers("ColorRange", {run_.range.low, run_.range.high})
          .number("FixedRange", options_.range ? 1 : 0);
    if (name != "particles" && name != "supports") return live;
    return live.text("Vectors", {name == "supports" ? "force" : run_.forces})
        .number("ArrowLength", arrow_fraction * run_.size());
  }

  /// Graphics have single precision: a body far away is shown relative to a point near it.
  StateProxy& near_body(const std::string& name, StateProxy& series) {
    const Vec3& at = run_.origin;
    if (at.isZero(0)) return series;
    return filter("Calculator", name + ", from the run's origin", series)
        .number("CoordinateResults", 1)
        .text("Function", {"coords-((" + number_text(at.x()) + ")*iHat+(" + number_text(at.y()) +
                           ")*jHat+(" + number_text(at.z()) + ")*kHat)"});
  }

  int axis() const { return options_.cut.at(0) - 'x'; }
  double middle() const { return (run_.rest[0][axis()] + run_.rest[1][axis()]) / 2; }

  /// Along the axis of the cut.
  StateProxy& place_at_rest(const std::string& name, const StateProxy& input) {
    const std::string letter(1, static_cast<char>('X' + axis()));
    return filter("Calculator", name, input)
        .text("ResultArrayName", {"place at rest"})
        .text("Function", {"coords" + letter + "-displacement_" + letter});
  }

  /// The particles beyond a plane across an axis. It deforms with the body, so that the same
  /// particles are seen at all times.
  StateProxy& cut_particles() {
    if (options_.cut == "none" || !run_.can_be_cut) return *made_.series["particles"];
    const StateProxy& place = place_at_rest("place at rest", *made_.series["particles"]);
    return filter("Threshold", run_.has_cells ? "cut-away particles" : "cut-away body", place)
        .array("SelectInputScalars", false, "place at rest")
        .number("ThresholdMethod", above_upper)
        .number("LowerThreshold", 0)
        .number("UpperThreshold", middle());
  }

  /// The same of cells, which are cut where the plane goes through them.
  StateProxy& cut_cells() {
    StateProxy* body = &filter("Threshold", "untorn cells", *made_.series["volume"])
                            .array("SelectInputScalars", true, "torn")
                            .number("LowerThreshold", 0)
                            .number("UpperThreshold", 0);
    if (options_.cut != "none") {
      const StateProxy& place = place_at_rest("place of cells at rest", *body);
      body = &filter("Clip", "cut-away body", place);
      const StateProxy& by_scalar =
          state_.add("implicit_functions", "Scalar",
                     "pq_helper_proxies." + std::to_string(body->id()), "ClipFunction");
      body->refer("ClipFunction", {&by_scalar})
          .array("SelectInputScalars", false, "place at rest")
          .number("Value", middle())
          .number("Invert", 0);
    }
    const StateProxy& outside = filter("DataSetSurfaceFilter", "outside of the body", *body);
    return filter("PolyDataNormals", "smooth body", outside).number("FeatureAngle", crease);
  }

  StateProxy& feature_edges() {
    StateProxy& outside = filter("DataSetSurfaceFilter", "skin", *made_.series["surface"]);
    return filter("FeatureEdges", "feature edges", outside)
        .number("FeatureAngle", 50)
        .number("Coloring", 0);
  }

  StateProxy& tubes_of(const std::string& name, double first, double last, double radius) {
    StateProxy& chosen = filter("Threshold", name, *made_.series["bones"])
                             .array("SelectInputScalars", true, "axis")
                             .number("LowerThreshold", first)
                             .number("UpperThreshold", last);
    StateProxy& lines = filter("DataSetSurfaceFilter", name + " lines", chosen);
    return filter("TubeFilter", name + " tubes", lines)
        .number("Radius", radius)
        .number("NumberOfSides", 24);
  }

  /// Arrows of an array of vectors; the longest at any time is a fifth of the body.
  StateProxy& arrows_of(const std::string& name, const StateProxy& input, const std::string& array,
                        double largest, std::array<double, 2> radii, double sides) {
    StateProxy& glyph = filter("Glyph", name, input);
    StateProxy& arrow = state_
                            .add("sources", "ArrowSource",
                                 "pq_helper_proxies." + std::to_string(glyph.id()), "Source")
                            .number("TipResolution", sides)
                            .number("ShaftResolution", sides)
                            .number("TipRadius", radii[0])
                            .number("ShaftRadius", radii[1]);
    const std::string named = options_.live ? "arrow" : array;  // which has the length to be shown
    const double scale = largest > 0 ? arrow_fraction * run_.size() / largest : 0;
    return glyph.refer("Source", {&arrow})
        .array("OrientationArray", false, named)
        .array("ScaleArray", false, named)
        .number("ScaleFactor", options_.live ? 1 : scale);
  }

  StateProxy& force_arrows() {
    const std::size_t stride = std::max<std::size_t>(1, run_.particles / max_arrows);
    return arrows_of("force arrows", *made_.series["particles"], run_.forces, run_.strongest,
                     {0.09, 0.03}, 12)
        .number("GlyphMode", every_nth_point)
        .number("Stride", static_cast<double>(stride));
  }

  /// Forces of the supports, or of the loads, on the body.
  StateProxy& machine_arrows(bool load) {
    const std::string name = load ? "loads" : "supports";
    StateProxy& chosen = filter("Threshold", name + " only", *made_.series["supports"])
                             .array("SelectInputScalars", false, "load")
                             .number("LowerThreshold", load)
                             .number("UpperThreshold", load);
    return arrows_of(name + " arrows", chosen, "force", run_.hardest, {0.1, 0.03}, 24)
        .number("GlyphMode", all_points);
  }

  StateProxy& time_note() {
    const StateProxy& particles = *made_.series["particles"];
    if (options_.live)
      return filter("AnnotateGlobalData", "time", particles)
          .text("SelectArrays", {"TimeValue"})
          .text("Prefix", {"t = "})
          .text("Suffix", {" s"})
          .text("Format", {"%.3f"});
    return filter("TimeToTextConvertor", "time", particles).text("Format", {"t = {time:.3f} s"});
  }

  StateProxy& arrow_note() {
    const std::string of_live = ": the longest arrow is the largest so far";
    return source("sources", "TextSource", "length of arrows")
        .text("Text", {run_.forces + (options_.live ? of_live
                                                    : ": the longest arrow at any time is " +
                                                          quantity_text(run_.strongest, "N"))});
  }

  StateFile& state_;
  const ShownRun& run_;
  const ViewOptions& options_;
  ViewPipeline made_;
};

}  // namespace

double bone_radius(const ShownRun& run) { return bone_fraction * run.size(); }

ViewPipeline view_pipeline(StateFile& state, const ShownRun& run, const ViewOptions& options) {
  return Pipeline(state, run, options).made();
}

}  // namespace sinew
