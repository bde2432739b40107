// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/paraview/view_state.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <sinew/core/color.h>
#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/io/paraview/detail/view_pipeline.h>
#include <sinew/io/paraview/state_file.h>

namespace sinew {
namespace {

using Numbers = std::vector<double>;

constexpr const char* mark = "<!-- written by sinew: sinew view writes it anew -->\n";
constexpr const char* version = "5.10.0";

const Numbers ink = {0.16, 0.18, 0.22}, paper = {0.98, 0.98, 0.99}, paper_top = {0.86, 0.89, 0.93};
const Numbers skin = {0.55, 0.71, 0.86}, edge = {0.20, 0.33, 0.47}, bone = {0.98, 0.93, 0.80};
const Numbers obstacle = {0.62, 0.60, 0.58}, force = {0.86, 0.30, 0.10};
/// Colors of the axes x, y, z of a bone.
const Numbers axes = {0.88, 0.15, 0.17, 0.13, 0.62, 0.24, 0.13, 0.36, 0.92};
/// A sphere lit from the upper left on each splat; fragments outside its outline are discarded.
constexpr const char* sphere = R"(//VTK::Color::Impl
vec2 at = offsetVCVSOutput.xy;
float outside = dot(at, at);
if (outside > 1.0) { discard; }
vec3 normal = vec3(at, sqrt(1.0 - outside));
float light = max(dot(normal, normalize(vec3(-0.35, 0.50, 0.79))), 0.0);
float shine = 0.25 * pow(max(dot(normal, normalize(vec3(-0.19, 0.27, 0.95))), 0.0), 40.0);
ambientColor = ambientColor * (0.25 + 0.75 * light) + vec3(shine);
diffuseColor = diffuseColor * (0.25 + 0.75 * light) + vec3(shine);
)";

constexpr int color_steps = 16;  // colors of pictures, between which ParaView interpolates

// Numbers of ParaView's enumerations.
constexpr double lab = 2, magnitude = 0, custom_shader = 6, gradient = 1;
constexpr double snap_to_timesteps = 2;
constexpr double never = -1, grow_every_timestep = 1;
constexpr double height = 1000;  ///< pixels of a view that is in no window: letters have theirs
/// Bones shine through the skin.
constexpr double skin_opacity = 0.45, bare_skin_opacity = 0.2;
constexpr double upper_left = 4, lower_center = 3, horizontal = 0, any_place = 0;

Numbers of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// The state under construction: sources that are there already, and what both views show.
class Show {
 public:
  Show(const ShownRun& run, const ViewOptions& options, CameraLinks links)
      : run_(run), options_(options), links_(links) {}

  std::string text() {
    parts_ = view_pipeline(state_, run_, options_);
    left_ = &begin_view("body"), right_ = &begin_view("bones");
    std::vector<const StateProxy*> shown = {&particles()};
    if (parts_.body != nullptr) shown.push_back(&cells());
    shown.push_back(&color_bar());
    add_common(shown, 0.35);
    shown.push_back(&note(*parts_.time, ink, upper_left));
    left_->refer("Representations", shown);
    shown.clear();
    if (run_.has("surface")) shown.push_back(&skin_in_view());
    add_common(shown, 0.8);
    if (parts_.note != nullptr) {
      shown.push_back(&shape("arrows", "GeometryRepresentation", *parts_.forces, force));
      shown.push_back(&note(*parts_.note, force, lower_center));
    }
    right_->refer("Representations", shown);
    arrange();
    return mark + state_.text();
  }

 private:
  StateProxy& representation(const std::string& name, const char* type, const StateProxy& input,
                             bool visible = true) {
    return state_.add("representations", type, "representations", name + std::to_string(++shown_))
        .refer("Input", {&input})
        .number("Visibility", visible);
  }

  /// In one color.
  StateProxy& shape(const std::string& name, const char* type, const StateProxy& input,
                    const Numbers& color, double opacity = 1) {
    return representation(name, type, input)
        .text("Representation", {"Surface"})
        .array("ColorArrayName", false, "")
        .numbers("AmbientColor", color)
        .numbers("DiffuseColor", color)
        .number("Opacity", opacity);
  }

  /// Colors it by the array.
  StateProxy& colored(StateProxy& shown) {
    return shown.text("Representation", {"Surface"})
        .array("ColorArrayName", false, run_.array)
        .refer("LookupTable", {table_})
        .number("Ambient", 0.35)  // what is seen at an angle still has the colors of the scale
        .number("Diffuse", 0.75);
  }

  StateProxy& skin_in_view() {
    constexpr const char* type = "UnstructuredGridRepresentation";
    const StateProxy& series = *parts_.series["surface"];
    StateProxy& shown =
        run_.skin_has_array
            ? colored(representation("surface", type, series)).number("Opacity", skin_opacity)
            : shape("surface", type, series, skin, bare_skin_opacity);
    return shown.text("SelectNormalArray", {"normal"}).number("Specular", 0.3);
  }

