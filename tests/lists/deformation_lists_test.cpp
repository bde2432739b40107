// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever happens to a body, its lists hold the pairs that the cells find, at every moment
// checked.
#include "support/all_steppers.h"
#include "support/golden.h"

namespace sinew::deformation_lists_test {

/// A body and its motion, for bodies of r = 10 mm.
struct Story {
  std::string name;
  Settings settings;
  Points rest;
  double duration = 0.5;         ///< s
  double factor = 0.5;           ///< of the step's limit
  double shake = 0;              ///< at the start, in radii
  double speed = 0;              ///< at the start, m/s
  Vec3 velocity = Vec3::Zero();  ///< at the start, of all particles, m/s
  Vec3 aside = Vec3::Zero();     ///< of the second half more, of the first less, m/s
  std::int64_t min_listed = 1;   ///< pieces in the run

  friend void PrintTo(const Story& story, std::ostream* out) { *out << story.name; }
};

constexpr double r = 0.01;

double height(int half_planes) { return half_planes * half_plane_spacing(r); }

KeyDefinition key(double time, const Vec3& translation, double angle = 0) {
  KeyDefinition key = test::bend_key(time, angle);
  key.translation = translation;
  return key;
}

Story bend() {
  Story story{"Bend", test::box_scene(49), test::fcc_box(7, 7, 49, r)};
  story.settings.tracks = {test::track("upper", {key(0, {0, 0, 0}), key(0.4, {0, 0, 0}, 90)})};
  return story;
}

Story twist() {
  Story story{"Twist", test::box_scene(33), test::fcc_box(9, 9, 33, r)};
  story.settings.binding.joint_zone = 3;
  story.settings.tracks = {
      test::track("upper", {test::twist_key(0, 0), test::twist_key(0.5, 180)})};
  return story;
}

/// The upper half driven into the lower one.
Story crush() {
  Story story{"Crush", test::box_scene(33), test::fcc_box(9, 9, 33, r)};
  story.settings.tracks = {
      test::track("upper", {key(0, {0, 0, 0}), key(0.5, {0, 0, -height(33) / 3})})};
  return story;
}

/// Folded at the middle until distant parts meet.
Story fold() {
  Story story{"Fold", test::box_scene(61), test::fcc_box(5, 5, 61, r)};
  story.settings.tracks = {
      test::track("upper", {key(0, {0, 0, 0}), key(0.3, {0, 0, 0}, 90), key(0.6, {0, 0, 0}, 178)})};
  story.duration = 0.7;
  return story;
}

/// Two bars side by side, each on a bone of its own.
Story two_bars(const std::string& name) {
  Story story{name, test::box_scene(25), test::fcc_box(5, 5, 25, r)};
  const Vec3 aside(10 * r, 0, 0);
  story.settings.bones = {{"left", "", Vec3(0, 0, 0), Vec3(0, 0, height(25))},
                          {"right", "", aside, Vec3(aside + Vec3(0, 0, height(25)))}};
  for (const Vec3& point : test::fcc_box(5, 5, 25, r)) story.rest.push_back(point + aside);
  return story;
}

/// One bar pressed into the other.
Story collide() {
  Story story = two_bars("Collide");
  story.settings.tracks = {test::track("right", {key(0, {0, 0, 0}), key(0.4, {-7 * r, 0, 0}, 20)})};
  return story;
}

/// One bar passing through the other along both of its own and sideways.
Story pass() {
  Story story = two_bars("Pass");
  story.settings.tracks = {
      test::track("right", {key(0, {0, 0, 0}), key(0.5, {-20 * r, 3 * r, height(25) / 2})})};
  story.settings.tracks[0].interpolation = Interpolation::linear;
  return story;
}

/// Hot and free: it flows.
Story melt() {
  Story story{"Melt", test::unbound(test::box_scene(15)), test::fcc_box(13, 13, 15, r)};
  story.settings.material.damping = 0;
  story.factor = 0.1;
  story.duration = 0.4;
  story.shake = 0.3;
  story.speed = 1.2;
  story.min_listed = 5;
  return story;
}

/// Fully disordered, still on its bones.
Story shake() {
  Story story{"Shake", test::box_scene(15), test::fcc_box(13, 13, 15, r)};
  story.factor = 0.2;
  story.duration = 0.2;
  story.shake = 2;
  story.speed = 2;
  return story;
}

/// Ten lengths in a second, the body moving with it from the start.
Story travel() {
  Story story{"Travel", test::box_scene(25), test::fcc_box(7, 7, 25, r)};
  const Vec3 shift(0, 7 * height(25), 7 * height(25));
  story.settings.tracks = {test::track("lower", {key(0, {0, 0, 0}), key(0.5, shift)}),
                           test::track("upper", {test::bend_key(0, 0), test::bend_key(0.5, 60)})};
  story.settings.tracks[0].interpolation = Interpolation::linear;
  story.velocity = shift / 0.5;
  story.min_listed = 0;
  return story;
}

/// The same without a bone.
Story drift_away() {
  Story story{"DriftAway", test::unbound(test::box_scene(25)), test::fcc_box(7, 7, 25, r)};
  story.duration = 5;
  story.shake = 0.1;
  story.velocity = {0.6, -0.3, 0.3};
  return story;
}

/// Two bars leave each other by many lengths.
Story part() {
  Story story = two_bars("Part");
  story.settings = test::unbound(story.settings);
  story.duration = 3;
  story.speed = 0.01;
  story.aside = {0.8, 0.2, 0.1};
  return story;
}

/// Two turns of a stiff body about an end, and a twist.
Story spin() {
  Story story{"Spin", test::box_scene(25), test::fcc_box(7, 7, 25, r)};
  story.settings.material.young_modulus = 1e6;
  std::vector<KeyDefinition> keys;
  for (int k = 0; k <= 8; ++k) keys.push_back(key(k / 16.0, {0, 0, 0}, 90 * k));
  story.settings.tracks = {test::track("lower", keys),
                           test::track("upper", {test::twist_key(0, 0), test::twist_key(0.5, 60)})};
  story.settings.tracks[0].interpolation = Interpolation::linear;
  return story;
}

/// Both bones jump.
Story jump() {
  Story story{"Jump", test::box_scene(25), test::fcc_box(7, 7, 25, r)};
  std::vector<KeyDefinition> lower, upper;
  for (int k = 0; k < 10; ++k) {
    lower.push_back(key(0.05 * k, {0.1 * r * k, 0, 0}, k));
    upper.push_back(test::bend_key(0.04 * k, 3 * k));
  }
  story.settings.tracks = {test::track("lower", lower), test::track("upper", upper)};
  for (auto& track : story.settings.tracks) track.interpolation = Interpolation::step;
  return story;
}

/// A ball no larger than the distance its particles may travel between checks, rotated in jumps.
Story tumble() {
  Story story{"Tumble", test::box_scene(9), test::fcc_ball(3, r)};
  story.settings.bones = {{"core", "", Vec3(0, 0, -r), Vec3(0, 0, r)}};
  std::vector<KeyDefinition> keys;
  for (int k = 0; k < 100; ++k) keys.push_back(test::bend_key(0.003 * k, 2 * k));
  story.settings.tracks = {test::track("core", keys)};
  story.settings.tracks[0].interpolation = Interpolation::step;
  story.shake = 0.3;
  return story;
}

/// The whole scene elsewhere.
Story moved(Story story, const Vec3& by, const std::string& name) {
  story.name = name;
  for (Vec3& point : story.rest) point += by;
  for (BoneDefinition& bone : story.settings.bones) {
    if (bone.head) *bone.head += by;
    *bone.tail += by;
  }
  return story;
}

/// The same scene for a body `scale` times as large: it takes that much longer.
Story scaled(Story story, double scale, const std::string& name) {
  story.name = name;
  *story.settings.body.radius *= scale;
  for (Vec3& point : story.rest) point *= scale;
  for (BoneDefinition& bone : story.settings.bones) {
    if (bone.head) *bone.head *= scale;
    *bone.tail *= scale;
  }
  for (TrackDefinition& track : story.settings.tracks)
    for (KeyDefinition& key : track.keys) *key.time *= scale, key.translation *= scale;
  story.duration *= scale;
  return story;
}

std::vector<Story> stories() {
  const double far = 1e5 * height(49);
  return {bend(),
          twist(),
          crush(),
          fold(),
          collide(),
          pass(),
          melt(),
          shake(),
          travel(),
          drift_away(),
          part(),
          spin(),
          jump(),
          tumble(),
          moved(bend(), {far, -far, far / 3}, "BendFarAway"),
          moved(melt(), {far, -far, far / 3}, "MeltFarAway"),
          scaled(collide(), 1e-7, "CollideOfRadius1e_9"),
          scaled(shake(), 1e-7, "ShakeOfRadius1e_9"),
          scaled(collide(), 1e5, "CollideOfRadius1000"),
          scaled(shake(), 1e5, "ShakeOfRadius1000")};
}

Simulation begin(const Story& story, Precision precision) {
  const Settings settings = test::in(precision, story.settings);
  const Body body = test::make_body(settings, story.rest);
  const double radius = body.material.pair.r;
  Particles particles = test::shaken(story.rest, body.material, story.shake * radius, story.speed);
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.set_velocity(i, particles.velocity(i) + story.velocity +
                                  (2 * i < particles.size() ? -1 : 1) * story.aside);
  return test::simulation_from(settings, story.rest, particles,
                               test::step_of(settings, body, story.factor));
}

class ListsThroughStories : public testing::TestWithParam<std::tuple<Story, Precision>> {};

TEST_P(ListsThroughStories, HoldThePairsThatCellsFind) {
  const auto& [story, precision] = GetParam();
  Simulation simulation = begin(story, precision);
  constexpr int moments = 29;
  for (int moment = 0; moment <= moments; ++moment) {
    while (simulation.time() < moment * story.duration / moments) simulation.step();
    test::expect_pairs_of_cells(simulation, precision);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(simulation.list_counts().listed, story.min_listed);
}

/// Every third particle without a bone.
Body half_bound(const Settings& settings, const Points& rest) {
  Body body = test::make_body(settings, rest);
  Binding binding{{0}, {}, body.binding.cross_section};
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const auto influences = body.binding.of(i);
    if (i % 3 != 0)
      binding.influences.insert(binding.influences.end(), influences.begin(), influences.end());
    binding.first.push_back(static_cast<std::uint32_t>(binding.influences.size()));
  }
  body.binding = binding;
  return body;
}

TEST(ListsThrough, ABendOfABodyThatBonesHoldInPart) {
  for (const Precision precision : test::precisions)
    for (const Story& story : {bend(), collide(), crush()}) {
      const Settings settings = test::in(precision, story.settings);
      const Body body = half_bound(settings, story.rest);
      Simulation simulation(body, motion_of(settings, body.skeleton),
                            particles_at(story.rest, r, body.material.mass),
                            stepping_of(settings.solver, test::step_of(settings, body, 0.2)));
      for (int moment = 0; moment < 20; ++moment) {
        while (simulation.time() < moment * story.duration / 20) simulation.step();
        test::expect_pairs_of_cells(simulation, precision);
        if (HasFatalFailure()) return;
      }
    }
}

/// A bar on one bone, and twelve particles that fly towards it, past it and at each other: led by
/// the bar's bone, by another one that rotates, or by none, but not bound.
struct Snapshots {
  Settings settings;
  Points rest = test::fcc_box(9, 9, 33, r);
  Body body;
  Particles particles;
  static constexpr std::size_t count = 12;

