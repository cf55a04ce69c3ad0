// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/recorded_draw.hpp"

#include <fmt/format.h>

#include <glob.h>

#include <algorithm>
#include <iterator>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '*' || c == '?' || c == '[' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::vector<std::filesystem::path> matches(const std::string& pattern, const std::filesystem::path& folder) {
  const bool absolute = std::filesystem::path(pattern).is_absolute();
  const std::string whole = absolute ? pattern : escaped((folder / "").string()) + pattern;
  glob_t found{};
  const int status = glob(whole.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<std::filesystem::path> paths;
  for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  globfree(&found);
  if (paths.empty()) {
    throw BadInput(fmt::format("no recording matches '{}' in the folder {}; set --data to the folder of the recordings",
                               pattern, folder.string()));
  }
  return paths;
}

std::string digest_of(const RecordingInfo& info, const sim::Sensors& sensors, const std::filesystem::path& path) {
  if (!info.digest.empty()) return info.digest;
  if (!info.has_truth) return digest(sensors, nullptr);
  const sim::Truth truth = read_truth(path);
  return digest(sensors, &truth);
}

}  // namespace

std::vector<RecordedDraw> find_recordings(std::span<const std::string> patterns, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& pattern : patterns) {
    const std::vector<std::filesystem::path> found = matches(pattern, folder);
    paths.insert(paths.end(), found.begin(), found.end());
  }
  std::sort(paths.begin(), paths.end(), [](const auto& a, const auto& b) {
    return std::pair(a.stem().string(), a.string()) < std::pair(b.stem().string(), b.string());
  });
  paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
  std::vector<RecordedDraw> recordings;
  for (const std::filesystem::path& path : paths) {
    if (!recordings.empty() && recordings.back().name == path.stem().string()) {
      throw BadInput(
          fmt::format("{}: another recording, {}, has the same name; results identify recordings only by name, so "
                      "rename one of them",
                      path.string(), recordings.back().path.string()));
    }
    const RecordingInfo info = read_info(path);
    const sim::Sensors sensors = read_sensors(path);
    recordings.push_back({path.stem().string(),
                          path,
                          {sensors.robot, !sensors.lidars.empty()},
                          digest_of(info, sensors, path),
                          !info.scenario.empty(),
                          info.has_truth});
  }
  return recordings;
}

std::vector<MethodPointer> applicable(std::span<const MethodPointer> methods, const RecordedDraw& recording) {
  std::vector<MethodPointer> chosen;
  std::copy_if(methods.begin(), methods.end(), std::back_inserter(chosen), [&](const MethodPointer& method) {
    return method->info.applies_to(recording.subject) &&
           (!method->info.needs_truth || (recording.simulated && recording.has_truth));
  });
  return chosen;
}

SimulatedDraw read_draw(const RecordedDraw& recording) {
  SimulatedDraw draw;
  draw.scenario = recording.name;
  draw.seed = kRecordingSeed;
  draw.recording.sensors = read_sensors(recording.path);
  draw.has_truth = recording.has_truth;
  if (draw.has_truth) draw.recording.truth = read_truth(recording.path);
  draw.recording_digest = digest(draw.recording.sensors, draw.has_truth ? &draw.recording.truth : nullptr);
  if (draw.recording_digest != recording.digest) {
    throw BadInput(fmt::format(
        "{}: the recording changed during the sweep: its digest is {}, but was {} at the start; start the sweep again",
        recording.path.string(), draw.recording_digest, recording.digest));
  }
  return draw;
}

}  // namespace tumble::scenarios
