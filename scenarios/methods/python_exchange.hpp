// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/processes/shared_memory.hpp"

/// A Python function exchanges sensor data and result through shared memory. In both directions, the memory contains
/// the length of a JSON text (uint64, little endian), the text, and arrays. The first array starts at the next multiple
/// of 64 bytes. The text describes each array as {"dtype": "<f8", "shape": [N, 3], "offset": bytes after the start of
/// the first array}. The Python side is python_runner.py.
namespace tumble::scenarios {

/// The arrays have the names of the Python package (python/src/tumble/recordings.py).
void write_sensors(const sim::Sensors& sensors, SharedMemory& memory);

/// Rates belong to the samples of the first IMU. Throws NoAnswer with the traceback if the function raised an
/// exception. Throws BadInput with the reason for a wrong shape, a non-finite number, times that do not increase,
/// corrupted memory, or values outside AnswerBounds.
Estimate read_answer(const SharedMemory& memory, Kind kind, Frame frame, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
