// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/clips.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/gltf/detail/accessors.h>
#include <sinew/io/gltf/detail/joint_motion.h>

namespace sinew {
namespace {

constexpr double same_length = 0.01;  // fraction of a frame's or a clip's time

/// A small file can refer to the same numbers many thousand times.
void check_size(const GltfDocument& document, std::size_t nodes) {
  constexpr double key = 100, node = 1000;  // bytes
  constexpr double max_visits = 1e8;        // visits of nodes, about 10 s
  constexpr std::size_t max_animations = 10000;
  double bytes = node * static_cast<double>(nodes), keys = 0;
  for (const GltfAnimation& animation : document.animations)
    for (const GltfChannel& channel : animation.channels) {
      const GltfSampler& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
      keys +=
          static_cast<double>(document.accessors[static_cast<std::size_t>(sampler.values)].count);
    }
  bytes += key * keys;
  const double visits =
      static_cast<double>(nodes) * static_cast<double>(document.animations.size());
  if (bytes > available_memory() || visits > max_visits ||
      document.animations.size() > max_animations)
    throw bad_input("its " + std::to_string(document.animations.size()) + " animations of " +
                        std::to_string(nodes) + " nodes hold " +
                        std::to_string(static_cast<std::int64_t>(keys)) + " keys, too many",
                    "export fewer of them");
}

/// Sets the clip's frames where its keys are evenly spaced.
void count_frames(const std::vector<double>& times, Clip& clip) {
  constexpr double uneven = 0.01;  // fraction of a frame; times are in single precision
  if (times.size() < 2) return;
  const double first = times.front(), count = static_cast<double>(times.size());
  const double frame = (times.back() - first) / (count - 1);
  for (std::size_t i = 0; i < times.size(); ++i)
    if (std::abs(times[i] - first - frame * static_cast<double>(i)) > uneven * frame) return;
  clip.frames = static_cast<int>(times.size());
  clip.frame_time = frame;
}

std::string free_name(const std::string& name, std::size_t index, std::set<std::string>& taken) {
  const std::string wanted = name.empty() ? "animation_" + std::to_string(index) : name;
  std::string free = wanted;
  for (int i = 2; !taken.insert(free).second; ++i) {
    free = wanted;
    free += '_' + std::to_string(i);
  }
  return free;
}

Clip clip_of(const GltfNodeMotion& nodes, const CheckedGltf& gltf, const GltfBindPose& bind,
             double rate) {
  Clip clip;
  clip.motion = joint_motion(bind, gltf.tree, nodes, rate);
  if (!nodes.times.empty()) clip.duration = nodes.times.back() - nodes.times.front();
  count_frames(nodes.times, clip);
  return clip;
}

/// Calls make(i) for each animation, and names what it makes.
template <class Make>
std::vector<Clip> named_clips(const std::vector<GltfAnimation>& animations, const Make& make) {
  std::vector<Clip> clips;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    try {
      clips.push_back(make(i));
    } catch (const Error& error) {
      throw error.with_context(
          {"animation " + std::to_string(i) + ' ' + shown(animations[i].name)});
    }
    clips.back().name = free_name(animations[i].name, i, taken);
  }
  return clips;
}

/// The time of an animation's last key, s.
double end_of(const CheckedGltf& gltf, const GltfAnimation& animation) {
  double end = 0;
  for (const GltfSampler& sampler : animation.samplers)
    end = std::max(end, gltf_numbers(gltf, sampler.times).back());
  return end;
}

std::set<int> nodes_of(const GltfAnimation& animation) {
  std::set<int> nodes;
  for (const GltfChannel& channel : animation.channels) nodes.insert(channel.node);
  return nodes;
}

void append(const GltfAnimation& more, GltfAnimation& all) {
  const int samplers = static_cast<int>(all.samplers.size());
  all.samplers.insert(all.samplers.end(), more.samplers.begin(), more.samplers.end());
  for (GltfChannel channel : more.channels) {
    channel.sampler += samplers;
    all.channels.push_back(channel);
  }
}

/// The clips of another file on the nodes of a skeleton.
class Borrowing {
 public:
  Borrowing(const CheckedGltf& from, const CheckedGltf& gltf, const GltfBindPose& bind)
      : from_(from), gltf_(gltf), bind_(bind), top_(gltf.document.nodes.size()) {
    for (std::size_t i = 0; i < gltf.document.nodes.size(); ++i)
      if (const auto& name = gltf.document.nodes[i].name; !name.empty())
        node_of_name_.try_emplace(name, i);
    for (const GltfJoint& joint : bind.joints) {  // rather than other nodes of their name
      const auto node = static_cast<std::size_t>(joint.node);
      node_of_name_[gltf.document.nodes[node].name] = node;
      top_[node] = joint.parent < 0;
    }
  }

