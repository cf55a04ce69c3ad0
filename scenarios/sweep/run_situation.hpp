// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/built_situation.hpp"
#include "sim/lidar/surface.hpp"

namespace tumble::scenarios {

struct RunResult {
  std::string scenario;
  std::uint64_t seed = 0;
  std::optional<sim::BuiltSituation> built;     ///< the simulated situation
  std::shared_ptr<const sim::Surface> surface;  ///< null without maps
  sim::Recording recording;
  std::string recording_digest;
  double simulate_cpu_s = 0;
  std::vector<MethodPointer> methods;
  std::vector<Estimate> estimates;  ///< parallel to methods
  std::vector<Outcome> outcomes;    ///< parallel to methods
};

/// A `setting` changes one parameter of the run. The returned recording contains the sensor data that methods receive.
RunResult run_situation(const DataRoot& data, const Scenario& scenario, std::uint64_t seed,
                        std::span<const MethodPointer> methods, int threads, Lidars lidars = Lidars::simulated,
                        const Setting& setting = {});

std::string run_digest(const RunResult& result);

}  // namespace tumble::scenarios