  StateProxy& as_spheres(StateProxy& points, double radius) {
    return points.text("Representation", {"Point Gaussian"})
        .number("ShaderPreset", custom_shader)
        .number("CustomTriangleScale", 2)
        .text("CustomShader", {sphere})
        .number("GaussianRadius", radius);
  }

  StateProxy& cells() {
    return colored(representation("cells", "GeometryRepresentation", *parts_.body));
  }

  /// Hidden where cells are shown, to be switched to.
  StateProxy& particles() {
    StateProxy& points = representation("body", "UnstructuredGridRepresentation", *parts_.particles,
                                        parts_.body == nullptr);
    return as_spheres(points, run_.radius)
        .array("ColorArrayName", false, run_.array)
        .refer("LookupTable", {&color_table()});
  }

  StateProxy& color_table() {
    const auto [low, high] = run_.range;
    std::vector<double> points;
    for (int k = 0; k <= color_steps; ++k) {
      const double fraction = double(k) / color_steps;
      const auto [red, green, blue] = mapped_color(fraction);
      points.insert(points.end(),
                    {low + fraction * (high - low), red / 255.0, green / 255.0, blue / 255.0});
    }
    table_ =
        &state_
             .add("lookup_tables", "PVLookupTable", "lookup_tables", run_.array + ".PVLookupTable")
             .numbers("RGBPoints", points)
             .number("ColorSpace", lab)
             .number("VectorMode", magnitude)
             .numbers("NanColor", {0.62, 0.62, 0.62})  // gray: no value here
             .number("ScalarRangeInitialized", 1)
             .number("AutomaticRescaleRangeMode",
                     run_.grows && !options_.live ? grow_every_timestep : never);
    return *table_;
  }

  /// "equivalent strain (1)"
  std::string title() const {
    std::string name = run_.array == "strain_eq" ? "equivalent strain" : run_.array;
    std::replace(name.begin(), name.end(), '_', ' ');
    return run_.unit.empty() ? name : name + " (" + run_.unit + ')';
  }

  StateProxy& color_bar() {
    return state_
        .add("representations", "ScalarBarWidgetRepresentation", "scalar_bars", "color bar")
        .refer("LookupTable", {table_})
        .number("Enabled", 1)
        .number("Visibility", 1)
        .text("Title", {title()})
        .text("ComponentTitle", {""})
        .number("AutoOrient", 0)
        .number("Orientation", horizontal)
        .number("WindowLocation", any_place)
        .numbers("Position", {0.25, 0.02})
        .number("ScalarBarLength", 0.5)
        .number("ScalarBarThickness", 14)
        .numbers("TitleColor", ink)
        .numbers("LabelColor", ink)
        .number("TitleFontSize", 18)
        .number("LabelFontSize", 16)
        .number("AutomaticLabelFormat", 0)
        .text("LabelFormat", {"%.3g"})
        .text("RangeLabelFormat", {"%.3g"});
  }

  StateProxy& axis_colors() {
    if (axis_table_ != nullptr) return *axis_table_;
    axis_table_ =
        &state_.add("lookup_tables", "PVLookupTable", "lookup_tables", "axis.PVLookupTable")
             .number("IndexedLookup", 1)
             .text("Annotations", {"1", "x", "2", "y", "3", "z"})
             .numbers("IndexedColors", axes)
             .number("ScalarRangeInitialized", 1);
    return *axis_table_;
  }

  /// What both views show: edges of the skin, bones, obstacles, forces of supports and loads.
  void add_common(std::vector<const StateProxy*>& shown, double opacity) {
    if (parts_.edges != nullptr)
      shown.push_back(&shape("edges", "GeometryRepresentation", *parts_.edges, edge, opacity)
                           .number("LineWidth", 2));
    if (parts_.bones != nullptr) add_bones(shown);
    if (run_.has("obstacles"))
      shown.push_back(&shape("obstacles", "UnstructuredGridRepresentation",
                             *parts_.series["obstacles"], obstacle, 0.6));
    for (const bool load : {false, true})
      if (const StateProxy* arrows = parts_.machine[load])
        shown.push_back(&shape("machine", "GeometryRepresentation", *arrows, load ? force : ink));
  }

  void add_bones(std::vector<const StateProxy*>& shown) {
    shown.push_back(&shape("bones", "GeometryRepresentation", *parts_.bones, bone)
                         .number("Ambient", 0.25)
                         .number("Specular", 0.4));
    shown.push_back(&representation("axes", "GeometryRepresentation", *parts_.axes)
                         .text("Representation", {"Surface"})
                         .array("ColorArrayName", true, "axis")
                         .refer("LookupTable", {&axis_colors()})
                         .number("Ambient", 0.25)
                         .number("Specular", 0.3));
    if (!run_.has("frames")) return;
    StateProxy& heads =
        shape("heads", "UnstructuredGridRepresentation", *parts_.series["frames"], ink);
    shown.push_back(&as_spheres(heads, 1.8 * bone_radius(run_)));
  }

