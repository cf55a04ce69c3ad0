// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/stairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/world/hillside.hpp"
#include "sim/world/terrain/profile.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kOwnStairsParameters = {
    Parameter{"step_count", 18, 1, 80, "1", "number of steps"},
    Parameter{"step_rise_m", 0.17, 0.05, 0.5, "m", "height of a step"},
    Parameter{"step_tread_m", 0.29, 0.15, 1.0, "m", "depth of a step"},
    Parameter{"flight_half_width_m", 2.5, 0.8, 8.0, "m",
              "half width of the flight of stairs, which has a side wall on each side"},
    Parameter{"cheek_height_m", 0.4, 0.05, 2.0, "m", "height of the side walls above the edges of the steps"},
};
constexpr std::array kStairsParameters = joined(kOwnStairsParameters, hillside::kCoverParameters);

constexpr Colour kStone = {0.66f, 0.64f, 0.6f, 1.0f};

void add_cheeks(mjSpec* spec, engine::World& world, const Flight& flight, double height_m) {
  constexpr int kPiece = 4;
  constexpr double kHalfThickness_m = 0.1, kDepth_m = 3.0;
  for (int first = 0; first < flight.steps; first += kPiece) {
    const int count = std::min(kPiece, flight.steps - first);
    const double top_m = -first * flight.rise_m + height_m;
    const double bottom_m = -(first + count) * flight.rise_m - kDepth_m;
    const double half_length_m = 0.5 * count * flight.tread_m;
    const double x_m = flight.edge_x_m + first * flight.tread_m + half_length_m;
    for (const double side : {-1.0, 1.0}) {
      add_surface(spec, world, (side < 0 ? "cheek_right_" : "cheek_left_") + std::to_string(first / kPiece), mjGEOM_BOX,
                  {x_m, side * (flight.half_width_m + kHalfThickness_m), 0.5 * (top_m + bottom_m)},
                  {half_length_m, kHalfThickness_m, 0.5 * (top_m - bottom_m)}, 0.0, kStone);
    }
  }
}

void build_stairs(mjSpec* spec, const Values& values, std::uint64_t seed, engine::World& world) {
  const Flight flight{hillside::kEdge_m, static_cast<int>(values.at("step_count")), values.at("step_rise_m"),
                      values.at("step_tread_m"), values.at("flight_half_width_m")};
  const SlopeProfile slope{flight.edge_x_m, flight.slope_rad(), flight.drop_m(), 0.05};
  const auto beside = [&](double, double y_m) {
    return fade(std::abs(y_m), flight.half_width_m + 0.3, flight.half_width_m + 1.5);
  };
  Ground ground(hillside::kSide, hillside::kHalfExtent_m);
  ground.transform([&](double x_m, double y_m, double) {
    const double under_m = flight.rise_m + 0.25;
    const bool over_flight = x_m > flight.edge_x_m && x_m < flight.edge_x_m + flight.length_m() - 0.1;
    const bool inside = std::abs(y_m) < flight.half_width_m + 0.1;
    return slope.height_m(x_m) - (over_flight && inside ? under_m : 0.0);
  });
  hillside::roughen(ground, values, seed, beside);
  const double foot_m = flight.edge_x_m + flight.length_m();
  hillside::cover(spec, world, ground, values, seed, foot_m + 1.0, hillside::kHalfExtent_m);
  constexpr double kStepDepth_m = 1.0;
  add_steps(spec, world, lay_steps(flight, kStepDepth_m), kStone);
  add_cheeks(spec, world, flight, values.at("cheek_height_m"));
}

}  // namespace

const WorldType& stairs_world() {
  static const WorldType kType{
      {"stairs",
       "flight of stone steps along +x down a grassy slope of 40 m by 40 m, with level ground at the top and the foot",
       kStairsParameters},
      build_stairs};
  return kType;
}

}  // namespace tumble::sim
