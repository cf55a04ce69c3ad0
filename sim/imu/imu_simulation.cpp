// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/imu_simulation.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include "sim/imu/stages.hpp"
#include "sim/truth/record_truth.hpp"

namespace tumble::sim {

namespace {

/// One triad's errors up to the rail, at the physics rate.
class Triad {
 public:
  Triad(const Values& values, const std::string& prefix, const std::string& unit, double rate_hz, std::uint64_t seed,
        const std::string& stream_name)
      : noise_stream_(seed, stream_name + ".noise"),
        bias_stream_(seed, stream_name + ".bias"),
        rate_hz_(rate_hz),
        noise_(values.at(prefix + "_noise_" + unit + "_sqrt_hz")),
        low_pass_(values.at(prefix + "_bandwidth_hz"), rate_hz),
        bias_({values.at(prefix + "_bias_turn_on_" + unit), values.at(prefix + "_bias_in_run_" + unit),
               values.at(prefix + "_bias_in_run_s"), values.at(prefix + "_bias_walk_" + unit + "_sqrt_s")},
              1.0 / rate_hz, bias_stream_) {
    Stream axes(seed, stream_name + ".axes");
    axis_errors_ = draw_axis_errors(axes, values.at(prefix + "_scale_error"), values.at(prefix + "_misalignment_rad"));
  }

  Eigen::Vector3d operator()(const Eigen::Vector3d& ideal, const Eigen::Vector3d& g_term) {
    bias_now_ = bias_.next(bias_stream_);
    return axis_errors_ * low_pass_(ideal) + bias_now_ + g_term + white_noise(noise_stream_, noise_, rate_hz_);
  }
  const Eigen::Vector3d& bias() const { return bias_now_; }

 private:
  Stream noise_stream_, bias_stream_;
  double rate_hz_, noise_;
  LowPass low_pass_;
  Bias bias_;
  Eigen::Matrix3d axis_errors_;
  Eigen::Vector3d bias_now_ = Eigen::Vector3d::Zero();
};

/// From the physics rate to one reading per window: rail, digital low-pass, mean, quantum.
class Output {
 public:
  struct Params {
    double rail = 0.0, quantum = 0.0, digital_bandwidth_hz = 0.0;
    bool rail_after = false;
    int first_bit = 0;
  };
  Output(const Params& params, double rate_hz) : params_(params), low_pass_(params.digital_bandwidth_hz, rate_hz) {}

  void add(const Eigen::Vector3d& signal) {
    sum_ += low_pass_(params_.rail_after ? signal : apply_rail(signal, params_.rail, params_.first_bit, flags_));
    ++count_;
  }

  /// The reading of the window that ends here; sets the bits of the axes that met the rail in it.
  Eigen::Vector3d take(std::uint8_t& flags) {
    Eigen::Vector3d mean = sum_ / count_;
    if (params_.rail_after) mean = apply_rail(mean, params_.rail, params_.first_bit, flags_);
    flags = static_cast<std::uint8_t>(flags | flags_);
    sum_.setZero();
    count_ = 0;
    flags_ = 0;
    return quantise(mean, params_.quantum);
  }

