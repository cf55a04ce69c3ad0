// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/dialects/export_for.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/scoring/estimate_in_bag.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct ExportOptions {
  std::filesystem::path recording, out;
  std::string format, peer, points, frame;
  bool with_truth = false;
  std::vector<std::filesystem::path> estimates;
};

std::string format_of(const ExportOptions& options) {
  const std::string format_name = options.format.empty() ? scenarios::format_of_ending(options.out) : options.format;
  if (format_name.empty())
    throw scenarios::BadInput(fmt::format(
        "{}: --format is missing; only the extensions .mcap, .bag and .tum imply a format", options.out.string()));
  return format_name;
}

int said(const Session& session, const ExportOptions& options, const std::string& what, const std::string& name) {
  Table table("", {"recording", what, "written to"});
  table.add_row({options.recording.string(), name, options.out.string()});
  session.print({table}, {{"recording", options.recording.string()}, {what, name}, {"output", options.out.string()}});
  return kDone;
}

int export_for_peer(const Session& session, const ExportOptions& options) {
  const auto refuse = [](bool given, const char* option) {
    if (given)
      throw scenarios::BadInput(fmt::format(
          "{}: this option does not apply with --for, which sets format and content; give only one of the two options",
          option));
  };
  refuse(!options.format.empty(), "--format");
  refuse(!options.points.empty(), "--points");
  refuse(!options.frame.empty(), "--frame");
  refuse(!options.estimates.empty(), "--estimate");
  prepare_output(options.out, std::vector<std::filesystem::path>{options.recording});
  for (const std::string& note :
       scenarios::export_for(options.recording, options.peer, options.out, options.with_truth))
    session.note(note);
  session.note(
      "manifest.json in the output folder lists the files. The key 'run' of manifest.json contains the command that "
      "starts the estimator");
  return said(session, options, "for", options.peer);
}

int export_as(const Session& session, const ExportOptions& options) {
  const std::string format = format_of(options);
  const bool bag = scenarios::is_bag_format(format);
  if (options.with_truth && !bag)
    throw scenarios::BadInput(
        "--with-truth applies to bags only; tum and kitti files always contain the truth, and nothing else");
  if (!options.estimates.empty() && !bag)
    throw scenarios::BadInput("--estimate applies to bags only (mcap, rosbag1, rosbag2, rosbag2_mcap)");
  if (!options.points.empty()) {
    if (!bag) throw scenarios::BadInput("--points applies to bags only (mcap, rosbag1, rosbag2, rosbag2_mcap)");
    require_known("kind of points", options.points, std::vector<std::string>{"livox", "pointcloud2"});
  }
  if (!options.frame.empty() && format != "tum" && format != "kitti")
    throw scenarios::BadInput("--frame applies to trajectories only (kitti, tum)");
  std::vector<std::filesystem::path> inputs = options.estimates;
  inputs.push_back(options.recording);
  scenarios::require_not_an_input(options.out, inputs);
  scenarios::require_own_kind(format, options.out);
  prepare_output(options.out, inputs);
  scenarios::ExportChoices choices{options.with_truth};
  if (!options.frame.empty()) choices.frame = options.frame;
  if (options.points == "livox") choices.sweeps = scenarios::livox_sweep_layout();
  if (!options.estimates.empty()) {
    choices.more = [&](const sim::Sensors& sensors, scenarios::BagWriting& writing) {
      scenarios::add_estimates(options.estimates, sensors, writing);
    };
  }
  for (const std::string& note : scenarios::export_recording(options.recording, format, options.out, choices))
    session.note(note);
  return said(session, options, "format", format);
}

}  // namespace

Action declare_export(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<ExportOptions>();
  std::string known;
  for (const std::string& format : scenarios::export_formats()) known += " " + format;
  verb.add("RECORDING", options->recording, "reads this recording, FILE.h5").required().check(a_recording);
  verb.add(
      "--format", options->format,
      fmt::format(
          "sets the format of the output, one of:{} [default: from the extension .mcap, .bag or .tum of the output]",
          known));
  std::string peers;
  for (const std::string& name : scenarios::peer_dialects()) peers += " " + name;
  verb.add("--for", options->peer,
           fmt::format("writes a folder for a published estimator. The folder contains a bag, the estimator's "
                       "configuration for the sensors of this recording, and manifest.json. Choose one of:{}",
                       peers));
  verb.add("--frame", options->frame,
           "sets the frame of the true poses in tum and kitti files: body (centre of mass), centre (of a sphere's "
           "shell) or the name of a sensor. To compare with estimates of a rig, use imu [default: body]");
  verb.add("--points", options->points,
           "sets the message type of the points in a bag: pointcloud2, or livox for the CustomMsg of Livox' drivers "
           "[default: pointcloud2]");
  verb.add("-o,--output", options->out,
           "writes to this file or folder. kitti and tum write the true poses to a file; mcap and rosbag1 write the "
           "sensor data to a file. csv, pcd, ply, rosbag2 and --for write to a folder")
      .required();
  verb.add_flag(
      "--with-truth", options->with_truth,
      "adds the true poses of the body: topic /truth in a bag, or file truth.tum in the folder that --for writes");
  verb.add(
      "--estimate", options->estimates,
      "adds the poses and lidar points of an estimate (a folder, or a TUM file of the IMU) to a bag. If the recording "
      "has a truth, the estimate is aligned with the truth at the start, and each point has a field error_m");
  return [&session, options] {
    return options->peer.empty() ? export_as(session, *options) : export_for_peer(session, *options);
  };
}

}  // namespace tumble::tools
