// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "sim/situation.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/verbs.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;

struct Listing {
  std::vector<Table> tables;
  json document = json::array();
};

json parameter_json(const sim::Parameter& p) {
  return {{"name", p.name}, {"unit", p.unit}, {"default", p.default_value},
          {"low", p.low},   {"high", p.high}, {"doc", p.doc}};
}

std::string bounds_of_parameter(const sim::Parameter& p) {
  if (p.low == -kUnbounded && p.high == kUnbounded) return "any";
  return "[" + number_text(p.low) + ", " + number_text(p.high) + "]";
}

std::string distribution_text(const scenarios::Distribution& d) {
  using Shape = scenarios::Distribution::Shape;
  const auto number = [&](std::size_t i) {
    return i < d.numbers.size() ? number_text(d.numbers[i]) : std::string("?");
  };
  const std::string bounds = d.numbers.size() > 3 ? " within [" + number(2) + ", " + number(3) + "]" : "";
  switch (d.shape) {
    case Shape::constant:
      return number(0);
    case Shape::uniform:
      return "uniform " + number(0) + " .. " + number(1);
    case Shape::log_uniform:
      return "log-uniform " + number(0) + " .. " + number(1);
    case Shape::normal:
      return "normal " + number(0) + " +- " + number(1) + bounds;
    case Shape::choice:
      break;
  }
  std::string text = "one of";
  for (std::size_t i = 0; i < d.numbers.size(); ++i) text += (i ? ", " : " ") + number(i);
  return text;
}

std::span<const sim::Parameter> parameters_of(std::span<const sim::ComponentType> registry, const std::string& type) {
  for (const sim::ComponentType& entry : registry) {
    if (entry.name == type) return entry.parameters;
  }
  return {};
}

void add_part(Table& table, json& rows, const std::string& place, std::span<const sim::Parameter> known,
              const std::map<std::string, scenarios::Distribution>& given) {
  for (const sim::Parameter& p : known) {
    const auto found = given.find(std::string(p.name));
    const std::string value = found == given.end() ? "" : distribution_text(found->second);
    table.add_row({place + "." + std::string(p.name), value, number_text(p.default_value), bounds_of_parameter(p),
                   std::string(p.unit), std::string(p.doc)});
    json row = parameter_json(p);
    row["place"] = place;
    row["value"] = value.empty() ? json(p.default_value) : json(value);
    rows.push_back(std::move(row));
  }
}

void add_scenario_numbers(const scenarios::Scenario& s, Listing& out, json& entry) {
  Table table(s.name + ": parameters (numbers)", {"number", "in this scenario", "default", "bound", "unit", "meaning"});
  json rows = json::array();
  add_part(table, rows, "world", parameters_of(sim::world_types(), s.world.type), s.world.numbers);
  add_part(table, rows, "robot", parameters_of(sim::robot_types(), s.robot.type), s.robot.numbers);
  add_part(table, rows, "motion", parameters_of(sim::motion_types(), s.motion.type), s.motion.numbers);
  for (const auto& sensor : s.sensors) {
    add_part(table, rows, sensor.name, parameters_of(sim::sensor_types(), sensor.kind), sensor.numbers);
  }
  out.tables.push_back(std::move(table));
  entry["numbers"] = std::move(rows);
}

void add_cases(const scenarios::DataRoot& data, Listing& out) {
  Table table("named cases", {"case", "of", "seed", "duration_s", "expected", "meaning"});
  for (const std::string& name : scenarios::case_names(data)) {
    const scenarios::Scenario s = scenarios::load_scenario(data, name);
    std::string expected;
    json expectations = json::array();
    for (const scenarios::Expectation& each : s.named_case->expected) {
      const std::string run = each.fails ? "fails" : "holds";
      expected += (expected.empty() ? "" : ", ") + each.method + " " + run;
      expectations.push_back({{"method", each.method}, {"run", run}});
    }
    table.add_row({name, s.named_case->scenario, std::to_string(s.named_case->seed), distribution_text(s.duration_s),
                   expected, s.doc});
    out.document.push_back({{"name", name},
                            {"doc", s.doc},
                            {"case_of", s.named_case->scenario},
                            {"seed", s.named_case->seed},
                            {"robot", s.robot.type},
                            {"world", s.world.type},
                            {"motion", s.motion.type},
                            {"duration_s", distribution_text(s.duration_s)},
                            {"expect", std::move(expectations)}});
  }
  if (!table.empty()) out.tables.push_back(std::move(table));
}

