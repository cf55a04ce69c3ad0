// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/attitude/detail/hand_held_smoother.hpp"

/// hand_held_readings.hpp assigns the IMU readings of a hand-held body to nodes (time steps), as input of Problem.
namespace tumble::hand_held {

/// kRowsMin is the minimum determinant of the matrix of sensing directions. Below kRowsMin, the sensing directions do
/// not span three dimensions.
inline constexpr double kRowsMin = 0.1;
/// kAge_samples is the standard deviation of a repeated reading's time, in samples: 1/sqrt(12) for a uniform
/// distribution.
inline constexpr double kAge_samples = 0.29;

/// Windows contains the times of the readings' averaging windows. Time zero is the centre of the first window.
struct Windows {
  double period_s = 0.0;
  std::vector<double> centre_s;
  std::vector<double> end_s;         ///< end of each window, which is its time stamp
  std::vector<std::size_t> node_of;  ///< nearest node to the centre of each window
};

/// TimedReadings contains the readings of a gyro or accelerometer with their true times, without repetitions. The
/// sensor may be slower than the log.
struct TimedReadings {
  std::vector<ImuSample> samples;  ///< stamped at the end of their windows
  std::vector<ClipSigns> signs;    ///< one per sample
  Windows windows;
  std::vector<std::size_t> of_sample;  ///< index of the reading of each IMU sample
};

/// GyroReadings contains the readings of the gyro without repetitions, corrected for partial saturation of the
/// averaging window.
struct GyroReadings : TimedReadings {
  /// Standard deviation of the correction for partial saturation, per sensing element; 0: not corrected.
  std::vector<Eigen::Vector3d> subsample_sigma_rad_s;
};

/// NodeData contains the readings assigned to nodes, and the times of samples relative to the nodes.
struct NodeData {
  Windows samples;
  GyroReadings rates;
  std::vector<NodeReadings> nodes;  ///< nodes at equal time steps from the first sample's centre
  /// Root density of the angular jerk, estimated from the readings near each node [rad/s^3 sqrt(s)]; 0: no estimate.
  std::vector<double> jerk;
};

NodeData collect(const HandHeldSmoother::Params& params, std::span<const ImuSample> samples,
                 const ClippedElements& clipped);

inline constexpr double kLongest = 1.5;  ///< longest averaging window, in sample periods

/// Estimates the root density of the angular jerk near each of `nodes` nodes [rad/s^3 sqrt(s)] from the readings:
/// carried.md (C24), (C25). Cost: O(N). The jerk follows from the curvature of unsaturated readings, and from the
/// change of slope across clipped segments. The result is 0 where the readings do not determine the jerk.
std::vector<double> estimate_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s,
                                  double node_s, std::size_t nodes);

/// Returns the gyro's rates, with a cubic polynomial in place of each clipped segment of a sensing element. Value and
/// slope are continuous at both ends of the segment. The cubic stays between 1 and kFillRatioMax times the saturation
/// level.
std::vector<Eigen::Vector3d> filled_rates(std::span<const ImuSample> samples, const ClippedElements& clipped);

/// heuristic upper limit of the initial rates, as a multiple of the saturation level
inline constexpr double kFillRatioMax = 2.5;

/// While the window contains no clipped sample, HandHeldStream makes one optimisation step per kFreeNodes nodes.
inline constexpr int kFreeNodes = 5;

/// Returns whether a node has clipped or unusable gyro readings.
bool clips(const NodeReadings& readings);

/// kWindowCentreSigmaRatio is the standard deviation of the time of an accelerometer reading, as a fraction of its
/// period. The time is uniformly distributed over the second half of the period, hence 1/(4 sqrt(3)).
inline constexpr double kWindowCentreSigmaRatio = 0.144;

/// Adds a gyro reading to a node. The reading is `t` seconds after the node. `subsample_sigma_rad_s` is the standard
/// deviation of its correction for partial saturation, per sensing element.
void add_rate(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
              const Eigen::Vector3d& subsample_sigma_rad_s, NodeReadings& node);
void add_force(const ImuSample& sample, const ClipSigns& signs, double t, NodeReadings& node);

/// Initialises attitude and rates of the nodes by a VQF filter with the rates of filled_rates(). The initial hand
/// acceleration is the force that gravity and rotation do not explain.
Status start_nodes(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows, const NodeData& collected,
                   std::vector<Node>& nodes);

}  // namespace tumble::hand_held
