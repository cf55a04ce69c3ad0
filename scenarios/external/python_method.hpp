// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/estimates/method.hpp"
#include "scenarios/external/external_description.hpp"
#include "scenarios/processes/shared_memory.hpp"

/// The Python function runs in a separate interpreter that only needs numpy (EXTERNAL.md).
namespace tumble::scenarios {

/// Calls the Python function of an external method. `transcript` receives the printed output of the Python function,
/// even if the function raises an exception.
Estimate call_python(const ExternalDescription& description, const sim::Sensors& sensors, std::string& transcript);

std::string python_version(const ExternalDescription& description);

/// The shared memory between the program and a Python function contains the length of a JSON text (uint64, little
/// endian), the text, and arrays. The first array in the shared memory starts at the first multiple of 64 bytes after
/// the JSON text. The JSON text describes each array as {"dtype": "<f8", "shape": [N, 3], "offset": bytes after the
/// start of the first array}.

/// Each array of sensor data has the name of its attribute in python/src/tumble/recordings.py.
void write_sensors(const sim::Sensors& sensors, SharedMemory& memory);

/// Throws NoAnswer with the traceback if the Python function raised an exception.
Estimate read_answer(const SharedMemory& memory, Kind kind, Frame frame, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
