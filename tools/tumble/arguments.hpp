// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/methods/method.hpp"
#include "tools/tumble/session.hpp"

/// Reading of command-line words, and files of the program's own. All throw scenarios::BadInput with one clear line.
namespace tumble::tools {

/// A seed: a whole decimal number below 2^64.
std::uint64_t parse_seed(const std::string& text);
/// "7" or "1..40", first to last, both included.
std::pair<std::uint64_t, std::uint64_t> parse_seeds(const std::string& text);

/// A share of work, "2/8": the second of eight.
struct Shard {
  std::uint64_t index = 1, count = 1;
};
Shard parse_shard(const std::string& text);
/// The seeds of one shard: the range is cut into `count` contiguous parts whose lengths differ by one at most.
/// Returns false when the part is empty.
bool shard_seeds(const Shard& shard, std::uint64_t& first, std::uint64_t& last);

/// Refuses a name that is not known, naming the nearest: "unknown verb 'rnu'; did you mean 'run'?".
void require_known(const std::string& what, const std::string& name, std::span<const std::string> known);

/// The methods named, each once, in the order given; all of them when none is named.
std::vector<scenarios::MethodPointer> select_methods(const std::vector<std::string>& names);

/// The one method of that name; a command of somebody else's is given at most `time_limit_s`.
scenarios::MethodPointer one_method(const std::string& name, double time_limit_s);

/// The metric of the method's kind that is named, or the kind's first.
std::string metric_of(const scenarios::Method& method, const std::string& name);

/// The seed given; without one that of a named case. Of another scenario it has to be given.
std::uint64_t seed_of(const scenarios::Scenario& scenario, const std::string& text);

/// Refuses what is neither a scenario of the catalogue nor a scenario file, before anything else is missing.
std::function<void(const std::string&)> a_scenario(const Session& session);
/// The same of a suite, a suite file or a scenario.
std::function<void(const std::string&)> a_suite(const Session& session);

/// Refuses a recording's file that is not there, likewise.
void a_recording(const std::string& file);

/// The processors that this process may use.
int available_processors();

/// Makes a folder and its parents.
void make_folder(const std::filesystem::path& folder);
/// Makes the folder of an output file, and refuses an output that is one of the inputs. For before the work begins.
void prepare_output(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

/// The same for an output that is one file: refuses what could not be written there before anything is worked out for
/// it, and leaves nothing.
void prepare_file(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

}  // namespace tumble::tools
