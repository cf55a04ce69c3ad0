// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/methods/method.hpp"
#include "scenarios/processes/shared_memory.hpp"

/// Sensors to a function of Python and its answer back, through memory and not through files. Both ways: the length of
/// a JSON text (uint64, little end first), the text, arrays from the next multiple of 64 bytes on; in the text each
/// array stands as {"dtype": "<f8", "shape": [N, 3], "offset": from the first array on}. The other side:
/// python_runner.py.
namespace tumble::scenarios {

/// All that an estimator may see, under the names that the package for Python has for it
/// (python/src/tumble/recordings.py).
void write_sensors(const sim::Sensors& sensors, SharedMemory& memory);

/// What the function returned as an estimate of that kind; rates by the samples of the first IMU. Throws NoAnswer with
/// the traceback when it raised, and BadInput with the reason when its answer is none: another shape, a number that is
/// not finite, times that do not rise, memory that holds something else, what AnswerBounds refuses.
Estimate read_answer(const SharedMemory& memory, Kind kind, Frame frame, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