  Snapshots(Precision precision, bool moving) : settings(test::in(precision, bend().settings)) {
    settings.bones = {{"lower", "", Vec3(0, 0, 0), Vec3(0, 0, height(33))},
                      {"upper", "", Vec3(0.5, 0, 0), Vec3(0.5, 0, height(33))}};
    settings.tracks.clear();
    if (moving)
      settings.tracks = {test::track("lower", {key(0, {0, 0, 0}), key(0.5, {4 * r, 0, 0}, 30)}),
                         test::track("upper", {key(0, {0, 0, 0}), key(0.5, {0, 0, 0}, 90)})};
    const std::size_t bar = rest.size();
    for (std::size_t k = 0; k < count; ++k) {
      const double angle = static_cast<double>(k), high = 0.03 + 0.035 * static_cast<double>(k);
      const double away = (k % 2 == 0 ? 12 : 15) * r;
      rest.emplace_back(away * std::cos(angle), away * std::sin(angle), high);
    }
    body = test::make_body(settings, rest);
    Binding binding{{0}, {}, body.binding.cross_section};
    for (std::size_t i = 0; i < rest.size(); ++i) {
      Influence influence = body.binding.of(i).front();
      if (i >= bar) influence.bone = moving ? static_cast<int>(i % 3 % 2) : 0;
      if (i >= bar) influence.weight = 1e-12;
      if (i < bar || !moving || i % 3 != 2) binding.influences.push_back(influence);
      binding.first.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    body.binding = binding;
    particles = particles_at(rest, r, body.material.mass);
    for (std::size_t i = bar; i < rest.size(); ++i)
      particles.set_velocity(
          i, -6 * rest[i].cwiseProduct(Vec3(1, 1, 0)) + 0.2 * Vec3(0, 0, i % 4 < 2 ? 1 : -1));
  }
};

Simulation begin(const Snapshots& snapshots) {
  return {snapshots.body, motion_of(snapshots.settings, snapshots.body.skeleton),
          snapshots.particles,
          stepping_of(snapshots.settings.solver,
                      test::step_of(snapshots.settings, snapshots.body, 0.2))};
}

void expect_pairs_through_snapshots(Precision precision, bool moving) {
  Simulation simulation = begin(Snapshots(precision, moving));
  for (int moment = 0; moment < 150; ++moment) {
    while (simulation.time() < moment * 0.4 / 150) simulation.step();
    test::expect_pairs_of_cells(simulation, precision);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_LE(simulation.list_counts().rebuilds, 4);
}

TEST(ListsThrough, AFewParticlesThatFlyThroughAMovingScene) {
  for (const Precision precision : test::precisions)
    expect_pairs_through_snapshots(precision, true);
}

TEST(ListsThrough, AFewParticlesThatFlyThroughAStillScene) {
  for (const Precision precision : test::precisions)
    expect_pairs_through_snapshots(precision, false);
}

TEST(ListsThrough, TravelOverLongDistancesInBothPrecisions) {
  for (const Story& story : {travel(), drift_away(), part()}) {
    Simulation doubles = begin(story, Precision::binary64);
    Simulation floats = begin(story, Precision::binary32);
    while (doubles.time() < story.duration) doubles.step(), floats.step();
    EXPECT_LT(test::largest_distance(doubles.particles(), floats.particles()), 0.01 * r)
        << story.name;
  }
}

std::string counts_after_250_steps(const std::string& name, Simulation simulation) {
  while (simulation.steps() < 250) simulation.step();
  const ListCounts counts = simulation.list_counts();
  std::string row = name;
  for (const auto count :
       {counts.rebuilds, counts.surveys, counts.sorts, counts.listed, counts.pruned})
    row += ',' + std::to_string(count);
  return row + ',' + test::rounded(counts.outer) + ',' + test::rounded(counts.inner) + '\n';
}

/// A change of these numbers changes the duration of a run, not its result.
TEST(ListsThrough, StoriesAreBuiltAsOftenAndAsLongAsTheyWere) {
  std::string text = "story,rebuilds,surveys,sorts,listed,pruned,outer,inner\n";
  for (const Precision precision : test::precisions) {
    const std::string in = precision == Precision::binary64 ? " in double" : " in single";
    for (const Story& story : {bend(), twist(), crush(), collide(), melt(), shake(), travel(),
                               part(), spin(), jump(), tumble()})
      text += counts_after_250_steps(story.name + in, begin(story, precision));
    text += counts_after_250_steps("Snapshots" + in, begin(Snapshots(precision, true)));
  }
  test::expect_golden("stepping/golden/lists.csv", text);
}

std::string name_of(const testing::TestParamInfo<std::tuple<Story, Precision>>& info) {
  const auto& [story, precision] = info.param;
  return story.name + (precision == Precision::binary64 ? "InDoubles" : "InFloats");
}

INSTANTIATE_TEST_SUITE_P(All, ListsThroughStories,
                         testing::Combine(testing::ValuesIn(stories()),
                                          testing::ValuesIn(test::precisions)),
                         name_of);

}  // namespace sinew::deformation_lists_test
