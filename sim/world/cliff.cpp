// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/world/hillside.hpp"
#include "sim/world/terrain/profile.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kOwnCliffParameters = {
    Parameter{"drop_count", 2, 1, 6, "1", "number of vertical drops, one below another"},
    Parameter{"drop_height_m", 1.2, 0.2, 5.0, "m",
              "height of each drop; the face of a drop is one ground cell (0.2 m) wide"},
    Parameter{"ledge_length_m", 2.0, 0.3, 8.0, "m",
              "horizontal length of the ledge below a drop, rounded to whole cells"},
    Parameter{"ledge_slope_rad", 0.35, 0.0, 1.0, "rad", "downward slope of a ledge along +x"},
};
constexpr std::array kCliffParameters = joined(kOwnCliffParameters, hillside::kCoverParameters);

void build_cliff(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  Ground ground(hillside::kSide, hillside::kHalfExtent_m);
  // Each drop of the cliff starts and ends at nodes of the ground grid, so the horizontal length of a drop is one grid
  // cell. If a drop started between two grid nodes, the drop would extend over two cells and have half the slope.
  const double cell_m = ground.cell_m();
  const double ledge_m = cell_m * std::max(1.0, std::round(values.at("ledge_length_m") / cell_m));
  const LedgeProfile profile{hillside::kEdge_m,
                             static_cast<int>(values.at("drop_count")),
                             values.at("drop_height_m"),
                             cell_m,
                             ledge_m,
                             values.at("ledge_slope_rad")};
  ground.transform([&](double x, double, double) { return profile.height_m(x); });
  hillside::roughen(ground, values, seed, [](double, double) { return 1.0; });
  hillside::cover(spec, world, ground, values, seed, -hillside::kHalfExtent_m, hillside::kHalfExtent_m);
}

}  // namespace

const WorldType& cliff_world() {
  static const WorldType kType{
      {"cliff",
       "terraces of 40 m by 40 m with a flat top, steep drops along +x, sloping ledges, a run-out, rocks and trunks",
       kCliffParameters},
      build_cliff};
  return kType;
}

}  // namespace tumble::sim
