// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/actors.h>

#include <vtkActor.h>
#include <vtkAppendPolyData.h>
#include <vtkArrowSource.h>
#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkClipClosedSurface.h>
#include <vtkClipPolyData.h>
#include <vtkDoubleArray.h>
#include <vtkFeatureEdges.h>
#include <vtkFloatArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkNonMergingPointLocator.h>
#include <vtkOpenGLSphereMapper.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>

namespace sinew {

namespace {

constexpr Color skin_color{250, 218, 196};
constexpr Color edge_color{104, 62, 42};

vtkNew<vtkPoints> vtk_points(const Points& points) {
  vtkNew<vtkPoints> out;
  out->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    out->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  return out;
}

template <std::size_t N>
vtkNew<vtkCellArray> vtk_cells(const std::vector<std::array<int, N>>& cells) {
  vtkNew<vtkCellArray> out;
  for (const auto& cell : cells) {
    out->InsertNextCell(static_cast<int>(N));
    for (const int point : cell) out->InsertCellPoint(point);
  }
  return out;
}

vtkProperty& add_actor(vtkRenderer& renderer, vtkMapper& mapper, const Color& color) {
  vtkNew<vtkActor> actor;
  actor->SetMapper(&mapper);
  renderer.AddActor(actor);
  vtkProperty& look = *actor->GetProperty();
  look.SetColor(color[0] / 255.0, color[1] / 255.0, color[2] / 255.0);
  look.SetAmbient(0.14);
  look.SetDiffuse(0.9);
  look.SetSpecular(0.12);
  look.SetSpecularPower(24);
  return look;
}

vtkNew<vtkPolyData> net(const Points& points, const std::vector<Shading::Edge>& edges) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points(points));
  data->SetLines(vtk_cells(edges));
  return data;
}

/// Lifted off the surface along its normals, which would otherwise hide half of each line.
Points lifted(const Triangles& surface, double by) {
  Points points = surface.points;
  const Points normals = point_normals(surface);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] += by * normals[i];
  return points;
}

/// `values`: of the surface's points. `source`: the surface's point behind each point; none:
/// itself.
vtkNew<vtkDoubleArray> named_values(const char* name, const std::vector<double>& values,
                                    const std::vector<int>& source = {}) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (const double value : values)
    if (source.empty()) array->InsertNextValue(value);
  for (const int point : source) array->InsertNextValue(values[static_cast<std::size_t>(point)]);
  return array;
}

/// The part on the negative side, with cut triangles and lines; all of it where there are no sides.
vtkSmartPointer<vtkPolyData> part_of(vtkPolyData* data, const std::vector<double>& sides,
                                     const std::vector<int>& source = {}) {
  if (sides.empty()) return data;
  data->GetPointData()->SetScalars(named_values("side", sides, source));
  vtkNew<vtkClipPolyData> clip;
  clip->SetInputData(data);
  clip->InsideOutOn();
  clip->SetLocator(vtkNew<vtkNonMergingPointLocator>());  // points stay split along creases
  clip->Update();
  return clip->GetOutput();
}

vtkNew<vtkLookupTable> table_of(const ColorScale& scale) {
  constexpr int colors = 1024;
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(colors);
  table->SetTableRange(scale.low, scale.high);
  const auto put = [](const Color& color, auto&& set) {
    set(color[0] / 255.0, color[1] / 255.0, color[2] / 255.0);
  };
  for (int k = 0; k < colors; ++k)
    put(scale.color(scale.low + (scale.high - scale.low) * (k + 0.5) / colors),
        [&](double r, double g, double b) { table->SetTableValue(k, r, g, b); });
  put(palette::no_value, [&](double r, double g, double b) { table->SetNanColor(r, g, b, 1); });
  return table;
}

/// Values between points are interpolated, not colors, which the scale may lack.
void show_values(vtkPolyDataMapper& mapper, const ColorScale& scale) {
  mapper.SetLookupTable(table_of(scale));
  mapper.SetScalarRange(scale.low, scale.high);
  mapper.SetScalarModeToUsePointFieldData();
  mapper.SelectColorArray("value");
  mapper.InterpolateScalarsBeforeMappingOn();
}

