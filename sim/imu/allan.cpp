// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/allan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tumble::sim {

namespace {

constexpr std::size_t kLeastClusters = 9;

std::vector<double> integrate(std::span<const double> samples) {
  double mean = 0.0;
  for (const double sample : samples) mean += sample;
  mean /= static_cast<double>(samples.size());
  std::vector<double> sums(samples.size() + 1, 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) sums[i + 1] = sums[i] + (samples[i] - mean);
  if (!std::isfinite(sums.back())) throw std::invalid_argument("allan_deviation: a sample is not finite");
  return sums;
}

double deviation_of(const std::vector<double>& sums, std::size_t cluster) {
  const std::size_t count = sums.size() - 2 * cluster;
  double total = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double difference = sums[i + 2 * cluster] - 2.0 * sums[i + cluster] + sums[i];
    total += difference * difference;
  }
  return std::sqrt(total / (2.0 * static_cast<double>(count))) / static_cast<double>(cluster);
}

double chi_squared_quantile(double degrees, double sigmas) {
  const double a = 2.0 / (9.0 * degrees);
  return degrees * std::pow(std::max(1.0 - a + sigmas * std::sqrt(a), 1e-3), 3);
}

}  // namespace

std::vector<AllanPoint> allan_deviation(std::span<const double> samples, double period_s, int per_decade) {
  if (!(period_s > 0.0) || !std::isfinite(period_s))
    throw std::invalid_argument("allan_deviation: period_s must be above 0");
  if (per_decade < 1 || per_decade > 100)
    throw std::invalid_argument("allan_deviation: per_decade (averaging times per decade) must be within [1, 100]");
  std::vector<AllanPoint> curve;
  if (samples.size() < kLeastClusters) return curve;
  const std::vector<double> sums = integrate(samples);
  const std::size_t largest = samples.size() / kLeastClusters;
  for (int i = 0;; ++i) {
    const std::size_t cluster =
        static_cast<std::size_t>(std::llround(std::pow(10.0, static_cast<double>(i) / per_decade)));
    if (cluster > largest) break;
    if (!curve.empty() && curve.back().cluster == cluster) continue;
    curve.push_back({static_cast<double>(cluster) * period_s, deviation_of(sums, cluster), cluster, samples.size(), 1});
  }
  return curve;
}

std::vector<AllanPoint> mean_deviation(std::span<const std::vector<AllanPoint>> series) {
  if (series.empty()) throw std::invalid_argument("mean_deviation: there is no series; give at least one");
  std::vector<AllanPoint> mean = series.front();
  for (std::size_t i = 0; i < mean.size(); ++i) {
    double variance = 0.0;
    std::size_t count = 0;
    for (const std::vector<AllanPoint>& each : series) {
      if (each.size() != mean.size() || each[i].tau_s != mean[i].tau_s || each[i].samples != mean[i].samples)
        throw std::invalid_argument("mean_deviation: the averaging times of the series differ; they must be equal");
      variance += each[i].deviation * each[i].deviation * static_cast<double>(each[i].series);
      count += each[i].series;
    }
    mean[i].deviation = std::sqrt(variance / static_cast<double>(count));
    mean[i].series = count;
  }
  return mean;
}

const AllanPoint& nearest_point(std::span<const AllanPoint> curve, double tau_s) {
  if (curve.empty()) throw std::invalid_argument("nearest_point: the curve has no points; it must have at least one");
  return *std::min_element(curve.begin(), curve.end(), [&](const AllanPoint& a, const AllanPoint& b) {
    return std::abs(std::log(a.tau_s / tau_s)) < std::abs(std::log(b.tau_s / tau_s));
  });
}

double degrees_of_freedom(const AllanPoint& point, AllanNoise noise) {
  const double n = static_cast<double>(point.samples) + 1.0;  // NIST table counts integral points
  const double m = static_cast<double>(point.cluster);
  double degrees = 0.0;
  switch (noise) {
    case AllanNoise::white:
      degrees = (1.5 * (n - 1.0) / m - 2.0 * (n - 2.0) / n) * 4.0 * m * m / (4.0 * m * m + 5.0);
      break;
    case AllanNoise::flicker:
      degrees = point.cluster == 1 ? 2.0 * (n - 2.0) * (n - 2.0) / (2.3 * n - 4.9) : 1.25 * n * n / (m * (n + 3.0 * m));
      break;
    case AllanNoise::walk:
      degrees = (n - 2.0) / m * ((n - 1.0) * (n - 1.0) - 3.0 * m * (n - 1.0) + 4.0 * m * m) / ((n - 3.0) * (n - 3.0));
      break;
  }
  return std::max(degrees * static_cast<double>(point.series), 1.0);
}

AllanInterval confidence_interval(const AllanPoint& point, AllanNoise noise, double sigmas) {
  if (!(sigmas > 0.0 && sigmas <= 6.0))
    throw std::invalid_argument("confidence_interval: sigmas must be within (0, 6]");
  const double degrees = degrees_of_freedom(point, noise);
  return {point.deviation * std::sqrt(degrees / chi_squared_quantile(degrees, sigmas)),
          point.deviation * std::sqrt(degrees / chi_squared_quantile(degrees, -sigmas))};
}

double white_deviation(double density, double tau_s) {
  return density / std::sqrt(tau_s);
}

double walk_deviation(double walk_sqrt_s, double tau_s) {
  return walk_sqrt_s * std::sqrt(tau_s / 3.0);
}

double gauss_markov_deviation(double sigma, double time_s, double tau_s) {
  const double x = tau_s / time_s;
  // x is the ratio of averaging time to correlation time. For small x, large terms of the exact formula cancel, so
  // `bracket` is the series x^2 / 3 - x^3 / 4.
  const double bracket =
      x < 1e-3 ? x * x / 3.0 - x * x * x / 4.0 : 1.0 - (3.0 - 4.0 * std::exp(-x) + std::exp(-2.0 * x)) / (2.0 * x);
  return sigma * std::sqrt(2.0 / x * bracket);
}

}  // namespace tumble::sim
