// SPDX-License-Identifier: BSD-3-Clause
// tumbling_state.cpp saves and loads a TumblingOdometry.
#include <memory>

#include "odometry_members.hpp"
#include "saved_state.hpp"

namespace tumble {

namespace {

constexpr Status missing(const char* field) {
  return {ErrorCode::empty, field, 0.0, 1.0};
}

}  // namespace

Status OdometryPass::check_state() const {
  if (const Status status = rates_.check_state(rate_state_); !status.ok()) return status;
  const auto& window = rate_state_.rate.window;
  if (window.empty()) return {};
  const TimeNs newest_ns = window.back().observation.sample.time_ns;
  if (last_mapped_ns_ && *last_mapped_ns_ > newest_ns)
    return {ErrorCode::out_of_range, "pass.last_mapped_ns", double(*last_mapped_ns_), double(newest_ns)};
  if (pending_.all().empty()) {  // all poses were reported, as after the second pass
    const bool complete = smoothed_ && smoothed_->time_ns == newest_ns && last_mapped_ns_ == newest_ns;
    return complete ? Status{} : missing("pass.pending");
  }
  const TimeNs received_ns = pending_.all().back().time_ns;
  if (received_ns == newest_ns) return {};
  return {ErrorCode::out_of_range, "pass.pending", double(received_ns), double(newest_ns)};
}

Status SecondPass::check_state(const OdometryPass& first) const {
  if (!pass_) return {};
  if (!motion_start_ns_) return missing("second_pass.moves_ns");
  if (sweeps_.empty()) return missing("second_pass.sweeps");
  if (!first.smoothed_rate()) return missing("pass.smoothed");
  return pass_->check_state();
}

Status TumblingOdometry::check_state() const {
  if (const Status status = SampleClock::check_state(sample_clock_state_); !status.ok()) return status;
  if (const Status status = pass_.check_state(); !status.ok()) return status;
  if (const Status status = second_pass_.check_state(pass_); !status.ok()) return status;
  if (pass_.smoothed_rate() && !last_registered_ns_) return missing("registered_ns");
  if (newest_ns_ && !last_registered_ns_) return missing("registered_ns");
  if (newest_rate() && !newest_ns_) return missing("newest_ns");
  return {};
}

std::vector<std::byte> TumblingOdometry::save() const {
  return odometry::save(odometry::SavedKind::tumbling, *this, params_);
}

Status TumblingOdometry::load(std::span<const std::byte> bytes) {
  const auto fresh = std::make_unique<TumblingOdometry>(params_);
  if (Status status = odometry::load(odometry::SavedKind::tumbling, bytes, params_, *fresh); !status.ok())
    return status;
  if (Status status = fresh->check_state(); !status.ok()) return status;
  *this = std::move(*fresh);
  return {};
}

Status TumblingOdometry::saved_params(std::span<const std::byte> bytes, Params& params) {
  Params read;
  read.lever_arm_I_m.setZero();  // the lever arm has no default
  const auto any = std::make_unique<TumblingOdometry>(read);
  const Status status = odometry::load_params(odometry::SavedKind::tumbling, bytes, *any, read);
  if (status.ok()) params = read;
  return status;
}

}  // namespace tumble
