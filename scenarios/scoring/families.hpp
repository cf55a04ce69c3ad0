// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/scoring/score.hpp"

namespace tumble::scenarios {

std::vector<Metric> rate_metrics();
std::vector<Metric> binned_rate_metrics();
std::vector<Metric> reference_rate_metrics();  ///< for recordings with a reference instrument
std::vector<Metric> attitude_metrics();
std::vector<Metric> position_metrics();
std::vector<Metric> slip_metrics();
std::vector<Metric> trajectory_metrics(Kind kind);  ///< for kinds position and slam
std::vector<Metric> end_pose_metrics();
std::vector<Metric> map_metrics();
std::vector<Metric> sweep_border_metrics();
std::vector<Metric> time_offset_metrics();  ///< for all kinds
std::vector<Metric> health_metrics();       ///< does the health detect errors?

std::vector<MetricInfo> cost_quantities();
std::vector<MetricInfo> motion_quantities();
std::vector<MetricInfo> binned_rate_quantities();

inline constexpr double kNormal3Sigma = 0.9973;

double rms(std::span<const double> values);

}  // namespace tumble::scenarios
