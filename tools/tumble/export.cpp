// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/errors.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct Options {
  std::filesystem::path recording, out;
  std::string format;
  bool with_truth = false;
};

int export_as(const Session& session, const Options& options) {
  if (options.with_truth && !options.format.starts_with("rosbag"))
    throw scenarios::BadInput("--with-truth is for bags; tum and kitti hold nothing else");
  prepare_output(options.out, std::vector<std::filesystem::path>{options.recording});
  scenarios::export_recording(options.recording, options.format, options.out, options.with_truth);
  Table table("", {"recording", "format", "written to"});
  table.add_row({options.recording.string(), options.format, options.out.string()});
  session.print(
      {table},
      {{"recording", options.recording.string()}, {"format", options.format}, {"output", options.out.string()}});
  return kDone;
}

}  // namespace

Action declare_export(CLI::App& app, const Session& session) {
  auto options = std::make_shared<Options>();
  std::string known;
  for (const std::string& format : scenarios::export_formats()) known += " " + format;
  app.add_option("RECORDING", options->recording, "a recording, FILE.h5")->required();
  app.add_option("--format", options->format, "one of:" + known)->required();
  app.add_option(
         "-o,--output", options->out,
         "a file (kitti, tum: the true poses; rosbag1: the sensors) or a folder (csv, pcd, ply, rosbag2: the sensors)")
      ->required();
  app.add_flag("--with-truth", options->with_truth, "a bag also holds the true poses, under /truth");
  return [&session, options] { return export_as(session, *options); };
}

}  // namespace tumble::tools
