// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/checkpoint.h>

#include <cstring>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "SINEWCKP";
constexpr std::uint32_t byte_order_mark = 0x01020304;
constexpr std::uint32_t format_version = 10;
constexpr std::size_t name_size = 8;
// Twice, within a frame or an increment of a load. Bonds: 18 neighbors at rest, from both sides;
// branches of them; positions, velocities, order.
constexpr std::size_t max_before_count = 4096;  // bytes
constexpr std::uint64_t max_bytes_per_particle = 2560, max_bytes_beside = 1 << 20;

Error no_checkpoint(const std::string& what) {
  return bad_input(what, "remove the file to go on without it");
}

// Visit all values in the order of the file, for both the writer and the reader: archive(name,
// value or list of values).

template <class Relaxation, class Archive>
void serialize_relaxation(Archive& archive, Relaxation& relaxation) {
  archive("atrest", relaxation.at_rest);
  archive("iterate", relaxation.iterations);
  archive("spent", relaxation.spent);
  archive("incrmnts", relaxation.increments);
  archive("reached", relaxation.reached);
  archive("incrmnt", relaxation.increment);
  archive("shorter", relaxation.shortened);
  archive("damping", relaxation.damping);
  archive("pushed", relaxation.pushed);
  archive("largest", relaxation.largest);
  archive("applied", relaxation.applied);
  archive("unbal", relaxation.unbalanced);
  archive("best", relaxation.best);
  archive("bestat", relaxation.best_at);
  archive("newton", relaxation.newton);
  archive("negative", relaxation.negative);
  archive("unstable", relaxation.unstable);
}

template <class State, class Archive>
void serialize_guard(Archive& archive, State& state) {
  archive("divided", state.guard.divided);
  archive("divisor", state.guard.divisor);
  archive("lenient", state.guard.lenient);
  archive("residual", state.guard.residual);
  archive("turnover", state.guard.turnover);
  archive("limited", state.limited.in_frame);
  archive("limits", state.limited.times);
  archive("limitlos", state.limited.energy);
  archive("limitimp", state.limited.impulse);
}

template <class State, class Archive>
void serialize_state(Archive& archive, State& state) {
  archive("steps", state.steps);
  for (auto* ledger : {&state.ledger, &state.world_ledger}) serialize(archive, *ledger);
  archive("heldkin", state.held_at_start);
  archive("kicked", state.kicked);
  archive("length", state.fixed_point_units.length);
  archive("origin", state.fixed_point_units.origin);
  archive("boxlow", state.fixed_point_units.box.min());
  archive("boxhigh", state.fixed_point_units.box.max());
  archive("travel", state.fixed_point_units.traveled);
  archive("meansort", state.mean_when_sorted);
  archive("order", state.order);
  std::visit(
      [&](auto& moving) {
        for (auto& axis : moving.x) archive("position", axis);
        for (auto& axis : moving.v) archive("velocity", axis);
      },
      state.moving);
  archive("bonds", state.rest_length);
  archive("lanes", state.bonded_lanes);
  archive("creep", state.creep);
  archive("clocks", state.branch_clocks);
  archive("stretch", state.branch_stretches);
  serialize_relaxation(archive, state.relaxation);
  archive("slidpair", state.sliding_pairs);
  archive("sliding", state.sliding);
  archive("groups", state.groups);
  archive("grouping", state.grouping);
  archive("regroups", state.regrouping.times);
  archive("merging", state.regrouping.lost);
  archive("still", state.regrouping.still_since);
  archive("pressed", state.pressed);
  archive("pieces", state.pieces);
  archive("broken", state.broken_ends);
  serialize_guard(archive, state);
}

template <class State, class Archive>
void serialize_checkpoint(Archive& archive, State& checkpoint) {
  auto& run = checkpoint.run;
  archive("program", run.program);
  archive("scene", run.scene);
  archive("body", run.body);
  archive("motion", run.motion);
  archive("count", run.particles);
  archive("timestep", run.time_step);
  serialize_state(archive, checkpoint.state);
  auto& begun = checkpoint.state.begun;
  bool has_begun = begun != nullptr;
  archive("hasbegun", has_begun);
  if (!has_begun) return;
  SimulationState of_begin;
  if (begun)
    of_begin = *begun;
  else if (std::holds_alternative<MovingInSingle>(checkpoint.state.moving))
    of_begin.moving = MovingInSingle();
  serialize_state(archive, of_begin);
  if constexpr (!std::is_const_v<State>)
    begun = std::make_shared<const SimulationState>(std::move(of_begin));
}

template <class Value>
concept List = requires(Value value) {
  value.data();
  value.resize(std::size_t{});
};

class Writer {
 public:
  explicit Writer(NewFile& file) : file_(file) {}

