// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/external_description.hpp"

/// A method that is one function of a Python file (EXTERNAL.md): called with the sensors in shared memory, in an
/// interpreter of its own that needs numpy and nothing of ours.
namespace tumble::scenarios {

/// Calls the function; `transcript` becomes what was printed, also where it throws, as external_method.hpp states.
Estimate call_python(const ExternalDescription& description, const sim::Sensors& sensors, std::string& transcript);

/// Versions of interpreter and numpy, and a digest of the file; modules that it imports are not looked at. Throws
/// BadInput when there is no interpreter, or none with numpy.
std::string python_version(const ExternalDescription& description);

}  // namespace tumble::scenarios
