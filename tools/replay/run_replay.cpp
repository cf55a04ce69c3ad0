// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/run_replay.hpp"

#include <algorithm>
#include <optional>

namespace tumble::tools {

namespace {

bool can_be_shown(const scenarios::RunResult& run, std::size_t i) {
  const scenarios::Estimate& estimate = run.estimates[i];
  return !run.methods[i]->info.needs_truth && (!estimate.poses.empty() || !estimate.rates.empty());
}

}  // namespace

std::vector<std::size_t> shown_methods(const scenarios::RunResult& run) {
  std::vector<std::size_t> first, paths, rates;
  for (std::size_t i = 0; i < run.methods.size() && i < run.estimates.size(); ++i) {
    if (!can_be_shown(run, i)) continue;
    const scenarios::MethodInfo& info = run.methods[i]->info;
    const bool leads = info.baseline || info.name == "tumble";
    (leads ? first : run.estimates[i].poses.empty() ? rates : paths).push_back(i);
  }
  first.insert(first.end(), paths.begin(), paths.end());
  first.insert(first.end(), rates.begin(), rates.end());
  first.resize(std::min(first.size(), kRunReplayMethods));
  std::sort(first.begin(), first.end());
  return first;
}

Replay replay_of_run(const scenarios::RunResult& run) {
  std::optional<sim::Surface> own;
  if (!run.surface && !run.recording.sensors.lidars.empty()) own.emplace(*run.built);
  ReplayInput input;
  input.title = run.scenario + ", seed " + std::to_string(run.seed);
  input.facts = {{"digest of the recording", run.recording_digest}};
  input.sensors = &run.recording.sensors;
  input.truth = &run.recording.truth;
  input.built = &run.built.value();
  input.surface = run.surface ? run.surface.get() : own ? &*own : nullptr;
  for (const std::size_t i : shown_methods(run)) {
    const scenarios::MethodInfo& info = run.methods[i]->info;
    input.estimates.push_back({full_name(info), &run.estimates[i]});
  }
  return replay_of(input);
}

}  // namespace tumble::tools