Listing list_scenarios(const scenarios::DataRoot& data, const std::string& only) {
  Listing out;
  std::vector<std::string> names = scenarios::scenario_names(data);
  const std::vector<std::string> cases = scenarios::case_names(data);
  if (!only.empty()) {  // as for a scenario
    names.insert(names.end(), cases.begin(), cases.end());
    require_known("scenario", only, names);
  }
  Table table("", {"scenario", "robot", "world", "motion", "sensors", "meaning"});
  json entries = json::array();
  for (const std::string& name : names) {
    if (!only.empty() && name != only) continue;
    const scenarios::Scenario s = scenarios::load_scenario(data, name);
    std::string sensors;
    for (const auto& sensor : s.sensors) sensors += (sensors.empty() ? "" : " ") + sensor.device;
    table.add_row({name, s.robot.type, s.world.type, s.motion.type, sensors, s.doc});
    json entry = {{"name", name},
                  {"doc", s.doc},
                  {"robot", s.robot.type},
                  {"world", s.world.type},
                  {"motion", s.motion.type},
                  {"duration_s", distribution_text(s.duration_s)}};
    for (const auto& sensor : s.sensors) {
      entry["sensors"].push_back({{"name", sensor.name}, {"kind", sensor.kind}, {"device", sensor.device}});
    }
    if (!only.empty()) {
      add_scenario_numbers(s, out, entry);
    }
    out.document.push_back(std::move(entry));
  }
  out.tables.insert(out.tables.begin(), std::move(table));
  if (only.empty()) add_cases(data, out);
  return out;
}

Listing list_methods(const std::string& only) {
  Listing out;
  const std::vector<scenarios::MethodPointer> selected =
      select_methods(only.empty() ? std::vector<std::string>{} : std::vector<std::string>{only});
  Table table("", {"method", "robots", "needs truth", "source", "meaning"});
  const std::vector<std::string> columns = {"method", "parameter", "default", "bound", "unit", "meaning"};
  Table parameters("parameters", columns), further("further parameters", columns);
  for (const scenarios::MethodPointer& method : selected) {
    const scenarios::MethodInfo& info = method->info;
    const std::string name = full_name(info);
    std::string robots;
    for (const std::string& robot : info.robots) robots += (robots.empty() ? "" : " ") + robot;
    table.add_row({name, robots.empty() ? "all" : robots, info.needs_truth ? "yes" : "no", info.source, info.doc});
    json entry = {{"name", info.name},          {"kind", to_string(info.kind)},    {"doc", info.doc},
                  {"source", info.source},      {"needs_truth", info.needs_truth}, {"robots", info.robots},
                  {"parameters", json::array()}};
    for (std::size_t k = 0; k < info.parameters.size(); ++k) {
      const sim::Parameter& p = info.parameters[k];
      const bool first = k < info.parameters_first;
      (first ? parameters : further)
          .add_row({name, std::string(p.name), number_text(p.default_value), bounds_of_parameter(p),
                    std::string(p.unit), std::string(p.doc)});
      entry["parameters"].push_back(parameter_json(p));
      entry["parameters"].back()["first"] = first;
    }
    out.document.push_back(std::move(entry));
  }
  out.tables.push_back(std::move(table));
  if (!parameters.empty()) out.tables.push_back(std::move(parameters));
  if (!only.empty() && !further.empty()) out.tables.push_back(std::move(further));
  return out;
}

void add_sensor_kinds(const std::string& only, Listing& out) {
  Table kinds("kinds", {"kind", "meaning"});
  for (const sim::ComponentType& kind : sim::sensor_types()) {
    const std::string name(kind.name);
    if (only.empty()) kinds.add_row({name, std::string(kind.doc)});
    if (only != name) continue;
    Table numbers(name + ": " + std::string(kind.doc), {"number", "default", "bound", "unit", "meaning"});
    json entry = {{"kind", name}, {"doc", kind.doc}, {"numbers", json::array()}};
    for (const sim::Parameter& p : kind.parameters) {
      numbers.add_row({std::string(p.name), number_text(p.default_value), bounds_of_parameter(p), std::string(p.unit),
                       std::string(p.doc)});
      entry["numbers"].push_back(parameter_json(p));
    }
    out.tables.push_back(std::move(numbers));
    out.document.push_back(std::move(entry));
  }
  if (only.empty()) out.tables.push_back(std::move(kinds));
}

Listing list_sensors(const scenarios::DataRoot& data, const std::string& only) {
  Listing out;
  const std::vector<std::string> names = scenarios::device_names(data);
  std::vector<std::string> known_names = names;
  for (const sim::ComponentType& kind : sim::sensor_types()) known_names.emplace_back(kind.name);
  if (!only.empty()) require_known("sensor", only, known_names);
  if (std::find(names.begin(), names.end(), only) == names.end() && !only.empty()) {
    add_sensor_kinds(only, out);
    return out;
  }
  Table table("", {"device", "kind", "title"});
  std::vector<Table> sheets;
  for (const std::string& name : names) {
    if (!only.empty() && name != only) continue;
    const scenarios::DataSheet sheet = scenarios::load_data_sheet(data, name);
    table.add_row({name, sheet.sensor_kind, sheet.title});
    const auto known = parameters_of(sim::sensor_types(), sheet.sensor_kind);
    Table numbers(name + ": data sheet", {"number", "value", "unit", "bound", "source"});
    json entry = {{"device", name}, {"kind", sheet.sensor_kind}, {"title", sheet.title}, {"numbers", json::array()}};
    for (const auto& number : sheet.entries) {
      const auto p = std::find_if(known.begin(), known.end(),
                                  [&](const sim::Parameter& each) { return each.name == number.name; });
      numbers.add_row({number.name, number_text(number.value), number.unit,
                       p == known.end() ? "" : bounds_of_parameter(*p), number.source});
      json row = {{"name", number.name}, {"value", number.value}, {"unit", number.unit}, {"source", number.source}};
      if (p != known.end())
        row.update({{"default", p->default_value}, {"low", p->low}, {"high", p->high}, {"doc", p->doc}});
      entry["numbers"].push_back(std::move(row));
    }
    sheets.push_back(std::move(numbers));
    out.document.push_back(std::move(entry));
  }
  out.tables.push_back(std::move(table));
  if (only.empty()) add_sensor_kinds("", out);
  if (!only.empty()) std::ranges::move(sheets, std::back_inserter(out.tables));
  return out;
}

