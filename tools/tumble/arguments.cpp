// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/arguments.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>

#include "scenarios/errors.hpp"
#include "scenarios/external/external_description.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "scenarios/text.hpp"
#include "sim/parameters.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;

}  // namespace

std::uint64_t parse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  if (!scenarios::read_number(text, seed))
    throw BadInput(fmt::format("--seed is '{}'; a seed must be a whole number from 0 to 2^64 - 1", text));
  return seed;
}

std::pair<std::uint64_t, std::uint64_t> parse_seeds(const std::string& text) {
  const std::size_t dots = text.find("..");
  std::uint64_t first = 0, last = 0;
  const bool read =
      dots == std::string::npos
          ? scenarios::read_number(text, first) && scenarios::read_number(text, last)
          : scenarios::read_number(text.substr(0, dots), first) && scenarios::read_number(text.substr(dots + 2), last);
  if (!read)
    throw BadInput(fmt::format("--seeds is '{}'; write A..B with whole numbers A and B, for example 1..40", text));
  if (last < first) throw BadInput(fmt::format("--seeds is '{}'; the first seed must be at most the last seed", text));
  return {first, last};
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  const std::size_t bar = text.find('/');
  const bool read = bar != std::string::npos && scenarios::read_number(text.substr(0, bar), shard.index) &&
                    scenarios::read_number(text.substr(bar + 1), shard.count);
  if (!read || shard.index < 1 || shard.index > shard.count || shard.count > 1000000) {
    throw BadInput(fmt::format("--shard is '{}'; write i/n with 1 <= i <= n <= 1000000, for example 2/8", text));
  }
  return shard;
}

bool shard_seeds(const Shard& shard, std::uint64_t& first, std::uint64_t& last) {
  if (shard.count == 1) return true;
  // The count of 2^64 seeds overflows, but the difference of the last and the first seed does not.
  const std::uint64_t span = last - first, rest = span % shard.count + 1;
  const std::uint64_t length = span / shard.count + rest / shard.count, longer = rest % shard.count;
  const std::uint64_t before = shard.index - 1;
  const std::uint64_t begin = first + before * length + std::min(before, longer);
  const std::uint64_t own = length + (before < longer ? 1 : 0);
  if (own == 0) return false;
  first = begin;
  last = begin + own - 1;
  return true;
}

void require_known(const std::string& what, const std::string& name, std::span<const std::string> known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const std::string near = sim::did_you_mean(name, known);
  std::string line = "unknown " + what + " '" + name + "'";
  if (!near.empty()) {
    line += "; " + near;
  } else {
    line += "; known:";
    for (const std::string& each : known) line += " " + each;
  }
  throw BadInput(line);
}

std::vector<scenarios::MethodPointer> select_methods(const std::vector<std::string>& names) {
  if (!names.empty()) return scenarios::find_methods(names);
  std::vector<scenarios::MethodPointer> selected;
  for (const scenarios::Method& method : scenarios::methods()) selected.push_back(scenarios::unowned(method));
  return selected;
}

scenarios::MethodPointer one_method(const std::string& name, double time_limit_s) {
  const std::vector<scenarios::MethodPointer> found =
      scenarios::find_methods_within(std::vector<std::string>{name}, time_limit_s);
  if (found.size() == 1) return found.front();
  std::string line = fmt::format("--method {} is the name of several methods; choose one of:", name);
  for (const scenarios::MethodPointer& method : found)
    line += std::string(" ") + to_string(method->info.kind) + "/" + method->info.name;
  throw BadInput(line);
}

void note_time_limits(const Session& session, std::span<const std::string> names) {
  for (const std::string& name : names) {
    if (!scenarios::is_method_file(name)) continue;
    session.note(
        fmt::format("{}: the program stops each run of this method after {:g} s. The key time_limit_s in the method's "
                    "description sets the limit",
                    name, scenarios::read_external(name).time_limit_s));
  }
}

std::string metric_of(const scenarios::Method& method, const std::string& name) {
  if (name.empty()) return scenarios::headline_metrics(method.info.kind).front();
  std::vector<std::string> known;
  for (const scenarios::Metric& metric : scenarios::metrics()) {
    if (metric.kind == method.info.kind) known.push_back(metric.info.name);
  }
  require_known(std::string("metric of kind ") + to_string(method.info.kind), name, known);
  return name;
}

scenarios::FailureGoal failure_of(const scenarios::Method& method, const std::string& text) {
  return text.empty() ? scenarios::FailureGoal{} : scenarios::parse_goal(text, method.info.kind);
}

std::uint64_t seed_of(const scenarios::Scenario& scenario, const std::string& text) {
  if (!text.empty()) return parse_seed(text);
  if (scenario.named_case) return scenario.named_case->seed;
  throw BadInput(
      fmt::format("--seed is missing; use --seed NUMBER to choose a simulated run of scenario '{}'", scenario.name));
}

// CLI11 does not convert a BadInput that a check throws.
std::function<void(const std::string&)> a_scenario(const Session& session) {
  return [&session](const std::string& text) { scenarios::load_scenario(session.data(), text); };
}

std::function<void(const std::string&)> a_suite(const Session& session) {
  return [&session](const std::string& text) { scenarios::load_suite(session.data(), text); };
}

void a_recording(const std::string& file) {
  scenarios::require_recording_file(file);
}

int available_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  const int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  return std::clamp(count, 1, 1024);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw BadInput(fmt::format("{}: the program cannot create this folder: {}", folder.string(), error.message()));
  if (!std::filesystem::is_directory(folder, error))
    throw BadInput(fmt::format("{}: this path exists, but is not a folder; choose another path", folder.string()));
}

void prepare_output(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs) {
  scenarios::require_not_an_input(output, inputs);
  if (output.has_parent_path()) make_folder(output.parent_path());
}

void require_ending(const std::filesystem::path& output, std::span<const std::string_view> endings) {
  const std::string ending = output.extension().string();
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  std::string allowed;
  for (const std::string_view each : endings) allowed.append(allowed.empty() ? "" : " or ").append(each);
  throw BadInput(fmt::format("{}: the name of this output must end in {}", output.string(), allowed));
}

void prepare_file(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs,
                  const std::vector<std::string_view>& endings) {
  scenarios::require_not_an_input(output, inputs);
  require_ending(output, endings);
  if (output.has_parent_path()) make_folder(output.parent_path());
  const scenarios::OutputFile tried(output);
}

}  // namespace tumble::tools
