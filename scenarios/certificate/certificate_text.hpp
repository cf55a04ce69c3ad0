// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::scenarios {

/// The JSON format is {"build", "verdict": "pass" | "fail", "entries": [{row, subject, law, unit, value, low, high,
/// verdict, note}]}; non-finite numbers become null.
std::string to_json(const Certificate& certificate);

Certificate certificate_from_json(const std::string& text, const std::string& place);

}  // namespace tumble::scenarios
