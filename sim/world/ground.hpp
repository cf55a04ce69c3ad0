// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>

#include "sim/random/stream.hpp"
#include "sim/world/geoms.hpp"

namespace tumble::sim {

inline constexpr std::array kGroundParameters = {
    Parameter{"friction", 0.6, 0.0, 2.0, "1", "sliding friction coefficient of the floor outside the patches"},
    Parameter{"spin_friction_m", 0.0005, 0.0, 0.1, "m",
              "friction moment about the contact normal divided by the normal force (MuJoCo's torsional friction)"},
    Parameter{"soft_time_s", 0.0, 0.0, 0.1, "s",
              "time constant of a contact with the ground (MuJoCo solref[0]); a longer time makes the ground softer: "
              "the sphere sinks 0.02 mm at 4 ms, 0.5 mm at 20 ms; 0: as hard as the robot"},
    Parameter{"soft_damping_ratio", 1.0, 0.05, 1.5, "1",
              "damping ratio of a contact with the ground (MuJoCo solref[1])"},
    Parameter{"roughness_m", 0.0, 0.0, 0.03, "m", "root mean square height of the ground's unevenness; 0: a plane"},
    Parameter{"roughness_shortest_m", 0.15, 0.1, 5.0, "m", "shortest wavelength of the unevenness"},
    Parameter{"roughness_longest_m", 1.0, 0.1, 10.0, "m",
              "longest wavelength of the unevenness; the height of a wave is proportional to its wavelength"},
};

/// Sets the friction of the ground. MuJoCo uses the larger friction coefficient of two touching geoms, and the
/// simulated sphere has the friction coefficient 0.
void set_ground_contact(mjsGeom* geom, const Values& values);

/// Adds an uneven floor. The unevenness only lowers the floor, so that no object starts inside the ground. Returns
/// false if the floor is a plane.
bool add_ground(mjSpec* spec, engine::World& world, const Values& values, double half_x_m, double half_y_m,
                const std::function<double(double, double)>& profile_m, const Colour& colour, Stream& stream);

}  // namespace tumble::sim