void add_edges(vtkRenderer& renderer, const Snapshot& snapshot, double lift,
               const std::vector<Shading::Edge>& edges, double opacity, double width) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(part_of(net(lifted(snapshot.surface, lift), edges), snapshot.skin_sides));
  mapper->ScalarVisibilityOff();
  vtkProperty& look = add_actor(renderer, *mapper, edge_color);
  look.LightingOff();
  look.SetOpacity(opacity);  // below 1 depths are not written: lines cast no shadows
  look.SetLineWidth(static_cast<float>(width));
}

void add_tubes(vtkRenderer& renderer, vtkPolyData* lines, double radius, const Color& color) {
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(lines);
  tubes->SetRadius(radius);
  tubes->SetNumberOfSides(20);
  tubes->CappingOn();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tubes->GetOutputPort());
  add_actor(renderer, *mapper, color);
}

void add_tubes(vtkRenderer& renderer, const Points& ends, double radius, const Color& color) {
  std::vector<Shading::Edge> pairs;
  for (int i = 0; i + 1 < static_cast<int>(ends.size()); i += 2) pairs.push_back({i, i + 1});
  add_tubes(renderer, net(ends, pairs), radius, color);
}

void add_balls(vtkRenderer& renderer, const Points& centers, double radius, const Color& color) {
  vtkNew<vtkAppendPolyData> balls;
  for (const Vec3& center : centers) {
    vtkNew<vtkSphereSource> ball;
    ball->SetCenter(center.x(), center.y(), center.z());
    ball->SetRadius(radius);
    ball->SetThetaResolution(24);
    ball->SetPhiResolution(16);
    balls->AddInputConnection(ball->GetOutputPort());
  }
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(balls->GetOutputPort());
  add_actor(renderer, *mapper, color);
}

Color color_of(const Snapshot& snapshot, std::size_t particle, const ColorScale& scale) {
  switch (snapshot.marks.empty() ? Mark::none : snapshot.marks[particle]) {
    case Mark::held:
      return palette::held;
    case Mark::loaded:
      return palette::loaded;
    case Mark::muscle:
      return palette::muscle;
    case Mark::sample:
      return palette::sample;
    case Mark::none:
      break;
  }
  return snapshot.values.empty() ? palette::particle : scale.color(snapshot.values[particle]);
}

vtkNew<vtkUnsignedCharArray> colors_of(const Snapshot& snapshot, const ColorScale& scale) {
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(static_cast<vtkIdType>(snapshot.particles.size()));
  for (std::size_t i = 0; i < snapshot.particles.size(); ++i) {
    const Color color = color_of(snapshot, i, scale);
    colors->SetTypedTuple(static_cast<vtkIdType>(i), color.data());
  }
  return colors;
}

}  // namespace

void add_particles(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale) {
  if (snapshot.particles.empty()) return;
  vtkNew<vtkCellArray> vertices;
  for (std::size_t i = 0; i < snapshot.particles.size(); ++i) {
    const auto point = static_cast<vtkIdType>(i);
    vertices->InsertNextCell(1, &point);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points(snapshot.particles));
  data->SetVerts(vertices);
  data->GetPointData()->SetScalars(colors_of(snapshot, scale));
  vtkNew<vtkOpenGLSphereMapper> mapper;  // one quadrangle each, round by its shader
  mapper->SetInputData(data);
  mapper->SetRadius(static_cast<float>(snapshot.radius));
  add_actor(renderer, *mapper, palette::paper);
}

