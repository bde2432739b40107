// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/detail/run_checkpoints.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/hash.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/run/run_record.h>

namespace sinew {
namespace {

struct DecidingLine {
  std::string section, text;
};

/// Lines of a resolved scene that affect the results, without comments.
std::vector<DecidingLine> deciding_lines(const std::string& resolved) {
  std::vector<DecidingLine> lines;
  std::string section;
  std::istringstream text(resolved);
  for (std::string line; std::getline(text, line);) {
    line = line.substr(0, line.find("  # "));
    if (!line.starts_with(' ')) section = line.substr(0, line.find(':'));
    if (!line.starts_with("  checkpoint_interval:") && !line.starts_with("  wall_time:") &&
        !line.starts_with("  iterations:"))
      lines.push_back({section, line});
  }
  return lines;
}

std::string trimmed(const std::string& line) {
  const auto first = line.find_first_not_of(' ');
  return first == std::string::npos ? "nothing" : line.substr(first);
}

Error another_run(const std::string& what) {
  return bad_input("a run goes on only as it began: " + what,
                   "give what the run began with, replace the run with --force, or choose another "
                   "folder with -o");
}

void refuse_other_files(bool body_differs, bool motion_differs) {
  if (body_differs) throw another_run("the mesh, or what fills or binds it, has changed");
  if (motion_differs) throw another_run("the motion of its bones or obstacles has changed");
}

void add(const Triangles& surface, Hash& hash) {
  for (const Vec3& point : surface.points) hash.add(point.data(), 3 * sizeof(double));
  for (const auto& face : surface.faces) hash.add(face.data(), sizeof face);
}

/// The body at rest, its attachment, and its skin.
std::uint64_t body_hash(const Body& body, const Triangles& surface) {
  Hash hash = hash_at_rest(body);
  add(surface, hash);
  return hash.value();
}

/// The bones at sampled times of the run, and the obstacles around it.
std::uint64_t motion_hash(const Prepared& prepared) {
  constexpr int moments = 1000;
  const double end = prepared.plan.time(prepared.plan.steps_until(prepared.frames.count));
  Hash hash;
  for (int i = 0; i <= moments; ++i)
    for (const BonePose& bone :
         pose_at(prepared.body.skeleton, prepared.motion, end * i / moments)) {
      hash.add(bone.frame.origin.data(), 3 * sizeof(double));
      hash.add(bone.frame.rotation.data(), 9 * sizeof(double));
    }
  for (const Triangles& obstacle : prepared.obstacles) add(obstacle, hash);
  return hash.value();
}

}  // namespace

void check_same_scene(const RunFolder& folder, const std::string& resolved) {
  if (!std::filesystem::exists(folder.scene())) return;
  const auto there = deciding_lines(read_file(folder.scene())), here = deciding_lines(resolved);
  for (std::size_t i = 0; i < std::max(there.size(), here.size()); ++i) {
    const DecidingLine none, &before = i < there.size() ? there[i] : none,
                             &now = i < here.size() ? here[i] : none;
    if (before.text != now.text)
      throw another_run("section " + (before.section.empty() ? now : before).section + " has '" +
                        trimmed(before.text) + "' in the run and '" + trimmed(now.text) +
                        "' in the scene");
  }
}

RunIdentity identity_of(const std::string& resolved, const Prepared& prepared) {
  Hash scene;
  for (const DecidingLine& line : deciding_lines(resolved)) scene.add(line.text + '\n');
  return {version(),
          scene.value(),
          body_hash(prepared.body, prepared.surface.triangles),
          motion_hash(prepared),
          prepared.body.rest.size(),
          prepared.steps.step};
}

void check_same_files(const RunFolder& folder, const RunIdentity& run) {
  const auto record = read_record(folder);
  if (!record.contains("version") || record["version"] != run.program)
    return;  // which may bind in another way
  const auto differs = [&](const char* key, std::uint64_t hash) {
    return record.contains(key) && record[key] != hash_text(hash);
  };
  refuse_other_files(differs("body_hash", run.body), differs("motion_hash", run.motion));
}

RunCheckpoints::RunCheckpoints(const RunFolder& folder, const Settings& settings)
    : checkpoints_(folder.checkpoints()),
      interval_(settings.output.checkpoint_interval),
      limit_(settings.solver.wall_time) {}

std::optional<SimulationState> RunCheckpoints::resume(const RunIdentity& run,
                                                      std::string& complaint) {
  auto found = checkpoints_.newest(run.particles, complaint);
  if (!found) return std::nullopt;
  const RunIdentity& was = found->run;
  if (was.program != run.program)
    throw another_run("it is of sinew " + was.program + ", this is " + run.program);
  if (was.time_step != run.time_step)
    throw another_run("its step is " + number_text(was.time_step) + " s, not " +
                      number_text(run.time_step) + " s");
  refuse_other_files(was.body != run.body, was.motion != run.motion);
  if (was.scene != run.scene) throw another_run("its scene is another");
  return std::move(found->state);
}

void RunCheckpoints::save(const std::function<SimulationState()>& state,
                          FrameWriter& frame_writer) {
  frame_writer.then([&]() -> Background::Job {
    auto checkpoint = std::make_shared<const Checkpoint>(Checkpoint{run_, state()});
    return [this, checkpoint] { checkpoints_.write(*checkpoint); };
  });
  since_ = Stopwatch();
}

}  // namespace sinew
