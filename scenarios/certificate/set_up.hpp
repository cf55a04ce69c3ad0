// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "sim/built_situation.hpp"
#include "sim/recording.hpp"
#include "sim/trial/trial.hpp"

/// set_up.hpp contains situations and motions that several certificate measurements share.
namespace tumble::scenarios {

/// Returns the situation of a robot ("rig", "sphere" or "pendulum") in an empty room with floor and walls, without
/// sensors.
sim::Situation bare_room(const std::string& robot);

/// Completes the situation with its default values and builds it with the models of `input`.
sim::BuiltSituation build(const CertificateInput& input, const sim::Situation& situation);

/// Returns a body state high enough above the floor for several seconds of free flight. The body rotates at
/// `rate_rad_s` near the rig's axis of intermediate inertia.
sim::BodyState thrown(double rate_rad_s);

/// Simulates a free flight and returns the true motion of the body, without contacts.
sim::Truth fly(sim::Trial& trial, double duration_s);

/// Returns the simulation parameters of the IMU in the data sheet. The sensor has the name of the data sheet.
sim::SensorSpec imu_of_sheet(const DataSheet& sheet);

/// Returns the larger of two values. NaN counts as the largest value, so a failed measurement remains visible.
double larger(double a, double b);

}  // namespace tumble::scenarios
