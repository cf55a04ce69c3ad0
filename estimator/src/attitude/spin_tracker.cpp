// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/spin_tracker.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tumble/attitude/detail/regimes.hpp"
#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/detail/squared.hpp"

namespace tumble {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kRate = 0, kAcceleration = 1, kWorld = 2, kBody = 4;
constexpr double kReading_s = 0.01;           // time within which vibration is correlated
constexpr double kScaleMemory_s = 0.5;        // averaging time of the variance ratio
constexpr double kVarianceRatioMax = 1e3;     // bounds of the variance ratio
constexpr double kGapMax_s = 0.5;             // the spin restarts after a longer gap
constexpr double kAxisHysteresis = 1.2;       // ratio of two rates at which the spin axis changes
constexpr double kReadingSigma_rad_s = 0.02;  // of an unsaturated reading
constexpr double kRailSigma_rad_s = 0.1;      // of a lower bound
constexpr double kStartSigma_rad_s = 1.0, kStartSigma_rad_s2 = 10.0, kStartSaturatedRatio = 0.5;
constexpr double kStartProbability = 0.01;
constexpr double kRatioSigma = 0.01;  // of (frequency of the modulation / rate of the spin): the body is not a thin rod
constexpr double kProbabilityMax = 1.0 - 1e-12;
constexpr double kLogRatioMax = 50.0;  // avoids overflow of the likelihood ratio of one sample

using Observation = Eigen::Matrix<double, 2, 6>;

Observation observation() {
  Observation out = Observation::Zero();
  out.block<2, 2>(0, kWorld).setIdentity();
  out.block<2, 2>(0, kBody).setIdentity();
  return out;
}

bool is_set(std::uint8_t axes, int axis) {
  return (axes >> axis & 1u) != 0;
}

// Returns the two gyro axes across the spin axis, in the order of a right-handed frame.
Vector2d across(const Eigen::Vector3d& v, int axis) {
  return {v[(axis + 1) % 3], v[(axis + 2) % 3]};
}

// Returns the probability of a change between spin and other motion: carried.md (C49).
double change(double changes_hz, double dt_s) {
  return 1.0 - std::exp(-changes_hz * dt_s);
}

}  // namespace

struct SpinTracker::Prediction {
  Vector x;
  Matrix P, F;
};

/// Recorded contains what smooth() needs of one sample.
struct SpinTracker::Recorded {
  Prediction predicted;
  Filter filter;
  double probability = 0.0;  // from earlier samples
  double likelihood_ratio = 1.0, change = 0.0;
  bool first = false;  // first sample of a spin
};

SpinTracker::SpinTracker(const Params& params) : params_(params) {
  require_valid_fields(params);
}

// Selects the gyro axis of the spin. Returns whether a spin starts at this sample.
bool SpinTracker::select_axis(const ImuSample& sample, std::uint8_t saturated_axes, State& state) const {
  const Eigen::Vector3d size = sample.angular_velocity_rad_s.cwiseAbs();
  Eigen::Index largest = 0;
  size.maxCoeff(&largest);
  const bool continues = state.axis >= 0 && seconds(sample.time_ns - state.time_ns) <= kGapMax_s &&
                         size[state.axis] >= params_.rate_min_rad_s &&
                         size[largest] <= kAxisHysteresis * size[state.axis];
  if (continues) return false;
  state.axis = size[largest] >= params_.rate_min_rad_s ? static_cast<int>(largest) : -1;
  if (state.axis < 0) return false;
  Filter start;
  start.x[kRate] = sample.angular_velocity_rad_s[state.axis];
  start.x.segment<2>(kBody) = across(sample.angular_velocity_rad_s, state.axis);
  start.P.diagonal().setConstant(squared(kStartSigma_rad_s));
  start.P(kAcceleration, kAcceleration) = squared(kStartSigma_rad_s2);
  if (is_set(saturated_axes, state.axis)) start.P(kRate, kRate) = squared(kStartSaturatedRatio * start.x[kRate]);
  state.spin = state.independent = start;
  state.probability = state.measured_probability = kStartProbability;
  return true;
}

