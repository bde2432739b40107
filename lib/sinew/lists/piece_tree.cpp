// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/piece_tree.h>

#include <algorithm>
#include <cmath>

namespace sinew {

double gap_between(const PieceNow& one, const PieceNow& other) {
  const Mat3 turned = one.axes.transpose() * other.axes, both = turned.cwiseAbs();
  const Vec3 half = one.along.sizes() / 2, others = other.along.sizes() / 2;
  const Vec3 apart = other.middle() - one.middle();
  const Vec3 in_one = one.axes.transpose() * apart, in_other = other.axes.transpose() * apart;
  const auto length = [](const Vec3& gap) { return gap.cwiseMax(0).squaredNorm(); };
  return std::sqrt(std::max({one.box.squaredExteriorDistance(other.box),
                             length(in_one.cwiseAbs() - half - both * others),
                             length(in_other.cwiseAbs() - others - both.transpose() * half)}));
}

double gap_across(const PieceNow& one, const PieceNow& other) {
  const Vec3 across = one.axes.col(one.shortest);
  const double reach = (other.axes.transpose() * across).cwiseAbs().dot(other.along.sizes()) / 2;
  return std::abs((other.middle() - one.middle()).dot(across)) -
         one.along.sizes()[one.shortest] / 2 - reach;
}

PieceTree::PieceTree(const std::vector<PieceNow>& pieces, std::span<const double> drift,
                     std::span<const std::int32_t> bound_to)
    : levels_(1) {
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    const Vec3 more = Vec3::Constant(drift[piece]);
    const Box& box = pieces[piece].box;
    levels_[0].push_back({Box(Vec3(box.min() - more), Vec3(box.max() + more)),
                          bound_to.empty() ? none : bound_to[piece]});
  }
  while (levels_.back().size() > 1) {
    const std::vector<Node>& below = levels_.back();
    std::vector<Node> level;
    for (std::size_t k = 0; k < below.size(); ++k) {
      if (k % branches == 0) level.push_back(below[k]);
      Node& node = level.back();
      node.box.extend(below[k].box);
      if (node.group != below[k].group) node.group = none;
    }
    levels_.push_back(std::move(level));
  }
}

}  // namespace sinew
