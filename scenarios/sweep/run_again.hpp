// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "scenarios/sweep/outcome.hpp"

/// command_again returns the command that reproduces one row of the results. Reports, gates and messages show it for
/// failed runs.
namespace tumble::scenarios {

/// RunKey is the key of a row in the results; kind and method are empty for a run that could not be simulated.
struct RunKey {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string kind, method;
  Setting setting = {};
};
RunKey key_of(const Outcome& outcome);

/// Returns the key of the note with the path of an external method's description, or of a recording. With the path, a
/// run can be repeated.
std::string description_note(const std::string& kind, const std::string& method);
std::string recording_note(const std::string& name);
bool is_place_note(const std::string& key);

/// Returns the command that repeats a run: `tumble run SCENARIO --seed N --method KIND/NAME`. For a point of a curve,
/// it also contains `--vary KEY=VALUE`; for an external method, the path of the description. For a recording, it is
/// `tumble estimate FILE.h5 --method KIND/NAME -o NAME`. Words are quoted for a POSIX shell. `notes` are the notes of
/// the results (Results::notes). Placeholders in capitals replace missing information. With equal build, models and
/// scenarios, the results are bit-identical.
std::string command_again(const RunKey& run, const std::map<std::string, std::string>& notes);

/// Parses a point of a curve, for example "world.rock_count=10" or "a.x+b.y=0.5". Throws BadInput for another form.
/// Whether the key exists is tested by `check` (variation.hpp).
Setting setting_from(const std::string& text);

/// Converts a point of a curve to text, from which the number is restored exactly.
std::string to_text(const Setting& setting);

}  // namespace tumble::scenarios
