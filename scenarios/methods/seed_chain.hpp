// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "sim/parameters.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::scenarios {

/// The published chain behind a rate method (Deschenes et al., ICRA 2024, with the constants of the authors' launch
/// files): Madgwick's attitude, accelerometer odometry whose velocity the registration feeds back, deskewing to the
/// start of the sweep, time weighting, trimmed point-to-plane registration of voxelised points, a map that grows where
/// it is empty. `estimate.rates` are given; the constants that one may want to vary, and the chain's own errors, are
/// parameters.
void run_seed_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const sim::Values& parameters,
                    Estimate& estimate);

std::span<const sim::Parameter> seed_parameters();

}  // namespace tumble::scenarios
