// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/attitude/carried_smoother.hpp"

/// Readings of a hand-held body's IMU, summed by node: input of Problem.
namespace tumble::carried {

/// Minimum determinant of the matrix of sensing directions. Below this determinant, the directions do not span the
/// axes.
inline constexpr double kRowsMin = 0.1;
/// Standard deviation of the time of a repeated reading, uniform within the previous sample: 1/sqrt(12).
inline constexpr double kTaken_samples = 0.29;

/// Positions of windows relative to the nodes, whose time starts at the centre of the first sample's window.
struct Windows {
  double period_s = 0.0;
  std::vector<double> centre_s;
  std::vector<double> end_s;         ///< of each window: its time stamp
  std::vector<std::size_t> node_of;  ///< nearest node to each centre
};

/// Distinct readings of one triad at their true times; a triad that is slower than the log repeats readings.
struct OwnReadings {
  std::vector<ImuSample> samples;  ///< stamped at the end of their windows
  std::vector<ClipSigns> signs;    ///< one per sample
  Windows windows;
  std::vector<std::size_t> of_sample;  ///< for each sample of the IMU, the index of its reading
};

/// Readings of the gyro, corrected for subsample saturation.
struct GyroReadings : OwnReadings {
  /// Standard deviation of the correction for subsample saturation, per element; 0: not corrected.
  std::vector<Eigen::Vector3d> open_rad_s;
};

/// Readings summed by node, and the positions of samples relative to the nodes.
struct Collected {
  Windows samples;
  GyroReadings rates;
  std::vector<NodeReadings> nodes;  ///< at equal times from the first sample's centre
  /// Root density of the angular jerk estimated from the readings near each node [rad/s^3 sqrt(s)]; 0: no estimate.
  std::vector<double> jerk;
};

Collected collect(const CarriedSmoother::Params& params, std::span<const ImuSample> samples,
                  const ClippedElements& clipped);

inline constexpr double kLongest = 1.5;  ///< longest window, in periods

/// Estimates the root density of the angular jerk near each of `nodes` nodes from readings [rad/s^3 sqrt(s)]. The
/// estimate uses the curvature of unsaturated readings, and the change of slope across clipped segments. The estimate
/// is 0 without information. carried.md (C24), (C25). Cost: O(N).
std::vector<double> seen_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s, double node_s,
                              std::size_t nodes);

/// Returns the rates with clipped segments of each sensing element replaced by cubics. Value and slope are continuous
/// at both ends of a segment. The cubic stays between the saturation level and kFillMost times the level.
std::vector<Eigen::Vector3d> filled_rates(std::span<const ImuSample> samples, const ClippedElements& clipped);

inline constexpr double kFillMost = 2.5;  ///< only an initial value

/// Nodes per step while nothing in the window of CarriedStream clips.
inline constexpr int kFreeNodes = 5;

/// Returns whether an element of the gyro is unmeasured for a part of the node's time.
bool clips(const NodeReadings& readings);

/// Standard deviation of the window centre of an accelerometer with unknown averaging, as a fraction of the period:
/// 1/(4 sqrt(3)). The centre is uniform between the window's end and its middle.
inline constexpr double kOpenShare = 0.144;

/// Adds one reading of the gyro, `t` seconds from the node. `open_rad_s` is the additional standard deviation per
/// element.
void add_rate(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
              const Eigen::Vector3d& open_rad_s, NodeReadings& node);
void add_force(const ImuSample& sample, const ClipSigns& signs, double t, NodeReadings& node);

/// Initialises attitude and rates of the nodes by a filter (VQF) on the filled rates, and the held point's acceleration
/// by the remaining force.
Status start_nodes(const CarriedSmoother::Params& params, const Eigen::Matrix3d& rows, const Collected& collected,
                   std::vector<Node>& nodes);

}  // namespace tumble::carried
