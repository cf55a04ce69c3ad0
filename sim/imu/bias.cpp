// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/bias.hpp"

#include <cmath>
#include <numbers>

#include "sim/imu/allan.hpp"
#include "sim/imu/stages.hpp"

namespace tumble::sim {

namespace {

// Ratio of successive correlation times of the Gauss-Markov processes. With the ratio 10, the Allan deviation of the
// sum is flat within 2 %.
constexpr double kRatio = 10.0;

/// Returns the standard deviation sigma of each Gauss-Markov process, such that the sum of the processes approximates
/// flicker noise with the Allan deviation `floor`. At frequency f, the sum of the processes has the spectrum sigma^2 /
/// (f ln kRatio). Flicker noise has the spectrum floor^2 / (2 f ln 2).
double sigma_of_one(double floor) {
  return floor * std::sqrt(std::log(kRatio) / (2.0 * std::numbers::ln2));
}

double time_of(const Bias::Params& params, std::size_t i) {
  return params.in_run_s / std::pow(kRatio, static_cast<double>(i));
}

}  // namespace

Bias::Bias(const Params& params, double period_s, const Stream& stream)
    : stream_(stream),
      walk_step_(params.walk_sqrt_s * std::sqrt(period_s)),
      constant_(normals(stream_, params.turn_on)) {
  const double sigma = sigma_of_one(params.in_run);
  for (std::size_t i = 0; i < in_run_.size(); ++i) {
    const double decay = std::exp(-period_s / time_of(params, i));
    in_run_[i] = {decay, sigma * std::sqrt(1.0 - decay * decay), normals(stream_, sigma)};
  }
}

Eigen::Vector3d Bias::next() {
  Eigen::Vector3d now = constant_ + walk_;
  for (Process& process : in_run_) {
    now += process.value;
    process.value = process.decay * process.value + normals(stream_, process.step);
  }
  walk_ += normals(stream_, walk_step_);
  return now;
}

double Bias::in_run_deviation(const Params& params, double tau_s) {
  const double sigma = sigma_of_one(params.in_run);
  double variance = 0.0;
  for (std::size_t i = 0; i < std::tuple_size_v<decltype(in_run_)>; ++i)
    variance += std::pow(gauss_markov_deviation(sigma, time_of(params, i), tau_s), 2);
  return std::sqrt(variance);
}

}  // namespace tumble::sim
