// SPDX-License-Identifier: GPL-3.0-or-later
// vtk_scene PICTURE.png: fills a shape of VTK, bends it with two bones and draws its skin with VTK;
// no file between. Debian's VTK draws on a display: xvfb-run ./vtk_scene bent.png
#include <sinew/sinew.h>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSuperquadricSource.h>
#include <vtkWindowToImageFilter.h>

#include <cstdio>

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: vtk_scene PICTURE.png\n"), 2;
  vtkNew<vtkSuperquadricSource> shape;  // along y, 0.4 m long
  shape->SetScale(0.1, 0.1, 0.4);
  shape->SetPhiResolution(64);
  shape->Update();
  sinew::Scene scene;
  scene.settings.meshes["shape"] = sinew::polygons_of(*shape->GetOutput());
  scene.settings.body = {.mesh = "shape", .count = 3000};
  scene.settings.bones = {{.name = "lower", .head = {{0, -0.2, 0}}, .tail = {{0, 0, 0}}},
                          {.name = "upper", .parent = "lower", .tail = {{0, 0.2, 0}}}};
  scene.settings.tracks = {
      {.bone = "upper", .keys = {{.time = 0}, {.time = 0.3, .axis = {{0, 0, 1}}, .angle = 45}}}};
  const sinew::Prepared prepared = sinew::prepare(scene);
  sinew::Simulation simulation = sinew::start(prepared);
  while (simulation.time() < 0.4) simulation.step();
  sinew::FrameData frame(prepared);
  frame.take(simulation);
  vtkNew<vtkPolyDataMapper> mapper;  // colors by the active scalars: the bone of each point
  mapper->SetInputData(sinew::vtk_poly_data(frame.surface(), "surface"));
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  renderer->SetBackground(1, 1, 1);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(800, 800);
  window->AddRenderer(renderer);
  vtkNew<vtkWindowToImageFilter> shot;
  shot->SetInput(window);
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(argv[1]);
  writer->SetInputConnection(shot->GetOutputPort());
  writer->Write();
} catch (const sinew::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), static_cast<int>(error.exit());
}
