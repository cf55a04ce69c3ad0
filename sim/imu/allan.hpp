// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// Overlapping Allan deviation of a sensor at rest, and how far the figure can be trusted. Pure functions of numbers:
/// nothing here knows the simulation. Source: Riley, "Handbook of Frequency Stability Analysis", NIST Special
/// Publication 1065 (2008), sections 5.2.5 (overlapping Allan variance), 5.3.2 (confidence), table 5 (degrees of
/// freedom); IEEE Std 952-1997, annex C, for the names of the noises of a gyroscope.
namespace tumble::sim {

/// Allan deviation at one averaging time.
struct AllanPoint {
  double tau_s = 0.0;
  double deviation = 0.0;   ///< [unit of the series]
  std::size_t cluster = 0;  ///< samples averaged, tau / period
  std::size_t samples = 0;  ///< of each series
  std::size_t series = 1;   ///< independent series that the figure is the mean of
};

/// The noise that dominates at an averaging time; it decides how many independent figures the average holds.
enum class AllanNoise {
  white,    ///< N / sqrt(tau): angle (velocity) random walk
  flicker,  ///< the floor: bias instability
  walk,     ///< K sqrt(tau / 3): random walk of the bias
};

/// Overlapping Allan deviation of `samples` (means over consecutive periods: rates, not angles) at averaging times
/// spaced evenly in the logarithm, `per_decade` of them, from one period to a ninth of the series. The mean of the
/// series does not matter. Empty when the series is shorter than nine samples. O(samples) for each time. Throws
/// std::invalid_argument for a period that is not positive and finite, `per_decade` outside of [1, 100], or a sample
/// that is not finite.
std::vector<AllanPoint> allan_deviation(std::span<const double> samples, double period_s, int per_decade = 5);

/// The root of the mean variance of several independent series of equal length and period: the axes of a triad. Throws
/// std::invalid_argument when there is none or their averaging times differ.
std::vector<AllanPoint> mean_deviation(std::span<const std::vector<AllanPoint>> series);

/// Deviation at the averaging time nearest to `tau_s` (in the ratio). Throws std::invalid_argument for an empty curve.
const AllanPoint& nearest_point(std::span<const AllanPoint> curve, double tau_s);

/// Equivalent degrees of freedom of the variance at one point, at least 1 (NIST SP 1065, table 5, Howe's
/// approximations).
double degrees_of_freedom(const AllanPoint& point, AllanNoise noise);

struct AllanInterval {
  double low = 0.0, high = 0.0;
};

/// Where the true deviation lies, with the probability of `sigmas` standard deviations of a normal distribution (3:
/// 99.73 %): chi-squared with the degrees of freedom above, its quantiles by Wilson and Hilferty (1931; within 1 % for
/// 3 degrees or more). Throws std::invalid_argument unless 0 < sigmas <= 6.
AllanInterval confidence_interval(const AllanPoint& point, AllanNoise noise, double sigmas = 3.0);

/// Allan deviation in closed form at averaging time `tau_s`: white noise of density N [unit / sqrt(Hz)] ...
double white_deviation(double density, double tau_s);
/// ... a random walk of K [unit / sqrt(s)] ...
double walk_deviation(double walk_sqrt_s, double tau_s);
/// ... and a first-order Gauss-Markov process of stationary standard deviation `sigma` and correlation time `time_s`.
double gauss_markov_deviation(double sigma, double time_s, double tau_s);

}  // namespace tumble::sim
