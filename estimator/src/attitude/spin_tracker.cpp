// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/spin_tracker.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tumble/attitude/detail/regimes.hpp"
#include "tumble/common/detail/scalar_update.hpp"

namespace tumble {

namespace {

constexpr int kRate = 0;
constexpr double kRateMin_rad_s = 6.0;   // minimum rate of a steady spin
constexpr double kMemory_s = 0.2;        // readings within kMemory_s together count as one independent observation
constexpr double kChanges_hz = 0.02;     // assumed frequency of starts and ends of a steady spin
constexpr double kGapMax_s = 0.5;        // a new spin starts after a longer data gap
constexpr double kAxisHysteresis = 1.2;  // rate of another axis, relative to the spin axis, that changes the spin axis
constexpr double kStartProbability = 0.01;
// relative standard deviations of the spin rate from the gyro and from the accelerometer, due to precession of the spin
// axis
constexpr double kRatioSigma = 0.01, kForceRatioSigma = 0.02;
constexpr double kProbabilityMax = 1.0 - 1e-12;
constexpr double kLogRatioMax = 50.0;  // avoids overflow of the likelihood ratio of one sample

// Returns the probability of a change between spin and other motion: carried.md (C48).
double probability_of_change(double dt_s) {
  return 1.0 - std::exp(-kChanges_hz * dt_s);
}

template <int N>
struct RecordedSpin {
  SpinPrediction<N> predicted;
  SpinFilter<N> filter;
  double probability = 0.0;  // probability of a spin, estimated from the current and all earlier samples
  double likelihood_ratio = 1.0, spin_change_probability = 0.0;
};

// Smooths the states of one spin by a backward pass (Rauch, Tung, Striebel, AIAA Journal 3, 1965). A backward recursion
// smooths the probability of the spin: carried.md (C37).
template <int N>
void smooth_spin(std::span<const RecordedSpin<N>> run, std::span<SpinRate> out) {
  if (run.empty()) return;
  Eigen::Matrix<double, N, 1> x = run.back().filter.x;
  Eigen::Matrix<double, N, N> P = run.back().filter.covariance;
  Eigen::Vector2d backward = Eigen::Vector2d::Ones();  // backward likelihoods of spin and of other motion
  for (std::size_t k = run.size() - 1; k-- > 0;) {
    const RecordedSpin<N>& next = run[k + 1];
    const Eigen::Matrix<double, N, N> gain =
        next.predicted.covariance.ldlt().solve(next.predicted.transition_matrix * run[k].filter.covariance).transpose();
    x = (run[k].filter.x + gain * (x - next.predicted.x)).eval();
    P = (run[k].filter.covariance + gain * (P - next.predicted.covariance) * gain.transpose()).eval();
    out[k].rate_rad_s = x[kRate];
    out[k].variance_rad2_s2 = std::max(0.0, P(kRate, kRate));
    const double spins = next.likelihood_ratio * backward[0], other = backward[1], c = next.spin_change_probability;
    backward = Eigen::Vector2d((1.0 - c) * spins + c * other, c * spins + (1.0 - c) * other);
    backward /= backward.sum();
    const double both = run[k].probability * backward[0];
    out[k].probability = both / (both + (1.0 - run[k].probability) * backward[1]);
  }
}

// Returns the estimate of the more probable spin model, `modulation` or `force`. If the body has several IMUs, `force`
// is not used, because the rates already depend on all specific forces.
SpinRate select_spin(const SpinRate& modulation, const SpinRate& force, bool further_imus) {
  const bool by_force = !further_imus && force.probability > modulation.probability;
  SpinRate out = by_force ? force : modulation;
  out.variance_rad2_s2 += squared((by_force ? kForceRatioSigma : kRatioSigma) * out.rate_rad_s);
  return out;
}

}  // namespace

SpinTracker::SpinTracker(const Params& params) : params_(params) {
  require_valid_fields(params);
}

// Returns whether a spin starts at the current sample.
bool SpinTracker::select_spin_axis(const ImuSample& sample, State& state) const {
  const Eigen::Vector3d size = sample.angular_velocity_rad_s.cwiseAbs();
  Eigen::Index largest = 0;
  size.maxCoeff(&largest);
  const bool continues = state.axis >= 0 && seconds(sample.time_ns - state.time_ns) <= kGapMax_s &&
                         size[state.axis] >= kRateMin_rad_s && size[largest] <= kAxisHysteresis * size[state.axis];
  if (continues) return false;
  state.axis = size[largest] >= kRateMin_rad_s ? static_cast<int>(largest) : -1;
  return state.axis >= 0;
}

template <class Model, class Recorder>
SpinRate SpinTracker::advance_spin_filter(const Model& model, const ImuSample& sample, std::uint8_t saturated_axes,
                                          double dt_s, bool first, int axis, Hypotheses<Model::kStates>& hypotheses,
                                          const Recorder& record) const {
  const SpinReading reading = model.reading(sample, saturated_axes, axis, dt_s);
  RecordedSpin<Model::kStates> recorded;
  recorded.spin_change_probability = probability_of_change(dt_s);
  if (first) {
    hypotheses.spin = hypotheses.independent_filter = model.start(reading);
    hypotheses.probability = hypotheses.measured_probability = kStartProbability;
  } else if (dt_s > 0.0) {
    recorded.predicted = model.predict(hypotheses.spin, 1.0, dt_s);
    const double log_ratio = model.update(recorded.predicted, reading, 1.0, hypotheses.spin) -
                             model.update(model.predict(hypotheses.independent_filter, 0.0, dt_s), reading, 0.0,
                                          hypotheses.independent_filter);
    double ratio = std::exp(std::clamp(std::min(1.0, dt_s / kMemory_s) * log_ratio, -kLogRatioMax, kLogRatioMax));
    const double c = recorded.spin_change_probability;
    const double spins = hypotheses.probability * (1.0 - c) + (1.0 - hypotheses.probability) * c;
    hypotheses.probability = std::min(kProbabilityMax, spins * ratio / (spins * ratio + 1.0 - spins));
    // If the spin axis is saturated, the readings do not limit the spin rate from above. If rate or force across the
    // spin axis oscillates, some spin rate beyond the saturation limit fits the frequency of the oscillation. Samples
    // with a saturated spin axis can lower the probability of a steady spin, but cannot raise this probability.
    if (!reading.saturated) {
      hypotheses.measured_probability = hypotheses.probability;
    } else if (hypotheses.probability > hypotheses.measured_probability) {
      hypotheses.probability = hypotheses.measured_probability;
      ratio = hypotheses.probability / (1.0 - hypotheses.probability) * (1.0 - spins) / spins;
    }
    recorded.likelihood_ratio = ratio;
  }
  recorded.filter = hypotheses.spin;
  recorded.probability = hypotheses.probability;
  record(recorded);
  return {axis, hypotheses.spin.x[kRate], hypotheses.spin.covariance(kRate, kRate), hypotheses.probability,
          reading.saturated};
}

SpinRate SpinTracker::step(const ImuSample& sample, std::uint8_t saturated_axes, State& state,
                           bool further_imus) const {
  const bool first = select_spin_axis(sample, state);
  const double dt_s = first ? 0.0 : seconds(sample.time_ns - state.time_ns);
  state.time_ns = sample.time_ns;
  if (state.axis < 0) return {};
  const auto ignore = [](const auto&) {};
  return select_spin(
      advance_spin_filter(Modulation{}, sample, saturated_axes, dt_s, first, state.axis, state.modulation, ignore),
      advance_spin_filter(Centripetal{}, sample, saturated_axes, dt_s, first, state.axis, state.centripetal, ignore),
      further_imus);
}

std::vector<SpinRate> SpinTracker::smooth(std::span<const ImuSample> samples,
                                          std::span<const std::uint8_t> saturated_axes, bool further_imus) const {
  std::vector<SpinRate> modulation(samples.size()), centripetal(samples.size());
  std::vector<RecordedSpin<Modulation::kStates>> modulation_run;
  std::vector<RecordedSpin<Centripetal::kStates>> centripetal_run;
  State state;
  const auto smooth_run = [&](std::size_t end) {
    const std::size_t size = modulation_run.size();
    smooth_spin<Modulation::kStates>(modulation_run, std::span(modulation).subspan(end - size, size));
    smooth_spin<Centripetal::kStates>(centripetal_run, std::span(centripetal).subspan(end - size, size));
    modulation_run.clear();
    centripetal_run.clear();
  };
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool first = select_spin_axis(samples[k], state);
    const double dt_s = first ? 0.0 : seconds(samples[k].time_ns - state.time_ns);
    state.time_ns = samples[k].time_ns;
    if (state.axis < 0 || first) smooth_run(k);
    if (state.axis < 0) continue;
    modulation[k] =
        advance_spin_filter(Modulation{}, samples[k], saturated_axes[k], dt_s, first, state.axis, state.modulation,
                            [&](const auto& recorded) { modulation_run.push_back(recorded); });
    centripetal[k] =
        advance_spin_filter(Centripetal{}, samples[k], saturated_axes[k], dt_s, first, state.axis, state.centripetal,
                            [&](const auto& recorded) { centripetal_run.push_back(recorded); });
  }
  smooth_run(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (modulation[k].axis >= 0) modulation[k] = select_spin(modulation[k], centripetal[k], further_imus);
  }
  return modulation;
}

AngularRateState SpinTracker::combine_with_spin_rate(const AngularRateState& rate, const SpinRate& spin,
                                                     bool further_imus) const {
  if (spin.axis < 0 || !spin.saturated || spin.probability < params_.probability_min) return rate;
  if (further_imus && rate.covariance_rad2_s2(spin.axis, spin.axis) < spin.variance_rad2_s2) return rate;
  AngularRateState spinning = rate;
  spinning.w_WI_I_rad_s[spin.axis] = spin.rate_rad_s;
  spinning.covariance_rad2_s2.row(spin.axis).setZero();
  spinning.covariance_rad2_s2.col(spin.axis).setZero();
  spinning.covariance_rad2_s2(spin.axis, spin.axis) = spin.variance_rad2_s2;
  return mix_rate_states(rate, spinning, spin.probability);
}

}  // namespace tumble