void add_skin(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin,
              const ColorScale& scale) {
  if (skin.faces.empty()) return;
  const Triangles shaded = skin.at(snapshot.surface.points);
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (const Vec3& normal : point_normals(shaded)) normals->InsertNextTuple(normal.data());
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points(shaded.points));
  data->SetPolys(vtk_cells(shaded.faces));
  data->GetPointData()->SetNormals(normals);
  const bool has_values = !snapshot.skin_values.empty();
  if (has_values)
    data->GetPointData()->AddArray(named_values("value", snapshot.skin_values, skin.source));
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(part_of(data, snapshot.skin_sides, skin.source));
  if (has_values)
    show_values(*mapper, scale);
  else
    mapper->ScalarVisibilityOff();
  vtkProperty& look = add_actor(renderer, *mapper, skin_color);
  look.SetAmbient(0.34);
  look.SetDiffuse(0.62);
  look.SetSpecular(0.02);
}

void add_net(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin,
             const LineStyle& style) {
  constexpr double wide_enough = 7;  // pixels between lines: closer ones would gray the skin
  if (skin.mean_line < wide_enough * style.pixel) return;
  add_edges(renderer, snapshot, style.lift, skin.lines, 0.28, 0.7 * style.width);
}

void add_creases(vtkRenderer& renderer, const Snapshot& snapshot, const Shading& skin,
                 const LineStyle& style) {
  add_edges(renderer, snapshot, style.lift, skin.creases, 0.8, style.width);
}

void add_bare_bones(vtkRenderer& renderer, const Snapshot& snapshot, double thickness,
                    const Color& color) {
  if (snapshot.bones.empty()) return;
  Points ends;
  for (const SnapshotBone& bone : snapshot.bones) ends.insert(ends.end(), {bone.head, bone.tail});
  add_tubes(renderer, ends, 0.3 * thickness, color);
  add_balls(renderer, ends, 0.55 * thickness, color);
}

void add_bones(vtkRenderer& renderer, const Snapshot& snapshot, double thickness,
               const Color& color) {
  if (snapshot.bones.empty()) return;
  add_bare_bones(renderer, snapshot, thickness, color);
  std::array<Points, 3> axes;
  for (const SnapshotBone& bone : snapshot.bones) {
    for (int k = 0; k < 3; ++k)
      axes[k].insert(axes[k].end(), {bone.head, bone.head + 3.2 * thickness * bone.axes.col(k)});
  }
  for (int k = 0; k < 3; ++k)  // the one along the bone covers it
    add_tubes(renderer, axes[k], (k == 0 ? 0.36 : 0.22) * thickness, palette::axes[k]);
}

void add_references(vtkRenderer& renderer, const Snapshot& snapshot, double radius) {
  if (!snapshot.references.empty())
    add_balls(renderer, snapshot.references, radius, palette::reference);
}

namespace {

/// Points at the same place become one: outlines are edges without a neighbor.
vtkSmartPointer<vtkPolyData> obstacles_within(const Triangles& obstacles, const Box& space) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points(obstacles.points));
  data->SetPolys(vtk_cells(obstacles.faces));
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(data);
  clean->ConvertPolysToLinesOff();
  clean->Update();
  vtkNew<vtkPlaneCollection> sides;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      const Vec3 origin = sign > 0 ? space.min() : space.max(), normal = sign * Vec3::Unit(axis);
      vtkNew<vtkPlane> side;
      side->SetOrigin(origin.x(), origin.y(), origin.z());
      side->SetNormal(normal.x(), normal.y(), normal.z());
      sides->AddItem(side);
    }
  vtkNew<vtkClipClosedSurface> clip;
  clip->SetInputConnection(clean->GetOutputPort());
  clip->SetClippingPlanes(sides);
  clip->Update();
  return clip->GetOutput();
}

}  // namespace

void add_obstacles(vtkRenderer& renderer, const Snapshot& snapshot, double line) {
  const auto obstacles = obstacles_within(snapshot.obstacles, snapshot.obstacle_space);
  if (obstacles->GetNumberOfCells() == 0) return;
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(obstacles);
  vtkNew<vtkPolyDataMapper> faces;
  faces->SetInputConnection(normals->GetOutputPort());
  add_actor(renderer, *faces, palette::obstacle).SetAmbient(0.3);
  vtkNew<vtkFeatureEdges> outlines;
  outlines->SetInputData(obstacles);
  outlines->NonManifoldEdgesOff();
  outlines->ColoringOff();
  vtkNew<vtkPolyDataMapper> edges;
  edges->SetInputConnection(outlines->GetOutputPort());
  vtkProperty& look = add_actor(renderer, *edges, palette::held);
  look.LightingOff();
  look.SetLineWidth(static_cast<float>(line));
}

