// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_scene.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/text.h>
#include <sinew/settings/row.h>
#include <sinew/settings/table.h>
#include <sinew/settings/text_file.h>

namespace sinew {
namespace {

std::string quoted(const std::string& text) { return scene_text(FieldValue(text), ""); }

/// Numbers to a ten-thousandth of the body, without what is below that.
class Rounded {
 public:
  explicit Rounded(double size) : step_(std::pow(10, std::floor(std::log10(size)) - 4)) {}

  std::string operator()(double value) const { return text(value, step_); }
  std::string operator()(const Vec3& v) const { return list(v, step_); }
  static std::string direction(const Vec3& v) { return list(v, 1e-4); }

 private:
  static std::string list(const Vec3& v, double step) {
    return '[' + text(v.x(), step) + ", " + text(v.y(), step) + ", " + text(v.z(), step) + ']';
  }

  /// Divided by a whole number: 0.0013 and not 0.0013000000000000002.
  static std::string text(double value, double step) {
    const double steps = std::round(value / step), parts = std::round(1 / step);
    return number_text(steps == 0 ? 0 : parts > 1 ? steps / parts : steps * step);
  }

  double step_;
};

/// The word by which the scene names the value of a key.
std::string word_of(const Settings& settings, std::string_view section, std::string_view name) {
  for (const auto& row : settings_table())
    if (row.section == section && row.name == name)
      return scene_text(row.get(settings), row.absent);
  return "";
}

std::string key_text(const Settings& settings, std::string_view section, std::string_view name) {
  return "  " + std::string(name) + ": " + word_of(settings, section, name) + '\n';
}

std::string note(const std::string& text) { return "  # " + text + '\n'; }

std::string body_text(const NewChoices& choices, const std::filesystem::path& folder) {
  const Settings& s = choices.settings;
  std::string text = "body:\n  mesh: " + quoted(path_in(folder, s.body.mesh)) + '\n';
  if (!choices.changed.empty()) text += note("It holds " + choices.changed + ", in meters, z up.");
  text += note("Unit: " + choices.unit + '.') + key_text(s, "body", "unit");
  text += note("Up: " + choices.axes + '.') + key_text(s, "body", "up");
  if (s.body.forward) text += key_text(s, "body", "forward");
  if (s.body.close_holes) text += note(choices.holes + '.') + key_text(s, "body", "close_holes");
  return text + note(choices.size + '.') + key_text(s, "body", "radius");
}

std::string material_text(const NewChoices& choices) {
  const Settings& s = choices.settings;
  return "\nmaterial:\n" +
         note("A solid that returns to its shape; parts that touch do not stick.") +
         key_text(s, "material", "model") +
         note("Pa. As stiff as a body of this size needs to follow its bones; or name a preset.") +
         key_text(s, "material", "young_modulus");
}

std::string parts_text(const NewChoices& choices, const std::filesystem::path& folder) {
  if (choices.materials.empty()) return "";
  std::string text =
      "\nmaterials:\n" + note("Of the mesh: " + choices.materials + ". Give each its own modulus.");
  for (const LocalMaterialSettings& part : choices.settings.materials)
    text += "  - {name: " + part.name + ", young_modulus: " + number_text(*part.young_modulus) +
            ", mesh: " + quoted(path_in(folder, part.part.mesh)) + "}\n";
  return text;
}

std::string bone_text(const BoneDefinition& bone, const Rounded& rounded) {
  std::string text = "    - {name: " + bone.name;
  if (!bone.parent.empty()) text += ", parent: " + bone.parent;
  if (bone.head) text += ", head: " + rounded(*bone.head);
  return text + ", tail: " + rounded(*bone.tail) + "}\n";
}

std::string skeleton_text(const NewChoices& choices, const std::filesystem::path& folder) {
  const Settings& s = choices.settings;
  std::string text = "\nskeleton:\n" + note(choices.bones + '.');
  if (s.skeleton.file.empty()) {
    const Rounded rounded(choices.box.sizes().maxCoeff());
    text += "  bones:\n";
    for (const BoneDefinition& bone : s.bones) text += bone_text(bone, rounded);
    return text;
  }
  text += "  file: " + quoted(path_in(folder, s.skeleton.file)) + '\n';
  text += key_text(s, "skeleton", "up");
  if (s.skeleton.forward) text += key_text(s, "skeleton", "forward");
  if (s.skeleton.scale != 1) text += key_text(s, "skeleton", "scale");
  if (s.skeleton.rest_at) text += note(choices.pose + '.') + key_text(s, "skeleton", "rest_at");
  if (s.skeleton.fit != Fit::none)
    text += note("The rig lies elsewhere: scaled, rotated and moved into the mesh.") +
            key_text(s, "skeleton", "fit");
  return text;
}

std::string track_text(const TrackDefinition& track) {
  std::string text = "    - bone: " + quoted(track.bone) + "\n      keys:\n";
  for (const KeyDefinition& key : track.keys)
    text += "        - {time: " + number_text(*key.time) +
            ", axis: " + Rounded::direction(*key.axis) +
            ", angle: " + number_text(std::round(*key.angle * 100) / 100) + "}\n";
  return text;
}

std::string clip_text(const NewChoices& choices, const std::filesystem::path& folder) {
  const Settings& s = choices.settings;
  std::string text;
  if (!choices.clip_note.empty()) text += note(choices.clip_note);
  if (!choices.clips.empty()) {
    const std::vector<std::string_view> others(choices.clips.begin(), choices.clips.end());
    text += note("The file also holds: " + listed(others) + '.');
  }
  if (!s.motion.file.empty()) text += "  file: " + quoted(path_in(folder, s.motion.file)) + '\n';
  if (!s.motion.clip.empty()) text += key_text(s, "motion", "clip");
  if (!s.motion.names.empty()) {
    text += note("Which joint of the clip moves which bone: [bone, joint].") + "  names:\n";
    for (const auto& [bone, joint] : s.motion.names)
      text += "    - [" + quoted(bone) + ", " + quoted(joint) + "]\n";
  }
  if (s.motion.start > 0) text += key_text(s, "motion", "start");
  if (s.motion.begin == Begin::automatic)
    text += note(
                "Where the clip begins far from rest, the body begins in its first pose; else the "
                "bones first move there.") +
            key_text(s, "motion", "begin");
  return text.empty() ? "" : "\nmotion:\n" + text;
}

std::string motion_text(const NewChoices& choices, const std::filesystem::path& folder) {
  const Settings& s = choices.settings;
  if (s.tracks.empty()) return clip_text(choices, folder);
  std::string text =
      "\nmotion:\n" +
      note("Limbs bend and go back: angles in degrees from rest, times in seconds.") +
      "  tracks:\n";
  for (const TrackDefinition& track : s.tracks) text += track_text(track);
  return text;
}

std::string binding_text(const NewChoices& choices) {
  const Settings& s = choices.settings;
  std::string text = "\nbinding:\n";
  const char* follow =
      "Particles follow the bone that is nearest inside the body, not across a gap.";
  if (s.binding.method == BindMethod::file)
    follow = "Particles follow the bones that the file's weights give to the skin near them.";
  else if (choices.hollow)
    follow = "Particles follow the bone that is nearest: the bones lie in the hollow.";
  text += note(follow);
  text += key_text(s, "binding", "method");
  if (s.binding.joint_zone > 0)
    text += note("Around a joint both bones pull, so that it bends in an arc.") +
            key_text(s, "binding", "joint_zone");
  text += note("Four times the usual hold: thin limbs follow closely.");
  for (const char* name : {"stiffness", "twist_stiffness", "axial_stiffness"})
    text += key_text(s, "binding", name);
  text += note("Parts of fewer particles across follow their bones rigidly.");
  text += key_text(s, "binding", "rigid_below");
  text += note("Bones of fewer particles pull less: they would set the time step of all.");
  text += key_text(s, "binding", "soften_below");
  if (s.binding.max_force)
    text += note("As much as pushes neighbors to half their distance: holds yield beyond.") +
            key_text(s, "binding", "max_force");
  if (s.contact.pass_through.any())
    text += "\ncontact:\n" +
            note("Limbs that the clip drives into each other pass through each other.") +
            key_text(s, "contact", "pass_through");
  return text;
}

}  // namespace

std::string new_scene_text(const NewChoices& choices, const std::filesystem::path& folder) {
  const Settings& s = choices.settings;
  const int pictures = static_cast<int>(std::lround(1 / s.output.interval));
  std::string text = "# Made by sinew new. Lengths in meters, times in seconds; z points up.\n";
  if (choices.quick) text += "# By --quick: few particles, few pictures, 2 s at most.\n";
  text += '\n';
  text += body_text(choices, folder) + material_text(choices) + parts_text(choices, folder) +
          skeleton_text(choices, folder) + motion_text(choices, folder) + binding_text(choices);
  text += "\nsolver:\n" + key_text(s, "solver", "duration");
  text +=
      note("No gravity, so that the body moves by its bones alone; [0, 0, -9.81] is the Earth's.");
  text += key_text(s, "solver", "gravity");
  text += "\noutput:\n" + note(std::to_string(pictures) + " pictures per second.") +
          "  interval: 1/" + std::to_string(pictures) + '\n';
  return text;
}

}  // namespace sinew
