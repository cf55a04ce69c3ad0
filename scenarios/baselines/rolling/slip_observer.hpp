// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble::baselines {

/// SlipObserver estimates the position of a rolling sphere on a flat floor. An observer estimates the slip velocity u
/// of the contact point, with v = r w x n + u.
///
/// If the sphere rolls without slip, the acceleration of its centre is r w' x n. The residual e is the measured
/// acceleration minus r w' x n, averaged over 11 samples. The window length suits a sample rate of about 125 Hz.
///
/// A slip event starts when |e| is large, and ends when |e| is small and u has returned to zero. During the event, the
/// observer integrates e to the slip velocity u. A slide starts before its detection, so the observer also integrates
/// the last 25 residuals at the start of the event. At the end of the event, it removes the linear drift of u. If the
/// event lasts too long, the observer removes the effect of the event on the position.
///
/// The observer neglects tilt changes within a slip event, impacts and slopes. In simulations with realistic physics,
/// the estimated position is hardly better than with the rolling assumption alone.
class SlipObserver {
 public:
  static constexpr int kWindow = 11;   ///< samples for fitting acceleration and rate; the delay is half the window
  static constexpr int kHistory = 25;  ///< samples integrated at the start of an event

  struct Params {
    double radius_m = 0.145;
    double gravity_m_s2 = 9.80665;
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from centre to IMU, sensor axes
    double open_m_s2 = 0.5;                                 ///< |e| above this value starts a slip event
    double quiet_m_s2 = 0.25;                               ///< a slip event can end while |e| is below this value
    double quiet_time_s = 0.12;                             ///< required time with |e| < quiet_m_s2 to end an event
    double closing_speed_m_s = 0.08;                        ///< a slip event can end while |u| is below this value
    double timeout_s = 2.0;                                 ///< a longer slip event does not change the position
    double ignore_time_s = 1.0;                             ///< after a time-out: required time with |e| < quiet_m_s2
    double closed_decay_per_s = 8.0;                        ///< decay rate of u outside slip events
    double bias_tau_s = 1.0;    ///< time constant of e's mean in quiet phases (tilt, accelerometer bias)
    double blend_tau_s = 0.25;  ///< time constant for applying a position correction
    double gap_max_s = 1.0;

    /// Calls the visitor with each parameter's reference, name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.radius_m, {"radius_m", "m", 1e-9, 10.0, "radius of the sphere"});
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-9, 100.0, "strength of gravity"});
      visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre to the IMU, sensor axes"});
      visit(p.open_m_s2, {"open_m_s2", "m/s^2", 1e-9, 100.0,
                          "a slip event starts when the residual exceeds this value; residual: measured acceleration "
                          "minus acceleration of rolling",
                          FieldRank::basic});
      visit(p.quiet_m_s2, {"quiet_m_s2", "m/s^2", 1e-9, 100.0,
                           "a slip event may end when the residual is below this value", FieldRank::basic});
      visit(p.quiet_time_s, {"quiet_time_s", "s", 0.0, 10.0,
                             "a slip event ends after the residual has been below quiet_m_s2 for this time"});
      visit(p.closing_speed_m_s, {"closing_speed_m_s", "m/s", 1e-9, 10.0,
                                  "a slip event may end when the contact speed is below this value", FieldRank::basic});
      visit(p.timeout_s,
            {"timeout_s", "s", 1e-9, 100.0,
             "maximum duration of a slip event; the position change by a longer event is undone", FieldRank::basic});
      visit(p.ignore_time_s, {"ignore_time_s", "s", 0.0, 100.0,
                              "after an undone event, the next event starts only after the residual has been below "
                              "quiet_m_s2 for this time"});
      visit(p.closed_decay_per_s,
            {"closed_decay_per_s", "1/s", 0.0, 1e3, "decay rate of the contact velocity outside slip events"});
      visit(p.bias_tau_s,
            {"bias_tau_s", "s", 1e-9, 1e3, "time constant of the mean residual outside slip events", FieldRank::basic});
      visit(p.blend_tau_s,
            {"blend_tau_s", "s", 1e-9, 1e3, "time constant with which a position correction is applied"});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap ends the run with an error"});
    }
  };
  struct State {
    Eigen::Vector2d p_WG_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d v_WG_m_s = Eigen::Vector2d::Zero();
    Eigen::Vector2d contact_velocity_W_m_s = Eigen::Vector2d::Zero();  ///< velocity u of the contact point
    Eigen::Vector2d bias_m_s2 = Eigen::Vector2d::Zero();               ///< mean of e in quiet phases
    Eigen::Vector2d pending_m = Eigen::Vector2d::Zero();               ///< correction not yet applied
    Eigen::Vector2d event_m = Eigen::Vector2d::Zero();                 ///< displacement due to u in this event
    std::array<Eigen::Vector2d, kWindow> a_W_m_s2{};    ///< ring buffers; the newest is at (count - 1) mod size
    std::array<Eigen::Vector2d, kWindow> roll_W_m_s{};  ///< r w x n
    std::array<double, kWindow> dt_s{};
    std::array<Eigen::Vector2d, kHistory> e_W_m_s2{};
    std::array<double, kHistory> e_dt_s{};
    Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero();
    std::int64_t count = 0, residuals = 0;
    double event_s = 0.0, quiet_s = 0.0;
    bool open = false;      ///< a slip event is in progress
    bool ignoring = false;  ///< a time-out ended the last slip event; new events are ignored
    TimeNs last_time_ns = 0;
    bool started = false;
    State();
    bool operator==(const State&) const = default;
  };

  explicit SlipObserver(const Params& params);

  /// Updates position and slip velocity with one IMU sample. The parameter `q_WI` is the attitude at the end of the
  /// sample's averaging window. On error, `state` keeps its content. The cost is O(kWindow), without allocation.
  Status step(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const;

 private:
  void observe(const ImuSample& sample, const Eigen::Quaterniond& q_WI, double dt_s, State& state) const;
  void advance_closed(const Eigen::Vector2d& e, double dt_s, State& state) const;
  void advance_open(const Eigen::Vector2d& e, double dt_s, State& state) const;
  void open_event(const Eigen::Vector2d& e, State& state) const;

  Params params_;
};

}  // namespace tumble::baselines
