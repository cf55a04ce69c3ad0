// SPDX-License-Identifier: BSD-3-Clause
// odometry_state.cpp saves and restores the state of the mapper.
#include <utility>

#include "../common/state_bytes.hpp"
#include "../common/state_layout.hpp"
#include "mapping_members.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

namespace {

/// Visits the parameters that may come from an earlier estimate, which a SecondPass also replaces.
template <StateOf<LidarInertialOdometry::Params> Self, class Visitor>
void visit_estimated(Self& p, Visitor& visit) {
  visit("T_IL", p.T_IL);
  visit("time_offset_s", p.time_offset_s);
  visit("mount_sigma_rad", p.mount_sigma_rad);
  visit("mount_sigma_m", p.mount_sigma_m);
  visit("time_offset_sigma_s", p.time_offset_sigma_s);
}

Status check_window(const mapping::LagWindow& window, std::size_t length) {
  if (window.length() != length)
    return {ErrorCode::out_of_range, "window.length", double(window.length()), double(length)};
  if (window.sweeps().size() > length)
    return {ErrorCode::out_of_range, "window.sweeps", double(window.sweeps().size()), double(length)};
  return {};
}

}  // namespace

Status LidarInertialOdometry::Impl::check_other() const {
  if (!other) return {};
  if (!mapping::is_unconfirmed(tracking) && !mapping::is_lost(tracking))
    return {ErrorCode::out_of_range, "other", 1.0, 0.0};
  if (other->inserted_from > map.sweeps())
    return {ErrorCode::out_of_range, "other.inserted_from", double(other->inserted_from), double(map.sweeps())};
  for (const mapping::WindowSweep& sweep : other->window.sweeps()) {
    if (!sweep.inserted.empty()) return {ErrorCode::out_of_range, "other.inserted", double(sweep.inserted.size()), 0.0};
  }
  return check_window(other->window, window.length());
}

Status LidarInertialOdometry::Impl::check_state() const {
  const auto most = static_cast<std::size_t>(params.expert.window_sweeps);
  if (Status status = check_window(window, most); !status.ok()) return status;
  if (Status status = check_other(); !status.ok()) return status;
  for (const mapping::WindowSweep& sweep : window.sweeps()) {
    for (const mapping::InsertedPoint& inserted : sweep.inserted) {
      if (inserted.index >= map.voxels().index_end() || !map.voxels().exists(inserted.index))
        return {ErrorCode::out_of_range, "inserted.index", double(inserted.index), double(map.voxels().index_end())};
    }
  }
  if (!map.has_sweep_origins()) return {ErrorCode::out_of_range, "map.sweep", 1.0, 0.0};
  const std::span<const MotionSample> samples = track.samples();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (samples[k].from_ns > samples[k].time_ns || (k > 0 && samples[k].time_ns <= samples[k - 1].time_ns))
      return {ErrorCode::time_order, "motion.time_ns", double(samples[k].time_ns), double(samples[k].from_ns)};
    if (const Status status = check_stamp(samples[k].from_ns, "motion.from_ns"); !status.ok()) return status;
    if (const Status status = check_stamp(samples[k].time_ns, "motion.time_ns"); !status.ok()) return status;
  }
  return check_stamp(track.last_ns().value_or(0), "track.boundary_ns");
}

void LidarInertialOdometry::save(StateWriter& out) const {
  visit_estimated(std::as_const(impl_->params), out);
  Impl::members(std::as_const(*impl_), out);
}

void LidarInertialOdometry::load(StateReader& in) {
  Params params = impl_->params;
  visit_estimated(params, in);
  if (in.going()) in.refuse(check_odometry_params(params));
  if (!in.going()) return;
  auto fresh = std::make_unique<Impl>(params);
  Impl::members(*fresh, in);
  in.refuse(fresh->check_state());
  if (in.going()) impl_ = std::move(fresh);
}

void LidarInertialOdometry::describe(StateLayout& out) const {
  visit_estimated(std::as_const(impl_->params), out);
  Impl::members(std::as_const(*impl_), out);
}

}  // namespace tumble
