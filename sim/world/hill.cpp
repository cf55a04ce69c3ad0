// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "sim/world/hillside.hpp"
#include "sim/world/terrain/profile.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kOwnHillParameters = {
    Parameter{"slope_rad", 0.6, 0.05, 1.2, "rad", "angle of the slope between top and run-out"},
    Parameter{"drop_m", 4.0, 0.2, 12.0, "m", "height of the slope; at equal height, a gentler slope is longer"},
};
constexpr std::array kHillParameters = joined(kOwnHillParameters, hillside::kCoverParameters);

void build_hill(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  const SlopeProfile profile{hillside::kEdge_m, values.at("slope_rad"), values.at("drop_m")};
  Ground ground(hillside::kSide, hillside::kHalfExtent_m);
  ground.transform([&](double x, double, double) { return profile.height_m(x); });
  hillside::roughen(ground, values, seed, [](double, double) { return 1.0; });
  hillside::cover(spec, world, ground, values, seed, -hillside::kHalfExtent_m, hillside::kHalfExtent_m);
}

}  // namespace

const WorldType& hill_world() {
  static const WorldType kType{
      {"hill", "hill of 40 m by 40 m with a flat top, a slope along +x, a run-out, relief, rocks and trunks",
       kHillParameters},
      build_hill};
  return kType;
}

}  // namespace tumble::sim
