// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/draw_files.hpp"

#include "scenarios/draw/scenario.hpp"
#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

DrawFiles::DrawFiles(const Keeping& keeping) : keeping_(keeping) {
  if (keeping.when == Keeping::When::never) return;
  try {
    folder_.emplace(keeping.folder, keeping.folder.parent_path().parent_path());
  } catch (const std::exception& error) {
    trouble_ = one_line(error.what());
  }
}

std::filesystem::path DrawFiles::estimate(const MethodInfo& method) const {
  return folder_ ? estimate_folder(folder_->path(), method.kind, method.name) : std::filesystem::path();
}

void DrawFiles::finish(const SimulatedDraw& draw, bool failed) {
  if (!folder_ || !(failed || keeping_.when == Keeping::When::always)) return folder_.reset();
  try {
    RecordingInfo info = keeping_.versions;
    info.scenario = draw.scenario;
    info.seed = draw.seed;
    info.situation_yaml = to_yaml(draw.built->situation());
    write_recording(folder_->path() / "recording.h5", info, draw.recording.sensors, &draw.recording.truth);
    replace_file(folder_->path() / kDrawCommand, keeping_.command + "\n");
    folder_->move_into_place();
  } catch (const std::exception& error) {
    trouble_ = one_line(error.what());
  }
  folder_.reset();
}

}  // namespace tumble::scenarios
