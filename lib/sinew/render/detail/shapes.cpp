// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/shapes.h>

#include <vtkActor.h>
#include <vtkAppendPolyData.h>
#include <vtkLookupTable.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>
#include <vtkTubeFilter.h>

namespace sinew {

vtkNew<vtkPoints> vtk_points(const Points& points) {
  vtkNew<vtkPoints> out;
  out->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    out->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  return out;
}

vtkNew<vtkPolyData> net(const Points& points, const std::vector<Shading::Edge>& edges) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points(points));
  data->SetLines(vtk_cells(edges));
  return data;
}

vtkNew<vtkDoubleArray> named_values(const char* name, const std::vector<double>& values,
                                    const std::vector<int>& source) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (const double value : values)
    if (source.empty()) array->InsertNextValue(value);
  for (const int point : source) array->InsertNextValue(values[static_cast<std::size_t>(point)]);
  return array;
}

namespace {

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

}  // namespace

void show_values(vtkPolyDataMapper& mapper, const ColorScale& scale) {
  mapper.SetLookupTable(table_of(scale));
  mapper.SetScalarRange(scale.low, scale.high);
  mapper.SetScalarModeToUsePointFieldData();
  mapper.SelectColorArray("value");
  mapper.InterpolateScalarsBeforeMappingOn();
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

void add_flat_lines(vtkRenderer& renderer, vtkPolyData* lines, const Color& color, double opacity,
                    double width) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(lines);
  mapper->ScalarVisibilityOff();
  vtkProperty& look = add_actor(renderer, *mapper, color);
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

}  // namespace sinew
