// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/range_errors.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

namespace {

// A lidar return whose signal is above certain_signal_ is never lost, because the loss probability is below the
// resolution of the random numbers.
constexpr double kSure = 0.99;
constexpr double kCertainOdds = 0x1p25;

/// Rounds a value to a multiple of `quantum`. Adding and subtracting 1.5 * 2^52 rounds a double to an integer without a
/// function call; ties round to even.
double rounded(double value, double quantum) {
  constexpr double kShift = 0x1.8p52;
  return quantum * ((value / quantum + kShift) - kShift);
}

}  // namespace

RangeErrors::RangeErrors(const Values& values, std::uint64_t seed, std::string_view stream_name)
    : noise_(Stream(seed, stream_name)),
      noise_m_(values.at("range_noise_m")),
      quantum_m_(values.at("range_quantum_m")),
      min_m_(values.at("range_min_m")),
      max_m_(values.at("range_max_m")),
      detection2_m2_(values.at("detection_range_m") * values.at("detection_range_m")),
      reference_reflectivity_(values.at("detection_reflectivity")),
      steepness_(values.at("detection_steepness")),
      kept_share_(1.0 - values.at("dropout_share")),
      intensity_quantum_(values.at("intensity_quantum")),
      sure_signal_(std::pow(kSure / (1.0 - kSure), 1.0 / steepness_)),
      certain_signal_(std::pow(kCertainOdds, 1.0 / steepness_)) {}

bool RangeErrors::is_detected(float signal, double uniform) const {
  if (uniform >= kept_share_) return false;
  if (detection2_m2_ == 0.0 || signal >= certain_signal_) return true;
  // If the return is not lost at random, `uniform` is uniformly distributed in [0, kept_share_), so u is uniformly
  // distributed in [0, 1).
  const double u = uniform / kept_share_;
  if (u < kSure && signal >= sure_signal_) return true;
  const double odds = std::pow(signal, steepness_);
  return u < 1.0 - 1.0 / (1.0 + odds);
}

[[gnu::target("avx2")]] void RangeErrors::apply(const RayPacket& hits, std::uint64_t index, Returns& returns) const {
  LaneNoise noise;
  noise_.draw(index, noise);
  alignas(64) float strength[kLanes], signal[kLanes];
  alignas(64) double measured_m[kLanes];
  const auto scale = static_cast<float>(detection2_m2_ / reference_reflectivity_);
  for (int i = 0; i < kLanes; ++i) {
    strength[i] = hits.reflectivity[i] * hits.cosine[i];
    signal[i] = strength[i] * scale / (hits.range[i] * hits.range[i]);
    measured_m[i] = static_cast<double>(hits.range[i]) + noise_m_ * static_cast<double>(noise.normal[i]);
    returns.intensity[i] = std::min(1.0f, strength[i]);
  }
  if (quantum_m_ > 0.0) {
    for (int i = 0; i < kLanes; ++i) measured_m[i] = rounded(measured_m[i], quantum_m_);
  }
  if (intensity_quantum_ > 0.0) {
    for (int i = 0; i < kLanes; ++i) {
      returns.intensity[i] = static_cast<float>(rounded(returns.intensity[i], intensity_quantum_));
    }
  }
  for (int i = 0; i < kLanes; ++i) {
    returns.range_m[i] = static_cast<float>(measured_m[i]);
    returns.kept[i] = hits.surface_id[i] != kNothing && measured_m[i] >= min_m_ && measured_m[i] <= max_m_ &&
                      is_detected(signal[i], static_cast<double>(noise.uniform[i]));
  }
}

}  // namespace tumble::sim
