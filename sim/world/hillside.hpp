// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "sim/parameters.hpp"
#include "sim/world/terrain/ground.hpp"

namespace tumble::sim::hillside {

inline constexpr double kHalfExtent_m = 20.0;
/// Number of grid nodes per side of the ground, with grid cells of 20 cm. With smaller cells of 10 cm, a strut that an
/// impact pushes some centimetres into the ground would stay wedged for seconds.
inline constexpr int kSide = 201;
inline constexpr double kEdge_m = -8.0;
inline constexpr double kSetBack_m = 0.8;  ///< robot's start behind the edge
inline constexpr double kStart_x_m = kEdge_m - kSetBack_m;

inline constexpr std::array kCoverParameters = {
    Parameter{"relief_m", 0.12, 0.0, 1.0, "m", "root mean square height of the relief; 0: none"},
    Parameter{"relief_shortest_m", 2.5, 0.5, 20.0, "m", "shortest wavelength of the relief"},
    Parameter{"relief_longest_m", 9.0, 0.5, 40.0, "m", "longest wavelength of the relief"},
    Parameter{"relief_exponent", 3.0, 0.0, 6.0, "1",
              "exponent with which the relief's power decreases with the wave number; a larger value makes a smoother "
              "relief"},
    Parameter{"relief_ruled", 0, 0, 1, "1", "1: the relief depends only on x, so that contour lines are straight"},
    Parameter{"bump_height_m", 0.2, 0.0, 0.6, "m",
              "maximum height of a bump or depth of a hollow, each 0.5 to 1.6 m wide; 0: none"},
    Parameter{"bump_count", 500, 0, 5000, "1", "number of bumps and hollows on the whole ground (1600 m^2)"},
    Parameter{"rock_count", 40, 0, 400, "1", "number of rocks, which are half-buried ellipsoids"},
    Parameter{"rock_size_m", 0.3, 0.05, 1.5, "m", "maximum half axis of a rock; the sizes of the rocks are random"},
    Parameter{"rock_half_width_m", 18.0, 1.0, 18.0, "m", "maximum distance of the rocks from the fall line"},
    Parameter{"trunk_count", 40, 0, 300, "1", "number of tree trunks, which are vertical cylinders"},
    Parameter{"trunk_radius_m", 0.15, 0.03, 0.6, "m", "maximum radius of a trunk"},
    Parameter{"trunk_half_width_m", 18.0, 2.0, 18.0, "m", "maximum distance of the trunks from the fall line"},
    Parameter{"clear_half_width_m", 2.5, 0.0, 15.0, "m", "minimum distance of trunks from the fall line"},
    Parameter{"buildings", 1, 0, 1, "1",
              "1: a building below the slope and a wall next to the slope, which the robot cannot reach; 0: none"},
};

/// Function of a position that returns a factor in [0, 1], by which the height of the relief is multiplied.
using Share = std::function<double(double x_m, double y_m)>;

void roughen(Ground& ground, const Values& values, std::uint64_t seed, const Share& share);

void cover(mjSpec* spec, engine::World& world, const Ground& ground, const Values& values, std::uint64_t seed,
           double rocks_from_x_m, double rocks_to_x_m);

}  // namespace tumble::sim::hillside
