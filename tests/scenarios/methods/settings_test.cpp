// SPDX-License-Identifier: BSD-3-Clause
// The test checks every parameter of every method: its default is the stage's, each value within its bounds has an
// effect, and values beyond them or fractions of whole numbers are rejected.
#include "scenarios/methods/settings.hpp"

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

using Stages = std::vector<const SettingsTable*>;

sim::Values resolved(const Stages& stages, const std::string& name, double value) {
  sim::Values given;
  given.set(name, value);
  return resolve_settings("method", given, stages);
}

bool refuses(const Stages& stages, const std::string& name, double value) {
  try {
    (void)resolved(stages, name, value);
    return false;
  } catch (const sim::InvalidSituation&) {
    return true;
  }
}

bool is_whole(const Stages& stages, std::string_view name) {
  return std::any_of(stages.begin(), stages.end(), [&](const SettingsTable* stage) { return stage->is_whole(name); });
}

/// Returns a value within the bounds that is not the default.
double another(const sim::Parameter& p, bool whole) {
  const double d = p.default_value;
  for (const double value : whole ? std::vector{d + 1.0, d - 1.0}
                                  : std::vector{1.5 * d, 0.5 * d, d + 0.25, d - 0.25, 0.5 * (p.low + p.high)}) {
    if (value != d && value >= p.low && value <= p.high) return value;
  }
  return d;
}

/// Returns the numbers of the stages that differ from their defaults.
std::vector<double> changed(const Stages& stages, const sim::Values& values) {
  const sim::Values defaults = resolve_settings("method", {}, stages);
  std::vector<double> out;
  for (const SettingsTable* stage : stages) {
    const std::map<std::string, double> before = stage->numbers(defaults), after = stage->numbers(values);
    for (const auto& [name, value] : after) {
      if (value != before.at(name)) out.push_back(value);
    }
  }
  return out;
}

/// Returns what is wrong with the parameters of a method; the list is empty when nothing is wrong.
std::vector<std::string> complaints(const Stages& stages) {
  std::vector<std::string> out;
  std::set<std::string> names;
  std::size_t first = 0;
  for (const sim::Parameter& p : joined_rows(stages, first)) {
    const std::string name(p.name);
    if (!names.insert(name).second) out.push_back(name + " stands twice");
    if (p.doc.empty() || p.unit.empty()) out.push_back(name + " lacks unit or meaning");
    if (!(p.low <= p.default_value && p.default_value <= p.high)) out.push_back(name + ": default out of bounds");
    const bool whole = is_whole(stages, name);
    const double value = another(p, whole);
    if (value == p.default_value || changed(stages, resolved(stages, name, value)) != std::vector{value}) {
      out.push_back(name + " is not read");
    }
    if (refuses(stages, name, p.low) || refuses(stages, name, p.high)) out.push_back(name + ": bounds refused");
    if (!refuses(stages, name, 2.0 * std::abs(p.high) + 1.0)) out.push_back(name + ": accepted above its bound");
    if (!refuses(stages, name, -2.0 * std::abs(p.low) - 1.0)) out.push_back(name + ": accepted below its bound");
    if (!refuses(stages, name, std::nan(""))) out.push_back(name + ": NaN accepted");
    if (whole && !refuses(stages, name, p.low + 0.5)) out.push_back(name + ": half accepted");
  }
  return out;
}

TEST(Settings, EveryParameterOfEveryMethodIsReadAndBound) {
  std::size_t with_parameters = 0;
  for (const Method& method : methods()) {
    const Stages& stages = method.info.settings;
    EXPECT_TRUE(std::none_of(stages.begin(), stages.end(), [](const auto* stage) { return stage == nullptr; }));
    for (const std::string& complaint : complaints(stages)) {
      ADD_FAILURE() << to_string(method.info.kind) << "/" << method.info.name << ": " << complaint;
    }
    std::size_t first = 0;
    const std::vector<sim::Parameter> rows = joined_rows(stages, first);
    EXPECT_EQ(rows.size(), method.info.parameters.size()) << method.info.name;
    EXPECT_EQ(first, method.info.parameters_first) << method.info.name;
    with_parameters += rows.empty() ? 0 : 1;
  }
  EXPECT_GT(with_parameters, 25u);
}

