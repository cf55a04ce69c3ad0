// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

namespace tumble::bench {

/// RatePool contains the errors of one method of kind `rate`, over many runs. Clipped samples, segments and contact are
/// defined as in the scores (ClippingTruth; consecutive samples with a clipped axis; any contact within the window of
/// the sample).
class RatePool {
 public:
  struct Segment {
    std::uint64_t seed = 0;
    double end_s = 0.0;
    std::size_t samples = 0;
    double mean_rad_s = 0.0;     ///< norm of the mean error vector
    double largest_rad_s = 0.0;  ///< norm of the largest error
    double contact_share = 0.0;
    double accel_clipped_share = 0.0;
    double sigma_rad_s = 0.0;  ///< root mean trace of the reported covariance
  };
  struct Run {
    std::uint64_t seed = 0;
    double clipped_mean_rad_s = 0.0, free_mean_rad_s = 0.0, noise_rad_s = 0.0;
    std::size_t clipped = 0;
    bool converged = true;  ///< every optimisation that reports convergence has converged
  };

  explicit RatePool(std::string name) : name_(std::move(name)) {}

  /// Adds a run; samples without an estimate count as failed, with an infinite error.
  void add(std::uint64_t seed, const sim::Recording& recording, const scenarios::Estimate& estimate, double cpu_s);

  const std::string& name() const { return name_; }
  std::span<const double> clipped_rad_s() const { return clipped_; }
  std::span<const double> free_rad_s() const { return free_; }
  /// Returns the errors of samples in which the body does not touch the ground.
  std::span<const double> flight_rad_s() const { return flight_; }
  std::span<const double> contact_rad_s() const { return contact_; }
  /// Returns squared errors of clipped axes divided by their reported variances.
  std::span<const double> normalised_flight() const { return normalised_flight_; }
  std::span<const double> normalised_contact() const { return normalised_contact_; }
  /// Counts the clipped samples that the method calls neither clipped nor suspect.
  std::size_t called_measured() const { return called_measured_; }
  std::span<const Segment> segments() const { return segments_; }
  std::span<const Run> runs() const { return runs_; }
  double cpu_us_per_sample() const { return 1e6 * cpu_s_ / static_cast<double>(clipped_.size() + free_.size()); }

 private:
  std::string name_;
  std::vector<double> clipped_, free_, flight_, contact_, normalised_flight_, normalised_contact_;
  std::vector<Segment> segments_;
  std::vector<Run> runs_;
  std::size_t called_measured_ = 0;
  double cpu_s_ = 0.0;
};

/// Prints quantiles of the pooled errors, and the median relative to that of the first pool.
void print_errors(std::span<const RatePool> pools);
/// Prints the errors of clipped samples in flight and in contact.
void print_contact(std::span<const RatePool> pools);
/// Prints the coverage of three standard deviations with its 95 % interval, and the mean normalised squared error.
void print_honesty(std::span<const RatePool> pools);
/// Prints runs that are worse than in the first pool by more than the gyro's noise, offsets of segments, and every
/// error relative to that of the pool `tumble`.
void print_runs(std::span<const RatePool> pools);
/// Prints the segments with the largest offsets.
void print_worst(const RatePool& pool, std::size_t count);

}  // namespace tumble::bench
