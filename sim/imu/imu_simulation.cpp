// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/imu_simulation.hpp"

#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "sim/imu/glitches.hpp"
#include "sim/imu/imu_chain.hpp"
#include "sim/imu/magnetometer.hpp"
#include "sim/imu/time_stamps.hpp"
#include "sim/truth/record_truth.hpp"

namespace tumble::sim {

namespace {

struct Ideal {
  Eigen::Vector3d rate_rad_s, force_m_s2;
};

std::optional<Eigen::Matrix3d> draw_g_sensitivity(const SensorSpec& sensor, std::uint64_t seed) {
  const double sigma = sensor.values.at("gyro_g_sensitivity_spread_s_m");
  if (sigma == 0.0) return std::nullopt;
  Stream stream(seed, sensor.name + ".gyro.g_sensitivity");
  Eigen::Matrix3d drawn;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) drawn(row, column) = bounded_normal(stream, sigma);
  }
  return drawn;
}

class Device {
 public:
  Device(const SensorSpec& sensor, double rate_hz, int steps, std::uint64_t seed, const GivenElements& given,
         ImuRecord& record, ImuTruth& truth)
      : record_(record),
        truth_(truth),
        gyro_(sensor.values, "gyro", "rad_s", rate_hz, steps, seed, sensor.name + ".gyro"),
        accel_(sensor.values, "accel", "m_s2", rate_hz, steps, seed, sensor.name + ".accel"),
        stamps_(sensor.values, "sensors." + sensor.name, record.period_ns, Stream(seed, sensor.name + ".time")),
        glitches_(sensor.values, Stream(seed, sensor.name + ".glitch")),
        g_sensitivity_(sensor.values.at("gyro_g_sensitivity_s_m")),
        g_sensitivity_drawn_(draw_g_sensitivity(sensor, seed)),
        flagged_(sensor.values.at("clip_flags") > 0.5) {
    if (given.gyro) gyro_.set_elements(*given.gyro);
    if (given.accel) accel_.set_elements(*given.accel);
    describe_elements();
  }

  void step(const Ideal& ideal) {
    Eigen::Vector3d felt_rad_s = g_sensitivity_ * ideal.force_m_s2;
    if (g_sensitivity_drawn_) felt_rad_s += *g_sensitivity_drawn_ * ideal.force_m_s2;
    gyro_.step(ideal.rate_rad_s, felt_rad_s);
    accel_.step(ideal.force_m_s2, Eigen::Vector3d::Zero());
  }

  bool take(const Ideal& exact, std::int64_t end_ns) {
    std::uint8_t flags = 0;
    TriadReading gyro = gyro_.take(exact.rate_rad_s, 0, flags);
    TriadReading accel = accel_.take(exact.force_m_s2, 3, flags);
    glitches_.spoil(gyro, accel);
    const std::optional<std::int64_t> time_ns = stamps_.stamp(end_ns);
    if (!time_ns) return false;
    record_.time_ns.push_back(*time_ns);
    record_.gyro_rad_s.push_back(gyro.delivered);
    record_.accel_m_s2.push_back(accel.delivered);
    record_.clip_flags.push_back(flagged_ ? flags : std::uint8_t{0});
    truth_.rate_rad_s.push_back(exact.rate_rad_s);
    truth_.specific_force_m_s2.push_back(exact.force_m_s2);
    truth_.gyro_unclipped_rad_s.push_back(gyro.unclipped);
    truth_.accel_unclipped_m_s2.push_back(accel.unclipped);
    truth_.gyro_bias_rad_s.push_back(gyro.bias);
    truth_.accel_bias_m_s2.push_back(accel.bias);
    return true;
  }

 private:
  void describe_elements() {
    const auto rows = [](const Elements& elements, std::vector<Eigen::Vector3d>& out, Eigen::Vector3d& offset) {
      if (elements.axis_aligned()) return;
      for (int i = 0; i < 3; ++i) out.emplace_back(elements.axes().row(i));
      offset = elements.offset();
    };
    rows(gyro_.elements(), truth_.gyro_elements, truth_.gyro_element_offset_rad_s);
    rows(accel_.elements(), truth_.accel_elements, truth_.accel_element_offset_m_s2);
  }