 private:
  Params params_;
  LowPass low_pass_;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  int count_ = 0;
  std::uint8_t flags_ = 0;
};

/// Mean over a window, for the truth.
struct Mean {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  void add(const Eigen::Vector3d& value) {
    sum += value;
    ++count;
  }
  Eigen::Vector3d take() {
    const Eigen::Vector3d mean = sum / count;
    *this = {};
    return mean;
  }
};

int steps_per_sample(const SensorSpec& sensor, std::int64_t step_ns) {
  const double steps = 1e9 / (sensor.values.at("output_rate_hz") * static_cast<double>(step_ns));
  const double whole = std::round(steps);
  if (whole < 1.0 || std::abs(steps - whole) > 1e-9 * whole) {
    std::ostringstream text;
    text << "sensors." << sensor.name << ".output_rate_hz is " << sensor.values.at("output_rate_hz")
         << " Hz, must divide the physics rate of " << 1e9 / static_cast<double>(step_ns) << " Hz";
    throw InvalidSituation(text.str());
  }
  return static_cast<int>(whole);
}

BodyState state_at(const Truth& truth, std::size_t k) {
  return {static_cast<double>(k) * static_cast<double>(truth.period_ns) * 1e-9, truth.p_WB_m[k], truth.q_WB[k],
          truth.v_WB_m_s[k], truth.w_WB_B_rad_s[k]};
}

void describe(const SensorSpec& sensor, std::int64_t period_ns, ImuRecord& record) {
  record.name = sensor.name;
  record.device = sensor.device;
  record.period_ns = period_ns;
  record.stated_gyro_range_rad_s = sensor.values.at("gyro_range_rad_s");
  record.stated_accel_range_m_s2 = sensor.values.at("accel_range_m_s2");
  record.gyro_noise_rad_s_sqrt_hz = sensor.values.at("gyro_noise_rad_s_sqrt_hz");
  record.accel_noise_m_s2_sqrt_hz = sensor.values.at("accel_noise_m_s2_sqrt_hz");
}

}  // namespace

void simulate_imu(const Truth& truth, const SensorSpec& sensor, const Eigen::Isometry3d& T_BI, double gravity_m_s2,
                  std::uint64_t seed, ImuRecord& record, ImuTruth& imu_truth) {
  const Values& values = sensor.values;
  const int window = steps_per_sample(sensor, truth.period_ns);
  const double rate_hz = 1e9 / static_cast<double>(truth.period_ns);
  const std::int64_t offset_ns = std::llround(values.at("time_offset_s") * 1e9);
  const bool flagged = values.at("clip_flags") > 0.5;
  describe(sensor, window * truth.period_ns, record);
  imu_truth.name = sensor.name;
  imu_truth.T_BI = T_BI;

  Triad gyro(values, "gyro", "rad_s", rate_hz, seed, sensor.name + ".gyro");
  Triad accel(values, "accel", "m_s2", rate_hz, seed, sensor.name + ".accel");
  const Output::Params gyro_params{values.at("gyro_rail_rad_s"), values.at("gyro_quantum_rad_s"),
                                   values.at("digital_bandwidth_hz"), values.at("clip_after_low_pass") > 0.5, 0};
  const Output::Params accel_params{values.at("accel_rail_m_s2"), values.at("accel_quantum_m_s2"),
                                    gyro_params.digital_bandwidth_hz, gyro_params.rail_after, 3};
  const auto without_rail = [](Output::Params params) {
    params.rail = 0.0;
    return params;
  };
  Output gyro_output(gyro_params, rate_hz), accel_output(accel_params, rate_hz);
  Output gyro_twin(without_rail(gyro_params), rate_hz), accel_twin(without_rail(accel_params), rate_hz);
  Mean true_rate, true_force;

  const Eigen::Matrix3d R_IB = T_BI.linear().transpose();
  const double g_sensitivity = values.at("gyro_g_sensitivity_s_m");
  BodyState before = state_at(truth, 0);
  for (std::size_t k = 1; k < truth.q_WB.size(); ++k) {
    const BodyState after = state_at(truth, k);
    const Eigen::Vector3d w_I = R_IB * mean_rate_B(before, after);
    const Eigen::Vector3d f_I = R_IB * specific_force_B(before, after, T_BI.translation(), gravity_m_s2);
    before = after;
    true_rate.add(w_I);
    true_force.add(f_I);
    const Eigen::Vector3d w = gyro(w_I, g_sensitivity * f_I), f = accel(f_I, Eigen::Vector3d::Zero());
    gyro_output.add(w);
    gyro_twin.add(w);
    accel_output.add(f);
    accel_twin.add(f);
    if (k % static_cast<std::size_t>(window) != 0) continue;

    std::uint8_t flags = 0, none = 0;
    record.time_ns.push_back(static_cast<std::int64_t>(k) * truth.period_ns + offset_ns);
    record.gyro_rad_s.push_back(gyro_output.take(flags));
    record.accel_m_s2.push_back(accel_output.take(flags));
    record.clip_flags.push_back(flagged ? flags : std::uint8_t{0});
    imu_truth.rate_rad_s.push_back(true_rate.take());
    imu_truth.specific_force_m_s2.push_back(true_force.take());
    imu_truth.gyro_unclipped_rad_s.push_back(gyro_twin.take(none));
    imu_truth.accel_unclipped_m_s2.push_back(accel_twin.take(none));
    imu_truth.gyro_bias_rad_s.push_back(gyro.bias());
    imu_truth.accel_bias_m_s2.push_back(accel.bias());
  }
}

}  // namespace tumble::sim
