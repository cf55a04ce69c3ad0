// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/tumble/arguments.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct Options {
  std::filesystem::path recording, out;
  std::string format;
};

int export_as(const Session& session, const Options& options) {
  if (options.out.has_parent_path()) make_folder(options.out.parent_path());
  scenarios::export_recording(options.recording, options.format, options.out);
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
  app.add_option("-o,--output", options->out,
                 "a file (kitti, tum: the true poses) or a folder (csv, pcd, ply: the sensors)")
      ->required();
  return [&session, options] { return export_as(session, *options); };
}

}  // namespace tumble::tools
