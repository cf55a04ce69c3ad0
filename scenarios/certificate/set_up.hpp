// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "sim/built_situation.hpp"
#include "sim/recording.hpp"
#include "sim/trial/trial.hpp"

/// Situations and motions that several rows measure on.
namespace tumble::scenarios {

/// A robot ("rig", "sphere" or "pendulum") in a room with nothing in it but floor and walls; no sensors.
sim::Situation bare_room(const std::string& robot);

/// The situation resolved and built from the input's models: anew at each call.
sim::BuiltSituation build(const CertificateInput& input, const sim::Situation& situation);

/// Thrown up high above the room, so that it stays in the air for seconds, and spun at `rate_rad_s` near the axis of
/// the rig's middle moment of inertia.
sim::BodyState thrown(double rate_rad_s);

/// The states of a free flight as the truth of a recording (body alone, no contacts).
sim::Truth fly(sim::Trial& trial, double duration_s);

/// The IMU of a data sheet, as a sensor that is named after it.
sim::SensorSpec imu_of_sheet(const DataSheet& sheet);

/// The larger of two; one that is not a number is the largest, so that it cannot hide.
double larger(double a, double b);

}  // namespace tumble::scenarios
