// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/sensor_type.hpp"

namespace tumble::sim {

const SensorType& barometer_sensor();

/// Returns the pressure of isothermal air [Pa]: p0 exp(-g M h / (R T)), for the pressure p0 at the world's origin,
/// gravity g, temperature T and height h above the origin. Source: US Standard Atmosphere 1976, equation 33b, with M =
/// 0.0289644 kg/mol and R = 8.31432 J/(mol K).
double air_pressure_pa(double ground_pressure_pa, double temperature_k, double gravity_m_s2, double height_m);

}  // namespace tumble::sim
