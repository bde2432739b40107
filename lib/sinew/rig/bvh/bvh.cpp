// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/bvh/bvh.h>

#include <algorithm>
#include <array>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/rig/bvh/detail/text.h>

namespace sinew {
namespace {

constexpr std::string_view first_word = "HIERARCHY";
// Rigs of films have a few thousand joints, ropes and tails some hundred in a chain. Each joint
// multiplies its parent's transformation, in each frame; beyond these a file is damaged or hostile.
constexpr std::size_t max_joints = 10'000;
constexpr std::size_t deepest = 200;

constexpr std::array<std::string_view, 6> channel_names = {"Xposition", "Yposition", "Zposition",
                                                           "Xrotation", "Yrotation", "Zrotation"};

/// Reads the joints; the open ones are a stack, not recursive calls.
class Hierarchy {
 public:
  explicit Hierarchy(BvhText& text) : text_(text) {}

  std::vector<BvhJoint> read() {
    text_.expect(first_word, "name a BVH file, which begins with HIERARCHY");
    while (!open_.empty() || begins_root()) read_item();
    return std::move(joints_);
  }

 private:
  struct Open {
    int joint;
    std::size_t position;  // position of its keyword
    bool has_offset = false, has_channels = false, has_children = false;
  };

  /// Opens the next root; false where the hierarchy is over.
  bool begins_root() {
    if (text_.take("ROOT")) {
      open_joint();
      return true;
    }
    if (!joints_.empty()) return false;
    text_.expect("ROOT", "begin the skeleton with ROOT name");
    return false;
  }

  void read_item() {
    if (text_.take("OFFSET")) return read_offset();
    if (text_.take("CHANNELS")) return read_channels();
    if (text_.take("JOINT")) return open_joint();
    if (text_.take("End")) return read_end();
    if (text_.take("}")) return close_joint();
    refuse_item(text_.next());
  }

  void open_joint() {
    const std::size_t position = text_.position();
    if (open_.size() == deepest)
      throw text_.wrong("more than 200 joints nested in each other", "check the braces");
    if (joints_.size() == max_joints)
      throw text_.wrong("more than 10000 joints", "leave out what does not move");
    BvhJoint joint;
    if (!open_.empty()) {
      joint.parent = open_.back().joint;
      open_.back().has_children = true;
    }
    joint.name = text_.name();
    text_.expect("{", "open the joint with '{'");
    open_.push_back({static_cast<int>(joints_.size()), position});
    joints_.push_back(std::move(joint));
  }

  void close_joint() {
    if (!open_.back().has_offset)
      throw text_.wrong("joint " + shown(joint().name) + " has no OFFSET",
                        "give it one; OFFSET 0 0 0 puts it at its parent");
    open_.pop_back();
  }

  void read_offset() {
    if (open_.back().has_offset)
      throw text_.wrong("joint " + shown(joint().name) + " has two OFFSETs", "remove one");
    joint().offset = vector();
    open_.back().has_offset = true;
  }

  void read_channels() {
    Open& open = open_.back();
    if (open.has_channels)
      throw text_.wrong("joint " + shown(joint().name) + " has CHANNELS twice", "remove one");
    if (open.has_children)  // otherwise the order of their values would be ambiguous
      throw text_.wrong("CHANNELS after a joint within this one", "put them before it");
    open.has_channels = true;
    const std::int64_t count = text_.integer("the number of channels");
    if (count < 0 || count > 6)
      throw text_.wrong("a joint with " + std::to_string(count) + " channels",
                        "give it at most 3 positions and 3 rotations");
    for (int i = 0; i < count; ++i) read_channel();
    if (channel_of(text_.peek()) < channel_names.size()) {
      text_.next();
      throw text_.wrong("more channels than the " + std::to_string(count) + " announced",
                        "correct their number");
    }
  }

  void read_channel() {
    const std::string_view word = text_.next();
    const std::size_t index = channel_of(word);
    if (index == channel_names.size())
      throw text_.wrong(shown(word) + " is not a channel", suggestion(word, channel_names));
    const auto channel = static_cast<BvhChannel>(index);
    auto& channels = joint().channels;
    if (std::find(channels.begin(), channels.end(), channel) != channels.end())
      throw text_.wrong(
          "joint " + shown(joint().name) + " has the channel " + shown(word) + " twice",
          "name three different axes");
    channels.push_back(channel);
  }

  static std::size_t channel_of(std::string_view word) {
    std::size_t index = 0;
    while (index < channel_names.size() && !same_word(word, channel_names[index])) ++index;
    return index;
  }

  void read_end() {
    text_.expect("Site", "write End Site");
    text_.name();
    text_.expect("{", "open the End Site with '{'");
    text_.expect("OFFSET", "give the End Site its OFFSET, and nothing else");
    const Vec3 end = vector();
    if (text_.take("CHANNELS") && text_.integer("the number of channels") != 0)
      throw text_.wrong("an End Site with channels", "make it a JOINT, or take them out");
    text_.expect("}", "close the End Site with '}'");
    if (!joint().end) joint().end = end;
  }

