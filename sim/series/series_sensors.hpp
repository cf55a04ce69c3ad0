// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/sensor_type.hpp"

namespace tumble::sim {

const SensorType& barometer_sensor();

/// Returns the pressure of isothermal air at height h above the world's origin [Pa]: p0 exp(-g M h / (R T)). Source: US
/// Standard Atmosphere 1976, equation 33b, with M = 0.0289644 kg/mol and R = 8.31432 J/(mol K).
double air_pressure_pa(double ground_pressure_pa, double temperature_k, double gravity_m_s2, double height_m);

}  // namespace tumble::sim