// Predicts the state of a filter over `dt_s`: carried.md (C46). In the axes of the body, a vector that is constant in
// the world turns by minus the angle of the spin. `turning` is 1 if the filter assumes a steady spin, and 0 if not.
SpinTracker::Prediction SpinTracker::predict(const Filter& filter, double turning, double dt_s) const {
  const Vector& x = filter.x;
  const double angle = -turning * dt_s * (x[kRate] + 0.5 * dt_s * x[kAcceleration]);
  const double c = std::cos(angle), s = std::sin(angle);
  const Matrix2d turn = (Matrix2d() << c, -s, s, c).finished();
  const Vector2d by_angle = (Matrix2d() << -s, -c, c, -s).finished() * x.segment<2>(kWorld);
  Prediction out;
  out.F.setIdentity();
  out.F(kRate, kAcceleration) = dt_s;
  out.F.block<2, 2>(kWorld, kWorld) = turn;
  out.F.block<2, 1>(kWorld, kRate) = -turning * dt_s * by_angle;
  out.F.block<2, 1>(kWorld, kAcceleration) = -0.5 * turning * dt_s * dt_s * by_angle;
  out.x = x;
  out.x[kRate] += dt_s * x[kAcceleration];
  out.x.segment<2>(kWorld) = turn * x.segment<2>(kWorld);
  out.P = out.F * filter.P * out.F.transpose();
  const double jerk = squared(params_.jerk_rad_s3_sqrts) * dt_s;
  out.P(kRate, kRate) += jerk * dt_s * dt_s / 3.0;
  out.P(kRate, kAcceleration) += 0.5 * jerk * dt_s;
  out.P(kAcceleration, kRate) += 0.5 * jerk * dt_s;
  out.P(kAcceleration, kAcceleration) += jerk;
  out.P.diagonal().tail<4>().array() += filter.variance_ratio * squared(params_.walk_rad_s_sqrts) * dt_s;
  return out;
}

// Updates a filter with the readings of one sample, and returns the log likelihood of the rate across the spin axis:
// carried.md (C47), (C48).
double SpinTracker::update(const Prediction& predicted, const ImuSample& sample, std::uint8_t saturated_axes, int axis,
                           double dt_s, Filter& filter) const {
  filter.x = predicted.x;
  filter.P = predicted.P;
  double log_likelihood = 0.0;
  if ((saturated_axes & ~(1u << axis)) == 0) {
    const Observation H = observation();
    const Vector2d innovation = across(sample.angular_velocity_rad_s, axis) - H * filter.x;
    const double variance =
        filter.variance_ratio * squared(params_.vibration_rad_s) * std::max(1.0, kReading_s / std::max(dt_s, 1e-6));
    const Matrix2d noise = variance * Matrix2d::Identity();
    const Matrix2d S = H * filter.P * H.transpose() + noise;
    const double squared_norm = innovation.dot(S.inverse() * innovation);
    log_likelihood = -0.5 * (squared_norm + std::log(S.determinant()));
    filter.x += vector_update<2, 6>(H, innovation, noise, filter.P);
    const double ratio = 1.0 + std::min(1.0, dt_s / kScaleMemory_s) * (0.5 * squared_norm - 1.0);
    filter.variance_ratio = std::clamp(ratio * filter.variance_ratio, 1.0 / kVarianceRatioMax, kVarianceRatioMax);
  }
  const double reading = sample.angular_velocity_rad_s[axis], innovation = reading - filter.x[kRate];
  const bool saturated = is_set(saturated_axes, axis);
  // A saturated reading is a lower bound of the rate, so it corrects only a smaller estimate. After an overflow, the
  // reading has the wrong sign and no information.
  if (!saturated || (innovation * reading > 0.0 && filter.x[kRate] * reading > 0.0)) {
    const double sigma = saturated ? kRailSigma_rad_s : kReadingSigma_rad_s;
    filter.x += component_update<6>(kRate, innovation, squared(sigma), filter.P);
  }
  filter.P = (0.5 * (filter.P + filter.P.transpose())).eval();
  return log_likelihood;
}

