// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/scoring/score.hpp"

/// The metrics, one source file per family. Add one: write its function in the family's file and name it in the list
/// there; a new family is declared here and joined once in score.cpp.
namespace tumble::scenarios {

std::vector<Metric> rate_metrics();
std::vector<Metric> binned_rate_metrics();
std::vector<Metric> reference_rate_metrics();  ///< of recordings whose truth is another instrument's
std::vector<Metric> attitude_metrics();
std::vector<Metric> position_metrics();
std::vector<Metric> slip_metrics();
std::vector<Metric> trajectory_metrics(Kind kind);  ///< of kinds position and slam
std::vector<Metric> end_pose_metrics();
std::vector<Metric> map_metrics();
std::vector<Metric> sweep_border_metrics();
std::vector<Metric> time_offset_metrics();  ///< of all kinds

/// Besides the metrics: costs and values of the motion, which sweeps store; measures and bases of the binned metrics.
std::vector<MetricInfo> cost_quantities();
std::vector<MetricInfo> motion_quantities();
std::vector<MetricInfo> binned_rate_quantities();

/// Share of a normal variable within three standard deviations.
inline constexpr double kNormal3Sigma = 0.9973;

/// Root of the mean of squares; NaN when there is nothing to average.
double rms(std::span<const double> values);

}  // namespace tumble::scenarios
