// SPDX-License-Identifier: BSD-3-Clause
// rolling_state.cpp implements saving and loading of RollingOdometry.
#include "../angular_velocity/frozen_members.hpp"
#include "../attitude/imu_merge_members.hpp"
#include "../attitude/imu_plausibility_members.hpp"
#include "../attitude/rest_gravity_members.hpp"
#include "../common/outlier_filter_members.hpp"
#include "../common/sample_clock_members.hpp"
#include "../common/state_params.hpp"
#include "../rolling/rolling_members.hpp"
#include "saved_state.hpp"
#include "stamp_order_members.hpp"
#include "tumble/odometry/rolling_odometry.hpp"

namespace tumble {

template <StateOf<UnitRails::Unit> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("unit.rails", s.rails);
  visit("unit.before", s.before);
}

template <StateOf<UnitAlignment::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("alignment.readings", s.readings);
  visit("alignment.reference", s.reference, 0.0, ImuMerge::kImus - 1);
  visit("alignment.first_ns", s.first_ns);
  visit("alignment.common_ns", s.common_ns);
}

template <StateOf<RollingOdometry::Unit> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit_params(s.sheet, visit);
  visit("T_BI", s.T_BI);
}

template <StateOf<RollingOdometry::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  visit("units", p.units);
  others(p.expert.merge, visit);
  others(p.expert.rolling, visit);
}

template <class Self, class Visitor>
void RollingRestart::members(Self& s, Visitor& visit) {
  visit("restart.p_WG", s.p_WG_m);
  visit("restart.covariance", s.covariance);
}

template <class Self, class Visitor>
void RollingOdometry::members(Self& s, Visitor& visit) {
  visit.scratch(s.params_);  // must equal the saved parameters, from which the next three members follow
  visit.scratch(s.stamp_order_);
  visit("order", s.stamp_order_state_);
  visit.scratch(s.sample_clock_);
  visit.scratch(s.imu_merge_);
  visit.scratch(s.smoother_);
  visit.scratch(s.rails_);
  visit.scratch(s.unit_alignment_);
  visit("alignment", s.unit_alignment_state_);
  visit("recorded", s.recorded_);
  visit("stamps", s.sample_clock_state_);
  visit("merge", *s.imu_merge_state_);
  visit.scratch(s.merge_state_buffer_);
  visit("rolling", *s.state_);
  visit("rails", s.rails_state_);
  visit.scratch(s.outlier_filters_);  // derived from the parameters
  visit("outliers", s.outlier_filter_state_);
  visit.with_nan("held", s.delayed_samples_);
  visit.scratch(s.frozen_axis_detectors_);
  visit("frozen", s.frozen_);
  visit.scratch(s.checks_.rest_gravity);  // derived from the parameters
  visit("gravity", s.checks_.rest_gravity_state);
  visit.scratch(s.checks_.plausibility);  // derived from the parameters
  visit("plausibility", s.checks_.plausibility_state);
  visit.scratch(s.whole_);  // finish() computes the results again
  if constexpr (std::is_const_v<Self>) {
    const std::vector<RollingEstimate> waiting(s.results_.begin() + static_cast<std::ptrdiff_t>(s.returned_count_),
                                               s.results_.end());
    visit("done", waiting);
  } else {
    visit("done", s.results_);
    s.returned_count_ = 0;
  }
  visit("start", s.start_);
  visit("T_WR", s.T_W_run_);
  visit("gaps", s.restart_count_);
  visit("restart", s.restart_);
  visit.scratch(s.live_);
  visit("finished", s.finished_);
}

std::vector<std::byte> RollingOdometry::save() const {
  return odometry::save(odometry::SavedKind::rolling, *this, params_);
}

Status RollingOdometry::load(std::span<const std::byte> bytes) {
  RollingOdometry fresh(params_);
  if (Status status = odometry::load(odometry::SavedKind::rolling, bytes, params_, fresh); !status.ok()) return status;
  if (Status status = SampleClock::check_state(fresh.sample_clock_state_); !status.ok()) return status;
  if (Status status = fresh.smoother_.check_state(*fresh.state_); !status.ok()) return status;
  if (Status status = fresh.rails_.check_state(fresh.rails_state_); !status.ok()) return status;
  *this = std::move(fresh);
  return {};
}

Status RollingOdometry::saved_params(std::span<const std::byte> bytes, Params& params) {
  Params read;  // two of the parameters have no default
  read.radius_m = 1.0;
  read.units.emplace_back();
  const RollingOdometry any(read);
  const Status status = odometry::load_params(odometry::SavedKind::rolling, bytes, any, read);
  if (status.ok()) params = read;
  return status;
}

}  // namespace tumble
