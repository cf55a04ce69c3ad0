// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/run_situation.hpp"
#include "tools/report/map_pictures.hpp"
#include "tools/report/paths.hpp"
#include "tools/report/summary.hpp"

namespace tumble::tools {

/// One draw of a report, run again from its scenario and seed, which gives the same bits as the sweep's.
struct Example {
  scenarios::RunResult run;
  bool is_sphere = false;
  bool same_as_stored = false;            ///< the recording's digest is the one that the database holds
  std::vector<std::string> path_methods;  ///< "slam/icp": what the pictures draw
  std::vector<Path> paths;                ///< parallel
  std::vector<std::uint8_t> scene_png, film_png;
  std::vector<ErrorMap> maps;         ///< of the clipped gyro and of ours, as far as the results hold them
  std::vector<std::uint8_t> map_png;  ///< empty without maps
};

/// The draw whose headline score under `kind`'s baseline is the median one of its scenario: neither the best nor the
/// worst. Returns false when the results have no such score.
bool typical_seed(const Summary& summary, const std::string& scenario, std::uint64_t& seed);

/// Runs it with all methods that the results hold for the scenario. Throws what run_situation throws.
Example make_example(const scenarios::DataRoot& data, const scenarios::Results& results, const Summary& summary,
                     const std::string& scenario, std::uint64_t seed, int threads);

}  // namespace tumble::tools
