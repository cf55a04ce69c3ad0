// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "scenarios/sweep/outcome.hpp"

/// run_again.hpp computes the command that reproduces one row of the results. Reports, gates and messages show this
/// command for failed runs.
namespace tumble::scenarios {

/// RunKey is the key of a row of the results; kind and method are empty for a rejected run.
struct RunKey {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string kind, method;
  Setting setting = {};
};
RunKey key_of(const Outcome& outcome);

/// These functions return the keys of the notes that a sweep stores for reproduction. The notes for reproduction
/// contain the description file of an external method and the path of a recording.
std::string description_note(const std::string& kind, const std::string& method);
std::string recording_note(const std::string& name);
bool is_place_note(const std::string& key);

/// Returns `tumble run SCENARIO --seed N --method KIND/NAME`. A point of a curve adds `--vary KEY=VALUE`; an external
/// method adds the path of its description. For a recording, returns `tumble estimate FILE.h5 --method KIND/NAME -o
/// NAME`. The words of the command are quoted for a POSIX shell. `notes` are the notes of the results (Results::notes).
/// Placeholders in capitals replace missing information. With equal build, models and scenarios, the command gives
/// bit-identical results.
std::string command_again(const RunKey& run, const std::map<std::string, std::string>& notes);

/// Parses a point of a curve: "world.rock_count=10", "a.x+b.y=0.5". Throws BadInput for a malformed text. The function
/// `check` (variation.hpp) tests whether the key exists.
Setting setting_from(const std::string& text);

/// Returns the point of a curve as text. Numbers are restored exactly.
std::string to_text(const Setting& setting);

}  // namespace tumble::scenarios
