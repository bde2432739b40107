// SPDX-License-Identifier: GPL-3.0-or-later
// Lists that are made when NearPieces says so hold all pairs in range, however particles move and
// whatever velocity fields stand for them; and lists of what moves as a rigid body last.
#include <sinew/lists/near_pieces.h>

#include <gtest/gtest.h>
#include <functional>
#include <set>

#include "support/world.h"

namespace sinew::near_pieces_test {

const ListRanges ranges{1, 1.2, 2};
constexpr double dt = 0.01;

/// Along axes that point anywhere.
void bound(const Points& points, std::mt19937& random, PieceNow& piece) {
  piece.axes = Quat(1, 0, 0, 0)
                   .FromTwoVectors(Vec3::UnitX(), test::random_vector(random))
                   .toRotationMatrix();
  for (const Vec3& p : points)
    piece.along.extend(Vec3(piece.axes.transpose() * (p - piece.center)));
}

/// Clusters of points that move by a law, with lists of the pairs of each by brute force.
class Cloud {
 public:
  using Velocity = std::function<Vec3(const Vec3& p, double time, std::size_t piece)>;
  enum class Field { fitted, none, wrong };

  Cloud(std::size_t pieces, double apart, Velocity velocity, Field field)
      : velocity_(std::move(velocity)), field_(field), near_(ranges) {
    for (std::size_t piece = 0; piece < pieces; ++piece) {
      const double x = apart * static_cast<double>(piece);
      points_.emplace_back();
      for (int k = 0; k < 25; ++k)
        points_.back().push_back(Vec3(x, 0, 0) + 2 * test::random_vector(random_));
    }
    outer_.resize(pieces), inner_.resize(pieces);
    near_.survey(now(), dt);
    for (std::size_t piece = 0; piece < pieces; ++piece) list(piece);
  }

  void step() {
    std::vector<double> fastest(points_.size(), 0);
    for (std::size_t piece = 0; piece < points_.size(); ++piece)
      for (Vec3& p : points_[piece]) {
        const Vec3 v = velocity_(p, time_, piece);
        fastest[piece] = std::max(fastest[piece], (v - surveyed_[piece].velocity_at(p)).norm());
        p += dt * v;
      }
    time_ += dt;
    for (double& speed : fastest) speed *= 1 + 1e-12;
    for (PieceNow& piece : surveyed_) piece.center += dt * near_.common_velocity();
    if (!near_.advance(fastest, dt)) {
      near_ = NearPieces(ranges);
      near_.survey(now(), dt);
      for (std::size_t piece = 0; piece < points_.size(); ++piece) list(piece), ++listed;
      return;
    }
    if (near_.survey_due()) near_.survey(now(), dt);
    for (const std::uint32_t piece : near_.to_list()) list(piece), ++listed;
    for (const std::uint32_t piece : near_.to_prune()) prune(piece), ++pruned;
  }

  void expect_all_pairs_listed() const {
    for (std::size_t p = 0; p < points_.size(); ++p)
      for (std::size_t q = 0; q < points_.size(); ++q)
        for_each_pair(p, q, ranges.force, [&](const Entry& entry) {
          ASSERT_TRUE(inner_[p].count(entry)) << "pieces " << p << " and " << q << " at " << time_;
        });
  }

  int listed = 0, pruned = 0;

 private:
  using Entry = std::array<std::size_t, 3>;  ///< particle, other piece, particle of it

  template <class Visit>
  void for_each_pair(std::size_t p, std::size_t q, double range, Visit&& visit) const {
    for (std::size_t i = 0; i < points_[p].size(); ++i)
      for (std::size_t j = 0; j < points_[q].size(); ++j)
        if ((points_[p][i] - points_[q][j]).norm() < range) visit(Entry{i, q, j});
  }

  void list(std::size_t piece) {
    outer_[piece].clear();
    for (const std::uint32_t near : near_.of(piece))
      for_each_pair(piece, near, ranges.outer,
                    [&](const Entry& entry) { outer_[piece].insert(entry); });
    near_.listed(piece);
    prune(piece);
  }

  void prune(std::size_t piece) {
    inner_[piece].clear();
    for (const Entry& entry : outer_[piece])
      if ((points_[piece][entry[0]] - points_[entry[1]][entry[2]]).norm() < ranges.inner)
        inner_[piece].insert(entry);
    near_.pruned(piece);
  }

  /// Any velocity field will do; the right one lets lists last.
  std::vector<PieceNow> now() {
    surveyed_.clear();
    for (std::size_t piece = 0; piece < points_.size(); ++piece) {
      PieceNow one;
      for (const Vec3& p : points_[piece]) one.box.extend(p);
      one.center = points_[piece].front();
      if (piece % 2 == 0) bound(points_[piece], random_, one);
      if (field_ == Field::fitted) fit(piece, one);
      if (field_ == Field::wrong)
        one.velocity = test::random_vector(random_), one.spin = test::random_vector(random_);
      surveyed_.push_back(one);
    }
    return surveyed_;
  }

