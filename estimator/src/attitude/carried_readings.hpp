// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/attitude/carried_smoother.hpp"

/// Readings of a carried body's IMU, summed by node: what its Problem is made of.
namespace tumble::carried {

/// Least determinant of the elements' rows: below, they do not span the axes.
inline constexpr double kRowsMin = 0.1;
/// Deviation of the time at which a reading was taken that the log says again, anywhere within the sample before:
/// 1/sqrt(12).
inline constexpr double kTaken_samples = 0.29;

/// Where windows lie on the line of the nodes, which begins at the centre of the first sample's window.
struct Windows {
  double period_s = 0.0;             ///< median
  std::vector<double> centre_s;      ///< of each window
  std::vector<double> end_s;         ///< of each window: its time stamp
  std::vector<std::size_t> node_of;  ///< the nearest to each centre
};

/// The readings of one triad, each once and at its own time: one that is slower than the log repeats itself.
struct OwnReadings {
  std::vector<ImuSample> samples;  ///< stamped at the end of their windows
  std::vector<ClipSigns> signs;    ///< one per sample
  Windows windows;
  std::vector<std::size_t> of_sample;  ///< of each sample of the IMU, the reading that it says, anew or again
};

/// Those of the gyro, and what a window lost that met the rail in a part of its length.
struct GyroReadings : OwnReadings {
  /// Deviation of what a window lost of each element's reading, which stands in the readings; 0: the reading is whole.
  std::vector<Eigen::Vector3d> open_rad_s;
};

/// What the readings about each node say, and where the samples lie among the nodes.
struct Collected {
  Windows samples;
  GyroReadings rates;
  std::vector<NodeReadings> nodes;  ///< at equal times from the first sample's centre
  /// Root density of the angular jerk that the readings about each node show [rad/s^3 sqrt(s)]; 0: none is there.
  std::vector<double> jerk;
};

/// Sums the readings by node. O(N).
Collected collect(const CarriedSmoother::Params& params, std::span<const ImuSample> samples,
                  const ClippedElements& clipped);

inline constexpr double kLongest = 1.5;  ///< periods: the longest window

/// The root density of the angular jerk about each of `nodes` nodes as readings show it [rad/s^3 sqrt(s)]: where they
/// are free by how they bend, across what an element hides by how its slope has changed meanwhile; 0 where none tells.
/// carried.md (C37), (C39). O(N).
std::vector<double> seen_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s, double node_s,
                              std::size_t nodes);

/// Rates with the clipped segments of each element replaced by cubics: value and slope continued from both sides, held
/// beyond the rail and within kFillMost of it.
std::vector<Eigen::Vector3d> filled_rates(std::span<const ImuSample> samples, const ClippedElements& clipped);

inline constexpr double kFillMost = 2.5;  ///< rails: the fill is a start, no more

/// While nothing in the window of CarriedStream clips, one step for so many nodes.
inline constexpr int kFreeNodes = 5;

/// Whether an element of the gyro is not read, in a part of the node's time or in all of it.
bool clips(const NodeReadings& readings);

/// Of the period of an accelerometer that may filter for all of it or read at once: deviation of a centre that lies
/// evenly between the window's end and its middle, 1/(4 sqrt(3)).
inline constexpr double kOpenShare = 0.144;

/// Adds one triad's reading, `t` seconds from the node; `open_rad_s`: more deviation of each element's.
void add_rate(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
              const Eigen::Vector3d& open_rad_s, NodeReadings& node);
void add_force(const ImuSample& sample, const ClipSigns& signs, double t, NodeReadings& node);

/// Attitude and rates of the nodes by a filter (VQF) on the filled rates; the hand's acceleration is what is left.
Status start_nodes(const CarriedSmoother::Params& params, const Eigen::Matrix3d& rows, const Collected& collected,
                   std::vector<Node>& nodes);

}  // namespace tumble::carried
