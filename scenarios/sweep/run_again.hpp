// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "scenarios/sweep/outcome.hpp"

/// The command that makes one row of the results again: what report, gate and messages show beside a run that failed.
namespace tumble::scenarios {

/// A row, as results have it. A rejected draw has neither kind nor method.
struct RunKey {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string kind, method;
  Setting setting = {};
};
RunKey key_of(const Outcome& outcome);

/// Keys of the notes that a sweep leaves for it: the file that describes a method which is not of the build, and where
/// a recording of a suite of recordings stands.
std::string description_note(const std::string& kind, const std::string& method);
std::string recording_note(const std::string& name);
bool is_place_note(const std::string& key);

/// `tumble run SCENARIO --seed N --method KIND/NAME`, with `--vary KEY=VALUE` for a point of a curve and the
/// description's path for a method of somebody else's; of a recording `tumble estimate FILE.h5 --method KIND/NAME -o
/// NAME`. Words are quoted for a POSIX shell. `notes` are those of the results (Results::notes); what they do not tell
/// (a database of an older version) is named in capitals, to be filled in. The same build, models and scenarios give
/// the same bits.
std::string command_again(const RunKey& run, const std::map<std::string, std::string>& notes);

/// "world.rock_count=10", "a.x+b.y=0.5" as a point of a curve. Throws BadInput when it is none; whether there is such a
/// number, `check` asks (variation.hpp).
Setting setting_from(const std::string& text);

/// The same point as text: numbers come back to the bit.
std::string to_text(const Setting& setting);

}  // namespace tumble::scenarios
