// SPDX-License-Identifier: GPL-3.0-or-later
// The body: particles, skin, edges, and its volume cut by a plane.
#include <sinew/render/detail/actors.h>

#include <vtkClipPolyData.h>
#include <vtkCutter.h>
#include <vtkFloatArray.h>
#include <vtkNonMergingPointLocator.h>
#include <vtkOpenGLSphereMapper.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <sinew/render/detail/shapes.h>
#include <sinew/render/detail/visible_spheres.h>

namespace sinew {

namespace {

constexpr Color skin_color{250, 218, 196};
constexpr Color edge_color{104, 62, 42};

/// Lifted off the surface along its normals, which would otherwise hide half of each line.
Points lifted(const Triangles& surface, double by) {
  Points points = surface.points;
  const Points normals = point_normals(surface);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] += by * normals[i];
  return points;
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

void add_edges(vtkRenderer& renderer, const Snapshot& snapshot, double lift,
               const std::vector<Shading::Edge>& edges, double opacity, double width) {
  const auto lines = part_of(net(lifted(snapshot.surface, lift), edges), snapshot.skin_sides);
  add_flat_lines(renderer, lines, edge_color, opacity, width);
}

constexpr double dot_size = 0.38;  // radii, of the dot on what is held

/// Its center: it stands out of the sphere toward the viewer.
Vec3 dot_of(const Snapshot& snapshot, std::size_t particle, const Mat3& view) {
  return snapshot.particles[particle] + 0.8 * snapshot.radius * Vec3(view.row(2));
}

Mark mark_of(const Snapshot& snapshot, std::size_t particle) {
  return snapshot.marks.empty() ? Mark::none : snapshot.marks[particle];
}

/// What is held keeps the color of its value, and has a dot.
Color color_of(const Snapshot& snapshot, std::size_t particle, const ColorScale& scale) {
  switch (mark_of(snapshot, particle)) {
    case Mark::held:
      if (snapshot.values.empty()) return palette::held;
      break;
    case Mark::loaded:
      return palette::loaded;
    case Mark::muscle:
      return palette::muscle;
    case Mark::sample:
      return palette::sample;
    case Mark::within:
      return palette::within;
    case Mark::none:
      break;
  }
  return snapshot.values.empty() ? palette::particle : scale.color(snapshot.values[particle]);
}

/// Spheres of one size, each in its color.
class Spheres {
 public:
  Spheres() { colors_->SetNumberOfComponents(3); }

  void add(const Vec3& center, const Color& color) {
    const vtkIdType point = points_->InsertNextPoint(center.data());
    vertices_->InsertNextCell(1, &point);
    colors_->InsertNextTypedTuple(color.data());
  }

  void put(vtkRenderer& renderer, double radius) {
    if (points_->GetNumberOfPoints() == 0) return;
    vtkNew<vtkPolyData> data;
    data->SetPoints(points_);
    data->SetVerts(vertices_);
    data->GetPointData()->SetScalars(colors_);
    vtkNew<vtkOpenGLSphereMapper> mapper;  // one quadrangle each, round by its shader
    mapper->SetInputData(data);
    mapper->SetRadius(static_cast<float>(radius));
    add_actor(renderer, *mapper, palette::paper);
  }

 private:
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> vertices_;
  vtkNew<vtkUnsignedCharArray> colors_;
};

}  // namespace

void add_particles(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
                   const Mat3& view) {
  Spheres spheres, dots;
  for (const std::size_t i : visible_spheres(snapshot.particles, snapshot.radius, view)) {
    spheres.add(snapshot.particles[i], color_of(snapshot, i, scale));
    if (mark_of(snapshot, i) == Mark::held && !snapshot.values.empty())
      dots.add(dot_of(snapshot, i, view), palette::held);
  }
  spheres.put(renderer, snapshot.radius);
  dots.put(renderer, dot_size * snapshot.radius);
}

void add_held_dots(vtkRenderer& renderer, const Snapshot& snapshot, const Mat3& view) {
  Spheres dots;
  for (std::size_t i = 0; i < snapshot.particles.size(); ++i)
    if (mark_of(snapshot, i) == Mark::held) dots.add(dot_of(snapshot, i, view), palette::held);
  dots.put(renderer, dot_size * snapshot.radius);
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

namespace {

/// Where the cut's plane crosses the data, `lift` (m) in front of it.
vtkNew<vtkCutter> cutter(const SnapshotCut& cut, vtkDataSet* data, double lift = 0) {
  const Vec3 normal = cut.normal.normalized();
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(cut.point.data());
  plane->SetNormal(normal.data());
  vtkNew<vtkCutter> cutter;
  cutter->SetCutFunction(plane);
  cutter->SetInputData(data);
  cutter->Update();
  vtkPoints* points = cutter->GetOutput()->GetPoints();
  for (vtkIdType i = 0; lift != 0 && i < cutter->GetOutput()->GetNumberOfPoints(); ++i) {
    Vec3 point;
    points->GetPoint(i, point.data());
    point += lift * normal;
    points->SetPoint(i, point.data());
  }
  return cutter;
}

}  // namespace

void add_cut(vtkRenderer& renderer, const Snapshot& snapshot, const ColorScale& scale,
             const LineStyle& outline) {
  const SnapshotCut& cut = snapshot.cut;
  if (cut.cells.empty()) return;
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(vtk_points(cut.points));
  grid->SetCells(VTK_TETRA, vtk_cells(cut.cells));
  grid->GetPointData()->AddArray(named_values("value", cut.values));
  vtkNew<vtkPolyDataMapper> face;
  face->SetInputData(cutter(cut, grid)->GetOutput());
  show_values(*face, scale);
  vtkProperty& look = add_actor(renderer, *face, palette::no_value);
  look.LightingOff();
  look.SetAmbient(1);
  look.SetDiffuse(0);
  vtkNew<vtkPolyData> skin;
  skin->SetPoints(vtk_points(snapshot.surface.points));
  skin->SetPolys(vtk_cells(snapshot.surface.faces));
  add_flat_lines(renderer, cutter(cut, skin, outline.lift)->GetOutput(), edge_color, 0.9,
                 outline.width);
}

}  // namespace sinew
