// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/checkpoint.h>

#include <array>
#include <cstring>
#include <string_view>

#include <sinew/core/archive.h>
#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/text.h>
#include <sinew/io/state_archive.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "SINEWCKP";
constexpr std::uint32_t byte_order_mark = 0x01020304;
constexpr std::uint32_t format_version = 11;
constexpr std::size_t name_size = 8, tail_size = sizeof(std::uint64_t);
constexpr const char* cure = "remove the file to go on without it";
// Twice, within a frame or an increment of a load. Bonds: 18 neighbors at rest, from both sides;
// branches of them; positions, velocities, order.
constexpr std::size_t max_before_count = 4096;  // bytes
constexpr std::uint64_t max_bytes_per_particle = 2560, max_bytes_beside = 1 << 20;

Error no_checkpoint(const std::string& what) { return bad_input(what, cure); }

}  // namespace

// Members in the order of the file, for core/archive.h.

template <class Archive>
void serialize(Archive& archive, RunIdentity& run) {
  archive(run.scene);
  archive(run.body);
  archive(run.motion);
  archive(run.particles);
  archive(run.time_step);
}

template <class Archive>
void serialize(Archive& archive, Checkpoint& checkpoint) {
  archive(checkpoint.run);
  archive(checkpoint.number);
  archive(checkpoint.state);
  auto& begun = checkpoint.state.begun;
  bool has_begun = begun != nullptr;
  archive(has_begun);
  if (!has_begun) return;
  if (begun) return archive(*std::const_pointer_cast<SimulationState>(begun));  // is written
  const auto read = std::make_shared<SimulationState>();
  archive(*read);
  begun = read;
}

namespace {

/// A file that is written in pieces, with the checksum of all bytes.
class HashedFile {
 public:
  explicit HashedFile(NewFile& file) : file_(file) {}

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
  static constexpr std::size_t max_pending = 1 << 16;

  NewFile& file_;
  std::string pending_;
  Hash hash_;
};

/// What all versions begin with.
struct Head {
  std::uint32_t mark = byte_order_mark, version = format_version;
  std::uint64_t length = 0;  ///< length of the file, bytes
  std::string program;
};

/// Bytes of the head of a file by that program.
std::string head_bytes(const Head& head) {
  std::string bytes(magic);
  const auto add = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(head.mark), add(head.version), add(head.length);
  bytes.append("program", name_size);
  add(std::uint64_t{1}), add(std::uint64_t{head.program.size()});
  return bytes + head.program;
}

/// Reads the head, and takes it off; nothing where these bytes do not begin with one.
std::optional<Head> head_of(std::string_view& bytes) {
  Head head;
  if (bytes.substr(0, magic.size()) != magic) return {};
  std::string_view rest = bytes.substr(magic.size());
  const auto take = [&](auto& value) {
    if (rest.size() < sizeof value) return false;
    std::memcpy(&value, rest.data(), sizeof value);
    rest.remove_prefix(sizeof value);
    return true;
  };
  std::array<char, name_size> name = {};
  std::uint64_t width = 0, count = 0;
  if (!take(head.mark) || !take(head.version) || !take(head.length) || !take(name) ||
      !take(width) || !take(count) || count > rest.size())
    return {};
  head.program = rest.substr(0, count);
  bytes = rest.substr(count);
  return head;
}

std::uint64_t hash_of(std::string_view bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

/// The archive in a complete file; takes its head off.
std::string_view checked(std::string_view text, Head& head) {
  std::string_view body = text;
  const auto found = head_of(body);
  if (!found) throw no_checkpoint("it is not a checkpoint");
  head = *found;
  if (head.mark != byte_order_mark)
    throw no_checkpoint("it is of a machine with another byte order");
  if (head.version != format_version)
    throw bad_input("its format is of version " + std::to_string(head.version) + ", not " +
                        std::to_string(format_version) + ": it was written by sinew " +
                        shown(head.program),
                    "go on with that sinew, or begin again with --force");
  if (head.length != text.size() || body.size() < tail_size)
    throw no_checkpoint("it is truncated or too long: it has " + std::to_string(text.size()) +
                        " bytes");
  std::uint64_t hash = 0;
  std::memcpy(&hash, text.data() + text.size() - tail_size, tail_size);
  if (hash != hash_of(text.substr(0, text.size() - tail_size)))
    throw no_checkpoint("its checksum is wrong");
  return body.substr(0, body.size() - tail_size);
}

/// The settings are the same, so the mesh is another.
void check_count(std::uint64_t found, std::uint64_t particles) {
  if (found != particles)
    throw bad_input("the run has " + std::to_string(found) + " particles, the scene's body now " +
                        std::to_string(particles) + ": its mesh or its filling has changed",
                    "restore it, replace the run with --force, or choose another folder with -o");
}

Checkpoint parsed(std::string_view text, std::uint64_t particles) {
  Head head;
  ArchiveReader reader(checked(text, head), cure);
  Checkpoint checkpoint;
  reader(checkpoint);
  if (!reader.done()) throw no_checkpoint("it continues after its end");
  checkpoint.run.program = std::move(head.program);
  check_count(checkpoint.run.particles, particles);
  return checkpoint;
}

/// Before the file is read, whose largest size depends on the count. Other files are told apart
/// later.
void check_count_in(std::string_view bytes, std::uint64_t particles) {
  const auto head = head_of(bytes);
  if (!head || head->mark != byte_order_mark || head->version != format_version) return;
  RunIdentity run;
  ArchiveReader reader(bytes, cure);
  reader(run);
  check_count(run.particles, particles);
}

}  // namespace

void write_checkpoint(const fs::path& path, const Checkpoint& checkpoint) {
  std::uint64_t size = 0;
  ArchiveWriter([&](const void*, std::size_t count) { size += count; })(checkpoint);
  Head head{.program = checkpoint.run.program};
  head.length = head_bytes(head).size() + size + tail_size;
  NewFile file(path);
  HashedFile out(file);
  const std::string begin = head_bytes(head);
  out.put(begin.data(), begin.size());
  ArchiveWriter([&](const void* bytes, std::size_t count) { out.put(bytes, count); })(checkpoint);
  const std::uint64_t hash = out.hash();
  out.put(&hash, sizeof hash);
  out.flush();
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

fs::path file_of(const fs::path& folder, int which) {
  return folder / (which == 0 ? "a.bin" : "b.bin");
}

}  // namespace

void Checkpoints::write(Checkpoint checkpoint) {
  create_inner_folder(folder_);
  // The earlier frames must be on disk before the checkpoint is.
  sync_all(folder_);
  checkpoint.number = ++written_;
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
      if (newest && newest->number >= found.number) continue;
      newest = std::move(found);
      written_ = newest->number;
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
