// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::scenarios {

/// JSON: {"build", "verdict": "pass" | "fail", "entries": [{row, subject, law, unit, value, low, high, verdict,
/// note}]}; a number that is not finite is null.
std::string to_json(const Certificate& certificate);

/// Back to the bit; null becomes NaN, and verdicts are worked out anew. Throws BadInput; `place` begins the message.
Certificate certificate_from_json(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
