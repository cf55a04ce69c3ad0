// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "sim/built_situation.hpp"
#include "sim/recording.hpp"
#include "sim/trial/trial.hpp"

namespace tumble::scenarios {

sim::Situation bare_room(const std::string& robot);

sim::BuiltSituation build(const CertificateInput& input, const sim::Situation& situation);

sim::BodyState thrown(double rate_rad_s);

sim::Truth fly(sim::Trial& trial, double duration_s);

sim::SensorSpec imu_of_sheet(const DataSheet& sheet);

/// Returns the larger argument, or NaN if an argument is NaN, so that a failed measurement remains visible.
double larger(double a, double b);

}  // namespace tumble::scenarios
