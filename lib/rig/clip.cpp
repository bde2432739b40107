// SPDX-License-Identifier: GPL-3.0-or-later
#include "rig/clip.h"

#include <algorithm>

#include "core/error.h"
#include "core/words.h"

namespace sinew {

const Clip& find_clip(const std::vector<Clip>& clips, std::string_view name) {
  const auto found =
      std::find_if(clips.begin(), clips.end(), [&](const Clip& clip) { return clip.name == name; });
  if (found != clips.end()) return *found;
  std::vector<std::string_view> names;
  for (const Clip& clip : clips) names.push_back(clip.name);
  throw bad_input("there is no clip " + shown(name),
                  names.empty() ? "give a file with an animation" : suggestion(name, names));
}

}  // namespace sinew