  /// Fits to three points of the law, exact for a rigid motion.
  void fit(std::size_t piece, PieceNow& one) const {
    one.velocity = velocity_(one.center, time_, piece);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 along = Vec3::Unit(axis);
      const Vec3 change = velocity_(one.center + along, time_, piece) - one.velocity;
      one.spin += along.cross(change) / 2;
    }
  }

  std::mt19937 random_{7};
  Velocity velocity_;
  Field field_;
  double time_ = 0;
  std::vector<Points> points_;
  std::vector<PieceNow> surveyed_;
  NearPieces near_;
  std::vector<std::set<Entry>> outer_, inner_;
};

Vec3 flying(const Vec3& p, double, std::size_t) {
  return Vec3(900, 20, -300) + Vec3(0.3, -0.5, 1).cross(p);
}
Vec3 turning(const Vec3& p, double, std::size_t) { return Vec3(0.3, -0.5, 1).cross(p); }
Vec3 shearing(const Vec3& p, double time, std::size_t) {
  return Vec3(0, 0.8 * p.x() * std::sin(time), 0.3 * p.y());
}
/// Every piece its own way, and back: they pass through each other.
Vec3 crossing(const Vec3& p, double time, std::size_t piece) {
  const double speed = piece % 2 == 0 ? 3 : -1;
  return Vec3(speed * std::cos(time), 0.2 * p.z(), std::sin(3 * p.x() + time));
}
/// One turns fast about a distant point and sweeps over the others.
Vec3 sweeping(const Vec3& p, double, std::size_t piece) {
  return piece == 0 ? Vec3(Vec3(0, 0, 2).cross(p - Vec3(-6, 0, 0))) : Vec3(Vec3::Zero());
}

TEST(NearPieces, LetNoPairInRangeGoUnlisted) {
  for (const auto& velocity : {flying, turning, shearing, crossing, sweeping})
    for (const double apart : {1.5, 4.0, 9.0})
      for (const auto field : {Cloud::Field::fitted, Cloud::Field::none, Cloud::Field::wrong}) {
        Cloud cloud(5, apart, velocity, field);
        for (int step = 0; step < 250; ++step) {
          cloud.step();
          cloud.expect_all_pairs_listed();
          if (HasFatalFailure()) return;
        }
      }
}

TEST(NearPieces, AreNoNearerThanTheirGap) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 200; ++trial) {
    PieceNow pieces[2];
    Points points[2];
    for (int k = 0; k < 2; ++k) {
      pieces[k].center = 3 * test::random_vector(random);
      const Vec3 sizes = test::random_vector(random);
      for (int n = 0; n < 30; ++n)
        points[k].push_back(pieces[k].center + sizes.cwiseProduct(test::random_vector(random)));
      for (const Vec3& p : points[k]) pieces[k].box.extend(p);
      bound(points[k], random, pieces[k]);
    }
    double least = 1e9;
    for (const Vec3& p : points[0])
      for (const Vec3& q : points[1]) least = std::min(least, (p - q).norm());
    const double gap = gap_between(pieces[0], pieces[1]);
    ASSERT_LE(gap, least);
    ASSERT_GE(gap, std::sqrt(pieces[0].box.squaredExteriorDistance(pieces[1].box)));
  }
}

/// Slices of a bar at an angle to all axes: boxes along the axes overlap, theirs do not.
TEST(NearPieces, AreApartAlongTheirOwnAxes) {
  const Mat3 axes = test::turned(Vec3(1, 2, -1).normalized(), 33);
  std::vector<PieceNow> slices(6);
  for (int k = 0; k < 6; ++k) {
    const Box along(Vec3(-5, -5, 2 * k), Vec3(5, 5, 2 * k + 2));
    slices[k].axes = axes;
    slices[k].along = along;
    for (int corner = 0; corner < 8; ++corner)
      slices[k].box.extend(Vec3(axes * along.corner(static_cast<Box::CornerType>(corner))));
  }
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(gap_between(slices[0], slices[k]), std::max(0, 2 * k - 2), 1e-12);
  NearPieces near(ranges);
  near.survey(slices, dt);
  EXPECT_EQ(near.of(0).size(), 3u);  // itself, the next one, and one that is the outer range away
}

/// Some are alone, others of three groups.
std::vector<std::int32_t> some_groups(std::size_t pieces) {
  std::vector<std::int32_t> group;
  for (std::size_t piece = 0; piece < pieces; ++piece)
    group.push_back(piece < pieces / 3 ? -1 : static_cast<std::int32_t>(piece * 5 / pieces));
  return group;
}

