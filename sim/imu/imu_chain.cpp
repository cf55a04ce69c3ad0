// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/imu_chain.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

namespace {

/// Update period of the slowly changing bias. Updating the bias less often than the signal saves four fifths of the
/// random numbers.
constexpr double kBiasPeriod_s = 0.01;

int steps_of_bias(double rate_hz) {
  return std::max(1, static_cast<int>(std::lround(kBiasPeriod_s * rate_hz)));
}

Bias::Params bias_params(const Values& values, const std::string& prefix, const std::string& unit) {
  return {values.at(prefix + "_bias_turn_on_" + unit), values.at(prefix + "_bias_in_run_" + unit),
          values.at(prefix + "_bias_in_run_s"), values.at(prefix + "_bias_walk_" + unit + "_sqrt_s")};
}

Rail::Params rail_params(const Values& values, const std::string& prefix, const std::string& unit) {
  return {values.at(prefix + "_rail_" + unit),
          values.at(prefix + "_plateau_axis_spread_" + unit),
          values.at(prefix + "_plateau_event_spread_" + unit),
          values.at(prefix + "_wrap") > 0.5,
          values.at(prefix + "_slow_recovery_s"),
          values.at(prefix + "_slow_recovery_share")};
}

Elements::Params element_params(const Values& values, const std::string& prefix, const std::string& unit) {
  return {values.at(prefix + "_element_misalignment"), values.at(prefix + "_element_scale"),
          values.at(prefix + "_element_offset_" + unit)};
}

Sampling::Params sampling_params(const Values& values, const std::string& prefix) {
  return {values.at(prefix + "_window_s"), values.at(prefix + "_update_hz")};
}

Eigen::Matrix3d axis_errors(const Values& values, const std::string& prefix, Stream stream) {
  return draw_axis_errors(stream, values.at(prefix + "_scale_error"), values.at(prefix + "_misalignment_rad"));
}

}  // namespace

TriadChain::TriadChain(const Values& values, const std::string& prefix, const std::string& unit, double rate_hz,
                       int steps, std::uint64_t seed, const std::string& stream_name)
    : rate_hz_(rate_hz),
      noise_(values.at(prefix + "_noise_" + unit + "_sqrt_hz")),
      precise_noise_(values.at(prefix + "_precise_noise_" + unit + "_sqrt_hz")),
      quantum_(values.at(prefix + "_quantum_" + unit)),
      precise_quantum_(values.at(prefix + "_precise_quantum_" + unit)),
      rail_after_(values.at("clip_after_low_pass") > 0.5),
      bias_steps_(steps_of_bias(rate_hz)),
      noise_stream_(seed, stream_name + ".noise"),
      delay_(values.at(prefix + "_delay_s"), rate_hz),
      low_pass_(values.at(prefix + "_bandwidth_hz"), rate_hz),
      bias_(bias_params(values, prefix, unit), bias_steps_ / rate_hz, Stream(seed, stream_name + ".bias")),
      range_(values.at(prefix + "_handover_" + unit)),
      rail_(rail_params(values, prefix, unit), (rail_after_ ? steps : 1) / rate_hz,
            Stream(seed, stream_name + ".rail")),
      elements_(element_params(values, prefix, unit), Stream(seed, stream_name + ".elements")),
      axis_errors_(axis_errors(values, prefix, Stream(seed, stream_name + ".axes"))),
      delivered_{LowPass(values.at("digital_bandwidth_hz"), rate_hz)},
      unclipped_(delivered_),
      sampling_(sampling_params(values, prefix), rate_hz, Stream(seed, stream_name + ".sampling")) {}

Eigen::Vector3d TriadChain::Path::add(const Eigen::Vector3d& signal, const Eigen::Vector3d& ideal) {
  const Eigen::Vector3d out = low_pass(signal);
  sum += out;
  error += out - ideal;
  return out;
}

void TriadChain::step(const Eigen::Vector3d& ideal, const Eigen::Vector3d& added) {
  if (count_++ % bias_steps_ == 0) bias_now_ = bias_.next();
  const Eigen::Vector3d clean = axis_errors_ * low_pass_(delay_(ideal)) + bias_now_ + added;
  range_.update(clean);
  const Eigen::Vector3d signal = clean + white_noise(noise_stream_, range_.pick(noise_, precise_noise_), rate_hz_);
  const Eigen::Vector3d quantum = range_.pick(quantum_, precise_quantum_);
  std::uint8_t railed = 0;
  const Eigen::Vector3d clipped = rail_after_ ? signal : elements_.clip(signal, rail_, 0, railed);
  const Eigen::Vector3d delivered = delivered_.add(quantise(clipped, quantum), ideal);
  const Eigen::Vector3d unclipped = unclipped_.add(quantise(signal, quantum), ideal);
  if (sampling_.on()) sampling_.add({delivered, unclipped, railed});
  railed_ = static_cast<std::uint8_t>(railed_ | railed);
  ++in_window_;
}

TriadReading TriadChain::integrated(const Eigen::Vector3d& exact) const {
  TriadReading out{exact + delivered_.error / in_window_, exact + unclipped_.error / in_window_, bias_now_};
  out.delivered = elements_.with_elements_of(delivered_.sum / in_window_, railed_, out.delivered);
  return out;
}

TriadReading TriadChain::take(const Eigen::Vector3d& exact, int first_bit, std::uint8_t& flags) {
  TriadReading reading;
  if (sampling_.on()) {
    const Sampling::Reading sampled = sampling_.output();
    reading = {sampled.delivered, sampled.unclipped, bias_now_};
    railed_ = sampled.railed;
  } else {
    reading = integrated(exact);
  }
  if (rail_after_) reading.delivered = elements_.clip(reading.delivered, rail_, 0, railed_);
  flags = static_cast<std::uint8_t>(flags | railed_ << first_bit);
  railed_ = 0;
  in_window_ = 0;
  for (Path* path : {&delivered_, &unclipped_}) {
    path->sum.setZero();
    path->error.setZero();
  }
  return reading;
}

}  // namespace tumble::sim