  ImuRecord& record_;
  ImuTruth& truth_;
  TriadChain gyro_, accel_;
  TimeStamps stamps_;
  Glitches glitches_;
  double g_sensitivity_;
  std::optional<Eigen::Matrix3d> g_sensitivity_drawn_;  ///< empty without spread
  bool flagged_;
};

class Compass {
 public:
  Compass(const Truth& truth, const SensorSpec& sensor, const Eigen::Isometry3d& T_BI, std::uint64_t seed)
      : field_(draw_magnetic_field(sensor.values, truth.p_WB_m, seed)),
        errors_(sensor.values, seed, sensor.name + ".mag"),
        truth_(truth),
        T_BI_(T_BI) {}

  const Eigen::Vector3d& earth_W_t() const { return field_.earth_W_t; }
  void step(std::size_t k) {
    const Eigen::Vector3d p_WI_m = truth_.p_WB_m[k] + truth_.q_WB[k] * T_BI_.translation();
    sum_ += T_BI_.linear().transpose() * (truth_.q_WB[k].conjugate() * field_.at(p_WI_m));
    ++count_;
  }
  void take(bool kept, ImuRecord& record, ImuTruth& imu_truth) {
    const Eigen::Vector3d mean = sum_ / count_, reading = errors_.read(mean);
    sum_.setZero();
    count_ = 0;
    if (!kept) return;
    record.magnetic_field_t.push_back(reading);
    imu_truth.magnetic_field_t.push_back(mean);
  }

