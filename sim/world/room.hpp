// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sim/random/stream.hpp"
#include "sim/world/geoms.hpp"

namespace tumble::sim {

inline constexpr std::array kRoomParameters = {
    Parameter{"room_half_m", 5.0, 2.5, 1000.0, "m", "half width of the square room"},
    Parameter{"wall_height_m", 2.5, 0.2, 10.0, "m", "height of the four walls"},
    Parameter{"ceiling", 0.0, 0.0, 1.0, "1",
              "1: the room has a ceiling, which is transparent in pictures; 0: no ceiling"},
    Parameter{"pillar_count", 6, 0, 100, "1", "number of vertical pillars, as features for the lidar"},
    Parameter{"box_count", 8, 0, 100, "1", "number of boxes on the floor, as features for the lidar"},
    Parameter{"shelf_count", 0, 0, 100, "1", "number of tall cupboards along the walls, as features for the lidar"},
    Parameter{"clear_radius_m", 2.4, 0.5, 20.0, "m", "minimum distance of pillars and boxes from the middle"},
};

void add_room(mjSpec* spec, engine::World& world, const Values& values, Stream& stream);

void add_ceiling(mjSpec* spec, engine::World& world, double half_x_m, double half_y_m, double height_m);

/// group of geoms that are visible to lidars, but not in pictures
inline constexpr int kUnseenInPictures = 3;

}  // namespace tumble::sim
