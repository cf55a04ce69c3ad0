// SPDX-License-Identifier: BSD-3-Clause
#include "sim/series/series_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <utility>

#include "sim/imu/time_stamps.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

namespace {

std::size_t steps_in_window(const SensorSpec& sensor, std::int64_t step_ns) {
  const double steps = 1e9 / (sensor.values.at("output_rate_hz") * static_cast<double>(step_ns));
  const double whole = std::round(steps);
  if (whole >= 1.0 && std::abs(steps - whole) <= 1e-9 * whole) return static_cast<std::size_t>(whole);
  std::ostringstream text;
  text << "sensors." << sensor.name << ".output_rate_hz is " << sensor.values.at("output_rate_hz")
       << " Hz; it must divide the physics rate of " << 1e9 / static_cast<double>(step_ns) << " Hz";
  throw InvalidSituation(text.str());
}

class Reader {
 public:
  Reader(const Measured& measured, std::uint64_t seed, const std::string& stream)
      : measured_(&measured), noise_(seed, stream + ".noise") {
    const double bias = measured.errors.bias;
    if (bias > 0.0) bias_ = bias * Stream(seed, stream + ".bias").normal();
  }

  void step(std::size_t k) { sum_ += measured_->exact(k); }
  double end_of_window(std::size_t steps) { return std::exchange(sum_, 0.0) / static_cast<double>(steps); }
  double reading(double exact) {
    const ReadingErrors& errors = measured_->errors;
    const double noise = errors.noise > 0.0 ? errors.noise * noise_.normal() : 0.0;
    const double read = exact + bias_ + noise;
    // The reading is quantised before the range limit is applied, so that no quantised reading is out of range.
    const double step = errors.quantum > 0.0 ? errors.quantum * std::round(read / errors.quantum) : read;
    return std::clamp(step, errors.low, errors.high);
  }

 private:
  const Measured* measured_;
  double bias_ = 0.0, sum_ = 0.0;
  Stream noise_;
};

}  // namespace

void simulate_series(const SensorContext& context, const std::vector<Measured>& quantities,
                     const std::vector<std::string>& constants, Recording& recording) {
  const SensorSpec& sensor = context.sensor;
  const std::int64_t step_ns = recording.truth.period_ns;
  const std::size_t steps = steps_in_window(sensor, step_ns);
  const std::int64_t period_ns = static_cast<std::int64_t>(steps) * step_ns;
  SeriesRecord record{sensor.name, sensor.kind, sensor.device, period_ns, context.given_T_BX, {}, {}, {}};
  SeriesTruth truth{sensor.name, context.T_BX, {}};
  for (const std::string& name : constants) record.constants.push_back({name, sensor.values.at(name)});
  std::vector<Reader> readers;
  for (const Measured& measured : quantities) {
    record.quantities.push_back({measured.name, measured.unit, measured.errors.noise, {}});
    truth.quantities.push_back({measured.name, measured.unit, {}});
    readers.emplace_back(measured, context.seed, sensor.name + "." + measured.name);
  }
  TimeStamps stamps(sensor.values, "sensors." + sensor.name, period_ns, Stream(context.seed, sensor.name + ".time"));
  for (std::size_t k = 1; k < recording.truth.q_WB.size(); ++k) {
    for (Reader& reader : readers) reader.step(k);
    if (k % steps != 0) continue;
    const std::optional<std::int64_t> time_ns = stamps.stamp(static_cast<std::int64_t>(k) * step_ns);
    if (time_ns) record.time_ns.push_back(*time_ns);
    for (std::size_t q = 0; q < readers.size(); ++q) {
      const double exact = readers[q].end_of_window(steps), reading = readers[q].reading(exact);
      if (!time_ns) continue;
      record.quantities[q].values.push_back(reading);
      truth.quantities[q].values.push_back(exact);
    }
  }
  recording.sensors.series.push_back(std::move(record));
  recording.truth.series.push_back(std::move(truth));
}

}  // namespace tumble::sim