TEST(Settings, AllOfTheLibraryIsReachable) {
  const auto count = [](const char* name) { return find_methods(name).at(0)->info.parameters.size(); };
  EXPECT_GT(count("rate/tumble"), 25u);
  EXPECT_GT(count("rate/tumble_lag"), 45u);
  EXPECT_GT(count("position/tumble"), 20u);
  EXPECT_GT(count("slam/tumble"), 70u);
}

struct Numbers {
  int count = 3;
  double share = 0.5, gravity_m_s2 = 9.8;
  Vector3d arm_m = {0.1, 0.2, 0.3};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.count, {"count", "1", 1, 8, "a number of things"});
    visit(p.share, {"share", "1", 0.0, 1.0, "a share", ParameterAudience::common_use});
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity"});
    visit(p.arm_m, {"arm_m", "m", -1.0, 1.0, "an arm"});
  }
};

std::vector<std::string> names_of(const SettingsTable& table) {
  std::vector<std::string> names;
  for (const sim::Parameter& row : table.rows()) names.emplace_back(row.name);
  return names;
}

TEST(Settings, NameTheirRowsAndShowFirstWhatAUserSetsFirst) {
  const Settings<Numbers> table(Numbers{});
  EXPECT_EQ(names_of(table),
            (std::vector<std::string>{"share", "count", "gravity_m_s2", "arm_x_m", "arm_y_m", "arm_z_m"}));
  EXPECT_EQ(table.first_rows(), 1u);
  EXPECT_EQ(table.rows()[4].default_value, 0.2);
  EXPECT_EQ(complaints({&table}), std::vector<std::string>{});
}

TEST(Settings, HalvesOfWhatIsWholeAreRefused) {
  const Settings<Numbers> table(Numbers{});
  EXPECT_TRUE(refuses({&table}, "count", 4.5));
  EXPECT_FALSE(refuses({&table}, "count", 4.0));
  EXPECT_EQ(table.read(resolved({&table}, "count", 4.0)).count, 4);
  EXPECT_FALSE(refuses({&table}, "share", 0.25));
}

TEST(Settings, WhatARecordingStatesGivesWayOnlyToWhatSomebodyGave) {
  const Settings<Numbers> table(Numbers{}, {.stated = {"gravity_m_s2"}});
  const Stages stages = {&table};
  Numbers stated;
  stated.gravity_m_s2 = 1.6;
  table.apply(resolve_settings("method", {}, stages), stated);
  EXPECT_EQ(stated.gravity_m_s2, 1.6);
  table.apply(resolved(stages, "gravity_m_s2", 9.8), stated);  // the default's value, explicitly given
  EXPECT_EQ(stated.gravity_m_s2, 9.8);
}

TEST(Settings, WhatFollowsFromOthersCannotBeSet) {
  const Settings<Numbers> table(Numbers{}, {.fixed = {"arm_*", "share"}});
  EXPECT_EQ(names_of(table), (std::vector<std::string>{"count", "gravity_m_s2"}));
  EXPECT_TRUE(refuses({&table}, "share", 0.5));
}

TEST(Settings, AStageBesideAnotherBearsItsPrefixWhereNamesMeet) {
  const Settings<Numbers> chain(Numbers{}, {.fixed = {"share", "arm_*"}});
  const Settings<Numbers> rates(Numbers{}, {.beside = chain.rows(), .prefix = "rate_"});
  const Stages stages = {&chain, &rates};
  EXPECT_EQ(complaints(stages), std::vector<std::string>{});
  const sim::Values values = resolved(stages, "rate_count", 5.0);
  EXPECT_EQ(chain.read(values).count, 3);
  EXPECT_EQ(rates.read(values).count, 5);
}

