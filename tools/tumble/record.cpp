// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "sim/simulate.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/recording_info.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct RecordOptions {
  std::string scenario, seed;
  int threads = 1;
  std::filesystem::path file;
};

Table contents(const sim::Sensors& sensors) {
  Table table("", {"sensor", "device", "samples", "points"});
  table.align_right_from(2);
  for (const sim::ImuRecord& imu : sensors.imus)
    table.add_row({imu.name, imu.device, std::to_string(imu.time_ns.size())});
  for (const sim::LidarRecord& lidar : sensors.lidars) {
    table.add_row(
        {lidar.name, lidar.device, std::to_string(lidar.sweep_start_ns.size()), std::to_string(lidar.range_m.size())});
  }
  for (const sim::SeriesRecord& series : sensors.series)
    table.add_row({series.name, series.device, std::to_string(series.time_ns.size())});
  return table;
}

int record(const Session& session, const RecordOptions& options) {
  const scenarios::DataRoot data = session.data();
  const scenarios::Scenario scenario = scenarios::load_scenario(data, options.scenario);
  const std::uint64_t seed = seed_of(scenario, options.seed);
  const sim::ResolvedSituation situation = scenarios::draw(data, scenario, seed);
  prepare_file(options.file, std::vector<std::filesystem::path>{options.scenario}, kRecordingEndings);

  const sim::Recording recording = sim::simulate(sim::BuiltSituation(situation, data.models()), options.threads);
  const scenarios::RecordingInfo info =
      recording_info(situation, scenarios::digest(recording.sensors, &recording.truth));
  scenarios::write_recording(options.file, info, recording.sensors, &recording.truth);

  session.print(
      {contents(recording.sensors)},
      {{"scenario", info.scenario}, {"seed", seed}, {"digest", info.digest}, {"recording", options.file.string()}});
  session.note("digest " + info.digest);
  if (const std::string moving = end_in_motion(recording.truth); !moving.empty()) session.note(moving);
  return kDone;
}

}  // namespace

Action declare_record(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<RecordOptions>();
  verb.add("SCENARIO", options->scenario, "simulates this scenario of the catalogue, or this scenario file")
      .required()
      .check(a_scenario(session));
  verb.add("--seed", options->seed,
           "sets the seed of the simulated run [default: for a named case, the seed of the case]");
  verb.add("--threads", options->threads,
           "uses this number of threads to simulate the lidar; the result is the same for any number")
      .whole(1, 1024)
      .shows_default();
  verb.add("-o,--output", options->file, "writes this recording, FILE.h5").required();
  return [&session, options] { return record(session, *options); };
}

}  // namespace tumble::tools
