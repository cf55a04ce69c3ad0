// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/angular_velocity/clipped_baseline.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/detail/recording_check.hpp"
#include "tumble/angular_velocity/detail/truncated_normal.hpp"
#include "tumble/common/detail/scalar_update.hpp"

namespace tumble::baselines {

namespace {

// Axis contains the data of one gyro axis: readings, saturation flags and noise variance.
struct Axis {
  std::span<const ImuSample> samples;
  std::vector<bool> clipped;    ///< saturated
  std::vector<bool> overflown;  ///< clipped beyond the limit: the reading contains no information
  int index = 0;
  double variance = 0.0;  ///< variance of an unclipped reading

  double time_s(std::size_t k) const { return seconds(samples[k].time_ns - samples.front().time_ns); }
  double reading(std::size_t k) const { return samples[k].angular_velocity_rad_s[index]; }
};

struct Value {
  double rate = 0.0, variance = 0.0;
};

// Evaluates the cubic Hermite polynomial between two samples, whose derivatives are given.
double cubic(double share, double span_s, double from, double slope_from, double to, double slope_to) {
  const double u = share, u2 = u * u, u3 = u2 * u;
  return (2.0 * u3 - 3.0 * u2 + 1.0) * from + (u3 - 2.0 * u2 + u) * span_s * slope_from + (3.0 * u2 - 2.0 * u3) * to +
         (u3 - u2) * span_s * slope_to;
}

// Returns the derivative of the rate at sample k, the last before a gap (step -1) or the first after a gap (step +1).
// Returns 0 if the neighbouring sample outside the gap is clipped or missing.
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
      // A cubic has no variance. The distance between cubic and clipped reading serves as standard deviation.
      const double departure = out[k].rate - axis.reading(k);
      out[k].variance = axis.variance + departure * departure;
    }
    first = last;
  }
  return out;
}

// RandomWalk models the angular rate of one axis as a random walk.
struct RandomWalk {
  static constexpr int kSize = 1;
  using Matrix = Eigen::Matrix<double, 1, 1>;
  double psd = 0.0;

  Matrix start() const { return Matrix(1e4); }
  Matrix transition(double) const { return Matrix(1.0); }
  Matrix noise(double dt_s, const Matrix&) const { return Matrix(psd * dt_s); }
};

// BoundedJerk models the angular rate of one axis by a stationary Gaussian process with Matern 5/2 covariance. The
// state of the Matern 5/2 process is rate, acceleration and jerk (Hartikainen and Saerkkae 2010, section 4).
struct BoundedJerk {
  static constexpr int kSize = 3;
  using Matrix = Eigen::Matrix3d;
  double lambda = 1.0, variance = 1.0;

  BoundedJerk(double psd, double sigma)
      : lambda(std::pow(3.0 * psd / (16.0 * sigma * sigma), 0.2)), variance(sigma * sigma) {}

  Matrix start() const {
    const double middle = lambda * lambda * variance / 3.0;
    Matrix P;
    P << variance, 0.0, -middle, 0.0, middle, 0.0, -middle, 0.0, lambda * lambda * lambda * lambda * variance;
    return P;
  }
  // Returns the state transition matrix exp(A t), where all three eigenvalues of the companion matrix A are -lambda.
  Matrix transition(double dt_s) const {
    Matrix N;
    N << lambda, 1.0, 0.0, 0.0, lambda, 1.0, -lambda * lambda * lambda, -3.0 * lambda * lambda, -2.0 * lambda;
    return std::exp(-lambda * dt_s) * (Matrix::Identity() + dt_s * N + 0.5 * dt_s * dt_s * N * N);
  }
  Matrix noise(double, const Matrix& F) const { return start() - F * start() * F.transpose(); }
};

// Chain estimates the rate of one axis by a Kalman filter and smoother for a linear Gaussian process. By default, Chain
// ignores clipped readings. If `bounds` is set, each clipped reading adds one Gaussian measurement.
template <typename Process>
class Chain {
 public:
  static constexpr int N = Process::kSize;
  using Matrix = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, N, 1>;

  Chain(const Axis& axis, const Process& process, std::span<const GaussianSite> bounds)
      : axis_(axis), process_(process), after_(axis.samples.size()) {
    Moment now{Vector::Zero(), process.start()};
    for (std::size_t k = 0; k < after_.size(); ++k) {
      if (k > 0) now = predict(now, step_s(k - 1));
      if (!axis.clipped[k]) {
        update(now, axis.reading(k), axis.variance);
      } else if (!bounds.empty() && bounds[k].precision > 0.0) {
        update(now, bounds[k].shift / bounds[k].precision, 1.0 / bounds[k].precision);
      }
      after_[k] = now;
    }
  }

  // Returns the rate at each sample, estimated from all readings up to this sample.
  std::vector<Value> filtered() const { return values(after_); }

