// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/attitude/detail/hand_held_smoother.hpp"

namespace tumble::hand_held {

/// If the determinant of the three sensing directions is below kRowsMin, the directions are assumed linearly dependent.
inline constexpr double kRowsMin = 0.1;
/// standard deviation of a repeated reading's time, in sample periods: 1/sqrt(12) for a uniform distribution
inline constexpr double kAge_samples = 0.29;

/// All times are relative to the centre of the first averaging window.
struct AveragingWindows {
  double period_s = 0.0;
  std::vector<double> window_centre_s;
  std::vector<double> end_s;         ///< end of each window, which is its time stamp
  std::vector<std::size_t> node_of;  ///< nearest node to the centre of each window
};

/// TimedReadings contains each reading of a sensor once, even if the recording repeats the reading.
struct TimedReadings {
  std::vector<ImuSample> samples;  ///< with time stamps at the end of the averaging windows
  std::vector<ClipSigns> clip_signs;
  AveragingWindows averaging_windows;
  std::vector<std::size_t> reading_index_of_sample;  ///< index of the reading of each IMU sample
};

struct GyroReadings : TimedReadings {
  /// standard deviation of the correction for partial saturation, per sensing element; 0 without correction
  std::vector<Eigen::Vector3d> partial_saturation_sigma_rad_s;
};

struct NodeData {
  AveragingWindows samples;
  GyroReadings rates;
  std::vector<NodeReadings> nodes;  ///< time steps of equal length from the first sample's centre
  /// root of the spectral density of angular jerk, per element of `nodes` [rad/s^3 sqrt(s)]; 0 without an estimate
  std::vector<double> jerk;
};

NodeData collect_node_data(const HandHeldSmoother::Params& params, std::span<const ImuSample> samples,
                           const SensingAxisClipSigns& clipped);

inline constexpr double kLongest = 1.5;  ///< longest averaging window of a reading, in sample periods

/// Estimates the root of the spectral density of angular jerk [rad/s^3 sqrt(s)] near each time step (node) of the
/// smoother: carried.md (C24), (C25). Cost: O(N). The result for a time step is 0 if the readings near the time step do
/// not determine the jerk.
std::vector<double> estimate_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s,
                                  double node_s, std::size_t nodes);

/// Returns the gyro's rates, with clipped readings replaced by a cubic polynomial. The cubic polynomial is limited to
/// values between 1 and kFillRatioMax times the saturation level.
std::vector<Eigen::Vector3d> filled_rates(std::span<const ImuSample> samples, const SensingAxisClipSigns& clipped);

/// heuristic upper limit of the initial rates, as a multiple of the saturation level
inline constexpr double kFillRatioMax = 2.5;

/// Without saturation, HandHeldRateStream makes one optimisation step per kFreeNodes nodes (time steps).
inline constexpr int kFreeNodes = 5;

bool clips(const NodeReadings& readings);

/// The time of an accelerometer reading is uniformly distributed over the second half of its period, with a standard
/// deviation of 1/(4 sqrt(3)) periods.
inline constexpr double kWindowCentreSigmaRatio = 0.144;

/// Adds a gyro reading that is `t` seconds later than the time step `node`.
void add_rate(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
              const Eigen::Vector3d& subsample_sigma_rad_s, NodeReadings& node);
void add_force(const ImuSample& sample, const ClipSigns& signs, double t, NodeReadings& node);

/// The attitude filter VQF uses the rates of filled_rates(), and initialises attitude and rate of each time step
/// (node).
Status start_nodes(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows, const NodeData& collected,
                   std::vector<Node>& nodes);

}  // namespace tumble::hand_held
