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

/// Errors of one method of kind `rate` over many runs. Clipping, segments and contact are defined as for the scores
/// (ClippingTruth). A segment is a sequence of samples with a clipped axis. A sample has contact if its window does.
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

  /// Adds a run. Samples without an estimate count as failed, with an infinite error.
  void add(std::uint64_t seed, const sim::Recording& recording, const scenarios::Estimate& estimate, double cpu_s);

  const std::string& name() const { return name_; }
  std::span<const double> clipped_rad_s() const { return clipped_; }
  std::span<const double> free_rad_s() const { return free_; }
  /// Errors, separately for samples with and without ground contact within their window.
  std::span<const double> flight_rad_s() const { return flight_; }
  std::span<const double> contact_rad_s() const { return contact_; }
  /// Squared errors of clipped axes, divided by their reported variances.
  std::span<const double> normalised_flight() const { return normalised_flight_; }
  std::span<const double> normalised_contact() const { return normalised_contact_; }
  /// Clipped samples that the method classifies neither as clipped nor as suspect.
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

/// Prints quantiles of the pooled errors, and the ratio of the median to that of the first pool.
void print_errors(std::span<const RatePool> pools);
/// Prints errors of clipped samples in flight and in contact.
void print_contact(std::span<const RatePool> pools);
/// Prints the coverage of three standard deviations with its 95 % interval, and the mean normalised squared error.
void print_honesty(std::span<const RatePool> pools);
/// Prints the runs that are worse than in the first pool by more than the gyro's noise, the offsets of segments, and
/// each error as a multiple of the error of the pool `tumble`.
void print_runs(std::span<const RatePool> pools);
/// Prints the segments with the largest offsets.
void print_worst(const RatePool& pool, std::size_t count);

}  // namespace tumble::bench
