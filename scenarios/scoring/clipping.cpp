// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/clipping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/reference_clipping.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kToleranceMinRadS = 1e-6;

double noise_rad_s(const sim::ImuRecord& record) {
  return record.period_ns > 0
             ? record.gyro_noise_rad_s_sqrt_hz / std::sqrt(1e-9 * static_cast<double>(record.period_ns))
             : 0.0;
}

}  // namespace

ClippingTruth::ClippingTruth(const sim::Sensors& sensors, const sim::Truth& truth) {
  if (sensors.imus.empty() || truth.imus.empty())
    throw BadInput("the recording or the truth has no IMU, so rates cannot be scored");
  record_ = &sensors.imus.front();
  truth_ = &truth.imus.front();
  tolerance_rad_s_ = std::max(kToleranceMinRadS, noise_rad_s(*record_));
  const std::size_t count = record_->time_ns.size();
  if (truth_->rate_rad_s.empty() && count > 0)
    throw BadInput(fmt::format(
        "the truth has no rates of imu '{}'; the truth may be a reference that contains only poses", record_->name));
  const bool reference = truth_->gyro_unclipped_rad_s.empty() && count > 0;
  if (record_->gyro_rad_s.size() != count || truth_->rate_rad_s.size() != count ||
      (!reference && truth_->gyro_unclipped_rad_s.size() != count)) {
    throw BadInput(fmt::format("imu '{}' and its truth have different numbers of samples; the numbers must be equal",
                               record_->name));
  }
  for (std::size_t i = 0; i < truth_->gyro_elements.size() && i < 3; ++i)
    elements_.row(static_cast<Eigen::Index>(i)) = truth_->gyro_elements[i].transpose();
  if (reference) reference_axes_ = clipped_by_reference(record_->gyro_rad_s, truth_->rate_rad_s);
}

std::size_t ClippingTruth::known_samples() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < size(); ++i) count += known(i) ? 1 : 0;
  return count;
}

Eigen::Vector3d ClippingTruth::lost_rad_s(std::size_t index) const {
  const auto& unclipped = is_reference() ? truth_->rate_rad_s : truth_->gyro_unclipped_rad_s;
  return unclipped[index] - record_->gyro_rad_s[index];
}

std::uint8_t ClippingTruth::beyond_tolerance(const Eigen::Vector3d& lost_rad_s) const {
  std::uint8_t axes = 0;
  for (int j = 0; j < 3; ++j) {
    if (!(std::abs(lost_rad_s[j]) <= tolerance_rad_s_)) axes = static_cast<std::uint8_t>(axes | (1u << j));
  }
  return axes;
}

std::uint8_t ClippingTruth::clipped_axes(std::size_t index) const {
  if (is_reference()) return reference_axes_[index];
  return beyond_tolerance(elements_ * lost_rad_s(index));
}

std::uint8_t ClippingTruth::cross_axes(std::size_t index) const {
  if (is_reference()) return 0;
  const std::uint8_t clipped = clipped_axes(index);
  if (clipped == 0) return 0;
  return static_cast<std::uint8_t>(beyond_tolerance(lost_rad_s(index)) & ~clipped);
}

double ClippingTruth::depth_rad_s(std::size_t index) const {
  return lost_rad_s(index).lpNorm<Eigen::Infinity>();
}

std::optional<std::size_t> ClippingTruth::index_at(std::int64_t time_ns) const {
  const auto& times = record_->time_ns;
  const auto found = std::lower_bound(times.begin(), times.end(), time_ns);
  if (found == times.end() || (found == times.begin() && *found != time_ns)) return std::nullopt;
  return static_cast<std::size_t>(found - times.begin());
}

std::optional<ClippingTruth::Sample> ClippingTruth::at(std::int64_t time_ns) const {
  const auto& times = record_->time_ns;
  const std::optional<std::size_t> found = index_at(time_ns);
  if (!found) return std::nullopt;
  const std::size_t index = *found;
  if (!known(index) || (times[index] != time_ns && !known(index - 1))) return std::nullopt;
  if (times[index] == time_ns) return Sample{truth_->rate_rad_s[index], clipped_axes(index), cross_axes(index)};
  const double share =
      static_cast<double>(time_ns - times[index - 1]) / static_cast<double>(times[index] - times[index - 1]);
  return Sample{(1.0 - share) * truth_->rate_rad_s[index - 1] + share * truth_->rate_rad_s[index], clipped_axes(index),
                cross_axes(index)};
}

}  // namespace tumble::scenarios
