// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/rate_model_params.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

template <class Self, class Visitor>
void RateModelParams::fields(Self& p, Visitor& visit) {
  visit(p.lever_arm_sigma_m,
        {"lever_arm_sigma_m", "m", 1e-9, 10.0, "what the calibrated lever arm may be off by", Rank::first});
  visit(p.gyro_bias_sigma_rad_s,
        {"gyro_bias_sigma_rad_s", "rad/s", 1e-9, 10.0, "prior of the gyro's bias", Rank::first});
  visit(p.accel_bias_sigma_m_s2,
        {"accel_bias_sigma_m_s2", "m/s^2", 1e-9, 10.0, "prior of the accelerometer's bias", Rank::first});
  visit(p.inertia_sigma,
        {"inertia_sigma", "1", 1e-9, 10.0, "prior of the inertia's shape about equal moments", Rank::first});
  visit(p.element_sigma,
        {"element_sigma", "1", 1e-9, 0.2,
         "prior of each slope of a gyro element's rail: cross-axis sensitivity before the device compensates it",
         Rank::first});
  visit(p.gyro_noise_density,
        {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0, "noise density of the gyro (0.03 deg/s/sqrt(Hz))"});
  visit(p.accel_noise_density,
        {"accel_noise_density", "m/s^2/sqrt(Hz)", 1e-9, 10.0, "noise density of the accelerometer (60 ug/sqrt(Hz))"});
  visit(p.flight_sigma_m_s2,
        {"flight_sigma_m_s2", "m/s^2", 1e-6, 100.0, "what the flight model misses of the force", Rank::first});
  visit(p.model_error_s,
        {"model_error_s", "s", 1e-6, 1.0, "what the model misses of a force, a torque or a rate lasts so long"});
  visit(p.accel_scale_error,
        {"accel_scale_error", "1", 0.0, 1.0, "scale and misalignment of the accelerometer, as a share of the force"});
  visit.group("error_sizes_", p.error_sizes);
  visit(p.gyro_time_sigma_s,
        {"gyro_time_sigma_s", "s", 0.0, 0.1, "what bandwidth and clock leave open of the time of a gyro reading"});
  visit(p.euler_sigma_rad_s2,
        {"euler_sigma_rad_s2", "rad/s^2", 1e-6, 1e6, "what Euler's equation without torque misses", Rank::first});
  visit(p.jerk_psd_flight,
        {"jerk_psd_flight_rad2_s5", "rad^2/s^5", 1.0, 1e12, "density of the angular jerk in flight", Rank::first});
  visit(p.contact_gain_rad_m,
        {"contact_gain_rad_m", "rad/m", 0.0, 1e3, "angular acceleration per force of contact", Rank::first});
  visit(p.contact_sigma_factor,
        {"contact_sigma_factor", "1", 1.0, 10.0, "what a fit through an impact claims to know is widened by this"});
  visit(p.contact_lever_rad_m, {"contact_lever_rad_m", "rad/m", 0.0, 1e3,
                                "angular acceleration across a force of contact, up to this times the force"});
  visit(p.contact_twist_share,
        {"contact_twist_share", "1", 0.0, 1.0, "and about its own direction, as a share of that"});
  visit(p.contact_force_share,
        {"contact_force_share", "1", 0.0, 1e3,
         "deviation of the unknown force of contact as a share of itself; 0: nothing is assumed of it"});
  visit(p.flight_threshold,
        {"flight_threshold", "1", 1.0, 100.0, "residuals of flight beyond this count as contact", Rank::first});
  visit(p.rail_sigma_rad_s,
        {"rail_sigma_rad_s", "rad/s", 1e-6, 10.0, "softness of the bound that a clipped reading is"});
  visit(p.rest_sigma_rad_s, {"rest_sigma_rad_s", "rad/s", 1e-9, 10.0, "deviation of the rate from zero at rest"});
  visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1.0, 1e4, "a rate that no body of this kind has"});
  visit(p.acceleration_max_rad_s2,
        {"acceleration_max_rad_s2", "rad/s^2", 1.0, 1e7, "an angular acceleration that no body of this kind has"});
}

}  // namespace tumble
