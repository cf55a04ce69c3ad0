// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/methods/method.hpp"
#include "tools/tumble/session.hpp"

/// The functions in arguments.hpp parse command-line arguments and prepare output files. All functions in arguments.hpp
/// throw scenarios::BadInput with a one-line message.
namespace tumble::tools {

/// Parses a seed: an unsigned decimal integer below 2^64.
std::uint64_t parse_seed(const std::string& text);
/// Parses a range of seeds, "7" or "1..40"; both ends are included.
std::pair<std::uint64_t, std::uint64_t> parse_seeds(const std::string& text);

/// Shard is one of several parts of the work: "2/8" is the second of eight parts.
struct Shard {
  std::uint64_t index = 1, count = 1;
};
Shard parse_shard(const std::string& text);
/// Reduces a range of seeds to the seeds of one shard. The range is cut into `count` contiguous parts whose lengths
/// differ by at most one. Returns false if the part is empty.
bool shard_seeds(const Shard& shard, std::uint64_t& first, std::uint64_t& last);

/// Throws BadInput for an unknown name and suggests the nearest name: "unknown verb 'rnu'; did you mean 'run'?".
void require_known(const std::string& what, const std::string& name, std::span<const std::string> known);

/// Returns the named methods in order, without duplicates; all methods if `names` is empty.
std::vector<scenarios::MethodPointer> select_methods(const std::vector<std::string>& names);

/// Returns the method with this name. External methods have a time limit of `time_limit_s`.
scenarios::MethodPointer one_method(const std::string& name, double time_limit_s);

/// States how long a run of each external method among `names` may take, because such a run may hang.
void note_time_limits(const Session& session, std::span<const std::string> names);

/// Returns the named metric of the method's kind, or the first metric of the kind if `name` is empty.
std::string metric_of(const scenarios::Method& method, const std::string& name);

/// Parses the random seed in `text`. If `text` is empty, the function returns the seed of a named case; for other
/// scenarios, an empty seed is an error.
std::uint64_t seed_of(const scenarios::Scenario& scenario, const std::string& text);

/// Returns a check that rejects names that are neither a scenario of the catalogue nor a scenario file. The check runs
/// before CLI11 reports missing options.
std::function<void(const std::string&)> a_scenario(const Session& session);
/// Returns a check that rejects names that are neither a suite, a suite file nor a scenario.
std::function<void(const std::string&)> a_suite(const Session& session);

/// Throws BadInput for a missing file or a file that is no recording, before CLI11 reports missing options.
void a_recording(const std::string& file);

/// Returns the number of processors that this process may use.
int available_processors();

/// Creates a folder and its parent folders.
void make_folder(const std::filesystem::path& folder);
/// Creates the folder of an output file. Throws BadInput if the output is one of the inputs. Call this function before
/// the computation starts.
void prepare_output(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

/// Throws BadInput if the extension of an output is not one of `endings`, so that a file of another kind is never
/// replaced.
void require_ending(const std::filesystem::path& output, std::span<const std::string_view> endings);

/// Checks that an output file can be written, before the computation starts, and leaves no file behind. Throws BadInput
/// if the output is one of the inputs or has none of the extensions `endings`.
void prepare_file(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs,
                  const std::vector<std::string_view>& endings);

/// kRecordingEndings lists the extensions of a recording that the program writes.
inline const std::vector<std::string_view> kRecordingEndings = {".h5", ".hdf5"};

}  // namespace tumble::tools
