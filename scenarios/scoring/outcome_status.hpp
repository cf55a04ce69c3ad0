// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace tumble::scenarios {

/// The statuses `ok`, `diverged` (score.hpp, `verdict`), `failed` (the method returned an error), `crashed` and
/// `timeout` result from the method itself. The status `killed` has a cause outside the method: a signal from another
/// process, a lack of memory, or a failed process start. The status `rejected` means that the scenario cannot be
/// simulated with the seed of the run.
enum class OutcomeStatus { ok, diverged, failed, crashed, timeout, killed, rejected };

std::span<const OutcomeStatus> outcome_statuses();
const char* to_string(OutcomeStatus status);
std::optional<OutcomeStatus> outcome_status_named(std::string_view name);

}  // namespace tumble::scenarios
