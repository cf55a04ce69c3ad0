// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "sim/world/hillside.hpp"
#include "sim/world/terrain/profile.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kOwnParameters = {
    Parameter{"drop_count", 2, 1, 6, "1", "drops, one below the other"},
    Parameter{"drop_height_m", 1.2, 0.2, 5.0, "m", "height of each drop; its face is 0.1 m deep, so nearly upright"},
    Parameter{"ledge_length_m", 2.0, 0.3, 8.0, "m", "level length of the ledge below each drop"},
    Parameter{"ledge_slope_rad", 0.35, 0.0, 1.0, "rad", "fall of a ledge along +x"},
};
constexpr std::array kParameters = joined(kOwnParameters, hillside::kCoverParameters);

void build(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  const LedgeProfile profile{hillside::kEdge_m,
                             static_cast<int>(values.at("drop_count")),
                             values.at("drop_height_m"),
                             0.1,
                             values.at("ledge_length_m"),
                             values.at("ledge_slope_rad")};
  Ground ground(hillside::kSide, hillside::kHalfExtent_m);
  ground.transform([&](double x, double, double) { return profile.height_m(x); });
  hillside::roughen(ground, values, seed, [](double, double) { return 1.0; });
  hillside::cover(spec, world, ground, values, seed, -hillside::kHalfExtent_m, hillside::kHalfExtent_m);
}

}  // namespace

const WorldType& cliff_world() {
  static const WorldType kType{
      {"cliff", "terraces of 40 by 40 m: flat top, nearly upright drops along +x, sloping ledges, run-out, rocks, trunks",
       kParameters},
      build};
  return kType;
}

}  // namespace tumble::sim
