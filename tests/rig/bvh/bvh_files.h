// SPDX-License-Identifier: GPL-3.0-or-later
// BVH files for tests: a small one to vary and to break, two-joint ones, and a long one.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

namespace sinew::bvh_files {

/// Three joints whose orders differ, one of them with positions between its rotations; 3 frames.
inline const std::string small =
    "HIERARCHY\n"
    "ROOT hip\n"
    "{\n"
    "  OFFSET 0.0 1.5 0.25\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT knee\n"
    "  {\n"
    "    OFFSET 0.0 -0.5 0.0\n"
    "    CHANNELS 3 Yrotation Xrotation Zrotation\n"
    "    JOINT foot\n"
    "    {\n"
    "      OFFSET 0.0 -0.5 0.125\n"
    "      CHANNELS 4 Xrotation Yposition Zrotation Yrotation\n"
    "      End Site\n"
    "      {\n"
    "        OFFSET 0.0 0.0 0.25\n"
    "      }\n"
    "    }\n"
    "  }\n"
    "}\n"
    "MOTION\n"
    "Frames: 3\n"
    "Frame Time: 0.125\n"
    "0.0 1.5 0.25 1.0 2.0 3.0 4.0 5.0 6.0 7.0 -0.5 8.0 9.0\n"
    "0.5 1.5 0.25 11.0 12.0 13.0 14.0 15.0 16.0 17.0 -0.25 18.0 19.0\n"
    "1.0 1.5 0.25 21.0 22.0 23.0 24.0 25.0 26.0 27.0 -0.5 28.0 29.0\n";

/// `text` with each `from` as `to`.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// An arm along y: shoulder at the origin, elbow at 1, hand at 2 (an End Site).
inline std::string arm(const std::string& shoulder_channels, const std::string& elbow_channels,
                       const std::string& motion) {
  std::string text = "HIERARCHY\nROOT shoulder\n{\nOFFSET 0 0 0\n";
  text += shoulder_channels + "\nJOINT elbow\n{\nOFFSET 0 1 0\n" + elbow_channels;
  text += "\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n}\n";
  return text + motion;
}

/// A chain of joints that all turn, the first one moving as well.
inline std::string long_clip(int joints, int frames) {
  std::string text = "HIERARCHY\n", end = "End Site\n{\nOFFSET 0 0.1 0\n}\n";
  for (int i = 0; i < joints; ++i) {
    text += (i == 0 ? "ROOT" : "JOINT") + std::string(" joint");
    text += std::to_string(i) + "\n{\nOFFSET 0 0.1 0\nCHANNELS ";
    text += i == 0 ? "6 Xposition Yposition Zposition " : "3 ";
    text += "Zrotation Xrotation Yrotation\n";
    end += "}\n";
  }
  text += end + "MOTION\nFrames: " + std::to_string(frames) + "\nFrame Time: 0.0083333\n";
  for (int frame = 0; frame < frames; ++frame)
    for (int i = 0; i < 3 * joints + 3; ++i)
      text += std::to_string(90 * std::sin(0.01 * frame + i)) + (i < 3 * joints + 2 ? " " : "\n");
  return text;
}

}  // namespace sinew::bvh_files
