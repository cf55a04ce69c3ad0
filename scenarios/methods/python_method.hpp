// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/external_description.hpp"

/// A method that is one function of a Python file (EXTERNAL.md). It is called with the sensors in shared memory, in a
/// separate interpreter that only needs numpy.
namespace tumble::scenarios {

/// Calls the function. `transcript` receives its printed output, also on exceptions. Throws as external_method.hpp
/// states.
Estimate call_python(const ExternalDescription& description, const sim::Sensors& sensors, std::string& transcript);

/// Returns the versions of interpreter and numpy, and a digest of the file; imported modules are not included. Throws
/// BadInput if there is no interpreter with numpy.
std::string python_version(const ExternalDescription& description);

}  // namespace tumble::scenarios
