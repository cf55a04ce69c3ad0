// SPDX-License-Identifier: BSD-3-Clause
// carried_statistics [--wand FILE.h5]... [--broad NUMBER]... [--attitude NUMBER]... [--method NAME]... [--set
// NAME=VALUE]... [--flags]
//
// The program tests hand-held bodies with saturated gyros. FILE.h5 is an imported recording with an optical reference,
// which is scored as in `tumble score`. NUMBER is a trial of BROAD ("05"): the program uses 40 s about its peak, limits
// each axis to a third of that peak (with --flags the device reports where) and compares the rates with the unlimited
// gyro. --attitude runs the attitude method with the same parameters over whole unchanged trials. The program prints
// median, 90 % and 99 % of the errors at saturated samples, the removed share of the raw error, and the share of errors
// within three standard deviations. The program is no test: it needs some seconds of one core per recording.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "stand_ins/broad_trial.hpp"
#include "tests/bench/program.hpp"

namespace {

namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;

struct Request {
  std::vector<std::string> wands, broad, attitude, methods;
  sim::Values values;
  bool flags = false;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void print_health(const scenarios::Estimate& estimate) {
  for (const auto& [name, value] : estimate.health) {
    std::printf(" %s %.3g", name.c_str(), value);
  }
  std::printf("\n");
}

void wand(const std::string& file, const std::string& name, const sim::Values& values) {
  const sim::Sensors sensors = scenarios::read_sensors(file);
  const sim::Truth truth = scenarios::read_truth(file);
  const scenarios::Method& method = *scenarios::find_methods(name).front();
  const double start_s = scenarios::process_cpu_s();
  const scenarios::Estimate estimate = method.run(sensors, values, {&truth});
  const double cpu_s = scenarios::process_cpu_s() - start_s;
  std::printf("%-10s %-20s", name.c_str(), std::filesystem::path(file).stem().string().substr(0, 20).c_str());
  if (!estimate.status.ok()) std::printf(" %s", estimate.status.message().c_str());
  for (const scenarios::Score& score : scenarios::score(method.info.kind, estimate, {&sensors, &truth, nullptr})) {
    const bool wanted = score.metric.find("error_clipped") != std::string::npos ||
                        score.metric.find("reference_cov") != std::string::npos ||
                        score.metric.find("called") != std::string::npos ||
                        score.metric.find("inclination") != std::string::npos;
    if (wanted)
      std::printf(" %.12s%s %.3f", score.metric.c_str(),
                  score.metric.substr(score.metric.size() > 22 ? 18 : 12, 9).c_str(), score.value);
  }
  std::printf(" | %.1f s", cpu_s);
  print_health(estimate);
}

struct Clipped {
  sim::Sensors sensors;
  std::vector<Eigen::Vector3d> truth;
};

Clipped clipped_trial(const std::string& number, bool flags) {
  const tumble::testing::BroadTrial trial = tumble::testing::read_broad_trial(tumble::testing::broad_folder(), number);
  const auto size = [](const tumble::ImuSample& s) { return s.angular_velocity_rad_s.cwiseAbs().maxCoeff(); };
  const auto peak = std::max_element(trial.samples.begin(), trial.samples.end(),
                                     [&](const auto& a, const auto& b) { return size(a) < size(b); });
  const double rail = size(*peak) / 3.0;
  Clipped out;
  out.sensors.robot = "rig";
  sim::ImuRecord imu;
  imu.name = "imu";
  for (const tumble::ImuSample& sample : trial.samples) {
    if (std::abs(tumble::seconds(sample.time_ns - peak->time_ns)) > 20.0) continue;
    const Eigen::Vector3d& w = sample.angular_velocity_rad_s;
    imu.time_ns.push_back(sample.time_ns);
    imu.gyro_rad_s.push_back(w.cwiseMin(rail).cwiseMax(-rail));
    imu.accel_m_s2.push_back(sample.specific_force_m_s2);
    std::uint8_t bits = 0;
    for (int j = 0; j < 3; ++j)
      if (flags && std::abs(w[j]) > rail) bits = static_cast<std::uint8_t>(bits | (1u << j));
    imu.clip_flags.push_back(bits);
    out.truth.push_back(w);
  }
  imu.period_ns = (imu.time_ns.back() - imu.time_ns.front()) / static_cast<std::int64_t>(imu.time_ns.size() - 1);
  out.sensors.imus.push_back(std::move(imu));
  return out;
}

void broad(const std::string& number, bool flags, const std::string& name, const sim::Values& values,
           std::vector<double>& shares) {
  const Clipped trial = clipped_trial(number, flags);
  const scenarios::Method& method = *scenarios::find_methods(name).front();
  const double start_s = scenarios::process_cpu_s();
  const scenarios::Estimate estimate = method.run(trial.sensors, values, {});
  const double cpu_s = scenarios::process_cpu_s() - start_s;
  std::vector<double> raw, ours;
  double within = 0.0, axes = 0.0;
  for (std::size_t k = 0; k < trial.truth.size() && k < estimate.rates.size(); ++k) {
    const Eigen::Vector3d& reading = trial.sensors.imus.front().gyro_rad_s[k];
    if (reading == trial.truth[k]) continue;
    const Eigen::Vector3d error = estimate.rates[k].w_WI_I_rad_s - trial.truth[k];
    raw.push_back((reading - trial.truth[k]).norm());
    ours.push_back(error.norm());
    for (int j = 0; j < 3; ++j) {
      if (reading[j] == trial.truth[k][j]) continue;
      axes += 1.0;
      within += std::abs(error[j]) < 3.0 * std::sqrt(estimate.rates[k].covariance_rad2_s2(j, j)) ? 1.0 : 0.0;
    }
  }
  const double share = 1.0 - quantile(ours, 0.5) / quantile(raw, 0.5);
  shares.push_back(share);
  std::printf("%-10s BROAD %s %5zu raw %.3f / %.3f, is %.3f / %.3f / %.3f rad/s, %5.1f %% off, within %.3f | %.1f s",
              name.c_str(), number.c_str(), raw.size(), quantile(raw, 0.5), quantile(raw, 0.9), quantile(ours, 0.5),
              quantile(ours, 0.9), quantile(ours, 0.99), 100.0 * share, within / axes, cpu_s);
  print_health(estimate);
}

double attitude(const std::string& number, const std::string& name, const sim::Values& values) {
  const tumble::testing::BroadTrial trial = tumble::testing::read_broad_trial(tumble::testing::broad_folder(), number);
  sim::Sensors sensors;
  sensors.robot = "rig";
  sim::ImuRecord imu;
  imu.name = "imu";
  for (const tumble::ImuSample& sample : trial.samples) {
    imu.time_ns.push_back(sample.time_ns);
    imu.gyro_rad_s.push_back(sample.angular_velocity_rad_s);
    imu.accel_m_s2.push_back(sample.specific_force_m_s2);
  }
  imu.period_ns = (imu.time_ns.back() - imu.time_ns.front()) / static_cast<std::int64_t>(imu.time_ns.size() - 1);
  sensors.imus.push_back(std::move(imu));
  const scenarios::Estimate estimate = scenarios::find_methods(name).front()->run(sensors, values, {});
  std::vector<Eigen::Quaterniond> q_WI;
  for (const tumble::AttitudeState& state : estimate.attitudes) q_WI.push_back(state.orientation_W);
  const tumble::testing::BroadError error = tumble::testing::score(trial, q_WI);
  std::printf("%-10s BROAD %s inclination %.3f deg in motion, %.3f at rest |", name.c_str(), number.c_str(),
              error.inclination_motion_deg, error.inclination_rest_deg);
  print_health(estimate);
  return error.inclination_motion_deg;
}

int run(const Request& request) {
  for (const std::string& name : request.methods) {
    const bool attitudes = name.starts_with("attitude/");
    const sim::Values& values = request.values;
    for (const std::string& file : request.wands) wand(file, name, values);
    std::vector<double> shares, degrees;
    if (!attitudes)
      for (const std::string& number : request.broad) broad(number, request.flags, name, values, shares);
    if (attitudes)
      for (const std::string& number : request.attitude) degrees.push_back(attitude(number, name, values));
    const auto mean = [](const std::vector<double>& v) {
      double sum = 0.0;
      for (const double x : v) sum += x / static_cast<double>(v.size());
      return sum;
    };
    if (!shares.empty()) std::printf("%-10s mean %.1f %% off\n", name.c_str(), 100.0 * mean(shares));
    if (!degrees.empty()) std::printf("%-10s mean %.3f deg\n", name.c_str(), mean(degrees));
  }
  return 0;
}

bool parse(int count, char** words, Request& request) {
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--flags") {
      request.flags = true;
      continue;
    }
    if (i + 1 == count) return false;
    const std::string value = words[++i];
    if (word == "--wand") {
      request.wands.push_back(value);
    } else if (word == "--broad") {
      request.broad.push_back(value);
    } else if (word == "--attitude") {
      request.attitude.push_back(value);
    } else if (word == "--method") {
      request.methods.push_back(value);
    } else if (word == "--set" && value.find('=') != std::string::npos) {
      request.values.set(value.substr(0, value.find('=')), std::stod(value.substr(value.find('=') + 1)));
    } else {
      return false;
    }
  }
  if (request.methods.empty()) request.methods = {"rate/interpolate", "rate/tumble"};
  return true;
}

}  // namespace

int main(int count, char** words) {
  return tumble::bench::run_program(count, words,
                                    "carried_statistics [--wand FILE.h5]... [--broad NUMBER]... [--attitude NUMBER]... "
                                    "[--method NAME]... [--set NAME=VALUE]... [--flags]",
                                    parse, run);
}
