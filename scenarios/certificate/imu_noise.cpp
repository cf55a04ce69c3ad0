// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <initializer_list>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/standard_gravity.hpp"
#include "sim/imu/allan.hpp"
#include "sim/imu/bias.hpp"
#include "sim/imu/imu_simulation.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kRate_hz = 100.0;

struct RestReadings {
  std::vector<Eigen::Vector3d> gyro, accel;
};

/// Returns the IMU of a data sheet without filters, quantisation, averaging windows, time jitter and lost samples. Of
/// the remaining sensor errors, only noise and bias vary at rest.
sim::SensorSpec resting(const DataSheet& sheet) {
  sim::SensorSpec sensor = imu_of_sheet(sheet);
  for (const char* off :
       {"gyro_bandwidth_hz", "accel_bandwidth_hz", "digital_bandwidth_hz", "gyro_quantum_rad_s", "accel_quantum_m_s2",
        "gyro_precise_quantum_rad_s", "accel_precise_quantum_m_s2", "gyro_window_s", "accel_window_s", "gyro_update_hz",
        "accel_update_hz", "magnetometer", "time_jitter_s", "dropout_share"}) {
    sensor.values.set(off, 0.0);
  }
  sensor.values.set("output_rate_hz", kRate_hz);
  return sensor;
}

void multiply(sim::SensorSpec& sensor, std::initializer_list<const char*> names, double factor) {
  for (const char* name : names) sensor.values.set(name, factor * sensor.values.at(name));
}

constexpr std::initializer_list<const char*> kNoises = {"gyro_noise_rad_s_sqrt_hz", "gyro_precise_noise_rad_s_sqrt_hz",
                                                        "accel_noise_m_s2_sqrt_hz", "accel_precise_noise_m_s2_sqrt_hz"};
constexpr std::initializer_list<const char*> kInstabilities = {"gyro_bias_in_run_rad_s", "accel_bias_in_run_m_s2"};
constexpr std::initializer_list<const char*> kWalks = {"gyro_bias_walk_rad_s_sqrt_s", "accel_bias_walk_m_s2_sqrt_s"};

RestReadings rest(const sim::SensorSpec& sensor, double duration_s, std::uint64_t seed) {
  sim::ImuRecord record;
  sim::ImuTruth truth;
  sim::simulate_imu_at_rest(sensor, duration_s, kRate_hz, kStandardGravity_m_s2, seed, record, truth);
  return {std::move(record.gyro_rad_s), std::move(record.accel_m_s2)};
}

std::vector<sim::AllanPoint> curve_of(const std::vector<Eigen::Vector3d>& samples) {
  std::vector<std::vector<sim::AllanPoint>> axes;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> series;
    series.reserve(samples.size());
    for (const Eigen::Vector3d& sample : samples) series.push_back(sample[axis]);
    axes.push_back(sim::allan_deviation(series, 1.0 / kRate_hz));
  }
  return sim::mean_deviation(axes);
}

struct Stated {
  double noise;
  sim::Bias::Params bias;

  Stated(const sim::Values& sheet, const std::string& prefix, const std::string& unit) {
    const auto value = [&](const std::string& name) { return sheet.at(prefix + "_" + name); };
    const double signal = prefix == "accel" ? kStandardGravity_m_s2 : 0.0;
    const bool precise = value("handover_" + unit) > signal;
    noise = value((precise ? "precise_noise_" : "noise_") + unit + "_sqrt_hz");
    bias.in_run = value("bias_in_run_" + unit);
    bias.in_run_s = value("bias_in_run_s");
    bias.walk_sqrt_s = value("bias_walk_" + unit + "_sqrt_s");
  }
  double walk(double tau_s) const { return sim::walk_deviation(bias.walk_sqrt_s, tau_s); }
  double all(double tau_s) const {
    return std::hypot(sim::white_deviation(noise, tau_s), sim::Bias::in_run_deviation(bias, tau_s), walk(tau_s));
  }
};

CertificateEntry entry(const std::string& row, const std::string& subject, const std::string& law,
                       const sim::AllanPoint& measured, double stated, sim::AllanNoise noise) {
  constexpr double kSigmas = 4.0;  // no false alarm in twenty entries
  const sim::AllanInterval interval = sim::confidence_interval(measured, noise, kSigmas);
  return {row,
          subject,
          law,
          "1",
          measured.deviation / stated,
          measured.deviation / interval.high,
          measured.deviation / interval.low,
          ""};
}

std::vector<CertificateEntry> entries_of(const std::string& subject, const Stated& stated,
                                         const std::vector<sim::AllanPoint>& curve,
                                         const std::vector<sim::AllanPoint>& walk) {
  const sim::AllanPoint& white = sim::nearest_point(curve, 0.1);
  const sim::AllanPoint& floor = sim::nearest_point(curve, stated.bias.in_run_s / 10.0);
  std::vector<CertificateEntry> entries = {
      entry("imu_white_noise", subject,
            "white noise at rest; the value is the simulated Allan deviation at 0.1 s, divided by the Allan deviation "
            "of the data sheet",
            white, stated.all(white.tau_s), sim::AllanNoise::white),
      entry("imu_bias_instability", subject,
            "bias instability at rest; the value is the simulated Allan deviation at a tenth of the bias correlation "
            "time, divided by the Allan deviation of the data sheet",
            floor, stated.all(floor.tau_s), sim::AllanNoise::flicker)};
  if (stated.bias.walk_sqrt_s > 0.0) {
    const sim::AllanPoint& long_walk = sim::nearest_point(walk, 10.0);
    entries.push_back(entry("imu_bias_walk", subject,
                            "bias random walk without other noise; the value is the simulated Allan deviation at 10 s, "
                            "divided by the Allan deviation of the data sheet",
                            long_walk, stated.walk(long_walk.tau_s), sim::AllanNoise::walk));
  }
  return entries;
}

}  // namespace

std::vector<CertificateEntry> certify_imu_noise(const CertificateInput& input, const ImuNoiseSetup& setup) {
  std::vector<CertificateEntry> entries;
  for (const std::string& device : device_names(input.data)) {
    const DataSheet sheet = load_data_sheet(input.data, device);
    if (sheet.sensor_kind != "imu") continue;
    sim::SensorSpec sensor = resting(sheet);
    const Stated gyro(sensor.values, "gyro", "rad_s"), accel(sensor.values, "accel", "m_s2");
    multiply(sensor, kNoises, setup.noise_factor);
    multiply(sensor, kInstabilities, setup.bias_factor);
    multiply(sensor, kWalks, setup.bias_factor);
    const RestReadings all = rest(sensor, setup.duration_s, setup.seed);
    multiply(sensor, kNoises, 0.0);
    multiply(sensor, kInstabilities, 0.0);
    const RestReadings walk = rest(sensor, setup.duration_s / 2.0, setup.seed);
    for (CertificateEntry& each : entries_of(device + " gyro", gyro, curve_of(all.gyro), curve_of(walk.gyro))) {
      entries.push_back(std::move(each));
    }
    for (CertificateEntry& each : entries_of(device + " accel", accel, curve_of(all.accel), curve_of(walk.accel))) {
      entries.push_back(std::move(each));
    }
  }
  return entries;
}

}  // namespace tumble::scenarios
