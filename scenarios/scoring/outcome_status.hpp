// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace tumble::scenarios {

/// How a method's run on a draw ended. `ok`, `diverged` (the estimate left the truth: score.hpp, `verdict`), `failed`
/// (it said so), `crashed` (it ended its process) and `timeout` are the method's; `killed` is the machine's (a signal
/// from outside, no memory, no process) and says nothing of the method; `rejected` is the draw's: it cannot be
/// simulated.
enum class OutcomeStatus { ok, diverged, failed, crashed, timeout, killed, rejected };

std::span<const OutcomeStatus> outcome_statuses();
/// As the results database has it.
const char* to_string(OutcomeStatus status);
std::optional<OutcomeStatus> outcome_status_named(std::string_view name);

}  // namespace tumble::scenarios
