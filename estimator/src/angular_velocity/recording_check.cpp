// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/recording_check.hpp"

#include <algorithm>
#include <vector>

#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

Status check_recording(std::span<const ImuSample> samples, std::size_t count_min, double gap_max_s) {
  if (samples.empty()) return {ErrorCode::empty, "samples", 0.0, 1.0};
  if (samples.size() < count_min) {
    return {ErrorCode::insufficient_data, "samples", static_cast<double>(samples.size()),
            static_cast<double>(count_min)};
  }
  return check_samples(samples, gap_max_s);
}

double median_period_s(std::span<const ImuSample> samples) {
  std::vector<TimeNs> steps(samples.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = samples[k + 1].time_ns - samples[k].time_ns;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return std::clamp(seconds(steps[steps.size() / 2]), 1e-6, 10.0);
}

}  // namespace tumble
