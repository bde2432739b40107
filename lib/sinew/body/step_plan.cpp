// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/body/step_plan.h>

#include <algorithm>
#include <utility>

namespace sinew {

StepPlan::StepPlan(double step, int per_interval, std::vector<int> parts,
                   std::optional<WholeSteps> last)
    : step_(step), per_interval_(per_interval), parts_(std::move(parts)), last_(last) {
  if (max_parts() == 1 && !last_) return;
  first_ = {0};
  for (const int count : parts_)
    first_.push_back(first_.back() + std::int64_t{count} * per_interval_);
  if (last_) first_.back() = first_.end()[-2] + std::int64_t{parts_.back()} * last_->count;
}

std::size_t StepPlan::interval_of(std::int64_t n) const {
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), n) -
                                  first_.begin() - 1);
}

double StepPlan::whole_step(std::size_t interval) const {
  return last_ && interval + 1 == parts_.size() ? last_->step : step_;
}

double StepPlan::step(std::int64_t n) const {
  if (is_even()) return step_;
  const std::size_t index = interval_of(n);
  return whole_step(index) / parts(static_cast<int>(index));
}

double StepPlan::time(std::int64_t n) const {
  if (is_even()) return static_cast<double>(n) * step_;
  const std::size_t index = interval_of(n), whole_ones = parts_.size() - (last_ ? 1 : 0);
  const double within = static_cast<double>(n - first_[index]) / parts(static_cast<int>(index));
  const auto whole_until = [&](std::size_t interval) {
    return static_cast<double>(per_interval_) * static_cast<double>(interval);
  };
  if (!last_ || index < whole_ones) return (whole_until(index) + within) * step_;
  const double until = whole_until(whole_ones) * step_;
  if (index == whole_ones) return until + within * last_->step;
  return until + last_->count * last_->step + within * step_;
}

std::int64_t StepPlan::steps_until(int index) const {
  if (is_even()) return std::int64_t{index} * per_interval_;
  const auto known = std::min(static_cast<std::size_t>(index), parts_.size());
  return first_[known] + (std::int64_t{index} - static_cast<std::int64_t>(known)) * per_interval_;
}

int StepPlan::intervals_begun(std::int64_t n) const {
  if (is_even()) return static_cast<int>((n + per_interval_ - 1) / per_interval_);
  const auto known = std::lower_bound(first_.begin(), first_.end(), n) - first_.begin();
  if (known < static_cast<std::ptrdiff_t>(first_.size())) return static_cast<int>(known);
  return static_cast<int>(static_cast<std::int64_t>(parts_.size()) +
                          (n - first_.back() + per_interval_ - 1) / per_interval_);
}

StepPlan StepPlan::divided(const std::vector<int>& by) const {
  std::vector<int> parts = parts_;
  parts.resize(std::max(parts.size(), by.size()), 1);
  for (std::size_t index = 0; index < by.size(); ++index) parts[index] *= by[index];
  return {step_, per_interval_, std::move(parts), last_};
}

int StepPlan::parts(int index) const {
  return static_cast<std::size_t>(index) < parts_.size() ? parts_[static_cast<std::size_t>(index)]
                                                         : 1;
}

int StepPlan::max_parts() const {
  return parts_.empty() ? 1 : *std::max_element(parts_.begin(), parts_.end());
}

int StepPlan::divided() const {
  return static_cast<int>(
      std::count_if(parts_.begin(), parts_.end(), [](int count) { return count > 1; }));
}

}  // namespace sinew