  template <class Value>
  void operator()(std::string_view name, const Value& value) {
    if constexpr (std::is_same_v<Value, bool>)
      section(name, static_cast<std::uint32_t>(value));
    else
      section(name, value);
  }
  template <class Value>
  void put(const Value& value) {
    put(&value, sizeof value);
  }
  void put(const void* bytes, std::size_t count) {
    hash_.add(bytes, count);
    if (pending_.size() + count > max_pending) flush();
    if (count > max_pending)
      file_.write(bytes, count);
    else
      pending_.append(static_cast<const char*>(bytes), count);
  }
  void flush() {
    file_.write(pending_.data(), pending_.size());
    pending_.clear();
  }
  std::uint64_t hash() const { return hash_.value(); }

 private:
  template <class Value>
  void section(std::string_view name, const Value& value) {
    if constexpr (std::is_same_v<Value, Vec3>)
      elements(name, value.data(), 3);
    else if constexpr (List<Value>)
      elements(name, value.data(), value.size());
    else
      elements(name, &value, 1);
  }
  template <class Element>
  void elements(std::string_view name, const Element* first, std::size_t count) {
    char padded[name_size] = {};
    name.copy(padded, name_size);
    put(padded, name_size);
    put(std::uint64_t{sizeof(Element)});
    put(std::uint64_t{count});
    put(first, count * sizeof(Element));
  }

  static constexpr std::size_t max_pending = 1 << 16;

  NewFile& file_;
  std::string pending_;
  Hash hash_;
};

/// Size of all sections.
class Size {
 public:
  template <class Value>
  void operator()(std::string_view, const Value& value) {
    bytes_ += name_size + 16;
    if constexpr (std::is_same_v<Value, bool>)
      bytes_ += sizeof(std::uint32_t);
    else if constexpr (std::is_same_v<Value, Vec3>)
      bytes_ += sizeof(double) * 3;
    else if constexpr (List<Value>)
      bytes_ += value.size() * sizeof *value.data();
    else
      bytes_ += sizeof value;
  }
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::uint64_t bytes_ = 0;
};

constexpr std::size_t head_size = magic.size() + 2 * sizeof(std::uint32_t) + sizeof(std::uint64_t);
constexpr std::size_t tail_size = sizeof(std::uint64_t);

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  template <class Value>
  void operator()(std::string_view name, Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      std::uint32_t flag = 0;
      fill(name, &flag, 1);
      value = flag != 0;
    } else if constexpr (std::is_same_v<Value, Vec3>) {
      fill(name, value.data(), 3);
    } else if constexpr (List<Value>) {
      value.resize(head(name, sizeof *value.data()));
      take(value.data(), value.size() * sizeof *value.data());
    } else {
      fill(name, &value, 1);
    }
  }
  template <class Value>
  Value one() {
    Value value;
    take(&value, sizeof value);
    return value;
  }
  std::size_t left() const { return text_.size(); }
  /// The element size of the section after `skipped` others, or 0.
  std::uint64_t element_of(std::string_view name) const {
    Reader ahead = *this;
    while (ahead.left() > 0) {
      const std::string_view found = ahead.name();
      const auto size = ahead.one<std::uint64_t>(), count = ahead.one<std::uint64_t>();
      if (found == name) return size;
      ahead.drop(size, count);
    }
    return 0;
  }

 private:
  std::string_view name() {
    if (text_.size() < name_size) throw no_checkpoint("a section is truncated");
    const std::string_view padded = text_.substr(0, name_size);
    text_.remove_prefix(name_size);
    return padded.substr(0, std::min(padded.find('\0'), name_size));
  }
  void drop(std::uint64_t size, std::uint64_t count) {
    if (size == 0 || count > text_.size() / size) throw no_checkpoint("a section is truncated");
    text_.remove_prefix(size * count);
  }
  /// The elements of the section that begins here, which are present.
  std::size_t head(std::string_view expected, std::uint64_t size) {
    if (name() != expected)
      throw no_checkpoint("section '" + std::string(expected) + "' is missing");
    const auto found = one<std::uint64_t>(), count = one<std::uint64_t>();
    if (found != size || count > text_.size() / size)
      throw no_checkpoint("section '" + std::string(expected) + "' is truncated");
    return count;
  }
  template <class Element>
  void fill(std::string_view name, Element* to, std::size_t count) {
    if (head(name, sizeof(Element)) != count)
      throw no_checkpoint("section '" + std::string(name) + "' is truncated");
    take(to, count * sizeof(Element));
  }
  void take(void* to, std::size_t bytes) {
    if (bytes > text_.size()) throw no_checkpoint("it is truncated");
    if (bytes > 0) std::memcpy(to, text_.data(), bytes);
    text_.remove_prefix(bytes);
  }

  std::string_view text_;
};

