// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/kept_recording.hpp"

#include "scenarios/draw/scenario.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/simulate.hpp"

namespace tumble::bench {

sim::Recording kept_recording(const scenarios::DataRoot& data, const std::filesystem::path& folder,
                              const std::string& name, const std::string& scenario, std::uint64_t seed,
                              const std::function<sim::Situation()>& situation) {
  const std::filesystem::path file = folder / (name + ".h5");
  if (!folder.empty() && std::filesystem::exists(file)) {
    return {scenarios::read_sensors(file), scenarios::read_truth(file)};
  }
  const sim::Situation drawn = situation();
  sim::Recording recording = sim::simulate(sim::BuiltSituation(sim::resolve(drawn), data.models()));
  if (folder.empty()) return recording;
  std::filesystem::create_directories(folder);
  scenarios::RecordingInfo info;
  info.scenario = scenario;
  info.seed = seed;
  info.situation_yaml = scenarios::to_yaml(drawn);
  scenarios::write_recording(file, info, recording.sensors, &recording.truth);
  return recording;
}

}  // namespace tumble::bench
