// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/cubic/pulled_sample.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace sinew {
namespace {

constexpr std::uint32_t samples_at_a_time = 64;

/// These rows, which are `size` long.
template <class Real>
Lines<Real> rows_of(const Real* all, const std::vector<std::size_t>& rows, std::size_t size) {
  Lines<Real> some(rows.size() * size);
  for (std::size_t k = 0; k < rows.size(); ++k)
    std::copy_n(all + rows[k] * size, size, some.data() + k * size);
  return some;
}

}  // namespace

template <class Real>
PulledSample<Real>::PulledSample(Quadrature quadrature, const InnerParticles& particles)
    : quadrature_(std::move(quadrature)),
      number_(quadrature_.block.size()),
      state_(number_.size() * block) {
  for (auto& axis : at_of_kernel_) axis.resize(number_.size() * block);
  std::iota(number_.begin(), number_.end(), 0U);
  for (const std::uint32_t s : number_) {
    const std::size_t begin = quadrature_.block[s] * block;
    const std::int32_t group = particles.group[begin];
    if (runs_.empty() || runs_.back().group != group ||
        runs_.back().end - runs_.back().begin == samples_at_a_time)
      runs_.push_back({s, s, group});
    ++runs_.back().end;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = begin; k < begin + block; ++k) {
        at_[axis].push_back(particles.at[axis][k]);
        at_of_kernel_[axis][at_[axis].size() - 1] = static_cast<Real>(particles.at[axis][k]);
      }
  }
}

template <class Real>
void PulledSample<Real>::bind(const kernel::Bindings<Real>& body) {
  bindings_first_.assign(1, 0);
  slots_.clear();
  std::vector<std::size_t> attachments, weights;
  for (const std::uint32_t b : quadrature_.block) {
    for (std::size_t s = body.first[b]; s < body.first[b + 1]; ++s) {
      kernel::Slot slot = body.slots[s];
      if (slot.weights >= 0) {
        weights.push_back(static_cast<std::size_t>(slot.weights));
        slot.weights = static_cast<std::int32_t>(weights.size() - 1);
      }
      attachments.push_back(s);
      slots_.push_back(slot);
    }
    bindings_first_.push_back(static_cast<std::uint32_t>(slots_.size()));
  }
  attachments_ = rows_of(body.attachments, attachments, kernel::attachment_fields * block);
  weights_ = rows_of(body.weights, weights, kernel::weight_fields * block);
}

template <class Real>
kernel::PullSums PulledSample<Real>::pull(const PulledRun& run, kernel::Motions motions,
                                          const kernel::Functions<Real>& kernel,
                                          const kernel::Step<Real>& step,
                                          const GroupMotion& motion) {
  kernel::Step<Real> own = step;
  own.before = state_.arrays();
  own.bindings = {bindings_first_.data(), slots_.data(), attachments_.data(), weights_.data(),
                  step.bindings.bones};
  kernel.put[motions]({own.before,
                       run.begin * block,
                       run.end * block,
                       {at_[0].data(), at_[1].data(), at_[2].data()},
                       motion.x.data(),
                       motion.v.data()});
  kernel::PullSums sums;
  kernel.pull[motions](
      own,
      {number_.data() + run.begin,
       quadrature_.weight.data() + run.begin,
       run.end - run.begin,
       {at_of_kernel_[0].data(), at_of_kernel_[1].data(), at_of_kernel_[2].data()}},
      sums);
  return sums;
}

template class PulledSample<double>;
template class PulledSample<float>;

}  // namespace sinew