  GltfNodeMotion motion(std::size_t animation) {
    GltfNodeMotion given = gltf_node_motion(from_, animation), own;
    for (const GltfNode& node : gltf_.document.nodes) own.places.push_back(place_of(node));
    own.curves.resize(own.places.size());
    own.times = given.times;
    for (const GltfChannel& channel : from_.document.animations[animation].channels) {
      const auto source = static_cast<std::size_t>(channel.node);
      const std::string& name = from_.document.nodes[source].name;
      const auto found = node_of_name_.find(name);
      if (found == node_of_name_.end()) {
        lacking_.insert(name);
        continue;
      }
      moved_.insert(found->second);
      put(channel.path, given.places[source], given.curves[source], found->second, own);
    }
    return own;
  }

  /// Throws bad input where no joint is moved.
  std::vector<std::string> warnings() const {
    std::vector<std::string> still;
    for (const GltfJoint& joint : bind_.joints)
      if (!moved_.contains(static_cast<std::size_t>(joint.node)))
        still.push_back(gltf_.document.nodes[static_cast<std::size_t>(joint.node)].name);
    const std::vector<std::string> lacking(lacking_.begin(), lacking_.end());
    if (still.size() == bind_.joints.size())
      throw bad_input("it moves no joint of the skeleton, but " + some_shown(lacking),
                      "name nodes as the skeleton does: " +
                          shown(still.empty() ? std::string() : still.front()));
    std::vector<std::string> warnings;
    if (!lacking.empty())
      warnings.push_back("moves " + std::to_string(lacking.size()) +
                         (lacking.size() == 1 ? " node" : " nodes") +
                         " that the skeleton lacks: " + some_shown(lacking));
    if (!still.empty())
      warnings.push_back("does not move " + std::to_string(still.size()) + " of " +
                         std::to_string(bind_.joints.size()) + " joints: " + some_shown(still));
    return warnings;
  }

 private:
  void put(GltfPath path, const GltfPlace& place, const GltfNodeCurves& curves, std::size_t node,
           GltfNodeMotion& own) const {
    GltfPlace& to = own.places[node];
    if (to.whole) {
      to.rotation = Quat(nearest_rotation(to.linear));
      to.scale = to.linear.colwise().norm();
      to.whole = false;
    }
    if (path == GltfPath::rotation)
      own.curves[node].rotation = curves.rotation, to.rotation = place.rotation;
    else if (path == GltfPath::scale)
      own.curves[node].scale = curves.scale;
    else if (top_[node] || changes(curves.translation, to.translation.norm()))
      own.curves[node].translation = curves.translation;
  }

  static bool changes(const Curve<Vec3>& curve, double length) {
    constexpr double noise = 0.01;
    return std::any_of(curve.values.begin(), curve.values.end(), [&](const Vec3& value) {
      return (value - curve.values.front()).norm() > noise * length;
    });
  }

  const CheckedGltf &from_, &gltf_;
  const GltfBindPose& bind_;
  std::map<std::string, std::size_t> node_of_name_;
  std::vector<bool> top_;  // whether each node is a topmost joint
  std::set<std::size_t> moved_;
  std::set<std::string> lacking_;
};

}  // namespace

void join_unnamed(CheckedGltf& gltf) {
  struct Joined {
    std::size_t place;
    double end;
    std::set<int> nodes;
  };
  std::vector<Joined> joined;
  std::vector<GltfAnimation> all;
  for (GltfAnimation& animation : gltf.document.animations) {
    if (animation.name.empty() && !animation.channels.empty()) {
      const double end = end_of(gltf, animation);
      std::set<int> nodes = nodes_of(animation);
      const auto apart = [&](const std::set<int>& others) {
        return std::none_of(nodes.begin(), nodes.end(),
                            [&](int node) { return others.contains(node); });
      };
      const auto found = std::find_if(joined.begin(), joined.end(), [&](const Joined& one) {
        return std::abs(one.end - end) <= same_length * end && apart(one.nodes);
      });
      if (found != joined.end()) {
        append(animation, all[found->place]);
        found->nodes.merge(nodes);
        continue;
      }
      joined.push_back({all.size(), end, std::move(nodes)});
    }
    all.push_back(std::move(animation));
  }
  gltf.document.animations = std::move(all);
}

std::vector<Clip> gltf_clips(const CheckedGltf& gltf, const GltfBindPose& bind, double rate) {
  check_size(gltf.document, gltf.document.nodes.size());
  return named_clips(gltf.document.animations, [&](std::size_t i) {
    return clip_of(gltf_node_motion(gltf, i), gltf, bind, rate);
  });
}

std::vector<Clip> gltf_clips_from(const CheckedGltf& from, const CheckedGltf& gltf,
                                  const GltfBindPose& bind, double rate,
                                  std::vector<std::string>& warnings) {
  check_size(from.document, from.document.nodes.size() + gltf.document.nodes.size());
  Borrowing borrowing(from, gltf, bind);
  std::vector<Clip> clips = named_clips(from.document.animations, [&](std::size_t i) {
    return clip_of(borrowing.motion(i), gltf, bind, rate);
  });
  if (clips.empty())
    throw bad_input("the file holds no motion", "name one that does in motion.file");
  warnings = borrowing.warnings();
  return clips;
}

}  // namespace sinew
