// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

/// What our position methods and their oracles share.
namespace tumble::scenarios {

/// Parameters of `rolling_params`.
std::span<const sim::Parameter> rolling_parameters();
RollingParams rolling_params(const sim::Sensors& sensors, const MergedImus& imus, const sim::Values& parameters);

/// Runs the smoother over all samples, with modes known from elsewhere when given, into `estimate`.
void smooth(const RollingSmoother::Params& params, const MergedImus& imus, std::span<const RollingMode> known,
            Estimate& estimate);

}  // namespace tumble::scenarios
