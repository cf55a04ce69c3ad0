// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/carried_smoother.hpp"

/// What the methods on a carried body have in common: the smoother fed with the primary IMU, its rails found before.
namespace tumble::scenarios {

/// Parameters of a method on the carried body, with the library's own defaults.
const Settings<CarriedSmoother::Params>& carried_settings();

/// Signs of the elements that stand at a rail, per sample: flags of the device, plateaus and tilted planes found in the
/// readings. `rows` of the result are those of the planes, the axes themselves where none was seen; it refers to
/// `signs`. `near`: bits of may_meet_rails(), where asked for.
ClippedElements find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::vector<ClipSigns>& signs, std::vector<std::uint8_t>* near = nullptr);

/// Runs the smoother over the primary IMU. `doubted_axes`: of each sample the axes whose readings may stand at a rail
/// that was not seen, which are bounds then, or none. Trouble: that of the record and of the smoother; the outputs are
/// then empty.
Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters,
                   std::span<const std::uint8_t> doubted_axes, std::vector<RateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
