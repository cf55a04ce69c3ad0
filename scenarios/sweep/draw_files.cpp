// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/draw_files.hpp"

#include <system_error>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

DrawFiles::DrawFiles(const Keeping& keeping) : keeping_(keeping) {
  if (keeping.when == Keeping::When::never) return;
  try {
    folder_.emplace(keeping.folder, keeping.folder.parent_path().parent_path());
  } catch (const std::exception& error) {
    trouble_ = one_line(error.what());
  }
}

std::filesystem::path DrawFiles::estimate(const MethodInfo& method) {
  if (!folder_) return {};
  std::filesystem::path place = estimate_folder(folder_->path(), method.kind, method.name);
  asked_.insert(place.filename());
  return place;
}

void DrawFiles::take_over(const sim::Sensors& sensors) const {
  const std::filesystem::path theirs = keeping_.folder / "estimates", own = folder_->path() / "estimates";
  if (!std::filesystem::exists(theirs)) return;
  const std::string made_from = digest(sensors, nullptr);
  for (const std::filesystem::directory_entry& each : std::filesystem::directory_iterator(theirs)) {
    const std::filesystem::path name = each.path().filename();
    if (asked_.contains(name) || estimated_sensors(each.path()) != made_from) continue;
    std::filesystem::create_directories(own);
    std::filesystem::rename(each.path(), own / name);
  }
}

void DrawFiles::finish(const SimulatedDraw& draw, bool failed) {
  if (!folder_) return;
  if (!failed && keeping_.when != Keeping::When::always) {
    trouble_.clear();
    return folder_.reset();
  }
  if (!trouble_.empty()) return folder_.reset();
  try {
    RecordingInfo info = keeping_.versions;
    info.scenario = draw.scenario;
    info.seed = draw.seed;
    info.situation_yaml = to_yaml(draw.built->situation());
    write_recording(folder_->path() / "recording.h5", info, draw.recording.sensors, &draw.recording.truth);
    replace_file(folder_->path() / kDrawCommand, keeping_.command + "\n");
    take_over(draw.recording.sensors);
    folder_->move_into_place();
  } catch (const std::exception& error) {
    trouble_ = one_line(error.what());
  }
  folder_.reset();
}

UnfinishedFolder::UnfinishedFolder(const std::filesystem::path& place, const std::filesystem::path& within)
    : place_(place),
      path_(within / kUnfinished / (place.parent_path().filename().string() + "-" + place.filename().string())) {
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
}

UnfinishedFolder::~UnfinishedFolder() {
  std::error_code ignored;
  if (!moved_) std::filesystem::remove_all(path_, ignored);
}

void UnfinishedFolder::move_into_place() {
  std::filesystem::create_directories(place_.parent_path());
  std::filesystem::remove_all(place_);
  std::filesystem::rename(path_, place_);
  moved_ = true;
}

}  // namespace tumble::scenarios
