// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/attitude/carried_smoother.hpp"

namespace tumble::carried {

/// Node and offset from it of each sample's window, and what the samples about each node say.
struct Collected {
  double period_s = 0.0;             ///< median
  std::vector<double> centre_s;      ///< of each sample's window, from the first one's
  std::vector<double> end_s;         ///< of each sample's window: its time stamp, from the first window's centre
  std::vector<std::size_t> node_of;  ///< the nearest to each sample's centre
  std::vector<NodeReadings> nodes;   ///< at equal times from the first sample's centre
};

/// Sums the readings by node. O(N).
Collected collect(const CarriedSmoother::Params& params, std::span<const ImuSample> samples,
                  const ClippedElements& clipped);

/// Rates with the clipped stretches of each element replaced by cubics: value and slope continued from both sides, held
/// beyond the rail and within kFillMost of it.
std::vector<Eigen::Vector3d> filled_rates(std::span<const ImuSample> samples, const ClippedElements& clipped);

inline constexpr double kFillMost = 2.5;  ///< rails: the fill is a start, no more

/// Attitude and rates of the nodes by a filter (VQF) on the filled rates; the hand's acceleration is what is left.
Status start_nodes(const CarriedSmoother::Params& params, std::span<const ImuSample> samples,
                   const ClippedElements& clipped, const Collected& collected, std::vector<Node>& nodes);

/// The normal equations of one recording and their solution.
class Problem {
 public:
  Problem(const CarriedSmoother::Params& params, const Eigen::Matrix3d& rows, double period_s,
          std::span<const NodeReadings> readings, std::vector<Node> nodes);

  /// Gauss-Newton; `diverged` when the equations lose their definiteness.
  Status solve(CarriedSmoother::Report& report);
  /// Covariances of all nodes at the solution.
  Status covariances(CarriedSmoother::Report& report);

  std::span<const Node> nodes() const { return nodes_; }
  /// Of attitude (error in sensor axes), rate, angular acceleration.
  const Eigen::Matrix<double, 9, 9>& covariance(std::size_t node) const { return covariances_[node]; }

 private:
  double linearise();
  bool eliminate(System::BorderVector& step);
  bool step(double& largest);
  void follow_hand();
  double hand_surprise() const;

  CarriedSmoother::Params params_;
  Eigen::Matrix3d rows_;
  std::span<const NodeReadings> readings_;
  Motion motion_;
  ReadingNoise noise_;
  Eigen::Vector3d g_W_m_s2_;
  std::vector<Node> nodes_;
  Constants constants_;
  std::vector<double> hand_;        // what the density of the hand's acceleration is multiplied with, per step
  std::vector<double> hand_power_;  // running sum of its square
  std::vector<System::Block> blocks_;
  System::Corner corner_;
  System::BorderMatrix constants_covariance_;
  std::vector<Eigen::Matrix<double, 9, 9>> covariances_;
};

}  // namespace tumble::carried
