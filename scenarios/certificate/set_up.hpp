// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "sim/built_situation.hpp"
#include "sim/recording.hpp"
#include "sim/trial/trial.hpp"

/// Situations and motions shared by several rows.
namespace tumble::scenarios {

/// Returns a robot ("rig", "sphere" or "pendulum") in an empty room with floor and walls, without sensors.
sim::Situation bare_room(const std::string& robot);

/// Resolves the situation and builds it from the input's models.
sim::BuiltSituation build(const CertificateInput& input, const sim::Situation& situation);

/// Returns a state high above the room, for seconds of free flight, rotating at `rate_rad_s` near the axis of the rig's
/// medium moment of inertia.
sim::BodyState thrown(double rate_rad_s);

/// Simulates a free flight and returns its truth (body only, no contacts).
sim::Truth fly(sim::Trial& trial, double duration_s);

/// Returns the IMU of a data sheet as a sensor with its name.
sim::SensorSpec imu_of_sheet(const DataSheet& sheet);

/// Returns the larger value; NaN counts as largest, so that it cannot be hidden.
double larger(double a, double b);

}  // namespace tumble::scenarios
