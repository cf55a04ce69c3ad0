// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "sim/imu/allan.hpp"
#include "sim/imu/imu_simulation.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kPeriod_ns = 10'000'000;
constexpr double kPeriod_s = 0.01;

/// An hour of rest, far coarser than the engine's: at rest nothing happens between two samples.
sim::Truth rest(double duration_s) {
  const auto count = static_cast<std::size_t>(std::llround(duration_s / kPeriod_s)) + 1;
  sim::Truth truth;
  truth.period_ns = kPeriod_ns;
  truth.p_WB_m.assign(count, Eigen::Vector3d::Zero());
  truth.v_WB_m_s = truth.w_WB_B_rad_s = truth.p_WB_m;
  truth.q_WB.assign(count, Eigen::Quaterniond::Identity());
  return truth;
}

/// The device with its noise and bias alone: filters need a faster rate than this one, and the rest is constant at rest.
sim::SensorSpec resting(const DataSheet& sheet, const ImuNoiseSetup& setup) {
  sim::SensorSpec sensor;
  sensor.name = sheet.device;
  sensor.kind = sheet.sensor_kind;
  sensor.device = sheet.device;
  sensor.values = sheet.values();
  for (const char* off : {"gyro_bandwidth_hz", "accel_bandwidth_hz", "digital_bandwidth_hz", "gyro_quantum_rad_s",
                          "accel_quantum_m_s2"}) {
    sensor.values.set(off, 0.0);
  }
  sensor.values.set("output_rate_hz", 1.0 / kPeriod_s);
  const auto multiply = [&](const char* name, double factor) { sensor.values.set(name, factor * sensor.values.at(name)); };
  for (const char* noise : {"gyro_noise_rad_s_sqrt_hz", "accel_noise_m_s2_sqrt_hz"}) multiply(noise, setup.noise_factor);
  for (const char* bias : {"gyro_bias_in_run_rad_s", "gyro_bias_walk_rad_s_sqrt_s", "accel_bias_in_run_m_s2",
                           "accel_bias_walk_m_s2_sqrt_s"}) {
    multiply(bias, setup.bias_factor);
  }
  sensor.values = sim::resolve("certificate." + sheet.device, sensor.values, sim::imu_parameters());
  return sensor;
}

std::vector<sim::AllanPoint> curve_of(const std::vector<Eigen::Vector3d>& samples) {
  std::vector<std::vector<sim::AllanPoint>> axes;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> series;
    series.reserve(samples.size());
    for (const Eigen::Vector3d& sample : samples) series.push_back(sample[axis]);
    axes.push_back(sim::allan_deviation(series, kPeriod_s));
  }
  return sim::mean_deviation(axes);
}

/// What the data sheet leads to at an averaging time, one triad.
struct Stated {
  double noise, in_run, in_run_s, walk;
  double deviation(double tau_s) const {
    return std::sqrt(std::pow(sim::white_deviation(noise, tau_s), 2) +
                     std::pow(sim::gauss_markov_deviation(in_run, in_run_s, tau_s), 2) +
                     std::pow(sim::walk_deviation(walk, tau_s), 2));
  }
};

/// Measured over stated deviation; the bound is the statistical interval of an hour on three axes.
CertificateEntry entry(const std::string& row, const std::string& subject, const std::string& law,
                       const std::vector<sim::AllanPoint>& curve, const Stated& stated, double tau_s,
                       sim::AllanNoise noise) {
  constexpr double kSigmas = 4.0;  // of some ten figures none fails by chance
  const sim::AllanPoint& point = sim::nearest_point(curve, tau_s);
  const sim::AllanInterval interval = sim::confidence_interval(point, noise, kSigmas);
  return {row, subject, law, "1", point.deviation / stated.deviation(point.tau_s), point.deviation / interval.high,
          point.deviation / interval.low, ""};
}

}  // namespace

std::vector<CertificateEntry> certify_imu_noise(const CertificateInput& input, const ImuNoiseSetup& setup) {
  const sim::Truth truth = rest(setup.duration_s);
  std::vector<CertificateEntry> entries;
  for (const std::string& device : device_names(input.data)) {
    const DataSheet sheet = load_data_sheet(input.data, device);
    if (sheet.sensor_kind != "imu") continue;
    sim::ImuRecord record;
    sim::ImuTruth imu_truth;
    sim::simulate_imu(truth, resting(sheet, setup), Eigen::Isometry3d::Identity(), 9.80665, setup.seed,
                      record, imu_truth);
    const sim::Values sheet_values = sim::resolve(device, sheet.values(), sim::imu_parameters());
    for (const auto& [prefix, unit] : {std::pair<std::string, std::string>{"gyro", "rad_s"}, {"accel", "m_s2"}}) {
      const auto value = [&](const std::string& name) { return sheet_values.at(prefix + "_" + name); };
      const Stated stated{value("noise_" + unit + "_sqrt_hz"), value("bias_in_run_" + unit), value("bias_in_run_s"),
                          value("bias_walk_" + unit + "_sqrt_s")};
      const std::string subject = device + " " + prefix;
      const std::vector<sim::AllanPoint> curve = curve_of(prefix == "gyro" ? record.gyro_rad_s : record.accel_m_s2);
      entries.push_back(entry("imu_white_noise", subject,
                              "Allan deviation at 0.1 s at rest over that of the data sheet's white noise", curve, stated,
                              0.1, sim::AllanNoise::white));
      // a Gauss-Markov process shows most at about twice its correlation time
      entries.push_back(entry("imu_bias", subject,
                              "Allan deviation at twice the bias's correlation time over that of the data sheet's bias",
                              curve, stated, std::min(2.0 * stated.in_run_s, setup.duration_s / 10.0),
                              sim::AllanNoise::walk));
    }
  }
  return entries;
}

}  // namespace tumble::scenarios
