// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/sensor_type.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {

/// Returns a motion that rises by 1 m/s, upside down.
inline Truth rising(double duration_s) {
  Truth truth;
  const auto steps = static_cast<std::size_t>(duration_s * 2000.0);
  for (std::size_t k = 0; k <= steps; ++k) {
    truth.p_WB_m.emplace_back(0.0, 0.0, static_cast<double>(k) / 2000.0);
    truth.q_WB.emplace_back(0.0, 1.0, 0.0, 0.0);
  }
  return truth;
}

/// Returns a sensor with its default numbers, except the given ones.
inline SensorSpec sensor(const std::string& kind, const std::map<std::string, double>& given) {
  SensorSpec out;
  out.name = "it";
  out.kind = kind;
  out.device = "made";
  out.values = resolve(kind, {}, find_sensor_type(kind).component.parameters);
  for (const auto& [name, value] : given) out.values.set(name, value);
  return out;
}

}  // namespace tumble::sim
