// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace tumble::scenarios {

/// The method causes `ok`, `diverged` (score.hpp, `verdict`), `failed` (it returned an error), `crashed` and `timeout`.
/// The machine causes `killed`: a signal from outside, no memory, or no process. `rejected` means that the scenario
/// cannot be simulated with this seed.
enum class OutcomeStatus { ok, diverged, failed, crashed, timeout, killed, rejected };

std::span<const OutcomeStatus> outcome_statuses();
const char* to_string(OutcomeStatus status);
std::optional<OutcomeStatus> outcome_status_named(std::string_view name);

}  // namespace tumble::scenarios
