// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/methods/external_description.hpp"

/// The functions in python_method.hpp run a method that is one function of a Python file (EXTERNAL.md). The Python
/// function receives the sensor data in shared memory, in a separate interpreter that only needs numpy.
namespace tumble::scenarios {

/// Calls the Python function with the sensor data and returns the estimate. The text `transcript` receives the printed
/// output of the Python function, even if the function throws. Throws the exceptions that external_method.hpp
/// describes.
Estimate call_python(const ExternalDescription& description, const sim::Sensors& sensors, std::string& transcript);

/// Returns the versions of the interpreter and of numpy, and a digest of the Python file. The digest covers only the
/// Python file of the method, without imported modules. Throws BadInput if there is no interpreter with numpy.
std::string python_version(const ExternalDescription& description);

}  // namespace tumble::scenarios