namespace {

template <class Arrow, class ColorOf>
vtkNew<vtkPolyData> data_of(const std::vector<Arrow>& arrows, const ColorOf& color_of) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> along;
  along->SetName("along");
  along->SetNumberOfComponents(3);
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (const Arrow& arrow : arrows) {
    points->InsertNextPoint(arrow.from.data());
    along->InsertNextTuple(arrow.along.data());
    colors->InsertNextTypedTuple(color_of(arrow).data());
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->GetPointData()->AddArray(along);
  data->GetPointData()->SetScalars(colors);
  return data;
}

void add_glyphs(vtkRenderer& renderer, vtkPolyData* arrows) {
  vtkNew<vtkArrowSource> shape;
  shape->SetTipRadius(0.11);
  shape->SetShaftRadius(0.04);
  shape->SetTipResolution(16);
  shape->SetShaftResolution(12);
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(arrows);
  mapper->SetSourceConnection(shape->GetOutputPort());
  mapper->SetOrientationArray("along");
  mapper->SetScaleArray("along");
  mapper->SetScaleModeToScaleByMagnitude();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.3);
  actor->GetProperty()->SetDiffuse(0.75);
  renderer.AddActor(actor);
}

}  // namespace

void add_arrows(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale) {
  if (snapshot.arrows.empty()) return;
  const auto color = [&](const SnapshotArrow& arrow) { return scale.color(arrow.value); };
  add_glyphs(renderer, data_of(snapshot.arrows, color));
}

void add_forces(vtkRenderer& renderer, const Snapshot& snapshot) {
  const auto color = [](const SnapshotForce& force) {
    return force.is_load ? palette::loaded : palette::held;
  };
  add_glyphs(renderer, data_of(snapshot.forces, color));
}

namespace {

vtkNew<vtkPolyData> data_of(const std::vector<SnapshotLine>& lines, const ColorScale& scale) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (const SnapshotLine& line : lines) {
    cells->InsertNextCell(2);
    for (const Vec3& end : {line.from, line.to}) {
      cells->InsertCellPoint(points->InsertNextPoint(end.data()));
      colors->InsertNextTypedTuple(scale.color(line.value).data());
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  data->GetPointData()->SetScalars(colors);
  return data;
}

/// Without the steps at which it stands still, which have no direction.
vtkNew<vtkPolyData> polyline(const Points& path) {
  vtkNew<vtkPoints> points;
  for (std::size_t i = 0; i < path.size(); ++i)
    if (i == 0 || path[i] != path[i - 1]) points->InsertNextPoint(path[i].data());
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(points->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i) cells->InsertCellPoint(i);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  return data;
}

}  // namespace

void add_lines(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
               double width) {
  if (snapshot.lines.empty()) return;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data_of(snapshot.lines, scale));
  vtkProperty& look = add_actor(renderer, *mapper, palette::paper);
  look.LightingOff();
  look.SetLineWidth(static_cast<float>(width));
}

void add_traces(vtkRenderer& renderer, const Snapshot& snapshot, double thickness) {
  for (std::size_t k = 0; k < snapshot.traces.size(); ++k) {
    const Points& path = snapshot.traces[k].path;
    if (path.empty()) continue;
    const Color& color = palette::traces[k % palette::traces.size()];
    add_balls(renderer, {path.back()}, snapshot.radius, color);
    const auto line = polyline(path);
    if (line->GetNumberOfPoints() < 2) continue;
    add_tubes(renderer, line, thickness / 2, color);
  }
}

}  // namespace sinew
