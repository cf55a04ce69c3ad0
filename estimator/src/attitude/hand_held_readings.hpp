// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/attitude/hand_held_smoother.hpp"

/// hand_held_readings.hpp sums the IMU readings of a hand-held body by node, as input of Problem.
namespace tumble::hand_held {

/// Minimum determinant of the matrix of sensing directions. Below the minimum determinant, the sensing directions do
/// not span the axes.
inline constexpr double kRowsMin = 0.1;
/// Standard deviation of the time of a repeated reading, which is uniform within the previous sample: 1/sqrt(12).
inline constexpr double kAge_samples = 0.29;

/// Windows contains the positions of sample windows relative to the nodes; time zero is the centre of the first
/// sample's window.
struct Windows {
  double period_s = 0.0;
  std::vector<double> centre_s;
  std::vector<double> end_s;         ///< end of each window, which is its time stamp
  std::vector<std::size_t> node_of;  ///< nearest node to the centre of each window
};

/// TimedReadings contains the distinct readings of gyro or accelerometer at their true times, if the sensor is slower
/// than the log.
struct TimedReadings {
  std::vector<ImuSample> samples;  ///< stamped at the end of their windows
  std::vector<ClipSigns> signs;    ///< one per sample
  Windows windows;
  std::vector<std::size_t> of_sample;  ///< index of the reading of each IMU sample
};

/// GyroReadings contains the readings of the gyro, corrected for subsample saturation.
struct GyroReadings : TimedReadings {
  /// Standard deviation of the correction for subsample saturation, per sensing element; 0: not corrected.
  std::vector<Eigen::Vector3d> subsample_sigma_rad_s;
};

/// NodeData contains the readings summed by node, and the positions of samples relative to the nodes.
struct NodeData {
  Windows samples;
  GyroReadings rates;
  std::vector<NodeReadings> nodes;  ///< nodes at equal time steps from the first sample's centre
  /// Root density of the angular jerk, estimated from the readings near each node [rad/s^3 sqrt(s)]; 0: no estimate.
  std::vector<double> jerk;
};

NodeData collect(const HandHeldSmoother::Params& params, std::span<const ImuSample> samples,
                 const ClippedElements& clipped);

inline constexpr double kLongest = 1.5;  ///< longest window, in periods

/// Estimates the root density of the angular jerk near each of `nodes` nodes from the readings [rad/s^3 sqrt(s)]. Cost:
/// O(N). The estimate uses the curvature of unsaturated readings, and the change of slope across clipped segments.
/// Without information, the estimate is 0. See carried.md (C24), (C25).
std::vector<double> estimate_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s,
                                  double node_s, std::size_t nodes);

/// Returns the rates, with clipped segments of each sensing element replaced by cubic polynomials. Value and slope of
/// the rates are continuous at both ends of a clipped segment. The cubic polynomial stays between the saturation level
/// and kFillRatioMax times the level.
std::vector<Eigen::Vector3d> filled_rates(std::span<const ImuSample> samples, const ClippedElements& clipped);

inline constexpr double kFillRatioMax = 2.5;  ///< heuristic, affects only initial values

/// Number of nodes per step while no sample in the window of HandHeldStream is clipped.
inline constexpr int kFreeNodes = 5;

/// Returns whether a sensing element of the gyro is unmeasured for a part of the node's time.
bool clips(const NodeReadings& readings);

/// Standard deviation of the window centre of an accelerometer with unknown averaging, as a fraction of the period:
/// 1/(4 sqrt(3)). The window centre is assumed uniform between the window's end and its middle.
inline constexpr double kWindowCentreSigmaRatio = 0.144;

/// Adds one reading of the gyro, at `t` seconds from the node. `subsample_sigma_rad_s` is the additional standard
/// deviation per sensing element.
void add_rate(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
              const Eigen::Vector3d& subsample_sigma_rad_s, NodeReadings& node);
void add_force(const ImuSample& sample, const ClipSigns& signs, double t, NodeReadings& node);

/// Initialises attitude and rates of the nodes by a filter (VQF) on the filled rates, and the held point's acceleration
/// by the remaining force.
Status start_nodes(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows, const NodeData& collected,
                   std::vector<Node>& nodes);

}  // namespace tumble::hand_held
