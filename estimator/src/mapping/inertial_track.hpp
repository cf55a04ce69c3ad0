// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gap_bridge.hpp"
#include "inertial_prior.hpp"
#include "tumble/angular_velocity/rest_detector.hpp"

namespace tumble::mapping {

/// What the IMU has said since the last sweep's end: its samples, the rest at the start, gaps bridged, and flight told.
class InertialTrack {
 public:
  using Params = LidarInertialOdometry::Params;

  explicit InertialTrack(const Params& params);

  /// `time_order` unless the sample comes after all before it.
  Status check(const ImuSample& sample) const;
  /// Adds a checked sample with its angular velocity.
  void take(const Params& params, const ImuSample& sample, const RateState& rate);

  /// From the window that holds the last sweep's end on.
  std::span<const MotionSample> samples() const { return samples_; }
  /// Of them, those that end after this.
  std::span<const MotionSample> samples_from(TimeNs from_ns) const;
  /// End of the last sweep; nothing before the first.
  std::optional<TimeNs> border_ns() const { return border_ns_; }
  /// Mean specific force of the rest that the newest sample belongs to, if that had lasted for so long by `time_ns`.
  std::optional<Eigen::Vector3d> resting_force(TimeNs time_ns, double lasted_s) const;
  /// Whether the rest at the start goes on.
  bool has_not_moved() const { return initial_.lasts; }
  /// The newest of them, or the last sweep's end.
  std::optional<TimeNs> last_ns() const;
  /// Whether the IMU has nothing to say but gravity up to `end_ns`.
  bool rests_until(TimeNs end_ns) const;
  bool rests_between(TimeNs from_ns, TimeNs end_ns) const;
  /// What the accelerometer read before then is left out, as if it had been a gap's; the rates count.
  void leave_out_force(TimeNs end_ns);
  /// Forgets what ended by then, the end of a sweep.
  void forget_until(TimeNs end_ns);

  /// Stated once: `mapping_members.hpp`.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  /// The rest at the start of a recording: once left it does not come back, and what it has taught stays.
  struct InitialRest {
    bool lasts = true;
    std::optional<TimeNs> first_ns;  ///< the first sample of all
    std::optional<TimeNs> run_ns;    ///< that of the detector's run
    Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
    template <class Self, class Visitor>
    static void members(Self& s, Visitor& visit);
  };

  void listen_for_rest(const Params& params, const ImuSample& sample, const RateState& rate, MotionSample& next);
  void take_back_rest(std::optional<TimeNs> rests_since_ns);
  bool tell_flight(const Params& params, const MotionSample& next, bool after_gap);
  void fill_gap(const Params& params, bool in_flight);
  bool fly_through(const Params& params, const WindowRate& before, const WindowRate& after);

  std::vector<MotionSample> samples_;
  std::optional<TimeNs> border_ns_;  // end of the last sweep
  RestDetector rests_;
  RestDetector::State rest_;
  InitialRest initial_;
  std::vector<Eigen::Vector3d> undecided_rad_s_;  // rates since the detector's last whole reading
  std::optional<WindowRate> before_newest_, newest_;
};

}  // namespace tumble::mapping
