// SPDX-License-Identifier: GPL-3.0-or-later
// What is written comes back to the last bit; whatever is not a whole checkpoint is refused.
#include <sinew/io/checkpoint.h>

#include <cstring>
#include <random>

#include "support/expect_error.h"
#include "support/scratch.h"

namespace sinew::checkpoint_test {

constexpr std::uint64_t particles = 5;

template <class Columns>
Columns columns() {
  Columns made;
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint64_t k = 0; k < particles; ++k) {
      using Coord = typename std::decay_t<decltype(made.x[0])>::value_type;
      using Real = typename std::decay_t<decltype(made.v[0])>::value_type;
      made.x[axis].push_back(static_cast<Coord>(1000.0 * (axis + 1) / 3 + static_cast<double>(k)));
      made.v[axis].push_back(static_cast<Real>(-0.1 * (axis + 1) * static_cast<double>(k)));
    }
  return made;
}

Checkpoint sample(bool single = false) {
  Checkpoint sample;
  sample.run = {"1.2.3", 7, 8, 9, particles, 1e-4};
  SimulationState& state = sample.state;
  state.steps = 12345678901;
  state.kicked = true;
  state.fixed_point_units = {1e-9, {1, 2, 3}, Box(Vec3(-1, -2, -3), Vec3(1, 2, 3)), 0.7};
  state.order = {4, 3, 2, 1, 0};
  if (single)
    state.moving = columns<MovingInSingle>();
  else
    state.moving = columns<MovingInDouble>();
  put_column(state, "friction", "pairs", std::vector<std::int32_t>{0, 3, 3, 0});
  put_column(state, "friction", "stretches", std::vector<double>{0.1, 0.2, 0.3, -0.1, -0.2, -0.3});
  put_column(state, "pieces", "label", std::vector<std::uint32_t>{0, 0, 2, 2, 2});
  put_column(state, "pieces", "broken", std::vector<std::int64_t>{-6'000'000'000});
  put_column(state, "nothing", "at all", std::vector<double>{});
  return sample;
}

/// The same in the middle of an increment of a load.
Checkpoint sample_within_increment(bool single) {
  Checkpoint made = sample(single);
  SimulationState begun = made.state;
  begun.steps = 12;
  put_column(begun, "pieces", "broken", std::vector<std::int64_t>{3});
  made.state.begun = std::make_shared<const SimulationState>(begun);
  return made;
}

class CheckpointFile : public Scratch {
 protected:
  std::filesystem::path file() const { return folder / "a.bin"; }
  std::string bytes_of(const Checkpoint& checkpoint) const {
    write_checkpoint(file(), checkpoint);
    return text_of(file());
  }
  void expect_refused(const std::string& bytes, const std::vector<std::string>& parts = {}) const {
    put(file(), bytes);
    std::vector<std::string> all{"a.bin: ", "; "};
    all.insert(all.end(), parts.begin(), parts.end());
    test::expect_bad_input([&] { read_checkpoint(file(), particles); }, all);
  }
};

/// With the checksum that its bytes call for: only what it says is wrong.
std::string resealed(std::string bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (std::size_t i = 0; i + 8 < bytes.size(); ++i)
    hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3ULL;
  std::memcpy(bytes.data() + bytes.size() - 8, &hash, 8);
  return bytes;
}

TEST_F(CheckpointFile, ComesBackToTheLastBit) {
  for (const bool single : {false, true}) {
    const Checkpoint before = sample(single);
    const std::string bytes = bytes_of(before);
    const Checkpoint after = read_checkpoint(file(), particles);
    EXPECT_EQ(after.run, before.run);
    EXPECT_EQ(after.state.steps, before.state.steps);
    EXPECT_EQ(after.state.moving.index(), before.state.moving.index());
    EXPECT_EQ(after.state.order, before.state.order);
    EXPECT_EQ(bytes_of(after), bytes);  // and so does everything else
  }
}

TEST_F(CheckpointFile, IsRefusedCutAtAnyByte) {
  const std::string bytes = bytes_of(sample());
  for (std::size_t size = 0; size < bytes.size(); ++size) expect_refused(bytes.substr(0, size));
  expect_refused(bytes + '\0', {"too long"});
}

TEST_F(CheckpointFile, IsRefusedWithAnyByteFlipped) {
  for (const bool single : {false, true}) {
    const std::string bytes = bytes_of(sample(single));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      std::string flipped = bytes;
      flipped[i] = static_cast<char>(flipped[i] ^ (1 << i % 8));
      expect_refused(flipped);
    }
  }
}

TEST_F(CheckpointFile, WithARightChecksumAndAnyByteWrongNeverDoesHarm) {
  std::mt19937 random(5);
  const std::string bytes = bytes_of(sample());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(random());
    put(file(), resealed(changed));
    try {
      const Checkpoint read = read_checkpoint(file(), particles);
      EXPECT_LE(read.state.order.size(), bytes.size());
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::bad_input);
    }
  }
}

