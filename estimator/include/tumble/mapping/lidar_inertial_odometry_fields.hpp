// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble {

template <class Self, class Visitor>
void LidarInertialOdometry::Params::fields(Self& p, Visitor& visit) {
  visit(p.time_offset_s, {"time_offset_s", "s", -1.0, 1.0, "the IMU's clock minus the lidar's"});
  visit(p.mount_sigma_rad,
        {"mount_sigma_rad", "rad", 0.0, 1.0, "the lidar's attitude on the IMU as given; 0: exact", Rank::first});
  visit(p.mount_sigma_m,
        {"mount_sigma_m", "m", 0.0, 1.0, "the lidar's position on the IMU as given; 0: exact", Rank::first});
  visit(p.time_offset_sigma_s,
        {"time_offset_sigma_s", "s", 0.0, 0.02, "offset between the clocks of lidar and IMU; 0: none", Rank::first});
  visit(p.gravity_sigma_m_s2, {"gravity_sigma_m_s2", "m/s^2", 0.0, 10.0,
                               "gravity's direction as levelled at the start; 0: exact", Rank::first});
  visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity"});
  visit(p.rest_s,
        {"rest_s", "s", 1e-9, 60.0, "at most this much of the rest at the start levels the attitude", Rank::first});
  visit(p.rest_rate_rad_s, {"rest_rate_rad_s", "rad/s", 1e-6, 10.0,
                            "at rest the rate is within this of the bias and of its mean, per axis"});
  visit(p.rest_force_m_s2,
        {"rest_force_m_s2", "m/s^2", 1e-6, 10.0, "and the specific force within this of gravity and of its mean"});
  visit(p.range_min_m, {"range_min_m", "m", 0.0, 10.0, "nearer returns are dropped"});
  visit(p.range_max_m, {"range_max_m", "m", 0.0, 1e4, "farther returns are dropped"});
  visit(p.own_body_L.min(), {"own_body_min_m", "m", -kUnbounded, kUnbounded,
                             "least corner of the box that holds the robot's own returns, lidar axes"});
  visit(p.own_body_L.max(), {"own_body_max_m", "m", -kUnbounded, kUnbounded, "and its largest corner"});
  visit(p.sweep_voxel_m,
        {"sweep_voxel_m", "m", 0.01, 10.0, "one point per voxel of a sweep is registered", Rank::first});
  visit(p.map_voxel_m, {"map_voxel_m", "m", 0.01, 10.0, "cell of the map's hash", Rank::first});
  visit(p.map_spacing_m, {"map_spacing_m", "m", 0.0, 10.0, "edge of the cube that holds one map point", Rank::first});
  visit(p.neighbours, {"neighbours", "1", 3, 32, "map points per plane fit", Rank::first});
  visit(p.match_distance_m, {"match_distance_m", "m", 1e-3, 10.0, "farther map points are no match", Rank::first});
  visit(p.iterations_max,
        {"iterations_max", "1", 1, 200, "most iterations of a registration; one with all points has at most eight"});
  visit(p.correction_max_m, {"correction_max_m", "m", 0.0, 1e6, "a larger correction of the prior is refused"});
  visit(p.correction_max_rad, {"correction_max_rad", "rad", 0.0, 3.15, "a larger correction of the prior is refused"});
  visit(p.prior_sigma_m, {"prior_sigma_m", "m", 1e-9, 1e3, "inertial prior over 0.1 s: position", Rank::first});
  visit(p.prior_sigma_rad, {"prior_sigma_rad", "rad", 1e-9, 1e3, "inertial prior over 0.1 s: attitude", Rank::first});
  visit(p.prior_sigma_m_s, {"prior_sigma_m_s", "m/s", 1e-9, 1e3, "inertial prior over 0.1 s: velocity", Rank::first});
  visit(p.turn_sigma_share, {"turn_sigma_share", "1", 0.0, 1.0, "inertial prior: of the angle turned", Rank::first});
  visit(p.force_sigma_share,
        {"force_sigma_share", "1", 0.0, 1.0, "inertial prior: of the force's integral", Rank::first});
  visit(p.accel_rail_m_s2,
        {"accel_rail_m_s2", "m/s^2", 1e-9, 1e5, "readings of the accelerometer from here on are at its rail"});
  visit(p.railed_force_m_s2, {"railed_force_m_s2", "m/s^2", 0.0, 1e4, "how much larger the force may be there"});
  visit(p.clipped_sigma_rad_s, {"clipped_sigma_rad_s", "rad/s", 0.0, 100.0,
                                "assumed of a clipped axis that the rate method did not recover", Rank::first});
  visit(p.gap_force_m_s2,
        {"gap_force_m_s2", "m/s^2", 0.0, 1e3, "of a gap of the IMU, over which the velocity goes on"});
  visit(p.rate_sigma_max_rad_s,
        {"rate_sigma_max_rad_s", "rad/s", 0.0, 100.0, "what RateState reports is believed up to this"});
  visit(
      p.estimate_saturation_deficit,
      on_off("estimate_saturation_deficit", "1: by how much clipped axes are short is estimated in the registration"));
  visit(p.excess_sigma_min_rad_s,
        {"excess_sigma_min_rad_s", "rad/s", 1e-9, 100.0,
         "least prior of the saturation deficit of a clipped axis, whatever the rate method claims", Rank::first});
  visit(p.excess_time_s,
        {"excess_time_s", "s", 1e-3, 1e3, "over which the saturation deficit forgets what it was", Rank::first});
  visit(p.excess_carry_max,
        {"excess_carry_max", "1", 0.0, 1e3, "over the border of two sweeps the saturation deficit grows by no more"});
  visit(p.excess_knot_share, {"excess_knot_share", "1", 1e-6, 1.0,
                              "of the deficit's standard deviation, by which a knot may differ from its neighbours"});
  visit(p.window_sweeps, {"window_sweeps", "1", 1, 8,
                          "sweeps refined together: so many less one by what comes after them", Rank::first});
  visit(p.flight_force_m_s2, {"flight_force_m_s2", "m/s^2", 0.0, 100.0,
                              "with flight_arc: force at the centre of mass below which the body flies"});
  visit(p.skew_sigma_m_s, {"skew_sigma_m_s", "m/s", 0.0, 1e3,
                           "growth of a point's uncertainty over the sweep (time weighting); 0: none"});
  visit(p.degenerate_sigma_m, {"degenerate_sigma_m", "m", 1e-6, 1e3,
                               "a sweep that its surfaces hold less surely in some direction is degenerate"});
  visit(p.matches_min, {"matches_min", "1", 0, 1e9, "fewer matches are too few"});
  visit(p.trusted_prior_m, {"trusted_prior_m", "m", 0.0, 1e3,
                            "a sweep with too few matches extends the map while the prior is this certain"});
  visit(p.trusted_prior_rad, {"trusted_prior_rad", "rad", 0.0, 1e3, "and this certain of the attitude"});
  visit(p.map_radius_m, {"map_radius_m", "m", 0.0, 1e5, "the map is kept within this of the sensor, to a tenth of it"});
  visit(p.map_sigma_max_m, {"map_sigma_max_m", "m", 1e-6, 1e3,
                            "points that the trajectory places less surely than this are kept out of the map"});
  visit(p.lost_sweeps_max, {"lost_sweeps_max", "1", 1, 1e6,
                            "sweeps in a row without a place in the map, after which it goes on by inertia"});
  visit.group("start_", p.start);
  visit.group("standstill_", p.standstill);
  visit.group("effort_", p.effort);
  visit.group("search_", p.search);
  visit.group("world_", p.world);
}

}  // namespace tumble