  // Returns the rate at each sample, estimated from all readings (Rauch, Tung and Striebel 1965).
  std::vector<Value> smoothed() const {
    std::vector<Moment> out = after_;
    for (std::size_t k = out.size() - 1; k-- > 0;) {
      const Matrix F = process_.transition(step_s(k));
      const Moment ahead = predict(after_[k], step_s(k));
      const Matrix gain = ahead.covariance.ldlt().solve(F * after_[k].covariance).transpose();
      out[k].mean += gain * (out[k + 1].mean - ahead.mean);
      out[k].covariance += gain * (out[k + 1].covariance - ahead.covariance) * gain.transpose();
    }
    return values(out);
  }

 private:
  struct Moment {
    Vector mean;
    Matrix covariance;
  };

  double step_s(std::size_t k) const { return axis_.time_s(k + 1) - axis_.time_s(k); }

  Moment predict(const Moment& from, double dt_s) const {
    const Matrix F = process_.transition(dt_s);
    return {F * from.mean, F * from.covariance * F.transpose() + process_.noise(dt_s, F)};
  }

  void update(Moment& now, double reading, double variance) const {
    now.mean += component_update(0, reading - now.mean[0], variance, now.covariance);
  }

  std::vector<Value> values(const std::vector<Moment>& moments) const {
    std::vector<Value> out(moments.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k] = {moments[k].mean[0], std::max(moments[k].covariance(0, 0), 1e-3 * axis_.variance)};
    }
    return out;
  }

  const Axis& axis_;
  const Process& process_;
  std::vector<Moment> after_;
};

// Computes the most likely rate curve whose magnitude is at least that of every clipped reading. Each iteration smooths
// the curve, then adds a hard limit where the curve is below a clipped reading. The reported variance belongs to the
// curve without limits, truncated at the clipped reading.
std::vector<Value> smooth_with_bounds(const Axis& axis, const ClippedBaseline::Params& params) {
  constexpr int kRounds = 8;
  const BoundedJerk process(params.snap_psd, params.rate_sigma_rad_s);
  std::vector<GaussianSite> active(axis.samples.size());
  std::vector<Value> values = Chain<BoundedJerk>(axis, process, active).smoothed();
  std::vector<double> variances(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double side = std::copysign(1.0, axis.reading(k));
    const NormalMoments free{side * values[k].rate, values[k].variance};
    const bool bound = axis.clipped[k] && !axis.overflown[k];
    variances[k] =
        bound ? truncated_below(free, std::abs(axis.reading(k)), axis.variance).variance : values[k].variance;
  }
  for (int round = 0; round < kRounds; ++round) {
    bool moved = false;
    for (std::size_t k = 0; k < active.size(); ++k) {
      if (!axis.clipped[k] || axis.overflown[k]) continue;
      const double beyond = std::copysign(1.0, axis.reading(k)) * (values[k].rate - axis.reading(k));
      const bool standing = active[k].precision > 0.0;
      if (standing ? beyond <= 0.0 : beyond >= 0.0) continue;
      active[k] = standing ? GaussianSite{} : GaussianSite{1.0 / axis.variance, axis.reading(k) / axis.variance};
      moved = true;
    }
    if (!moved) break;
    values = Chain<BoundedJerk>(axis, process, active).smoothed();
  }
  for (std::size_t k = 0; k < values.size(); ++k) values[k].variance = std::max(variances[k], 1e-3 * axis.variance);
  return values;
}

std::vector<Value> bridge(const Axis& axis, const ClippedBaseline::Params& params) {
  switch (params.kind) {
    case ClippedBaseline::Kind::interpolate:
      return interpolate(axis);
    case ClippedBaseline::Kind::reject:
      return Chain<RandomWalk>(axis, {params.acceleration_psd}, {}).filtered();
    case ClippedBaseline::Kind::constant_jerk:
      return smooth_with_bounds(axis, params);
  }
  return {};
}

}  // namespace

ClippedBaseline::ClippedBaseline(const Params& params)
    : params_(params), rails_({.axis_aligned_rails = params.rails, .tilted = params.tilted_rails}) {
  require_valid_fields(params);
}

Status ClippedBaseline::estimate(std::span<const ImuSample> samples, std::vector<RateState>& out) const {
  if (Status status = check_recording(samples, 2, params_.gap_max_s); !status.ok()) return status;
  const std::size_t count = samples.size();
  const std::vector<Clipping> clippings = rails_.find(samples).clippings;

  out.assign(count, {});
  Axis axis{samples, std::vector<bool>(count), std::vector<bool>(count), 0,
            params_.gyro_noise_density * params_.gyro_noise_density / median_period_s(samples)};
  for (axis.index = 0; axis.index < 3; ++axis.index) {
    const int bit = 1 << axis.index;
    for (std::size_t k = 0; k < count; ++k) {
      axis.overflown[k] = (clippings[k].unusable_gyro & bit) != 0;
      axis.clipped[k] = axis.overflown[k] || (clippings[k].gyro & bit) != 0;
    }
    const std::vector<Value> values = bridge(axis, params_);
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
    out[k].source = out[k].clipped_axes == 0 ? RateSource::measured : RateSource::bounded_only;
  }
  return {};
}

}  // namespace tumble::baselines
