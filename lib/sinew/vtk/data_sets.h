// SPDX-License-Identifier: GPL-3.0-or-later
// Data sets of VTK, for programs that make, filter or draw shapes with VTK: bodies are filled from
// them, and a moment of a simulation becomes such sets, with no file between.
//
//     source->Update();                                    // a source, a reader, a filter
//     Scene scene{settings};                               // whose body.mesh is "ball"
//     scene.settings.meshes["ball"] = polygons_of(*source->GetOutput());
//     const Prepared prepared = prepare(scene);
//     Simulation simulation = start(prepared);
//     simulation.advance(1000);
//
//     FrameData frame(prepared);
//     frame.take(simulation);
//     mapper->SetInputData(vtk_poly_data(frame.surface(), "surface"));
//     glyphs->SetInputData(vtk_grid(frame.particles(), "particles"));
//     tubes->SetInputData(vtk_poly_data(frame.bones(), "bones"));
//
// Lengths are in m, those of polygons in the unit of the body's options. Points that a shape has
// several times, as VTK's sources have on their seams, become one where their coordinates are
// equal; BodyOptions::weld brings together those that rounding keeps apart.
#pragma once

#include <string_view>

#include <vtkSmartPointer.h>

#include <sinew/core/dataset.h>
#include <sinew/core/triangles.h>

class vtkDataSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace sinew {

/// Polygons and triangle strips of a vtkPolyData, in this order, with all of its points, of any
/// precision; vertices and lines are left out, and, with a warning, ghosts and hidden cells. Of
/// other data sets the surface that vtkDataSetSurfaceFilter finds: outer faces of volume cells, and
/// surface cells. Throws bad input for a data set without polygons, points that are not finite,
/// cells of fewer than 3 points or that name points which are not there, and for images, whose
/// surface is that of a contour.
PolygonSoup polygons_of(vtkDataSet& shape);

// Data sets have the arrays of a run's files, in their order: names, names of components, units
// (vtkDataArray::UNITS_LABEL), active scalars and vectors, the field arrays TimeValue and CYCLE;
// and the time as vtkDataObject::DATA_TIME_STEP. Numbers are those of output.double_precision:
// Float64 and Int32. All is copied: a data set outlives what it was made of. A pipeline that is set
// up shows the next moment after skin->ShallowCopy() of what was made of it. `series`: which rows
// of the table in core/arrays.h apply, as "surface", "particles", "bones", "frames".

/// What VTK's filters and mappers for surfaces, lines and points take. The array `normal` becomes
/// the normals, too, by which VTK shades smoothly. Lines come before triangles, as VTK counts them.
vtkSmartPointer<vtkPolyData> vtk_poly_data(const Dataset& data, std::string_view series);

/// What the files hold: cells in the order of the dataset, of particles a VTK_VERTEX each.
vtkSmartPointer<vtkUnstructuredGrid> vtk_grid(const Dataset& data, std::string_view series);

}  // namespace sinew
