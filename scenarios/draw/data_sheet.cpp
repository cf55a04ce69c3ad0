// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/data_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_folder.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

void require_every_number(const DataSheet& sheet, const std::string& file, const Registry& registry) {
  for (const sim::Parameter& parameter : find_type(registry.sensors, sheet.sensor_kind)->parameters) {
    const auto is_it = [&](const DataSheet::Entry& entry) { return entry.name == parameter.name; };
    if (std::none_of(sheet.entries.begin(), sheet.entries.end(), is_it)) {
      throw BadInput(
          fmt::format("{}: the number '{}' is missing; a data sheet of kind '{}' must state each of its numbers ({})",
                      file, parameter.name, sheet.sensor_kind, parameter.doc));
    }
  }
}

}  // namespace

std::vector<std::string> device_names(const DataRoot& data) {
  return yaml_stems(data.data_sheets());
}

DataSheet load_data_sheet(const DataRoot& data, const std::string& device) {
  const std::filesystem::path path = find_yaml(data.data_sheets(), "device", device);
  const Registry registry = Registry::of_simulation();
  DataSheet sheet = parse_data_sheet(read_text_file(path), path.string(), registry);
  if (sheet.device != device) {
    throw BadInput(fmt::format("{}: the key 'device' is '{}'; it must be the name of the file, '{}'", path.string(),
                               sheet.device, device));
  }
  require_every_number(sheet, path.string(), registry);
  return sheet;
}

}  // namespace tumble::scenarios
