// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/external_description.hpp"

/// The Python function runs in a separate interpreter that only needs numpy (EXTERNAL.md).
namespace tumble::scenarios {

/// `transcript` receives the printed output of the Python function, even if the function raises an exception.
Estimate call_python(const ExternalDescription& description, const sim::Sensors& sensors, std::string& transcript);

std::string python_version(const ExternalDescription& description);

}  // namespace tumble::scenarios
