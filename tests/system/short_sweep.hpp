// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "system/program.hpp"

/// The tests of sweeps, of their files and of their report share this sweep.
namespace tumble::system_test {

inline Ended run_shortened(const std::vector<std::string>& arguments) {
  return run_program(arguments, in_short_catalogue());
}

/// Returns the arguments of the shared sweep: short draws of the sphere.
inline std::vector<std::string> sweep_arguments(const fs::path& database, const std::string& seeds,
                                                const std::string& examples = "0") {
  return {"sweep",   "roll", "--seeds", seeds,        "--method", "rate/raw", "--method",
          "rolling", "--db", database,  "--examples", examples,   "--json"};
}

inline nlohmann::json report_json(const fs::path& database) {
  return json_of(run_shortened({"report", database.string(), "--json"}));
}

}  // namespace tumble::system_test