 private:
  MagneticField field_;
  Magnetometer errors_;
  const Truth& truth_;
  const Eigen::Isometry3d& T_BI_;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

struct Pace {
  int steps = 1;   ///< steps of the error simulation per output reading
  int shares = 1;  ///< output readings per physics step; above 1 for fast IMUs
};

Pace pace_of(const SensorSpec& sensor, double step_ns) {
  const double steps = 1e9 / (sensor.values.at("output_rate_hz") * step_ns);
  const bool faster = steps < 1.0;
  const double ratio = faster ? 1.0 / steps : steps, whole = std::round(ratio);
  if (std::abs(ratio - whole) > 1e-9 * whole) {
    std::ostringstream text;
    text << "sensors." << sensor.name << ".output_rate_hz is " << sensor.values.at("output_rate_hz")
         << " Hz; it must divide the physics rate of " << 1e9 / step_ns << " Hz or be a multiple of it";
    throw InvalidSituation(text.str());
  }
  return faster ? Pace{1, static_cast<int>(whole)} : Pace{static_cast<int>(whole), 1};
}

BodyState state_at(const Truth& truth, std::size_t k) {
  return {static_cast<double>(k) * static_cast<double>(truth.period_ns) * 1e-9, truth.p_WB_m[k], truth.q_WB[k],
          truth.v_WB_m_s[k], truth.w_WB_B_rad_s[k]};
}

Ideal ideal_between(const BodyState& before, const BodyState& after, const Eigen::Isometry3d& T_BI,
                    double gravity_m_s2) {
  const Eigen::Matrix3d R_IB = T_BI.linear().transpose();
  return {R_IB * mean_rate_B(before, after), R_IB * specific_force_B(before, after, T_BI.translation(), gravity_m_s2)};
}

/// Adds full turns to a mean rate over an averaging window. The attitudes at start and end of the window determine the
/// rotation only up to full turns. The number of full turns follows from `mean_of_steps_rad_s`, the mean of the rates
/// in the physics steps.
Eigen::Vector3d unwound(const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& mean_of_steps_rad_s, double time_s) {
  constexpr double kRevolution_rad = 6.283185307179586;
  const double norm = rate_rad_s.norm();
  if (norm == 0.0) return rate_rad_s;
  const double turns = std::round((mean_of_steps_rad_s.dot(rate_rad_s) / norm - norm) * time_s / kRevolution_rad);
  return turns == 0.0 ? rate_rad_s : Eigen::Vector3d(rate_rad_s * (1.0 + turns * kRevolution_rad / (norm * time_s)));
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

void require_bandwidths_below(const SensorSpec& sensor, double rate_hz) {
  for (const char* name : {"gyro_bandwidth_hz", "accel_bandwidth_hz", "digital_bandwidth_hz"}) {
    if (sensor.values.at(name) < 0.5 * rate_hz) continue;
    std::ostringstream text;
    text << "sensors." << sensor.name << "." << name << " is " << sensor.values.at(name)
         << " Hz; it must be below half of the IMU simulation's internal rate of " << rate_hz << " Hz";
    throw InvalidSituation(text.str());
  }
}

}  // namespace

void simulate_imu(const Truth& truth, const SensorSpec& sensor, const Eigen::Isometry3d& T_BI, double gravity_m_s2,
                  std::uint64_t seed, ImuRecord& record, ImuTruth& imu_truth, const GivenElements& given) {
  check_imu_values(sensor.values, "sensors." + sensor.name);
  const auto [steps, shares] = pace_of(sensor, static_cast<double>(truth.period_ns));
  const std::int64_t share_ns = truth.period_ns / shares;
  describe(sensor, steps * share_ns, record);
  imu_truth.name = sensor.name;
  imu_truth.T_BI = T_BI;
  Device device(sensor, 1e9 / static_cast<double>(share_ns), steps, seed, given, record, imu_truth);
  std::optional<Compass> compass;
  if (sensor.values.at("magnetometer") > 0.5) {
    compass.emplace(truth, sensor, T_BI, seed);
    record.earth_field_W_t = compass->earth_W_t();
  }

  BodyState window_start = state_at(truth, 0), before = window_start;
  Eigen::Vector3d sum_of_rates = Eigen::Vector3d::Zero();
  for (std::size_t k = 1; k < truth.q_WB.size(); ++k) {
    const BodyState after = state_at(truth, k);
    const Ideal step = ideal_between(before, after, T_BI, gravity_m_s2);
    before = after;
    if (shares > 1) {  // all readings equal the step's mean
      for (int share = 1; share <= shares; ++share) {
        device.step(step);
        if (compass) compass->step(k);
        const bool kept = device.take(step, static_cast<std::int64_t>(k - 1) * truth.period_ns + share * share_ns);
        if (compass) compass->take(kept, record, imu_truth);
      }
      continue;
    }
    sum_of_rates += step.rate_rad_s;
    device.step(step);
    if (compass) compass->step(k);
    if (k % static_cast<std::size_t>(steps) != 0) continue;

    Ideal exact = ideal_between(window_start, after, T_BI, gravity_m_s2);
    exact.rate_rad_s = unwound(exact.rate_rad_s, sum_of_rates / steps, after.time_s - window_start.time_s);
    window_start = after;
    sum_of_rates.setZero();
    const bool kept = device.take(exact, static_cast<std::int64_t>(k) * truth.period_ns);
    if (compass) compass->take(kept, record, imu_truth);
  }
}

void simulate_imu_at_rest(const SensorSpec& sensor, double duration_s, double chain_rate_hz, double gravity_m_s2,
                          std::uint64_t seed, ImuRecord& record, ImuTruth& imu_truth) {
  check_imu_values(sensor.values, "sensors." + sensor.name);
  require_bandwidths_below(sensor, chain_rate_hz);
  const int steps = pace_of(sensor, 1e9 / chain_rate_hz).steps;
  const std::int64_t period_ns = std::llround(1e9 / sensor.values.at("output_rate_hz"));
  describe(sensor, period_ns, record);
  imu_truth.name = sensor.name;
  Device device(sensor, chain_rate_hz, steps, seed, {}, record, imu_truth);
  const Ideal rest{Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, gravity_m_s2)};
  const std::int64_t windows = std::llround(duration_s * sensor.values.at("output_rate_hz"));
  for (std::int64_t window = 1; window <= windows; ++window) {
    for (int i = 0; i < steps; ++i) device.step(rest);
    device.take(rest, window * period_ns);
  }
}

}  // namespace tumble::sim
