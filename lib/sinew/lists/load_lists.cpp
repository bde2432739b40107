// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/lists/load_lists.h>

#include <numeric>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t particles_per_task = 1024;

}  // namespace

template <class Real>
LoadLists<Real>::LoadLists(std::span<const Load> loads, double mass) : given_(loads), mass_(mass) {
  for (const Load& load : loads) now_.emplace_back(load);
}

template <class Real>
void LoadLists<Real>::set_order(std::span<const std::int32_t> id) {
  if (given_.empty()) return;
  constexpr std::size_t block = BlockState<Real>::block;
  std::vector<std::uint32_t> place(id.size());
  for (std::uint32_t k = 0; k < id.size(); ++k) place[static_cast<std::size_t>(id[k])] = k;
  places_.assign(given_.size(), {});
  for (std::size_t n = 0; n < given_.size(); ++n)
    for (const std::uint32_t particle : given_[n].particles) places_[n].push_back(place[particle]);
  const auto for_each = [&](const auto& visit) {
    for (std::uint32_t n = 0; n < given_.size(); ++n)
      for (std::uint32_t at = 0; at < places_[n].size(); ++at) visit(places_[n][at], Loaded{n, at});
  };
  first_.assign(id.size() + 1, 0);
  for_each([&](std::uint32_t k, const Loaded&) { ++first_[k + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  loaded_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for_each([&](std::uint32_t k, const Loaded& one) { loaded_[next[k]++] = one; });
  const std::size_t blocks = (id.size() + block - 1) / block;
  on_.assign(blocks, 0);
  particles_.clear();
  per_force_ = 0;
  for (auto& axis : acceleration_) axis.assign(blocks * block, 0);
  for (std::uint32_t k = 0; k < id.size(); ++k) {
    if (first_[k] == first_[k + 1]) continue;
    particles_.push_back(k);
    on_[k / block] = 1;
  }
}

template <class Real>
void LoadLists<Real>::find(std::span<const LoadAt> loads, const BlockState<Real>& state,
                           const Units& units, bool stepping) {
  const double per_force = units.time * units.time / (mass_ * units.length);
  bool changed = per_force != per_force_;
  per_force_ = per_force;
  for (std::size_t n = 0; n < given_.size(); ++n)
    if (now_[n].find(
            loads[n], [&](std::size_t k) { return state.position(places_[n][k], units); },
            stepping))
      changed = true;
  if (!changed) return;
  const auto on_all = [&](std::size_t count, const auto& each) {
    parallel_for(count, particles_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t at = begin; at < end; ++at) each(at);
    });
  };
  for (auto& axis : acceleration_)
    on_all(particles_.size(), [&](std::size_t at) { axis[particles_[at]] = 0; });
  for (std::size_t n = 0; n < given_.size(); ++n)
    on_all(places_[n].size(), [&](std::size_t at) {
      const Vec3 more = per_force * now_[n].force(at);
      for (std::size_t axis = 0; axis < 3; ++axis)
        acceleration_[axis][places_[n][at]] += static_cast<Real>(more[static_cast<int>(axis)]);
    });
}

template <class Real>
kernel::Loads<Real> LoadLists<Real>::arrays() const {
  if (on_.empty()) return {};
  return {on_.data(), {acceleration_[0].data(), acceleration_[1].data(), acceleration_[2].data()}};
}

template <class Real>
Vec3 LoadLists<Real>::force(std::size_t k) const {
  Vec3 sum = Vec3::Zero();
  if (first_.empty()) return sum;
  for (std::uint32_t n = first_[k]; n < first_[k + 1]; ++n)
    sum += now_[loaded_[n].load].force(loaded_[n].place);
  return sum;
}

template <class Real>
void LoadLists<Real>::add(std::size_t k, const Vec3& position, const Vec3& velocity,
                          std::span<Reaction> load_reactions) const {
  if (first_.empty()) return;
  for (std::uint32_t n = first_[k]; n < first_[k + 1]; ++n) {
    const auto& [load, place] = loaded_[n];
    const Vec3 force = now_[load].force(place), arm = position - given_[load].pivot;
    load_reactions[load] += {force, arm.cross(force), force.dot(velocity)};
  }
}

template <class Real>
double LoadLists<Real>::sizes() const {
  double sum = 0;
  for (const LoadNow& load : now_) sum += load.size();
  return sum;
}

template class LoadLists<double>;
template class LoadLists<float>;

}  // namespace sinew
