// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::scenarios {

/// Returns the certificate as JSON: {"build", "verdict": "pass" | "fail", "entries": [{row, subject, law, unit, value,
/// low, high, verdict, note}]}. Non-finite numbers become null.
std::string to_json(const Certificate& certificate);

/// Parses the JSON of a certificate bit-exactly. Null becomes NaN, and verdicts are recomputed. Throws BadInput with a
/// message that starts with `place`.
Certificate certificate_from_json(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
