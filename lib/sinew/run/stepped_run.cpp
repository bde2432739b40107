// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/stepped_run.h>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/paraview/view_state.h>
#include <sinew/run/detail/run_log.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/settings/write_scene.h>

namespace sinew {
namespace {

FrameScene around(const Prepared& prepared) {
  return {prepared.surface.triangles, prepared.obstacles,      prepared.look, prepared.probes,
          prepared.body.neighbors,    cells_to_write(prepared)};
}

void write_beginning(const RunFolder& folder, const Prepared& prepared, const Settings& scene) {
  write_body(folder.body(), prepared.filled, scene.output.encoding);
  write_mesh_files(scene);
  write_file(folder.scene(), resolved_scene(scene, folder.path));
}

}  // namespace

SteppedRun::SteppedRun(const RunFolder& folder, const Prepared& prepared,
                       const Simulation& simulation, const SteppedRunOptions& options)
    : folder_(folder), simulation_(simulation) {
  if (prepared.surface.triangles.faces.empty())
    throw bad_input("this body has no surface, which frames show",
                    "make it from a scene with a mesh");
  const Settings scene = with_mesh_files(prepared.settings, folder.meshes());
  refuse_foreign_files(folder);
  lock_.emplace(folder, create(folder));
  if (folder.used() && !options.force)
    throw bad_input(Place{folder.path.string()}, "holds a run already",
                    "replace it with --force, or choose another folder with -o");
  remove_old_run(folder);
  log_ = std::make_unique<RunLog>(folder, options.command);
  log_->describe(prepared);
  write_beginning(folder, prepared, scene);
  writer_.emplace(folder.path, scene.output, simulation.body(), around(prepared));
}

SteppedRun::~SteppedRun() {
  try {
    close("stopped");
  } catch (const std::exception&) {  // has been recorded, as far as the disk permits
  }
}

void SteppedRun::add(Simulation& simulation) {
  const double time = simulation.time();
  if (frames_ > 0 && time <= last_)
    throw bad_input("the frame at " + number_text(time) + " s is not later than the last, at " +
                        number_text(last_) + " s",
                    "step the simulation between frames");
  writer_->add(simulation, time);
  log_->frame(frames_++, time);
  last_ = time;
}

void SteppedRun::close(const std::string& status) {
  if (!writer_) return;
  try {
    writer_->close();
    if (writer_->written() > 0) write_view_state(folder_.path, folder_.view());
    log_->end(status, simulation_);
  } catch (const std::exception& error) {
    writer_.reset();
    log_->fail("failed", error.what());
    throw;
  }
  writer_.reset();
  lock_.reset();
}

}  // namespace sinew