SpinRate SpinTracker::advance(const ImuSample& sample, std::uint8_t saturated_axes, State& state,
                              Recorded* recorded) const {
  const bool first = select_axis(sample, saturated_axes, state);
  const double dt_s = first ? 0.0 : seconds(sample.time_ns - state.time_ns);
  state.time_ns = sample.time_ns;
  if (state.axis < 0) return {};
  const double changed = change(params_.changes_hz, dt_s);
  double ratio = 1.0;
  if (!first && dt_s > 0.0) {
    const Prediction predicted = predict(state.spin, 1.0, dt_s);
    const double log_ratio =
        update(predicted, sample, saturated_axes, state.axis, dt_s, state.spin) -
        update(predict(state.independent, 0.0, dt_s), sample, saturated_axes, state.axis, dt_s, state.independent);
    ratio = std::exp(std::clamp(std::min(1.0, dt_s / params_.memory_s) * log_ratio, -kLogRatioMax, kLogRatioMax));
    const double spins = state.probability * (1.0 - changed) + (1.0 - state.probability) * changed;
    state.probability = std::min(kProbabilityMax, spins * ratio / (spins * ratio + 1.0 - spins));
    // During saturation, some spin rate explains any rate across the spin axis, so saturated samples can only
    // contradict a steady spin.
    if (!is_set(saturated_axes, state.axis)) {
      state.measured_probability = state.probability;
    } else if (state.probability > state.measured_probability) {
      state.probability = state.measured_probability;
      ratio = state.probability / (1.0 - state.probability) * (1.0 - spins) / spins;
    }
    if (recorded != nullptr) recorded->predicted = predicted;
  }
  if (recorded != nullptr) {
    recorded->filter = state.spin;
    recorded->probability = state.probability;
    recorded->likelihood_ratio = ratio;
    recorded->change = changed;
    recorded->first = first;
  }
  return {state.axis, state.spin.x[kRate], state.spin.P(kRate, kRate) + squared(kRatioSigma * state.spin.x[kRate]),
          state.probability, is_set(saturated_axes, state.axis)};
}

SpinRate SpinTracker::step(const ImuSample& sample, std::uint8_t saturated_axes, State& state) const {
  return advance(sample, saturated_axes, state, nullptr);
}

std::vector<SpinRate> SpinTracker::smooth(std::span<const ImuSample> samples,
                                          std::span<const std::uint8_t> saturated_axes) const {
  std::vector<SpinRate> out(samples.size());
  std::vector<Recorded> run;
  State state;
  const auto smooth_run = [&](std::size_t end) {
    smooth(run, std::span(out).subspan(end - run.size(), run.size()));
    run.clear();
  };
  for (std::size_t k = 0; k < samples.size(); ++k) {
    Recorded recorded;
    out[k] = advance(samples[k], saturated_axes[k], state, &recorded);
    if (out[k].axis < 0 || recorded.first) smooth_run(k);
    if (out[k].axis >= 0) run.push_back(recorded);
  }
  smooth_run(samples.size());
  return out;
}

// Smooths one spin: a backward pass over the states (Rauch, Tung, Striebel, AIAA Journal 3, 1965), and the backward
// recursion of carried.md (C38) for the probabilities.
void SpinTracker::smooth(std::span<const Recorded> run, std::span<SpinRate> out) const {
  if (run.empty()) return;
  Vector x = run.back().filter.x;
  Matrix P = run.back().filter.P;
  Vector2d backward = Vector2d::Ones();  // spin, other motion
  for (std::size_t k = run.size() - 1; k-- > 0;) {
    const Recorded& next = run[k + 1];
    const Matrix gain = next.predicted.P.ldlt().solve(next.predicted.F * run[k].filter.P).transpose();
    x = (run[k].filter.x + gain * (x - next.predicted.x)).eval();
    P = (run[k].filter.P + gain * (P - next.predicted.P) * gain.transpose()).eval();
    out[k].rate_rad_s = x[kRate];
    out[k].variance_rad2_s2 = std::max(0.0, P(kRate, kRate)) + squared(kRatioSigma * x[kRate]);
    const double spins = next.likelihood_ratio * backward[0], other = backward[1], c = next.change;
    backward = Vector2d((1.0 - c) * spins + c * other, c * spins + (1.0 - c) * other);
    backward /= backward.sum();
    const double both = run[k].probability * backward[0];
    out[k].probability = both / (both + (1.0 - run[k].probability) * backward[1]);
  }
}

RateState SpinTracker::combine(const RateState& rate, const SpinRate& spin, bool further_imus) const {
  if (spin.axis < 0 || !spin.saturated || spin.probability < params_.probability_min) return rate;
  if (further_imus && rate.covariance_rad2_s2(spin.axis, spin.axis) < spin.variance_rad2_s2) return rate;
  RateState spinning = rate;
  spinning.w_WI_I_rad_s[spin.axis] = spin.rate_rad_s;
  spinning.covariance_rad2_s2.row(spin.axis).setZero();
  spinning.covariance_rad2_s2.col(spin.axis).setZero();
  spinning.covariance_rad2_s2(spin.axis, spin.axis) = spin.variance_rad2_s2;
  return mix_rate_states(rate, spinning, spin.probability);
}

}  // namespace tumble
