// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/clipped_baseline.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "recording_check.hpp"

namespace tumble {

namespace {

// One axis of a recording: what was read, what of it is clipped, what comes out.
struct Axis {
  std::span<const ImuSample> samples;
  std::vector<bool> clipped;
  int index = 0;
  double variance = 0.0;  ///< of a free reading

  double time_s(std::size_t k) const { return seconds(samples[k].time_ns - samples.front().time_ns); }
  double reading(std::size_t k) const { return samples[k].angular_velocity_rad_s[index]; }
};

struct Value {
  double rate = 0.0, variance = 0.0;
};

// Cubic of Hermite between two samples with given slopes.
double cubic(double share, double span_s, double from, double slope_from, double to, double slope_to) {
  const double u = share, u2 = u * u, u3 = u2 * u;
  return (2.0 * u3 - 3.0 * u2 + 1.0) * from + (u3 - 2.0 * u2 + u) * span_s * slope_from + (3.0 * u2 - 2.0 * u3) * to +
         (u3 - u2) * span_s * slope_to;
}

// Slope of the free readings that end at k (step -1) or begin there (step +1); 0 where there is but one.
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
      // a cubic has no variance of its own: it is trusted as far as it departs from the reading
      const double departure = out[k].rate - axis.reading(k);
      out[k].variance = axis.variance + departure * departure;
    }
    first = last;
  }
  return out;
}

// White noise on derivative N of the rate: state (rate, ..., derivative N - 1).
template <int N>
class Chain {
 public:
  using Matrix = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, N, 1>;

  Chain(const Axis& axis, double psd) : axis_(axis), psd_(psd), after_(axis.samples.size()) {
    Moment now{Vector::Zero(), Matrix::Identity() * kUnknown};
    for (int i = 1; i < N; ++i) now.covariance(i, i) *= std::pow(kUnknown, i);
    for (std::size_t k = 0; k < after_.size(); ++k) {
      if (k > 0) now = predict(now, step_s(k - 1));
      if (!axis.clipped[k]) update(now, axis.reading(k));
      after_[k] = now;
    }
  }

  // With all readings up to the sample.
  std::vector<Value> filtered() const { return values(after_); }

  // With all readings (Rauch, Tung and Striebel 1965).
  std::vector<Value> smoothed() const {
    std::vector<Moment> out = after_;
    for (std::size_t k = out.size() - 1; k-- > 0;) {
      const Moment ahead = predict(after_[k], step_s(k));
      const Matrix gain = ahead.covariance.ldlt().solve(transition(step_s(k)) * after_[k].covariance).transpose();
      out[k].mean += gain * (out[k + 1].mean - ahead.mean);
      out[k].covariance += gain * (out[k + 1].covariance - ahead.covariance) * gain.transpose();
    }
    return values(out);
  }

 private:
  static constexpr double kUnknown =
      1e4;  // variance of a rate before anything is seen; of the next derivatives, powers
  struct Moment {
    Vector mean;
    Matrix covariance;
  };

  double step_s(std::size_t k) const { return axis_.time_s(k + 1) - axis_.time_s(k); }

  static Matrix transition(double dt_s) {
    Matrix F = Matrix::Identity();
    for (int i = 0; i < N; ++i) {
      for (int j = i + 1; j < N; ++j) F(i, j) = F(i, j - 1) * dt_s / (j - i);
    }
    return F;
  }

  Moment predict(const Moment& from, double dt_s) const {
    const Matrix F = transition(dt_s);
    Matrix Q;
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) {
        const int power = 2 * N - 1 - i - j;
        Q(i, j) = psd_ * std::pow(dt_s, power) / (std::tgamma(N - i) * std::tgamma(N - j) * power);
      }
    }
    return {F * from.mean, F * from.covariance * F.transpose() + Q};
  }

  void update(Moment& now, double reading) const {
    const Vector column = now.covariance.col(0);
    const double spread = column[0] + axis_.variance;
    now.mean += column * ((reading - now.mean[0]) / spread);
    now.covariance -= column * column.transpose() / spread;
  }

  std::vector<Value> values(const std::vector<Moment>& moments) const {
    std::vector<Value> out(moments.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k] = {moments[k].mean[0], std::max(moments[k].covariance(0, 0), 1e-3 * axis_.variance)};
    }
    return out;
  }

  const Axis& axis_;
  double psd_;
  std::vector<Moment> after_;
};

std::vector<Value> bridge(const Axis& axis, const ClippedBaseline::Params& params) {
  switch (params.kind) {
    case ClippedBaseline::Kind::interpolate:
      return interpolate(axis);
    case ClippedBaseline::Kind::reject:
      return Chain<1>(axis, params.acceleration_psd).filtered();
    case ClippedBaseline::Kind::constant_jerk:
      return Chain<3>(axis, params.snap_psd).smoothed();
  }
  return {};
}

}  // namespace

ClippedBaseline::ClippedBaseline(const Params& params) : params_(params), rails_(params.rails) {
  require_within("gyro_noise_density", params.gyro_noise_density, 1e-9, 1.0);
  require_within("acceleration_psd", params.acceleration_psd, 1e-12, 1e12);
  require_within("snap_psd", params.snap_psd, 1e-12, 1e15);
  require_within("rate_max_rad_s", params.rate_max_rad_s, 1.0, 1e4);
  require_within("gap_max_s", params.gap_max_s, 1e-6, 3600.0);
}

Status ClippedBaseline::estimate(std::span<const ImuSample> samples, std::vector<RateState>& out) const {
  if (Status status = check_recording(samples, 2, params_.gap_max_s); !status.ok()) return status;
  const std::size_t count = samples.size();
  std::vector<Clipping> clippings(count);
  RailDetector::State rails;
  rails_.classify_all(samples, rails, clippings);

  out.assign(count, {});
  Axis axis{samples, std::vector<bool>(count), 0,
            params_.gyro_noise_density * params_.gyro_noise_density / median_period_s(samples)};
  for (axis.index = 0; axis.index < 3; ++axis.index) {
    const int bit = 1 << axis.index;
    for (std::size_t k = 0; k < count; ++k) {
      axis.clipped[k] = ((clippings[k].gyro | clippings[k].void_gyro) & bit) != 0;
    }
    const std::vector<Value> values = bridge(axis, params_);
    for (std::size_t k = 0; k < count; ++k) {
      double rate = axis.reading(k);
      if ((clippings[k].void_gyro & bit) != 0) {
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
    out[k].clipped_axes = clippings[k].gyro | clippings[k].void_gyro;
    out[k].source = out[k].clipped_axes == 0 ? RateSource::measured : RateSource::bounded_only;
  }
  return {};
}

}  // namespace tumble
