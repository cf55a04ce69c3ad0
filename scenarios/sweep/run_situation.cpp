// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/run_situation.hpp"

#include <algorithm>

#include "scenarios/provenance/text_digest.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/sweep/variation.hpp"

namespace tumble::scenarios {

RunResult run_situation(const DataRoot& data, const Scenario& scenario, std::uint64_t seed,
                        std::span<const MethodPointer> methods, int threads, Lidars lidars, const Setting& setting) {
  SimulatedDraw draw = simulate_draw(data, with_setting(scenario, setting), seed, threads, lidars);
  std::optional<SimulatedDraw> original;  // for scoring modified sensor data
  if (reach(setting) == Reach::input) {
    SimulatedDraw given = with_setting(draw, setting);
    original = scored_by(draw, given);
    draw = std::move(given);
  }
  RunResult result;
  result.methods = applicable(methods, subject_of(scenario));
  const bool maps = std::any_of(result.methods.begin(), result.methods.end(),
                                [](const MethodPointer& method) { return method->info.kind == Kind::slam; });
  if (maps) result.surface = std::make_shared<const sim::Surface>(*draw.built);
  for (const MethodPointer& method : result.methods) {
    Outcome outcome;
    outcome.setting = setting;
    Estimate estimate = run_method(with_setting(*method, setting), draw, outcome);
    assess(*method, original ? *original : draw, result.surface.get(), estimate, outcome);
    result.estimates.push_back(std::move(estimate));
    result.outcomes.push_back(std::move(outcome));
  }
  result.scenario = std::move(draw.scenario);
  result.seed = draw.seed;
  result.built = std::move(draw.built);
  result.recording = std::move(draw.recording);
  result.recording_digest =
      original ? digest(result.recording.sensors, &result.recording.truth) : std::move(draw.recording_digest);
  result.simulate_cpu_s = draw.simulate_cpu_s;
  return result;
}

std::string run_digest(const RunResult& result) {
  std::vector<std::string> parts = {result.recording_digest};
  for (std::size_t k = 0; k < result.methods.size(); ++k) {
    parts.push_back(full_name(result.methods[k]->info));
    parts.push_back(digest(result.estimates[k]));
  }
  return digest_of_texts(parts);
}

}  // namespace tumble::scenarios
