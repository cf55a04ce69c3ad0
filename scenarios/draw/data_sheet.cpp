// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/data_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scenarios/draw/registry.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/draw/yaml_text.hpp"
#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

void require_every_number(const DataSheet& sheet, const std::string& file, const Registry& registry) {
  for (const sim::Parameter& parameter : find_type(registry.sensors, sheet.sensor_kind)->parameters) {
    const auto is_it = [&](const DataSheet::Entry& entry) { return entry.name == parameter.name; };
    if (std::none_of(sheet.entries.begin(), sheet.entries.end(), is_it)) {
      throw BadInput(
          fmt::format("{}: the number '{}' is missing; a data sheet of kind '{}' must state this number ({})", file,
                      parameter.name, sheet.sensor_kind, parameter.doc));
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

namespace {

DataSheet::Entry parse_entry(const std::string& name, const YamlNode& node, const sim::Parameter& parameter) {
  static const std::array<std::string, 3> kKeys = {"value", "unit", "source"};
  const auto fields = node.fields(kKeys);
  DataSheet::Entry entry{name, fields.at("value").number(), fields.at("unit").text(), fields.at("source").text()};
  if (entry.unit != parameter.unit) {
    fields.at("unit").fail(fmt::format("the unit of this number is '{}'; it must be '{}'", entry.unit, parameter.unit));
  }
  if (!(entry.value >= parameter.low && entry.value <= parameter.high)) {
    fields.at("value").fail(fmt::format("the number is {:g} {}; it must be within [{:g}, {:g}]", entry.value,
                                        parameter.unit, parameter.low, parameter.high));
  }
  return entry;
}

}  // namespace

sim::Values DataSheet::values() const {
  sim::Values out;
  for (const Entry& entry : entries) out.set(entry.name, entry.value);
  return out;
}

DataSheet parse_data_sheet(const std::string& text, const std::string& file, const Registry& registry) {
  static const std::array<std::string, 4> kKeys = {"device", "title", "kind", "values"};
  const auto fields = YamlNode::parse(text, file).fields(kKeys);
  DataSheet sheet;
  sheet.device = fields.at("device").identifier();
  sheet.title = fields.at("title").text();
  sheet.sensor_kind = fields.at("kind").identifier();
  const sim::ComponentType* const type = find_type(registry.sensors, sheet.sensor_kind);
  if (type == nullptr) {
    fields.at("kind").fail("unknown '" + sheet.sensor_kind + "'" +
                           suggestion(sheet.sensor_kind, names_of(registry.sensors)));
  }
  for (const auto& [name, node] : fields.at("values").entries()) {
    const sim::Parameter* const parameter = find_parameter(type->parameters, name);
    if (parameter == nullptr) {
      node.fail(fmt::format("'{}' is not a parameter of a sensor of kind '{}'{}", name, type->name,
                            suggestion(name, names_of(type->parameters))));
    }
    sheet.entries.push_back(parse_entry(name, node, *parameter));
  }
  return sheet;
}

}  // namespace tumble::scenarios
