// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/stepping/detail/force_probe.h>

#include <algorithm>
#include <array>
#include <utility>

namespace sinew {

template <class Real>
ForceProbe<Real>::ForceProbe(Work work, const kernel::Step<Real>& job,
                             const ParticleLayout<Real>& layout, double newtons, bool muscles,
                             const Points& of_world)
    : work_(std::move(work)),
      job_(job),
      layout_(layout),
      newtons_(newtons),
      muscles_(muscles),
      of_world_(of_world) {}

template <class Real>
void ForceProbe<Real>::operator()(std::size_t first, std::size_t last, Forces& forces) const {
  constexpr std::size_t size = kernel::blocks_per_piece * ParticleLayout<Real>::block;
  std::array<std::array<Real, size>, 12> probed;
  std::array<std::int32_t, size> neighbors;
  kernel::Step<Real> job = job_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    job.probed.pair[axis] = probed[axis].data();
    job.probed.damping[axis] = probed[3 + axis].data();
    job.probed.bone[axis] = probed[6 + axis].data();
    job.probed.muscle[axis] = muscles_ ? probed[9 + axis].data() : nullptr;
  }
  job.probed.neighbors = neighbors.data();
  const auto newtons = [&](std::size_t axis, std::size_t at) -> Vec3 {
    return newtons_ * Vec3(probed[axis][at], probed[axis + 1][at], probed[axis + 2][at]);
  };
  for (std::size_t piece = first; piece < last; ++piece) {
    const std::size_t begin = piece * size, count = std::min(size, layout_.size() - begin);
    job.probed.first = static_cast<std::ptrdiff_t>(begin);
    work_(job, piece, piece + 1);
    for (std::size_t at = 0; at < count; ++at) {
      const std::uint32_t i = layout_.caller()[begin + at];
      forces.pair[i] = newtons(0, at);
      forces.damping[i] = newtons(3, at);
      forces.bone[i] = newtons(6, at);
      if (muscles_) forces.world[i] = newtons(9, at);
      if (!of_world_.empty()) forces.world[i] += of_world_[begin + at];
      forces.neighbors[i] = neighbors[at];
    }
  }
}

template class ForceProbe<double>;
template class ForceProbe<float>;

void resize(Forces& forces, std::size_t count, bool with_world) {
  for (Points* of_particles : {&forces.pair, &forces.damping, &forces.bone})
    of_particles->resize(count);
  forces.world.assign(with_world ? count : 0, Vec3::Zero());
  forces.neighbors.resize(count);
}

}  // namespace sinew
