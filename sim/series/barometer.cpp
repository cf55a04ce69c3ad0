// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "sim/series/series_sensors.hpp"
#include "sim/series/series_simulation.hpp"

namespace tumble::sim {

namespace {

constexpr double kMolarMass_kg_mol = 0.0289644, kGasConstant_j_mol_k = 8.31432;

constexpr auto kBarometerParameters = joined(
    kSeriesParameters,
    std::array{
        Parameter{"pressure_min_pa", 3e4, 0.0, 1e6, "Pa", "lower end of the output range"},
        Parameter{"pressure_max_pa", 1.25e5, 0.0, 1e6, "Pa", "upper end of the output range"},
        Parameter{"pressure_noise_pa", 0.0, 0.0, 1e4, "Pa", "standard deviation of each sample's white noise; 0: off"},
        Parameter{"pressure_bias_pa", 0.0, 0.0, 1e4, "Pa", "standard deviation of the constant error; 0: off"},
        Parameter{"pressure_quantum_pa", 0.0, 0.0, 1e4, "Pa", "resolution of the output; 0: off"},
        Parameter{"ground_pressure_pa", 101325.0, 1e3, 2e5, "Pa", "air pressure at the world's origin"},
        Parameter{"air_temperature_k", 288.15, 150.0, 400.0, "K", "air temperature, which is the same at every height"},
    });

void add_barometer(const SensorContext& context, Recording& recording) {
  const Values& values = context.sensor.values;
  const auto pressure_pa = [&truth = recording.truth, &context, ground_pa = values.at("ground_pressure_pa"),
                            temperature_k = values.at("air_temperature_k")](std::size_t k) {
    const double height_m = (truth.p_WB_m[k] + truth.q_WB[k] * context.T_BX.translation()).z();
    return air_pressure_pa(ground_pa, temperature_k, context.gravity_m_s2, height_m);
  };
  const ReadingErrors errors{values.at("pressure_noise_pa"), values.at("pressure_bias_pa"),
                             values.at("pressure_min_pa"), values.at("pressure_max_pa"),
                             values.at("pressure_quantum_pa")};
  simulate_series(context, {{"pressure_pa", "Pa", errors, pressure_pa}}, {"ground_pressure_pa", "air_temperature_k"},
                  recording);
}

void check_pressure_range(const Values& values, const std::string& place) {
  if (values.at("pressure_min_pa") < values.at("pressure_max_pa")) return;
  throw InvalidSituation(place + ".pressure_min_pa must be below pressure_max_pa");
}

}  // namespace

double air_pressure_pa(double ground_pressure_pa, double temperature_k, double gravity_m_s2, double height_m) {
  return ground_pressure_pa *
         std::exp(-gravity_m_s2 * kMolarMass_kg_mol * height_m / (kGasConstant_j_mol_k * temperature_k));
}

const SensorType& barometer_sensor() {
  static const SensorType kType{
      {"barometer", "barometer: measures the air pressure, which decreases with height", kBarometerParameters},
      add_barometer,
      check_pressure_range};
  return kType;
}

}  // namespace tumble::sim
