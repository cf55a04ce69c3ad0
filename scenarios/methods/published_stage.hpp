// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/baselines/mapping/published_chain.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::scenarios {

const Settings<baselines::PublishedChain::Params>& published_settings();

void run_published_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const sim::Values& parameters,
                         Estimate& estimate);

}  // namespace tumble::scenarios
