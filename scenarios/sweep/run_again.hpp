// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "scenarios/sweep/outcome.hpp"

/// The command that reproduces one row of the results; reports, gates and messages show it for failed runs.
namespace tumble::scenarios {

/// A row of the results. Kind and method are empty for a rejected draw.
struct RunKey {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string kind, method;
  Setting setting = {};
};
RunKey key_of(const Outcome& outcome);

/// Keys of the notes that a sweep stores for this: the description file of an external method, and the path of a
/// recording.
std::string description_note(const std::string& kind, const std::string& method);
std::string recording_note(const std::string& name);
bool is_place_note(const std::string& key);

/// Returns `tumble run SCENARIO --seed N --method KIND/NAME`, with `--vary KEY=VALUE` for a point of a curve and the
/// description's path for an external method. For a recording: `tumble estimate FILE.h5 --method KIND/NAME -o NAME`.
/// Words are quoted for a POSIX shell. `notes` are those of the results (Results::notes); missing information appears
/// as placeholders in capitals. The same build, models and scenarios give the same bits.
std::string command_again(const RunKey& run, const std::map<std::string, std::string>& notes);

/// Parses a point of a curve: "world.rock_count=10", "a.x+b.y=0.5". Throws BadInput for a malformed text; `check`
/// (variation.hpp) tests whether the key exists.
Setting setting_from(const std::string& text);

/// Returns the point as text; numbers round-trip exactly.
std::string to_text(const Setting& setting);

}  // namespace tumble::scenarios