std::uint64_t hash_of(std::string_view bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

Error of_another_format(std::uint32_t version, Reader sections) {
  std::string program;
  sections("program", program);
  return bad_input("its format is of version " + std::to_string(version) + ", not " +
                       std::to_string(format_version) + ": it was written by sinew " +
                       shown(program),
                   "go on with that sinew, or begin again with --force");
}

/// The sections of a complete file.
std::string_view checked(std::string_view text) {
  if (text.size() < head_size + tail_size || text.substr(0, magic.size()) != magic)
    throw no_checkpoint("it is not a checkpoint");
  Reader head(text.substr(magic.size(), head_size));
  if (head.one<std::uint32_t>() != byte_order_mark)
    throw no_checkpoint("it is of a machine with another byte order");
  const auto version = head.one<std::uint32_t>();
  if (version != format_version) throw of_another_format(version, Reader(text.substr(head_size)));
  if (head.one<std::uint64_t>() != text.size())
    throw no_checkpoint("it is truncated or too long: it has " + std::to_string(text.size()) +
                        " bytes");
  const std::string_view body = text.substr(0, text.size() - tail_size);
  if (Reader(text.substr(body.size())).one<std::uint64_t>() != hash_of(body))
    throw no_checkpoint("its checksum is wrong");
  return body.substr(head_size);
}

/// The settings are the same, so the mesh is another.
void check_count(std::uint64_t found, std::uint64_t particles) {
  if (found != particles)
    throw bad_input("the run has " + std::to_string(found) + " particles, the scene's body now " +
                        std::to_string(particles) + ": its mesh or its filling has changed",
                    "restore it, replace the run with --force, or choose another folder with -o");
}

Checkpoint parsed(std::string_view text, std::uint64_t particles) {
  Reader reader(checked(text));
  Checkpoint checkpoint;
  if (reader.element_of("position") == sizeof(std::int32_t))
    checkpoint.state.moving = MovingInSingle();
  serialize_checkpoint(reader, checkpoint);
  if (reader.left() > 0) throw no_checkpoint("it continues after its last section");
  check_count(checkpoint.run.particles, particles);
  return checkpoint;
}

/// Before the file is read, whose largest size depends on the count. Other files are told apart
/// later.
void check_count_in(std::string_view head, std::uint64_t particles) {
  if (head.size() < head_size || !head.starts_with(magic)) return;
  Reader reader(head.substr(magic.size()));
  const auto mark = reader.one<std::uint32_t>(), version = reader.one<std::uint32_t>();
  if (mark != byte_order_mark || version != format_version) return;
  [[maybe_unused]] const auto size = reader.one<std::uint64_t>();
  RunIdentity run;
  reader("program", run.program);
  reader("scene", run.scene);
  reader("body", run.body);
  reader("motion", run.motion);
  reader("count", run.particles);
  check_count(run.particles, particles);
}

}  // namespace

void write_checkpoint(const fs::path& path, const Checkpoint& checkpoint) {
  Size size;
  serialize_checkpoint(size, checkpoint);
  NewFile file(path);
  Writer writer(file);
  writer.put(magic.data(), magic.size());
  writer.put(byte_order_mark);
  writer.put(format_version);
  writer.put(head_size + size.bytes() + tail_size);
  serialize_checkpoint(writer, checkpoint);
  const std::uint64_t hash = writer.hash();
  writer.put(hash);
  writer.flush();
  file.finish(Durability::synced);
}

Checkpoint read_checkpoint(const fs::path& path, std::uint64_t particles) {
  try {
    check_count_in(read_head(path, max_before_count), particles);
    const std::string text = read_file(path, particles * max_bytes_per_particle + max_bytes_beside);
    return parsed(text, particles);
  } catch (const Error& error) {
    throw std::string_view(error.what()).starts_with(path.string())
        ? error
        : error.with_context({path.string()});
  }
}

namespace {

/// What grows as a run goes on. A relaxation may come to rest, or give an increment up, without a
/// step.
auto progress(const SimulationState& state) {
  return std::tuple(state.steps, state.relaxation.at_rest, state.relaxation.spent);
}

fs::path file_of(const fs::path& folder, int which) {
  return folder / (which == 0 ? "a.bin" : "b.bin");
}

}  // namespace

void Checkpoints::write(const Checkpoint& checkpoint) {
  create_inner_folder(folder_);
  // The earlier frames must be on disk before the checkpoint is.
  sync_all(folder_);
  write_checkpoint(file_of(folder_, next_), checkpoint);
  next_ = 1 - next_;
}

std::optional<Checkpoint> Checkpoints::newest(std::uint64_t particles, std::string& complaint) {
  std::optional<Checkpoint> newest;
  std::optional<Error> broken;
  for (const int which : {0, 1}) {
    std::error_code unreachable;
    fs::remove(folder_ / ('.' + file_of("", which).string() + ".tmp"), unreachable);
    if (!fs::exists(file_of(folder_, which), unreachable)) continue;
    try {
      Checkpoint found = read_checkpoint(file_of(folder_, which), particles);
      if (newest && progress(newest->state) >= progress(found.state)) continue;
      newest = std::move(found);
      next_ = 1 - which;
    } catch (const Error& error) {
      broken = error;
    }
  }
  if (broken && !newest) throw *broken;
  if (broken) complaint = broken->what();
  return newest;
}

}  // namespace sinew
