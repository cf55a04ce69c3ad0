// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/import.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "scenarios/errors.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/import_options.hpp"
#include "tools/tumble/importing.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;
using scenarios::Imported;

nlohmann::json document_of(const ImportOptions& options, const std::string& format, const Imported& imported) {
  nlohmann::json document = {{"recording", options.out.string()},
                             {"format", format},
                             {"digest", scenarios::read_info(options.out).digest},
                             {"has_reference", imported.reference.has_value()},
                             {"attribution", imported.info.attribution},
                             {"origin_ns", imported.info.origin_ns},
                             {"notes", imported.notes}};
  if (!imported.sensors.imus.empty()) {
    document["samples"] = imported.sensors.imus.front().time_ns.size();
    document["period_ns"] = imported.sensors.imus.front().period_ns;
  }
  if (!imported.sensors.lidars.empty()) {
    const sim::LidarRecord& lidar = imported.sensors.lidars.front();
    document["sweeps"] = lidar.sweep_start_ns.size();
    document["points"] = lidar.sweep_first.back();
    document["sweep_period_ns"] = lidar.sweep_period_ns;
    document["point_times"] = point_times_word(lidar.point_times);
  }
  return document;
}

Table table_of(const Imported& imported) {
  Table table("", {"what", "name", "readings", "period [ms]", "seconds", "remark"});
  const auto ms = [](std::int64_t ns) { return number_text(static_cast<double>(ns) * 1e-6); };
  const auto span = [](const std::vector<std::int64_t>& times) {
    return times.empty() ? "0" : number_text(static_cast<double>(times.back() - times.front()) * 1e-9);
  };
  for (const sim::ImuRecord& imu : imported.sensors.imus) {
    table.add_row({"imu", imu.name, std::to_string(imu.time_ns.size()), ms(imu.period_ns), span(imu.time_ns), ""});
  }
  for (const sim::LidarRecord& lidar : imported.sensors.lidars) {
    table.add_row({"lidar", lidar.name, std::to_string(lidar.sweep_start_ns.size()), ms(lidar.sweep_period_ns),
                   span(lidar.sweep_start_ns),
                   std::to_string(lidar.sweep_first.back()) + " points, times " + point_times_word(lidar.point_times)});
  }
  if (imported.reference) {
    const sim::Truth& truth = *imported.reference;
    const auto seconds = static_cast<double>(truth.p_WB_m.size() - 1) * static_cast<double>(truth.period_ns) * 1e-9;
    table.add_row(
        {"reference", "", std::to_string(truth.p_WB_m.size()), ms(truth.period_ns), number_text(seconds), ""});
  }
  return table;
}

int import_from(const Session& session, const ImportOptions& options) {
  const std::string format = format_of(options);
  require_fitting(options, format);
  prepare_file(options.out,
               std::vector<std::filesystem::path>{options.path, options.imu, options.times, options.reference},
               kRecordingEndings);
  scenarios::LidarRotationCheck rotation;
  Imported imported = import_recording(session, options, format, rotation);
  imported.sensors.robot = options.robot;
  imported.sensors.sphere_radius_m = options.radius_m;
  imported.info.tumble_version = program_version();
  try {
    scenarios::write_recording(options.out, imported.info, imported.sensors, imported.points,
                               imported.reference ? &*imported.reference : nullptr);
  } catch (const std::invalid_argument& error) {  // inconsistent content
    throw BadInput(options.path.string() + ": " + error.what());
  }
  for (const std::string& note : imported.notes) session.note(note);
  session.print({table_of(imported)}, document_of(options, format, imported));
  return kDone;
}

}  // namespace

Action declare_import(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<ImportOptions>();
  declare(verb, *options);
  return [&session, options] { return import_from(session, *options); };
}

}  // namespace tumble::tools