TEST(NearPieces, AreFoundAmongThoseOfTheirOwnGroupAsWell) {
  std::mt19937 random(3);
  std::vector<PieceNow> pieces(120);
  for (PieceNow& piece : pieces) {
    const Vec3 at = 12 * test::random_vector(random);
    Points points;
    for (int k = 0; k < 8; ++k)
      points.push_back(at + test::random_vector(random).cwiseProduct(Vec3(2, 1, 0.3)));
    for (const Vec3& p : points) piece.box.extend(p);
    piece.center = at;
    piece.velocity = 0.3 * test::random_vector(random), piece.spin = test::random_vector(random);
    bound(points, random, piece);
  }
  const std::vector<std::int32_t> group = some_groups(pieces.size());
  NearPieces alone(ranges), grouped(ranges, group);
  alone.survey(pieces, dt), grouped.survey(pieces, dt);
  std::size_t bound = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const std::vector<std::uint32_t> near = alone.of(p);
    EXPECT_EQ(grouped.of(p), near);
    std::vector<std::uint32_t> others;
    for (const std::uint32_t q : near)
      if (group[p] < 0 || group[q] != group[p]) others.push_back(q);
    std::vector<std::uint32_t> found;
    for (const NearPieces::Near& one : grouped.others(p)) found.push_back(one.piece);
    EXPECT_EQ(found, others);
    bound += near.size() - others.size();
    for (std::uint32_t q = 0; q < pieces.size(); ++q) {
      if (gap_between(pieces[p], pieces[q]) < ranges.outer) {
        EXPECT_TRUE(std::binary_search(near.begin(), near.end(), q)) << p << ' ' << q;
      }
    }
  }
  EXPECT_GT(bound, pieces.size());
}

TEST(NearPieces, KeepTheListsOfABodyThatMovesAsOne) {
  const auto flying = [](const Vec3&, double, std::size_t) { return Vec3(900, 20, -300); };
  const auto slowly = [](const Vec3& p, double time, std::size_t piece) {
    return Vec3(turning(p, time, piece) / 4);
  };
  for (const Cloud::Velocity& velocity : {Cloud::Velocity(slowly), Cloud::Velocity(flying)}) {
    Cloud cloud(5, 1.5, velocity, Cloud::Field::fitted);
    for (int step = 0; step < 600; ++step) cloud.step();
    EXPECT_EQ(cloud.listed, 0);
    EXPECT_LE(cloud.pruned, 5 * 600 / 100);
  }
  // Turns by a degree in a step and a half, over a turn.
  Cloud cloud(5, 1.5, turning, Cloud::Field::fitted);
  for (int step = 0; step < 600; ++step) cloud.step();
  EXPECT_LE(cloud.listed, 2 * 5);
}

TEST(NearPieces, ListOnlyWhatAFastPieceCanMeet) {
  constexpr int steps = 314;  // one turn
  constexpr std::size_t pieces = 12;
  Cloud cloud(pieces, 3, sweeping, Cloud::Field::fitted);
  for (int step = 0; step < steps; ++step) cloud.step();
  EXPECT_GT(cloud.listed, 0);
  EXPECT_LT(cloud.listed, steps / 3);
}

/// The largest difference of two velocity fields at points of `inside` within reach of `near`.
double sampled_difference(const PieceNow& inside, const PieceNow& near, std::mt19937& random) {
  double most = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 p =
        inside.box.center() + test::random_vector(random).cwiseProduct(inside.box.sizes()) / 2;
    if (near.box.exteriorDistance(p) < ranges.outer)
      most = std::max(most, (inside.velocity_at(p) - near.velocity_at(p)).norm());
  }
  return most;
}

TEST(NearPieces, BoundTheDifferenceOfVelocityFieldsWhereverPiecesCanMeet) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 30; ++trial) {
    std::vector<PieceNow> pieces(2);
    for (int k = 0; k < 2; ++k) {
      const Vec3 center(3.0 * k, 0, 0);
      pieces[k].box = Box(Vec3(center - Vec3(1, 1, 1)), Vec3(center + Vec3(1, 1, 1)));
      pieces[k].center = center;
      pieces[k].velocity = test::random_vector(random);
      pieces[k].spin = test::random_vector(random);
    }
    NearPieces near(ranges);
    near.survey(pieces, dt);
    const double least = std::min(sampled_difference(pieces[0], pieces[1], random),
                                  sampled_difference(pieces[1], pieces[0], random));
    ASSERT_GT(least, 0);
    EXPECT_EQ(near.of(0).size(), 2u);
    for (const NearPieces::Near& other : near.others(0)) {
      if (other.piece == 1) {
        EXPECT_GE(other.rate, least);
      }
    }
  }
}

}  // namespace sinew::near_pieces_test
