// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/bvh/bvh.h>

#include <algorithm>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/rig/bvh/hierarchy.h>

namespace sinew {
namespace {

constexpr std::uint64_t most_bytes = 256 << 20;
constexpr double shortest_frame = 1e-9, longest_frame = 1e6;  // s

int read_frame_count(BvhText& text, std::size_t channels) {
  text.expect("Frames", "give the number of frames: Frames: COUNT");
  text.expect(":", "give the number of frames: Frames: COUNT");
  const std::int64_t frames = text.integer("the number of frames");
  if (frames < 1)
    throw text.wrong("a clip of " + std::to_string(frames) + " frames",
                     "give it at least one, or leave out MOTION");
  // Each value takes a digit and a space, but for the last.
  const std::uint64_t room = (text.rest().size() + 1) / 2;
  if (static_cast<std::uint64_t>(frames) > room / channels)
    throw text.wrong(std::to_string(frames) + " frames of " + std::to_string(channels) +
                         " values do not fit into the " + std::to_string(text.rest().size()) +
                         " bytes that follow",
                     "correct the number, or export the file again");
  return static_cast<int>(frames);
}

double read_frame_time(BvhText& text) {
  const char* cure = "give the time between frames: Frame Time: SECONDS";
  for (const char* word : {"Frame", "Time", ":"}) text.expect(word, cure);
  const double time = text.number("the frame time");
  if (!(time >= shortest_frame && time <= longest_frame))
    throw text.wrong("a frame time of " + number_text(time) + " s",
                     "give one between 1e-9 and 1e6 s: 1/30 s is 0.0333333");
  return time;
}

std::size_t words_in(std::string_view line) {
  BvhText words("", line);
  std::size_t count = 0;
  while (!words.next().empty()) ++count;
  return count;
}

/// In a file with one frame per line, the first line that holds more or fewer values: the place
/// where the count went wrong, long before it is noticed.
void refuse_odd_line(const BvhText& text, const Bvh& bvh, std::string_view frames) {
  const std::size_t channels = bvh.channels();
  for (int frame = 0; frame < bvh.frames && !frames.empty();) {
    const std::string_view line = frames.substr(0, frames.find_first_of("\r\n"));
    const std::size_t count = words_in(line);
    if (frame == 0 && count > 0 && count != channels) return;
    if (count > 0 && count != channels)
      throw bad_input(text.place_of(line),
                      "frame " + std::to_string(frame) + " has " + std::to_string(count) +
                          " values, and the joints have " + std::to_string(channels) + " channels",
                      "complete the frame, or export the file again");
    frame += count > 0;
    frames.remove_prefix(std::min(line.size() + 1, frames.size()));
  }
}

void refuse_end(BvhText& text, const Bvh& bvh, std::string_view frames) {
  const std::size_t channels = bvh.channels(), count = bvh.values.size();
  text.next();
  refuse_odd_line(text, bvh, frames);
  throw text.wrong("the file ends in frame " + std::to_string(count / channels) + " (of 0 to " +
                       std::to_string(bvh.frames - 1) + "), after " +
                       std::to_string(count % channels) + " of its " + std::to_string(channels) +
                       " values",
                   "correct the number of frames, or export the file again");
}

void refuse_rest(BvhText& text, const Bvh& bvh, std::string_view frames) {
  const std::size_t channels = bvh.channels(), more = words_in(text.rest());
  text.next();
  refuse_odd_line(text, bvh, frames);
  throw text.wrong("after the last of " + std::to_string(bvh.frames) + " frames stand " +
                       std::to_string(more) + " more words, where a frame has " +
                       std::to_string(channels) + " values",
                   "correct the number of frames, or export the file again");
}

void read_motion(BvhText& text, Bvh& bvh) {
  text.expect("MOTION", "close each '{' with one '}', and go on with MOTION or another ROOT");
  const std::size_t channels = bvh.channels();
  if (channels == 0)
    throw text.wrong("a MOTION, and no joint has channels", "give the root CHANNELS");
  bvh.frames = read_frame_count(text, channels);
  bvh.frame_time = read_frame_time(text);
  const std::string_view frames = text.rest();
  const std::size_t count = bvh.frames * channels;
  bvh.values.reserve(count);
  while (bvh.values.size() < count) {
    if (text.at_end()) refuse_end(text, bvh, frames);
    bvh.values.push_back(text.number("a value of a frame"));
  }
  if (!text.at_end()) refuse_rest(text, bvh, frames);
}

}  // namespace

std::size_t Bvh::channels() const {
  std::size_t count = 0;
  for (const BvhJoint& joint : joints) count += joint.channels.size();
  return count;
}

Bvh parse_bvh(std::string_view text, const std::string& file) {
  BvhText words(file, text);
  Bvh bvh;
  bvh.joints = read_hierarchy(words);
  if (!words.at_end()) read_motion(words, bvh);
  return bvh;
}

Bvh read_bvh(const std::filesystem::path& path) {
  return parse_bvh(read_file(path, most_bytes), path.string());
}

}  // namespace sinew