TEST_F(CheckpointFile, KeepsWhereAnIncrementBegan) {
  for (const bool single : {false, true}) {
    const Checkpoint written = sample_within_increment(single);
    write_checkpoint(file(), written);
    const Checkpoint read = read_checkpoint(file(), particles);
    ASSERT_TRUE(read.state.begun);
    EXPECT_EQ(read.state.begun->steps, 12);
    const auto broken = [](const SimulationState& state) {
      return column_of<std::int64_t>(state, "pieces", "broken");
    };
    EXPECT_EQ(broken(*read.state.begun), std::vector<std::int64_t>{3});
    EXPECT_EQ(broken(read.state), std::vector<std::int64_t>{-6'000'000'000});
    EXPECT_EQ(read.state.begun->moving.index(), single ? 1u : 0u);
    EXPECT_EQ(bytes_of(read), bytes_of(written));
  }
}

TEST_F(CheckpointFile, OfAnotherVersionMachineOrBodyIsNamed) {
  const std::string bytes = bytes_of(sample());
  std::string other = bytes;
  other[12] = 12;
  expect_refused(resealed(other), {"version 12, not 11"});
  other = bytes;
  std::swap(other[8], other[11]);
  expect_refused(resealed(other), {"byte order"});
  expect_refused("text", {"not a checkpoint"});
  Checkpoint larger = sample();
  larger.run.particles = particles + 1;
  expect_refused(bytes_of(larger), {"run has 6 particles", "body now 5", "--force"});
}

/// A run that goes on must not differ in its bits from one that never stopped.
TEST_F(CheckpointFile, OfAnOlderVersionIsRefusedWithTheSinewThatWroteIt) {
  Checkpoint older = sample();
  older.run.program = "0.4.2";
  std::string bytes = bytes_of(older);
  bytes[12] = 10;
  expect_refused(resealed(bytes), {"version 10, not 11", "sinew '0.4.2'", "--force"});
}

TEST_F(CheckpointFile, ThatPromisesMoreThanThereIsTakesNoMemory) {
  std::string bytes = bytes_of(sample());
  const std::size_t at = bytes.find("pairs") + 5 + 1;  // the count after name and kind of numbers
  const std::uint64_t huge = UINT64_MAX / 2;
  std::memcpy(bytes.data() + at, &huge, 8);
  expect_refused(resealed(bytes), {"truncated or damaged"});
}

TEST_F(CheckpointFile, InTurnLeavesTheOlderOneWhole) {
  Checkpoints checkpoints(folder / "checkpoint");
  std::string complaint;
  EXPECT_FALSE(checkpoints.newest(particles, complaint));
  Checkpoint one = sample();
  for (const std::int64_t steps : {10, 20, 30}) {
    one.state.steps = steps;
    checkpoints.write(one);
  }
  EXPECT_EQ(read_checkpoint(folder / "checkpoint/a.bin", particles).state.steps, 30);
  EXPECT_EQ(read_checkpoint(folder / "checkpoint/b.bin", particles).state.steps, 20);
  Checkpoints later(folder / "checkpoint");
  EXPECT_EQ(later.newest(particles, complaint)->state.steps, 30);
  EXPECT_EQ(complaint, "");
  one.state.steps = 40;
  later.write(one);
  EXPECT_EQ(read_checkpoint(folder / "checkpoint/b.bin", particles).state.steps, 40);
}

/// A body that comes to rest makes no step.
TEST_F(CheckpointFile, OfTheSameStepIsNewerThatWasWrittenLater) {
  Checkpoint one = sample();
  std::string complaint;
  for (const std::int64_t broken : {1, 2, 3, 4}) {
    Checkpoints checkpoints(folder / "one");  // as a run that is resumed each time
    if (const auto newest = checkpoints.newest(particles, complaint)) {
      EXPECT_EQ(column_of<std::int64_t>(newest->state, "pieces", "broken").front(), broken - 1);
    }
    put_column(one.state, "pieces", "broken", std::vector{broken});
    checkpoints.write(one);
  }
}

TEST_F(CheckpointFile, BrokenGivesWayToTheOlderOne) {
  Checkpoints checkpoints(folder);
  Checkpoint one = sample();
  checkpoints.write(one);
  one.state.steps += 5;
  checkpoints.write(one);
  put(folder / "b.bin", "torn");
  std::string complaint;
  EXPECT_EQ(Checkpoints(folder).newest(particles, complaint)->state.steps, one.state.steps - 5);
  EXPECT_TRUE(contains(complaint, "b.bin")) << complaint;
  put(folder / "a.bin", "");
  for (const char* file : {"b.bin", "a.bin"}) {  // to do what the message says leads on
    test::expect_bad_input([&] { Checkpoints(folder).newest(particles, complaint); },
                           {file, "remove the file to go on without it"});
    std::filesystem::remove(folder / file);
  }
  EXPECT_FALSE(Checkpoints(folder).newest(particles, complaint));
}

}  // namespace sinew::checkpoint_test