/// Returns whether the method called `name` has every parameter of `stage`, with the same name, bounds and default.
bool has_all_of(const std::string& name, const std::string& stage) {
  const MethodInfo &whole = find_methods(name).front()->info, &part = find_methods(stage).front()->info;
  return std::all_of(part.parameters.begin(), part.parameters.end(), [&](const sim::Parameter& p) {
    return std::any_of(whole.parameters.begin(), whole.parameters.end(), [&](const sim::Parameter& q) {
      return q.name == p.name && q.default_value == p.default_value && q.low == p.low && q.high == p.high;
    });
  });
}

TEST(Settings, AMapOfTheSphereHasTheNumbersOfThePositionMethodBeneath) {
  EXPECT_TRUE(has_all_of("slam/poses_rolling", "position/rolling"));
  EXPECT_TRUE(has_all_of("slam/poses_autogain_fusion", "position/autogain_fusion"));
  EXPECT_TRUE(has_all_of("slam/poses_tumble", "position/tumble"));
  EXPECT_TRUE(has_all_of("slam/rolling_prior", "position/tumble"));
  EXPECT_FALSE(has_all_of("slam/poses_rolling", "position/tumble")) << "negative control";
}

TEST(GivenParameters, ReachTheMethodThatTheyName) {
  const Settings<Numbers> table(Numbers{});
  Method method;
  method.info.name = "made_up";
  method.info.settings = {&table};
  sim::Values seen;
  method.run = [&seen](const sim::Sensors&, const sim::Values& given, const OracleInput&) {
    seen = given;
    return Estimate{};
  };
  const MethodPointer methods[] = {unowned(method)};
  const auto run = [&](const std::vector<std::string>& texts) {
    (void)with_parameters(methods, texts).front().run({}, {}, {});
    return seen;
  };
  EXPECT_TRUE(run({}).all().empty());
  EXPECT_EQ(run({"rate/made_up.count=5", "made_up.arm_x_m=-0.5"}).all(),
            (std::map<std::string, double>{{"arm_x_m", -0.5}, {"count", 5.0}}));
  for (const char* wrong : {"count=5", "rate/made_up.count", "rate/made_up.count=five", "rate/made_up.count=5x",
                            ".count=5", "rate/made_up.=5", "rate/made_up.counts=5", "rate/made_up.count=4.5",
                            "rate/made_up.count=9", "rate/other.count=5"}) {
    EXPECT_THROW(run({wrong}), BadInput) << wrong;
  }
  EXPECT_THROW(run({"made_up.count=5", "rate/made_up.count=6"}), BadInput);
}

/// Deaf is a method that ignores its parameters.
class Deaf : public SettingsTable {
 public:
  Deaf() : SettingsTable({}) { add("share", 0.5, {"share", "1", 0.0, 1.0, "a share"}, false); }
  std::map<std::string, double> numbers(const sim::Values&) const override { return {{"share", 0.5}}; }
};

// negative control: the test of the registry detects a parameter without effect, and two parameters of one name
TEST(Settings, FaultsAreSeen) {
  const Deaf deaf;
  EXPECT_EQ(complaints({&deaf}), std::vector<std::string>{"share is not read"});
  const Settings<Numbers> one(Numbers{}), other(Numbers{});
  const std::vector<std::string> found = complaints({&one, &other});
  EXPECT_NE(std::find(found.begin(), found.end(), "count stands twice"), found.end());
  Numbers wrong;
  wrong.share = 1.5;
  const Settings<Numbers> beyond(wrong);
  const std::vector<std::string> of_default = complaints({&beyond});
  EXPECT_NE(std::find(of_default.begin(), of_default.end(), "share: default out of bounds"), of_default.end());
}

}  // namespace
}  // namespace tumble::scenarios
