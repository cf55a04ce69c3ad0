// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/sweep_stamps.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/recording_clock.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

std::string ending_of(const std::string& format) {
  if (format == "ply" || format == "pcd" || format == "vtk") return "." + format;
  if (format == "kitti") return ".bin";
  throw BadInput(fmt::format("the sweep format '{}' is not supported; supported: ply, pcd, vtk and kitti", format));
}

path times_file(const SweepSource& source, const std::vector<path>& files) {
  if (!source.times.empty()) return source.times;
  for (const std::string& name : {stem_of(files.front()) + "_times.txt", std::string("times.txt")}) {
    if (std::filesystem::is_regular_file(source.folder / name)) return source.folder / name;
  }
  return {};
}

std::vector<std::int64_t> stamps_of(const SweepSource& source, const std::vector<path>& files,
                                    std::vector<std::string>& disorder) {
  const path file = times_file(source, files);
  if (file.empty()) return stamps_in_names(files);
  std::vector<std::int64_t> stamps = read_stamps(file, &disorder);
  if (stamps.size() != files.size()) {
    throw BadInput(
        fmt::format("{}: the file contains {} time stamps, but there are {} sweeps in {}; the numbers must be equal",
                    file.string(), stamps.size(), files.size(), source.folder.string()));
  }
  return stamps;
}

std::vector<std::int64_t> steady_stamps(std::size_t count, std::int64_t step_ns) {
  std::vector<std::int64_t> stamps;
  for (std::size_t k = 0; k < count; ++k) stamps.push_back(static_cast<std::int64_t>(k) * step_ns);
  return stamps;
}

}  // namespace

Imported import_sweeps(const SweepSource& source) {
  const std::vector<path> files = sweep_files(source.folder, ending_of(source.format), source.stem);
  std::vector<std::string> disorder;
  std::vector<std::int64_t> stamps = stamps_of(source, files, disorder);
  SweepReading reading = source.reading;
  Imported out;
  if (stamps.empty() && source.steady_ns > 0) {
    stamps = steady_stamps(files.size(), source.steady_ns);
    reading.assumed = true;
    out.notes.push_back("the sweeps have no time stamps; the import computes the times from the stated period");
  }
  const std::vector<bool> in_order = stamps_in_order(stamps);
  std::vector<std::int64_t> kept = stamps;
  keep_rows(in_order, kept);
  LeftOut left_out("clouds");
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    if (in_order[k]) continue;
    const bool decreases = k < disorder.size() && !disorder[k].empty();
    left_out.add(
        "a wrong time stamp",
        decreases ? disorder[k] : fmt::format("{}: the time stamp of the sweep is out of order", files[k].string()));
  }
  left_out.require_few(kept.size());
  const std::int64_t given_ns = reading.device.sweep_period_ns;
  SweepBuilder builder(std::move(reading), given_ns > 0 ? given_ns : median_step_ns(kept), std::move(left_out));
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (!stamps.empty() && !in_order[k]) continue;
    const std::optional<std::int64_t> stamp = stamps.empty() ? std::nullopt : std::optional(stamps[k]);
    std::optional<Cloud> cloud;
    builder.left_out().guard([&] { cloud = read_cloud(files[k], source.bin_columns); });
    if (cloud) builder.add(stamp, std::move(*cloud), files[k].string());
  }
  add_lidar(out, builder.finish(source.folder.string(), out.notes));
  out.info.attribution = fmt::format("imported from {}: {} sweeps in format {}", source.folder.filename().string(),
                                     files.size(), source.format);
  start_clock(out);
  return out;
}

}  // namespace tumble::scenarios
