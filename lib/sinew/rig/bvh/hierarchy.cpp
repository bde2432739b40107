// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/rig/bvh/hierarchy.h>

#include <algorithm>
#include <array>

#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr std::size_t most_joints = 10'000;
constexpr std::size_t deepest = 200;

constexpr std::array<std::string_view, 6> channel_names = {"Xposition", "Yposition", "Zposition",
                                                           "Xrotation", "Yrotation", "Zrotation"};

/// Reads the joints, each as it opens and closes; the open ones are a stack, not calls.
class Hierarchy {
 public:
  explicit Hierarchy(BvhText& text) : text_(text) {}

  std::vector<BvhJoint> read() {
    text_.expect("HIERARCHY", "name a BVH file, which begins with HIERARCHY");
    while (!open_.empty() || begins_root()) read_item();
    return std::move(joints_);
  }

 private:
  struct Open {
    int joint;
    std::size_t position;  // of its keyword
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
      throw text_.wrong("more than 200 joints in each other", "check the braces");
    if (joints_.size() == most_joints)
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
    if (open.has_children)  // in which order would their values stand?
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
    const std::string& name = joints_[open_.back().joint].name;
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

  BvhJoint& joint() { return joints_[open_.back().joint]; }

  BvhText& text_;
  std::vector<BvhJoint> joints_;
  std::vector<Open> open_;
};

}  // namespace

std::vector<BvhJoint> read_hierarchy(BvhText& text) { return Hierarchy(text).read(); }

}  // namespace sinew
