// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/angular_velocity/clipped_baseline.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tumble/common/detail/sample_check.hpp"

namespace tumble::baselines {

namespace {

struct Axis {
  std::span<const ImuSample> samples;
  std::vector<bool> clipped;
  std::vector<bool> overflown;  ///< the reading exceeded the representable range and is unusable
  int index = 0;
  double variance = 0.0;

  double time_s(std::size_t k) const { return seconds(samples[k].time_ns - samples.front().time_ns); }
  double reading(std::size_t k) const { return samples[k].angular_velocity_rad_s[index]; }
};

struct Value {
  double rate = 0.0, variance = 0.0;
};

double cubic(double share, double span_s, double from, double slope_from, double to, double slope_to) {
  const double u = share, u2 = u * u, u3 = u2 * u;
  return (2.0 * u3 - 3.0 * u2 + 1.0) * from + (u3 - 2.0 * u2 + u) * span_s * slope_from + (3.0 * u2 - 2.0 * u3) * to +
         (u3 - u2) * span_s * slope_to;
}

double slope_at(const Axis& axis, std::size_t k, int step) {
  if (step < 0 ? k == 0 : k + 1 == axis.samples.size()) return 0.0;
  const std::size_t other = step < 0 ? k - 1 : k + 1;
  if (axis.clipped[other]) return 0.0;
  return (axis.reading(other) - axis.reading(k)) / (axis.time_s(other) - axis.time_s(k));
}

std::vector<Value> interpolate(const Axis& axis) {
  const std::size_t count = axis.samples.size();
  std::vector<Value> out(count);
  for (std::size_t k = 0; k < count; ++k) out[k] = {axis.reading(k), axis.variance};
  for (std::size_t first = 0; first < count;) {
    if (!axis.clipped[first]) {
      ++first;
      continue;
    }
    std::size_t last = first;
    while (last < count && axis.clipped[last]) ++last;
    for (std::size_t k = first; k < last && first > 0 && last < count; ++k) {
      const std::size_t a = first - 1, b = last;
      const double span_s = axis.time_s(b) - axis.time_s(a), share = (axis.time_s(k) - axis.time_s(a)) / span_s;
      out[k].rate =
          cubic(share, span_s, axis.reading(a), slope_at(axis, a, -1), axis.reading(b), slope_at(axis, b, +1));
      // The variance of an interpolated rate is the gyro noise variance plus the squared difference between the
      // interpolated rate and the clipped reading.
      const double departure = out[k].rate - axis.reading(k);
      out[k].variance = axis.variance + departure * departure;
    }
    first = last;
  }
  return out;
}

}  // namespace

ClippedBaseline::ClippedBaseline(const Params& params)
    : params_(params), rails_({.axis_limit_params = params.rails}, params.tilted_rails) {
  require_valid_fields(params);
}

Status ClippedBaseline::estimate(std::span<const ImuSample> samples, std::vector<AngularRateState>& out) const {
  if (Status status = check_recording(samples, 2, params_.gap_max_s); !status.ok()) return status;
  const std::size_t count = samples.size();
  const std::vector<Clipping> clippings = rails_.find(samples).clipping_per_sample;

  out.assign(count, {});
  Axis axis{samples, std::vector<bool>(count), std::vector<bool>(count), 0,
            params_.gyro_noise_density * params_.gyro_noise_density / median_period_s(samples)};
  for (axis.index = 0; axis.index < 3; ++axis.index) {
    const int bit = 1 << axis.index;
    for (std::size_t k = 0; k < count; ++k) {
      axis.overflown[k] = (clippings[k].unusable_gyro & bit) != 0;
      axis.clipped[k] = axis.overflown[k] || (clippings[k].gyro & bit) != 0;
    }
    const std::vector<Value> values = interpolate(axis);
    for (std::size_t k = 0; k < count; ++k) {
      double rate = axis.reading(k);
      if ((clippings[k].unusable_gyro & bit) != 0) {
        rate = std::clamp(values[k].rate, -params_.rate_max_rad_s, params_.rate_max_rad_s);
      } else if (axis.clipped[k]) {
        const double low = std::abs(rate), side = std::copysign(1.0, rate);
        rate = side * std::clamp(side * values[k].rate, low, std::max(low, params_.rate_max_rad_s));
      }
      out[k].w_WI_I_rad_s[axis.index] = rate;
      out[k].covariance_rad2_s2(axis.index, axis.index) = axis.clipped[k] ? values[k].variance : axis.variance;
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    out[k].time_ns = samples[k].time_ns;
    out[k].clipped_axes = clippings[k].gyro | clippings[k].unusable_gyro;
    out[k].source = out[k].clipped_axes == 0 ? AngularRateSource::measured : AngularRateSource::lower_bound_only;
  }
  return {};
}

}  // namespace tumble::baselines
