// SPDX-License-Identifier: GPL-3.0-or-later
// Bones, what they hold, and obstacles.
#include <sinew/render/detail/actors.h>

#include <vtkCleanPolyData.h>
#include <vtkClipClosedSurface.h>
#include <vtkFeatureEdges.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <sinew/render/detail/shapes.h>

namespace sinew {

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

}  // namespace sinew
