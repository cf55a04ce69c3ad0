// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/outcome_status.hpp"

#include <array>

namespace tumble::scenarios {

std::span<const OutcomeStatus> outcome_statuses() {
  static constexpr std::array kAll = {OutcomeStatus::ok,      OutcomeStatus::diverged, OutcomeStatus::failed,
                                      OutcomeStatus::crashed, OutcomeStatus::timeout,  OutcomeStatus::killed,
                                      OutcomeStatus::rejected};
  return kAll;
}

const char* to_string(OutcomeStatus status) {
  switch (status) {
    case OutcomeStatus::ok:
      return "ok";
    case OutcomeStatus::diverged:
      return "diverged";
    case OutcomeStatus::failed:
      return "failed";
    case OutcomeStatus::crashed:
      return "crashed";
    case OutcomeStatus::timeout:
      return "timeout";
    case OutcomeStatus::killed:
      return "killed";
    case OutcomeStatus::rejected:
      return "rejected";
  }
  return "";
}

std::optional<OutcomeStatus> outcome_status_named(std::string_view name) {
  for (const OutcomeStatus status : outcome_statuses()) {
    if (name == to_string(status)) return status;
  }
  return std::nullopt;
}

}  // namespace tumble::scenarios
