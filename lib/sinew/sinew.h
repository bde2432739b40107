// SPDX-License-Identifier: GPL-3.0-or-later
// All of sinew, in the order of the data: scene, fill, bind, simulate, write, measure.
//
//     const sinew::Settings scene = sinew::read_scene("configs/box_bend.yaml");
//     sinew::simulate(scene, {"out/box_bend"});
//
// Link with sinew::sinew. The headers that are included here are promised; others are inner, and
// may change with any version. Each can be included by itself; lib/README.md lists the rooms.
#pragma once

#include <sinew/core/error.h>
#include <sinew/core/options.h>
#include <sinew/core/parallel.h>
#include <sinew/core/system.h>
#include <sinew/fill/pack.h>
#include <sinew/io/particle_formats/formats.h>
#include <sinew/io/series.h>
#include <sinew/io/series_table.h>
#include <sinew/io/single_files.h>
#include <sinew/io/vtu.h>
#include <sinew/material/material.h>
#include <sinew/metrics/files.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/table.h>
#include <sinew/repair/diagnosis.h>
#include <sinew/repair/read_surface.h>
#include <sinew/rig/motion.h>
#include <sinew/rig/posing.h>
#include <sinew/rig/skeleton.h>
#include <sinew/run/export_run.h>
#include <sinew/run/frame_data.h>
#include <sinew/run/frame_writer.h>
#include <sinew/run/measure_run.h>
#include <sinew/run/particle_meter.h>
#include <sinew/run/simulate.h>
#include <sinew/scene/check/needs.h>
#include <sinew/scene/prepare.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/write_scene.h>
#include <sinew/stepping/simulation.h>
#include <sinew/study/compare_runs.h>
#include <sinew/study/study.h>
#include <sinew/study/study_files.h>
#if __has_include(<sinew/render/figure.h>)  // without VTK there is none
#include <sinew/render/figure.h>
#endif
#if __has_include(<sinew/vtk/data_sets.h>) && __has_include(<vtkSmartPointer.h>)
#include <sinew/vtk/data_sets.h>
#endif
#include <sinew/volume/moving_cells.h>
#include <sinew/world/own_forces.h>
#include <sinew/world/world.h>
