// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::scenarios {

/// Converts a certificate (checks of the simulation) to JSON: {"build", "verdict": "pass" | "fail", "entries": [{row,
/// subject, law, unit, value, low, high, verdict, note}]}. Non-finite numbers become null.
std::string to_json(const Certificate& certificate);

/// Parses the JSON text of a certificate without loss of bits. JSON null becomes NaN. The verdict is computed from the
/// value and its range. Throws BadInput with a message that starts with `place`.
Certificate certificate_from_json(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