Listing list_suites(const scenarios::DataRoot& data, const std::string& only) {
  Listing out;
  const std::vector<std::string> names = scenarios::suite_names(data);
  if (!only.empty()) require_known("suite", only, names);
  Table table("", {"suite", "scenarios", "seeds", "methods", "varies", "time limit per method", "meaning"});
  const std::size_t all = scenarios::methods().size();
  const auto joined = [](const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
  };
  for (const std::string& name : names) {
    if (!only.empty() && name != only) continue;
    const scenarios::Suite suite = scenarios::load_suite(data, name);
    std::vector<std::string> varied;
    json curves = json::array();
    for (const scenarios::Variation& curve : suite.curves) {
      varied.push_back(curve.key());
      curves.push_back({{"keys", curve.keys}, {"values", curve.values}});
    }
    table.add_row(
        {name, joined(suite.recordings.empty() ? suite.scenarios : suite.recordings),
         suite.classes.empty() ? std::to_string(suite.first_seed) + ".." + std::to_string(suite.last_seed)
                               : std::to_string(suite.draw_count()) + " named",
         suite.methods.size() == all ? "all" : std::to_string(suite.methods.size()) + " of " + std::to_string(all),
         joined(varied), number_text(suite.timeout_s) + " s", suite.doc});
    out.document.push_back({{"name", name},
                            {"doc", suite.doc},
                            {"scenarios", suite.scenarios},
                            {"recordings", suite.recordings},
                            {"first_seed", suite.first_seed},
                            {"last_seed", suite.last_seed},
                            {"methods", suite.methods},
                            {"vary", std::move(curves)},
                            {"timeout_s", suite.timeout_s}});
  }
  out.tables.push_back(std::move(table));
  return out;
}

const char* place_text(scenarios::Place place) {
  switch (place) {
    case scenarios::Place::headline:
      return "headline, gate";
    case scenarios::Place::held:
      return "gate";
    case scenarios::Place::detail:
      break;
  }
  return "";
}

Listing list_metrics(const std::string& only) {
  Listing out;
  Table table("", {"metric", "kind", "unit", "sense", "headline or gate", "meaning"});
  std::vector<std::string> names;
  for (const scenarios::Metric& metric : scenarios::metrics()) names.push_back(metric.info.name);
  if (!only.empty()) require_known("metric", only, names);
  for (const scenarios::Metric& metric : scenarios::metrics()) {
    const scenarios::MetricInfo& info = metric.info;
    if (!only.empty() && info.name != only) continue;
    const std::string unit = symbol(info.unit);
    table.add_row({info.name, to_string(metric.kind), unit, sense_text(info), place_text(info.place), info.doc});
    out.document.push_back({{"name", info.name},
                            {"kind", to_string(metric.kind)},
                            {"unit", unit},
                            {"sense", sense_text(info)},
                            {"headline", info.place == scenarios::Place::headline},
                            {"gate", info.place != scenarios::Place::detail},
                            {"doc", info.doc}});
  }
  out.tables.push_back(std::move(table));
  return out;
}

Listing listing(const Session& session, const std::string& what, const std::string& only) {
  const std::vector<std::string> known = {"scenarios", "methods", "metrics", "sensors", "suites"};
  require_known("list", what, known);
  if (what == "scenarios") return list_scenarios(session.data(), only);
  if (what == "methods") return list_methods(only);
  if (what == "metrics") return list_metrics(only);
  if (what == "sensors") return list_sensors(session.data(), only);
  return list_suites(session.data(), only);
}

}  // namespace

Action declare_list(VerbOptions& verb, const Session& session) {
  auto what = std::make_shared<std::string>();
  auto only = std::make_shared<std::string>();
  verb.add("WHAT", *what, "lists scenarios, methods, metrics, sensors or suites").required();
  verb.add("NAME", *only, "lists all parameters of the entry with this name");
  return [&session, what, only] {
    Listing out = listing(session, *what, *only);
    for (Table& table : out.tables) table.wrap_last();
    session.print(out.tables, out.document);
    return static_cast<int>(kDone);
  };
}

}  // namespace tumble::tools