  StateProxy& note(const StateProxy& input, const Numbers& color, double place) {
    return representation("note", "TextSourceRepresentation", input)
        .numbers("Color", color)
        .number("FontSize", 20)
        .number("WindowLocation", place);
  }

  StateProxy& begin_view(const std::string& name) {
    StateProxy& view = state_.add("views", "RenderView", "views", name)
                           .number("UseColorPaletteForBackground", 0)
                           .number("BackgroundColorMode", gradient)
                           .numbers("Background", paper)
                           .numbers("Background2", paper_top)
                           .numbers("OrientationAxesLabelColor", ink)
                           .number("OrientationAxesVisibility", name == "bones")
                           .number("CenterAxesVisibility", 0)
                           .number("ViewTime", run_.moment)
                           .numbers("ViewSize", {std::round(height * options_.aspect), height});
    look_at(view);
    return view;
  }

  /// Looks from the left, the front and above, z up, as near as all corners allow.
  void look_at(StateProxy& view) const {
    constexpr double wide = 0.9, tall = 0.8, angle = 30;  // above the color bar
    const Vec3 back = Vec3(-0.46, -0.84, 0.29).normalized();
    const Vec3 across = Vec3(-back.y(), back.x(), 0).normalized(), up = back.cross(across);
    Vec3 low = run_.corners[0], high = run_.corners[0];
    for (const Vec3& corner : run_.corners)
      low = low.cwiseMin(corner), high = high.cwiseMax(corner);
    const Vec3 middle = (low + high) / 2;
    const double half = std::tan(radians(angle / 2));
    double distance = 0;
    for (const Vec3& corner : run_.corners) {
      const Vec3 offset = corner - middle;
      const double reach = std::max(std::abs(offset.dot(up)) / tall,
                                    std::abs(offset.dot(across)) / (wide * options_.aspect));
      distance = std::max(distance, offset.dot(back) + reach / half);
    }
    const Vec3 focus = middle - half * distance * (0.95 - tall) * up;
    view.number("CameraViewAngle", angle)
        .numbers("CameraFocalPoint", of(focus))
        .numbers("CameraPosition", of(focus + distance * back))
        .numbers("CameraViewUp", of(up))
        .numbers("CenterOfRotation", of(focus));
  }

  void arrange() {
    state_.link_cameras(*left_, *right_, links_);
    const std::string left = std::to_string(left_->id()), right = std::to_string(right_->id());
    state_.add("misc", "ViewLayout", "layouts", "sinew")
        .raw(
            "      <Layout number_of_elements=\"3\">\n"
            "        <Item direction=\"2\" fraction=\"0.5\" view=\"0\"/>\n"
            "        <Item direction=\"0\" fraction=\"0.5\" view=\"" +
            left +
            "\"/>\n"
            "        <Item direction=\"0\" fraction=\"0.5\" view=\"" +
            right +
            "\"/>\n"
            "      </Layout>\n");
    const std::vector<const StateProxy*> none;  // a live source has the moment that there is
    StateProxy& keeper = state_.add("misc", "TimeKeeper", "timekeeper", "TimeKeeper1")
                             .number("Time", run_.moment)
                             .refer("TimeSources", options_.live ? none : parts_.all)
                             .refer("Views", {left_, right_});
    state_.add("animation", "AnimationScene", "animation", "AnimationScene1")
        .refer("TimeKeeper", {&keeper})
        .refer("ViewModules", {left_, right_})
        .number("PlayMode", snap_to_timesteps)
        .number("StartTime", run_.times.front())
        .number("EndTime", run_.times.back())
        .number("AnimationTime", run_.moment);
  }

  const ShownRun& run_;
  const ViewOptions& options_;
  CameraLinks links_;
  StateFile state_{version};
  ViewPipeline parts_;
  StateProxy* left_ = nullptr;
  StateProxy* right_ = nullptr;
  StateProxy* table_ = nullptr;
  StateProxy* axis_table_ = nullptr;
  int shown_ = 0;
};

}  // namespace

std::string view_state(const ShownRun& run, const ViewOptions& options, CameraLinks links) {
  return Show(run, options, links).text();
}

void write_view_state(const std::filesystem::path& folder, const std::filesystem::path& file,
                      const ValueRanges& ranges) {
  write_file(file, view_state(shown_run(folder, {.ranges = ranges})));
}

bool is_foreign_state(const std::filesystem::path& file) {
  std::error_code unreachable;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, unreachable))) return false;
  if (!std::filesystem::is_regular_file(file, unreachable)) return true;
  try {
    return read_head(file, std::string_view(mark).size()) != mark;
  } catch (const Error&) {  // it may not be read: it is somebody's
    return true;
  }
}

}  // namespace sinew
