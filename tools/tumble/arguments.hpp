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
#include "scenarios/estimates/method.hpp"
#include "scenarios/sweep/failure_goal.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

std::uint64_t parse_seed(const std::string& text);
std::pair<std::uint64_t, std::uint64_t> parse_seeds(const std::string& text);

struct Shard {
  std::uint64_t index = 1, count = 1;
};
Shard parse_shard(const std::string& text);
/// The range of seeds is reduced to one of `count` contiguous parts, whose lengths differ by at most one; false means
/// an empty part.
bool shard_seeds(const Shard& shard, std::uint64_t& first, std::uint64_t& last);

void require_known(const std::string& what, const std::string& name, std::span<const std::string> known);

std::vector<scenarios::MethodPointer> select_methods(const std::vector<std::string>& names);

scenarios::MethodPointer one_method(const std::string& name, double time_limit_s);

void note_time_limits(const Session& session, std::span<const std::string> names);

std::string metric_of(const scenarios::Method& method, const std::string& name);

inline constexpr const char* kFailureHelp =
    "defines a failure: 'METRIC > VALUE' in SI units, or 'METRIC < VALUE' if lower values are worse. A run whose "
    "status is not ok, or that fails a pass-fail metric, also fails [default: only these runs fail]";

/// Returns the failure that the value of --failure defines. An empty text gives a failure without a metric.
scenarios::FailureGoal failure_of(const scenarios::Method& method, const std::string& text);

/// For an empty `text`, returns the seed of a named case; other scenarios require a seed.
std::uint64_t seed_of(const scenarios::Scenario& scenario, const std::string& text);

std::function<void(const std::string&)> a_scenario(const Session& session);
std::function<void(const std::string&)> a_suite(const Session& session);

void a_recording(const std::string& file);

int available_processors();

void make_folder(const std::filesystem::path& folder);
/// Throws BadInput if the output is one of the inputs; must be called before the computation starts.
void prepare_output(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

/// Throws BadInput if the extension of an output is not one of `endings`, so that an output never replaces a file of
/// another kind.
void require_ending(const std::filesystem::path& output, std::span<const std::string_view> endings);

/// Checks, before the computation starts, that an output file can be written.
void prepare_file(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs,
                  const std::vector<std::string_view>& endings);

inline const std::vector<std::string_view> kRecordingEndings = {".h5", ".hdf5"};

}  // namespace tumble::tools
