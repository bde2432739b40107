// SPDX-License-Identifier: GPL-3.0-or-later
// A picture with text: panels side by side, and below them the caption and the color bar.
//
//     write_png(figure({{&painter, &snapshot}}, {.camera = camera}).pixels(), "bent.png");
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sinew/render/canvas.h>
#include <sinew/render/picture.h>

namespace sinew {

/// One view of one snapshot.
struct Panel {
  Painter* painter = nullptr;
  const Snapshot* snapshot = nullptr;
  View view = View::both;
  std::string title;  ///< above it, or empty
};

struct FigureOptions {
  Camera camera;  ///< the same for all panels, and for all frames of a movie
  int width = 1280, height = 720;
  Finish finish = Finish::fine;
  Paper paper = {};
  bool axes = false;  ///< the scene's axes in a corner of the first panel
};

/// The caption is that of the first panel's snapshot, the color scale that of its painter: all
/// panels share it. Throws bad input without panels, and as Painter::draw does.
Canvas figure(const std::vector<Panel>& panels, const FigureOptions& options);

/// What pictures are drawn on; nothing where `transparent`, with the ink of `paper`.
struct Backdrop {
  Paper paper;
  bool transparent = false;
};

/// What `draw` draws, without its background: it is drawn on white and on black.
Image without_background(const Color& ink, const std::function<Canvas(const Paper&)>& draw);

/// The files of a page.
struct PageFiles {
  Backdrop backdrop;
  double print_width = 0;  ///< mm: the page is written as SVG, too; 0: it is not
};

/// Writes the page that `draw` draws on that background to `path`, which ends with .png; twice
/// drawn for a transparent one, which has to be cut out. Throws not written.
void write_page(const std::function<Canvas(const Paper&)>& draw, const PageFiles& files,
                const std::string& path);

// A contact sheet: a run in one picture, moments from left to right, views below each other.

/// One row: the same moments as in the other rows, in one view.
struct SheetRow {
  Painter* painter = nullptr;
  const std::vector<Snapshot>* snapshots = nullptr;
  View view = View::both;
  std::string title;  ///< above it, or empty
};

struct SheetOptions {
  Mat3 view = three_quarter_view();
  int width = 1600;      ///< at most, pixels
  int row_height = 560;  ///< at most, pixels
  Finish finish = Finish::fine;
  Paper paper = {};
  bool axes = false;           ///< the scene's axes in the corner below the panels
  std::string title = {};      ///< above everything, or empty
  bool rulers = false;         ///< a scale bar, and a key of the bones' axes and of forces in color
  double strongest_force = 0;  ///< force of the longest arrow of a support or a load, N
};

/// All panels to one scale; below them the captions of the first row's snapshots and the color
/// scale of its painter. Throws bad input without rows or snapshots, for rows of different lengths,
/// and as Painter::draw does.
Canvas contact_sheet(const std::vector<SheetRow>& rows, const SheetOptions& options);

/// Follows the paper's figure 4: the surface above, the particles below, over time.
std::vector<SheetRow> surface_above_particles(Painter& painter,
                                              const std::vector<Snapshot>& snapshots);

}  // namespace sinew
