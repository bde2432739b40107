// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/plate.h"

#include <algorithm>

#include "core/error.h"
#include "render/text.h"

namespace sinew {
namespace {

struct Layout {
  TextStyle words;
  int margin = 0;
  int top = 0;             ///< of the panels
  int wide = 0, high = 0;  ///< each panel
  int foot = 0;            ///< where caption and colours begin
};

Layout layout_of(const std::vector<Panel>& panels, const PlateOptions& options) {
  Layout layout;
  const int count = static_cast<int>(panels.size());
  layout.words.size = std::max(11, options.height / 32);
  layout.margin = options.height / 30;
  const bool titled = std::any_of(panels.begin(), panels.end(),
                                  [](const Panel& panel) { return !panel.title.empty(); });
  layout.top = layout.margin + (titled ? line_height(layout.words) : 0);
  layout.foot = options.height - colour_bar_height(layout.words) - layout.margin;
  layout.wide = (options.width - (count + 1) * layout.margin) / count;
  layout.high = layout.foot - layout.margin - layout.top;
  return layout;
}

}  // namespace

Image plate(const std::vector<Panel>& panels, const PlateOptions& options) {
  if (panels.empty()) throw bad_input("a plate needs panels", "give at least one");
  const Layout layout = layout_of(panels, options);
  Image image(options.width, options.height);
  int x = layout.margin;
  for (const Panel& panel : panels) {
    const PictureOptions picture{panel.view, options.camera, layout.wide, layout.high,
                                 4,          options.finish};
    paste(image, panel.painter->draw(*panel.shot, picture), x, layout.top);
    TextStyle title = layout.words;
    title.align = Align::centre;
    write_text(image, panel.title, x + layout.wide / 2, layout.margin / 2, title);
    x += layout.wide + layout.margin;
  }
  write_text(image, panels.front().shot->caption, 2 * layout.margin, layout.foot, layout.words);
  if (std::none_of(panels.begin(), panels.end(),
                   [](const Panel& panel) { return shows_values(panel.view); }))
    return image;
  const int bar = std::min(options.width / 3, 3 * options.height / 5);
  draw_colour_bar(image, panels.front().painter->scale(), options.width - 2 * layout.margin - bar,
                  layout.foot, bar, layout.words);
  return image;
}

}  // namespace sinew
