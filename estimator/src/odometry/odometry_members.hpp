// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

#include "../attitude/imu_plausibility_members.hpp"
#include "../common/outlier_filter_members.hpp"
#include "../common/sample_clock_members.hpp"
#include "../common/state_params.hpp"
#include "pass_members.hpp"
#include "stamp_order_members.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble {

namespace odometry {

/// kSweepFields lists the field names that add_sweep() may report in a Status. A loaded Status points to a name in this
/// list.
inline constexpr std::array<const char*, 13> kSweepFields = {"",
                                                             "end_ns",
                                                             "start_ns",
                                                             "points",
                                                             "imu samples",
                                                             "imu time_ns",
                                                             "offset_ns",
                                                             "position_L_m",
                                                             "points in range",
                                                             "spread of offset_ns",
                                                             "imu window start",
                                                             "specific_force_m_s2",
                                                             "sweep"};

inline std::size_t number_of(std::string_view field) {
  std::size_t k = 0;
  while (k + 1 < kSweepFields.size() && field != kSweepFields[k]) ++k;
  return k;
}

}  // namespace odometry

template <StateOf<Status> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("status.trouble", s.error_code, ErrorCode::diverged);
  std::size_t field = odometry::number_of(s.field);
  visit("status.field", field, 0.0, odometry::kSweepFields.size() - 1.0);
  if constexpr (!std::is_const_v<Self>)
    s.field = odometry::kSweepFields[std::min(field, odometry::kSweepFields.size() - 1)];
  visit.scratch(s.field);  // saved as an index of kSweepFields
  visit.with_nan("status.value", s.value);
  visit.with_nan("status.bound", s.bound);
}

template <StateOf<TumblingOdometry::Sweep> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("done.status", s.status);
  visit("done.report", s.report);
  visit("done.position_frame", s.position_frame);
}

template <StateOf<PositionFrame> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("position_frame.T_PW", s.T_PW);
  visit("position_frame.reference_W_m", s.reference_W_m);
  visit("position_frame.covariance", s.covariance);
}

template <StateOf<PositionReading> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("position.time_ns", s.time_ns);
  visit("position.p_PA_m", s.p_PA_m);
  visit("position.covariance_m2", s.covariance_m2);
  visit("position.p_IA_m", s.p_IA_m);
}

template <StateOf<PositionAlignment::Pair> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("pair.p_WA_m", s.p_WA_m);
  visit("pair.p_PA_m", s.p_PA_m);
  visit("pair.variance_m2", s.variance_m2);
  visit("pair.path_m", s.path_m);
  visit("pair.pose_variance_m2", s.pose_variance_m2);
}

template <class Self, class Visitor>
void PositionAlignment::members(Self& s, Visitor& visit) {
  visit("positions.waiting", s.waiting_);
  visit("positions.pairs", s.pairs_);
  if constexpr (Visitor::kReads) visit.bounded("positions.pairs", double(s.pairs_.size()), 0.0, double(kPairsMax));
  visit("positions.frame", s.frame_);
  visit("positions.last_W_m", s.last_W_m_);
  visit("positions.path_m", s.path_m_);
  visit("positions.pose_variance_m2", s.pose_variance_m2_);
  visit("positions.in_prior_map", s.in_prior_map_);
}

template <StateOf<FurtherLidar> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("further_lidar.T_IL", s.T_IL);
  visit_params(s.sheet, visit);
  visit("further_lidar.own_body_L", s.own_body_L);
  visit("further_lidar.time_offset_s", s.time_offset_s);
}

template <StateOf<TumblingOdometry::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit("T_IL", p.T_IL);
  visit("own_body_L", p.own_body_L);
  visit("further_lidars", p.further_lidars);
  others(p.expert.rate, visit);
  others(p.expert.mapping, visit);
}

template <StateOf<GyroOffset::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("offset.rest", s.rest);
  visit("offset.first_ns", s.first_ns);
  visit("offset.decided", s.decided);
}

template <StateOf<WaitingSweep> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("waiting.start_ns", s.start_ns);
  visit("waiting.end_ns", s.end_ns);
  visit("waiting.points", s.points);
}

template <class Self, class Visitor>
void FurtherLidars::members(Self& s, Visitor& visit) {
  visit.scratch(s.lidars_);  // copied from the parameters
  visit.scratch(s.T_LI_first_);
  visit("further.waiting", s.waiting_);
  visit("further.unused_points", s.unused_points_);
}

template <class Self, class Visitor>
void TumblingOdometry::members(Self& s, Visitor& visit) {
  visit.scratch(s.params_);       // must equal the saved parameters
  visit.scratch(s.stamp_order_);  // derived from the parameters
  visit("order", s.stamp_order_state_);
  visit.scratch(s.gyro_offset_);
  visit("gyro_offset", s.gyro_offset_state_);
  visit.scratch(s.outlier_filter_);  // derived from the parameters
  visit("outliers", s.outlier_filter_state_);
  visit.scratch(s.sample_clock_);
  visit("stamps", s.sample_clock_state_);
  visit.scratch(s.plausibility_);  // derived from the parameters
  visit("plausibility", s.plausibility_state_);
  visit("pass", s.pass_);
  visit("second_pass", s.second_pass_);
  visit("newest_ns", s.newest_ns_);
  visit("registered_ns", s.last_registered_ns_);
  visit("gaps", s.restart_count_);
  visit("dropped_sweeps", s.dropped_sweeps_);
  visit("early_sweeps", s.early_sweeps_);
  visit("waiting", s.waiting_);
  visit("readings", s.readings_);
  visit("positions", s.positions_);
  visit("further_lidars", s.further_lidars_);
  visit("done", s.results_);
  visit("sweep_end_ns", s.sweep_end_ns_);
  visit("recorded", s.recorded_);
  visit.scratch(s.whole_);  // finish() computes the results again
  visit.scratch(s.finished_);
}

}  // namespace tumble
