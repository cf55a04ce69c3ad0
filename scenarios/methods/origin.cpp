// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/origin.hpp"

#include <algorithm>
#include <array>

namespace tumble::scenarios {

namespace {

struct Baseline {
  Kind kind;
  const char* name;
};
constexpr std::array kBaselines = {Baseline{Kind::rate, "raw"}, Baseline{Kind::slam, "icp_raw"}};

}  // namespace

bool is_baseline(const MethodInfo& method) {
  return std::any_of(kBaselines.begin(), kBaselines.end(), [&](const Baseline& baseline) {
    return baseline.kind == method.kind && baseline.name == method.name;
  });
}

bool is_ours(const MethodInfo& method) {
  return method.source == "ours";
}

}  // namespace tumble::scenarios
