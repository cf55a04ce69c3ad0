// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/data_sheet.hpp"

#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_folder.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

std::vector<std::string> device_names(const DataRoot& data) {
  return yaml_stems(data.data_sheets());
}

DataSheet load_data_sheet(const DataRoot& data, const std::string& device) {
  const std::filesystem::path path = find_yaml(data.data_sheets(), "device", device);
  DataSheet sheet = parse_data_sheet(read_text_file(path), path.string(), Registry::of_simulation());
  if (sheet.device != device) {
    throw BadInput(path.string() + ": device is '" + sheet.device + "', must be the file's, '" + device + "'");
  }
  return sheet;
}

}  // namespace tumble::scenarios
