// SPDX-License-Identifier: BSD-3-Clause
// flight_senses SCENARIO FIRST LAST [HARM]: prints, per draw, how long the flights agree with the stated axis signs of
// the sensor, and with the most similar other signs (FlightSignCheck of a thrown body). This program is not a test; it
// takes 1 s per draw.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/simulate.hpp"
#include "tests/scenarios/methods/wrong_inputs.hpp"
#include "tests/tree.hpp"
#include "tumble/angular_velocity/detail/flight_sign_check.hpp"

namespace {

namespace scenarios = tumble::scenarios;
using tumble::FlightSignCheck;

void print_flights(const scenarios::SimulatedDraw& draw, const std::string& harm) {
  tumble::sim::Sensors sensors = draw.recording.sensors;
  scenarios::testing::wrong_inputs().at(harm)(sensors);
  std::vector<tumble::ImuSample> samples;
  if (!scenarios::bridge::primary_imu_samples(sensors, samples).ok()) return;
  FlightSignCheck::Params params;
  params.body = FlightSignCheck::Body::thrown;
  params.lever_arm_m = scenarios::bridge::lever_arm_I_m(sensors.imus.front());
  params.gyro_range_rad_s = sensors.imus.front().stated_gyro_range_rad_s;
  const FlightSignCheck sense(params);
  FlightSignCheck::State state;
  for (const tumble::ImuSample& sample : samples) sense.step(sample, state);
  const double other_s = *std::max_element(state.flight_duration_s.begin() + 1, state.flight_duration_s.end());
  std::printf("%-14s %6llu %-18s as it says %5.2f s, another %5.2f s  %s\n", draw.scenario.c_str(),
              static_cast<unsigned long long>(draw.seed), harm.c_str(), state.flight_duration_s.front(), other_s,
              sense.verdict(state).ok() ? "" : sense.verdict(state).field);
  std::fflush(stdout);
}

void run(const std::string& name, std::uint64_t first, std::uint64_t last, const std::string& harm) {
  const scenarios::DataRoot data{tumble::test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, name);
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    try {
      print_flights(scenarios::simulate_draw(data, scenario, seed, 1, scenarios::Lidars::left_out), harm);
    } catch (const tumble::sim::SimulationFailure&) {
      continue;
    }
  }
}

}  // namespace

int main(int count, char** words) {
  if (count < 4 || count > 5) {
    std::fprintf(stderr, "usage: flight_senses SCENARIO FIRST LAST [HARM]\n");
    return 2;
  }
  try {
    run(words[1], std::strtoull(words[2], nullptr, 10), std::strtoull(words[3], nullptr, 10),
        count == 5 ? words[4] : "none");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
