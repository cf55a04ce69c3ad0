// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export.hpp"

#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"
#include "scenarios/exchange/estimate_in_bag.hpp"
#include "scenarios/recordings/dialects/export_for.hpp"
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

/// Returns the requested format, or the one that corresponds to the output's extension.
std::string format_of(const ExportOptions& options) {
  const std::string told = options.format.empty() ? scenarios::format_of_ending(options.out) : options.format;
  if (told.empty())
    throw scenarios::BadInput(options.out.string() +
                              ": --format is needed for an output named so (.mcap, .bag and .tum tell theirs)");
  return told;
}

/// Reports what was written, and where.
int said(const Session& session, const ExportOptions& options, const std::string& what, const std::string& name) {
  Table table("", {"recording", what, "written to"});
  table.add_row({options.recording.string(), name, options.out.string()});
  session.print({table}, {{"recording", options.recording.string()}, {what, name}, {"output", options.out.string()}});
  return kDone;
}

int export_for_peer(const Session& session, const ExportOptions& options) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw scenarios::BadInput(std::string(option) + ": --for says what is written");
  };
  refuse(!options.format.empty(), "--format");
  refuse(!options.points.empty(), "--points");
  refuse(!options.frame.empty(), "--frame");
  refuse(!options.estimates.empty(), "--estimate");
  prepare_output(options.out, std::vector<std::filesystem::path>{options.recording});
  for (const std::string& note :
       scenarios::export_for(options.recording, options.peer, options.out, options.with_truth))
    session.note(note);
  session.note("manifest.json there says what lies in it; the peer is started by its 'run'");
  return said(session, options, "for", options.peer);
}

int export_as(const Session& session, const ExportOptions& options) {
  const std::string format = format_of(options);
  const bool bag = scenarios::is_bag_format(format);
  if (options.with_truth && !bag)
    throw scenarios::BadInput("--with-truth is for bags; tum and kitti hold nothing else");
  if (!options.estimates.empty() && !bag)
    throw scenarios::BadInput("--estimate is for bags (mcap, rosbag1, rosbag2, rosbag2_mcap)");
  if (!options.points.empty()) {
    if (!bag) throw scenarios::BadInput("--points is for bags (mcap, rosbag1, rosbag2, rosbag2_mcap)");
    require_known("kind of points", options.points, std::vector<std::string>{"livox", "pointcloud2"});
  }
  if (!options.frame.empty() && format != "tum" && format != "kitti")
    throw scenarios::BadInput("--frame is for trajectories (kitti, tum)");
  std::vector<std::filesystem::path> inputs = options.estimates;
  inputs.push_back(options.recording);
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
  verb.add("RECORDING", options->recording, "a recording, FILE.h5").required().check(a_recording);
  verb.add("--format", options->format, "one of:" + known + " [by the output's ending: .mcap, .bag, .tum]");
  std::string peers;
  for (const std::string& name : scenarios::peer_dialects()) peers += " " + name;
  verb.add("--for", options->peer,
           "a published estimator, one of:" + peers +
               "; a folder with the bag that it reads, its own configuration with this recording's sensors, and "
               "manifest.json");
  verb.add("--frame", options->frame,
           "tum, kitti: whose true poses, body (centre of mass), centre (of a sphere's shell) or a sensor's name; "
           "estimates of the rig are of imu [body]");
  verb.add("--points", options->points,
           "of a bag: pointcloud2, or livox for the CustomMsg of Livox' drivers [pointcloud2]");
  verb.add("-o,--output", options->out,
           "a file (kitti, tum: the true poses; mcap, rosbag1: the sensors) or a folder (csv, pcd, ply, rosbag2: "
           "the sensors; with --for)")
      .required();
  verb.add_flag("--with-truth", options->with_truth,
                "a bag also holds the true poses, under /truth and as the body's; with --for, as truth.tum beside it");
  verb.add("--estimate", options->estimates,
           "a bag also holds the poses of an estimate (a folder, or a TUM file of the IMU), and the returns of the "
           "lidar where it puts them; with the truth, laid onto it at the start, each with its error_m");
  return [&session, options] {
    return options->peer.empty() ? export_as(session, *options) : export_for_peer(session, *options);
  };
}

}  // namespace tumble::tools
