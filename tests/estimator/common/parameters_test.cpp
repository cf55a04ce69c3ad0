// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/parameters.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

struct Inner {
  double share = 0.5;
  int count = 3;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.share, {"share", "1", 0.0, 1.0, "a share"});
    visit(p.count, {"count", "1", 1, 4, "a number of things"});
  }
};

struct Outer {
  enum class Kind { first, second };
  double tau_s = 1.0;
  std::size_t least = 0;
  bool on = true;
  Kind kind = Kind::first;
  Eigen::Vector3d arm_m = Eigen::Vector3d::Zero();
  Inner left, right;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.tau_s, {"tau_s", "s", 1e-3, 10.0, "a time", ParameterAudience::common_use});
    visit(p.least, {"least", "1", 0, 1e9, "a number of things"});
    visit(p.on, boolean_parameter("on", "a switch"));
    visit(p.kind, {"kind", "1", 0, 1, "a choice"});
    visit(p.arm_m, {"arm_m", "m", -1.0, 1.0, "an arm"});
    visit.group("left_", p.left);
    visit.group("right_", p.right);
  }
};

/// Returns the message of require_valid_fields, or an empty text if it accepts.
std::string complaint(const Outer& params) {
  try {
    require_valid_fields(params);
  } catch (const InvalidParams& error) {
    return error.what();
  }
  return "";
}

TEST(Fields, AreWithinTheirBoundsBothIncluded) {
  Outer params;
  EXPECT_EQ(complaint(params), "");
  params.tau_s = 10.0;
  params.arm_m.setConstant(-1.0);
  params.right.share = 1.0;
  EXPECT_EQ(complaint(params), "");
}

TEST(Fields, OutOfBoundsAreNamedWithTheirGroup) {
  Outer params;
  params.right.share = 1.5;
  EXPECT_EQ(complaint(params), "right_share is 1.5; it must be within [0, 1]");
}

TEST(Fields, TheFirstOfSeveralIsReported) {
  Outer params;
  params.left.count = 0;
  params.right.share = 1.5;
  EXPECT_EQ(complaint(params), "left_count is 0; it must be within [1, 4]");
  params.tau_s = 0.0;
  EXPECT_EQ(complaint(params), "tau_s is 0; it must be within [0.001, 10]");
}

TEST(Fields, EachTypeIsLookedAt) {
  Outer params;
  params.arm_m.z() = 1.0 + 1e-12;
  EXPECT_NE(complaint(params), "");
  params = {};
  params.kind = static_cast<Outer::Kind>(2);
  EXPECT_EQ(complaint(params), "kind is 2; it must be within [0, 1]");
  params = {};
  params.least = 2'000'000'000;
  EXPECT_NE(complaint(params), "");
}

TEST(Fields, NaNIsOutOfAnyBounds) {
  Outer params;
  params.left.share = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(complaint(params).starts_with("left_share is nan")) << complaint(params);
  params = {};
  params.arm_m.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(complaint(params), "");
}

TEST(Fields, AreVisitedByTheirWholeNamesAndSetThroughThem) {
  Outer params;
  std::vector<std::string> names;
  for_each_parameter(params, [&](const std::string& name, auto& value, const ParameterInfo& field) {
    names.push_back(name);
    EXPECT_TRUE(name.ends_with(field.name));
    if constexpr (std::is_same_v<decltype(value), int&>) value = name == "left_count" ? 1 : 4;
  });
  const std::vector<std::string> all = {"tau_s",      "least",      "on",          "kind",       "arm_m",
                                        "left_share", "left_count", "right_share", "right_count"};
  EXPECT_EQ(names, all);
  EXPECT_EQ(params.left.count, 1);
  EXPECT_EQ(params.right.count, 4);
}

TEST(Fields, ANameIsAmongPatternsWholeOrByItsBeginning) {
  const std::vector<std::string> patterns = {"left_*", "tau_s"};
  EXPECT_TRUE(matches_any_pattern<std::string>("left_count", patterns));
  EXPECT_TRUE(matches_any_pattern<std::string>("tau_s", patterns));
  EXPECT_FALSE(matches_any_pattern<std::string>("tau_s_more", patterns));
  EXPECT_FALSE(matches_any_pattern<std::string>("right_left_count", patterns));
  EXPECT_FALSE(matches_any_pattern<std::string>("", patterns));
}

}  // namespace
}  // namespace tumble
