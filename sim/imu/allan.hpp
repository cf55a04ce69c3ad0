// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// The equations of the Allan deviation are from Riley, "Handbook of Frequency Stability Analysis", NIST Special
/// Publication 1065 (2008), sections 5.2.5, 5.3.2 and table 5. The names of the noise types of a gyro are from IEEE Std
/// 952-1997, annex C.
namespace tumble::sim {

struct AllanPoint {
  double tau_s = 0.0;
  double deviation = 0.0;   ///< in the unit of the series
  std::size_t cluster = 0;  ///< tau / period
  std::size_t samples = 0;  ///< per series
  std::size_t series = 1;
};

/// AllanNoise is the dominant noise type at an averaging time, which determines the degrees of freedom of the Allan
/// variance.
enum class AllanNoise {
  white,    ///< N / sqrt(tau): angle random walk
  flicker,  ///< minimum of the Allan deviation: bias instability
  walk,     ///< K sqrt(tau / 3): bias random walk
};

/// Computes the overlapping Allan deviation of `samples`. The samples are means over consecutive sample periods (rates,
/// not angles). The averaging times range from one sample period to a ninth of the series, with `per_decade` averaging
/// times per decade.
std::vector<AllanPoint> allan_deviation(std::span<const double> samples, double period_s, int per_decade = 5);

/// Returns the root of the mean Allan variance of several independent series of equal length and period, for example
/// the axes of a triad.
std::vector<AllanPoint> mean_deviation(std::span<const std::vector<AllanPoint>> series);

const AllanPoint& nearest_point(std::span<const AllanPoint> curve, double tau_s);

/// Returns the equivalent number of degrees of freedom of the Allan variance at one averaging time, which is at least
/// 1. The function uses Howe's approximations (NIST SP 1065, table 5).
double degrees_of_freedom(const AllanPoint& point, AllanNoise noise);

struct AllanInterval {
  double low = 0.0, high = 0.0;
};

/// Returns the confidence interval of the true Allan deviation by the chi-squared distribution, with the quantiles of
/// Wilson and Hilferty (1931). The confidence level is the probability that a normally distributed number is within
/// `sigmas` standard deviations, for example 99.73 % for 3.
AllanInterval confidence_interval(const AllanPoint& point, AllanNoise noise, double sigmas = 3.0);

/// Returns the Allan deviation of white noise with density N [unit / sqrt(Hz)].
double white_deviation(double density, double tau_s);
/// Returns the Allan deviation of a random walk with coefficient K [unit / sqrt(s)].
double walk_deviation(double walk_sqrt_s, double tau_s);
/// Returns the Allan deviation of a first-order Gauss-Markov process with stationary standard deviation `sigma` and
/// correlation time `time_s`.
double gauss_markov_deviation(double sigma, double time_s, double tau_s);

}  // namespace tumble::sim