  [[noreturn]] void refuse_item(std::string_view word) const {
    constexpr std::array<std::string_view, 4> items = {"OFFSET", "CHANNELS", "JOINT", "End Site"};
    const std::string& name = joints_[static_cast<std::size_t>(open_.back().joint)].name;
    if (word.empty())
      throw text_.wrong("the file ends within joint " + shown(name) + ", opened in line " +
                            std::to_string(text_.place(open_.back().position).line),
                        "close it with '}', or export the file again");
    if (same_word(word, "ROOT"))
      throw text_.wrong("a ROOT within joint " + shown(name),
                        "use JOINT, or close the joint first");
    throw text_.wrong(shown(word) + " is no part of a joint", suggestion(word, items));
  }

  Vec3 vector() {
    Vec3 vector;
    for (double& value : vector) value = text_.number("an offset");
    return vector;
  }

  BvhJoint& joint() { return joints_[static_cast<std::size_t>(open_.back().joint)]; }

  BvhText& text_;
  std::vector<BvhJoint> joints_;
  std::vector<Open> open_;
};

// Room for as many keys as a rig takes (rig.cpp), of twelve characters each.
constexpr std::uint64_t max_bytes = 256 << 20, enough_for_its_first_word = 4096;
constexpr double shortest_frame = 1e-9, longest_frame = 1e6;  // s

int read_frame_count(BvhText& text, std::size_t channels) {
  text.expect("Frames", "give the number of frames: Frames: COUNT");
  text.expect(":", "give the number of frames: Frames: COUNT");
  const std::int64_t frames = text.integer("the number of frames");
  if (frames < 1)
    throw text.wrong("a clip of " + std::to_string(frames) + " frames",
                     "give it at least one, or leave out MOTION");
  // Each value takes a digit and a space, except the last. A file that is cut has fewer.
  constexpr std::uint64_t cut = 10;
  const std::uint64_t room = cut * (text.rest().size() + 1) / 2;
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

/// In a file with one frame per line, the first line with more or fewer values: where the count
/// went wrong, long before the end of the file.
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

/// Where the file ends between two frames, with fewer of them than announced: reads what is there.
/// Refuses a file that ends within a frame, or before the first.
void end_early(BvhText& text, Bvh& bvh, std::string_view frames) {
  const std::size_t channels = std::max<std::size_t>(bvh.channels(), 1);
  const std::size_t count = bvh.values.size(), whole = count / channels;
  if (whole > 0 && count % channels == 0) {
    bvh.warnings.push_back(text.place_of(text.rest()).text() + ": the file ends after " +
                           std::to_string(whole) + " of the " + std::to_string(bvh.frames) +
                           " frames that are announced; these are read");
    bvh.frames = static_cast<int>(whole);
    return;
  }
  text.next();
  refuse_odd_line(text, bvh, frames);
  throw text.wrong("the file ends in frame " + std::to_string(whole) + " (of 0 to " +
                       std::to_string(bvh.frames - 1) + "), after " +
                       std::to_string(count % channels) + " of its " + std::to_string(channels) +
                       " values",
                   "correct the number of frames, or export the file again");
}

/// Many files announce the number of their last frame, counted from 0.
void warn_of_one_more(const BvhText& text, Bvh& bvh) {
  bvh.warnings.push_back(text.place_of(text.rest()).text() + ": one frame more than the " +
                         std::to_string(bvh.frames) + " that are announced; it is read as well");
  ++bvh.frames;
}

void refuse_rest(BvhText& text, const Bvh& bvh, std::string_view frames) {
  const std::size_t channels = bvh.channels(), more = words_in(text.rest());
  text.next();
  refuse_odd_line(text, bvh, frames);
  throw text.wrong("after the last of " + std::to_string(bvh.frames) + " frames there are " +
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
  const std::size_t count = static_cast<std::size_t>(bvh.frames) * channels;
  bvh.values.reserve(std::min(count, frames.size() / 2 + 1));
  const auto read_until = [&](std::size_t size) {
    while (bvh.values.size() < size) {
      if (text.at_end()) return end_early(text, bvh, frames);
      bvh.values.push_back(text.number("a value of a frame"));
    }
  };
  read_until(count);
  if (text.at_end()) return;
  if (words_in(text.rest()) != channels) refuse_rest(text, bvh, frames);
  warn_of_one_more(text, bvh);
  read_until(count + channels);
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
  bvh.joints = Hierarchy(words).read();
  if (!words.at_end()) read_motion(words, bvh);
  return bvh;
}

Bvh read_bvh(const std::filesystem::path& path) {
  const std::string head = read_head(path, enough_for_its_first_word);
  if (!same_word(BvhText("", head).next(), first_word)) return parse_bvh(head, path.string());
  return parse_bvh(read_file(path, max_bytes), path.string());
}

}  // namespace sinew
