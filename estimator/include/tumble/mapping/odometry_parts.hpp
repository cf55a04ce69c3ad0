// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "tumble/common/parameters.hpp"

/// Groups of LidarInertialOdometry::Params, by the part of it that reads them.
namespace tumble {

/// The start: an IMU levelled at rest, and how far the first sweeps may correct it.
struct OdometryStartParams {
  /// A weight and no error: five times the tilt that WorldCovarianceParams reports, for a rest that was none.
  double level_sigma_rad = 0.01;
  double speed_sigma_m_s = 0.05;  ///< within what passes for rest
  double bias_rest_s = 0.1;       ///< a shorter rest teaches no bias of the gyro

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.level_sigma_rad, {"level_sigma_rad", "rad", 1e-9, 1.0, "correction of the levelled tilt that is allowed"});
    visit(p.speed_sigma_m_s, {"speed_sigma_m_s", "m/s", 1e-9, 100.0, "speed that passes for rest"});
    visit(p.bias_rest_s, {"bias_rest_s", "s", 0.0, 60.0, "a shorter rest at the start teaches no bias of the gyro"});
  }
};

/// A robot that is known not to move, be it at the start or by an IMU that says nothing but gravity.
struct StandstillParams {
  double start_sigma_m_s = 0.01;  ///< of the velocity, during the rest at the start
  double sigma_m_s = 0.05;        ///< of the velocity, where the IMU says nothing but gravity
  /// Believed slower than this such an IMU rests, where no surface holds it: a world that holds nothing lets it creep.
  double creep_max_m_s = 0.5;
  int sweeps_min = 3;         ///< in a row before that is believed
  double noise_share = 0.02;  ///< of the inertial prior's standard deviations in motion

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.start_sigma_m_s, {"start_sigma_m_s", "m/s", 1e-9, 100.0, "velocity during the rest at the start"});
    visit(p.sigma_m_s, {"sigma_m_s", "m/s", 1e-9, 100.0, "velocity of an IMU that says nothing but gravity"});
    visit(p.creep_max_m_s, {"creep_max_m_s", "m/s", 0.0, 100.0,
                            "such an IMU rests where it is believed slower than this and no surface holds it"});
    visit(p.sweeps_min, {"sweeps_min", "1", 1, 1e6, "in a row before that is believed"});
    visit(p.noise_share, {"noise_share", "1", 1e-9, 1.0, "of the inertial prior's standard deviations in motion"});
  }
};

/// How much is spent on a registration, in steps: brief with all points; patient with some; coarse with few.
struct RegistrationEffortParams {
  int brief_iterations = 8;             ///< what has not settled by then is cheaper settled with some of the points
  std::size_t patient_points = 1000;    ///< tell whether a start leads somewhere
  int coarse_iterations = 15;           ///< of a start that may be far off
  std::size_t coarse_points = 300;      ///< serve one
  std::size_t coarse_matches_min = 50;  ///< fewer reject one

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.brief_iterations, {"brief_iterations", "1", 1, 200, "most iterations with all points"});
    visit(p.patient_points,
          {"patient_points", "1", 1, 1e9, "most points of a registration that runs to its convergence"});
    visit(p.coarse_iterations, {"coarse_iterations", "1", 1, 200, "most iterations from a start that may be far off"});
    visit(p.coarse_points, {"coarse_points", "1", 1, 1e9, "most points from such a start"});
    visit(p.coarse_matches_min, {"coarse_matches_min", "1", 0, 1e9, "fewer matches reject such a start"});
  }
};

/// Where a sweep is tried from that its prior did not place: docs/maths/mapping.md, sections 5 and 10.
struct RelocalizationParams {
  int excess_tries_max = 5;  ///< larger saturation deficits tried for one sweep, all axes together
  int starts_per_sweep = 3;  ///< of a lost sensor, the prior among them
  double shift_m = 1.0;      ///< such starts reach so far at first
  double turn_rad = 0.3;     ///< likewise in attitude
  int rounds = 3;            ///< each reaches that much further than the last

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.excess_tries_max, {"excess_tries_max", "1", 0, 12, "larger saturation deficits tried for one sweep"});
    visit(p.starts_per_sweep, {"starts_per_sweep", "1", 1, 100, "starts of a lost sensor, the prior among them"});
    visit(p.shift_m, {"shift_m", "m", 0.3, 100.0, "reach of such starts, first round"});
    visit(p.turn_rad, {"turn_rad", "rad", 0.1, 3.15, "reach of such starts in attitude, first round"});
    visit(p.rounds, {"rounds", "1", 1, 100, "of starts, each of which reaches that much further than the last"});
  }
};

/// What parts the map from the world: docs/maths/mapping.md, section 8.
struct WorldCovarianceParams {
  double tilt_sigma_rad = 0.002;  ///< of a levelled start: an accelerometer's turn-on bias of 2 mg
  /// Of the weakest direction's standard deviation, per sweep, where the surfaces do not hold it: measured.
  double drift_share = 0.1;
  double drift_sigma_max_m = 3.0;  ///< a direction held less surely counts as this

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.tilt_sigma_rad, {"tilt_sigma_rad", "rad", 0.0, 1.0, "tilt of a levelled start, as reported"});
    visit(p.drift_share, {"drift_share", "1", 0.0, 1.0, "of the weakest direction's standard deviation per sweep"});
    visit(p.drift_sigma_max_m, {"drift_sigma_max_m", "m", 0.0, 1e3, "a direction held less surely counts as this"});
  }
};

}  // namespace tumble
