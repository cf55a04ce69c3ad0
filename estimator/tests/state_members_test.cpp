// SPDX-License-Identifier: BSD-3-Clause
// A member that is not visited would not be saved. The tests check that every byte of a state is visited or is padding.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "../src/attitude/imu_merge_members.hpp"
#include "../src/common/state_bytes.hpp"
#include "../src/common/state_layout.hpp"
#include "../src/common/state_params.hpp"
#include "../src/mapping/mapping_members.hpp"
#include "../src/odometry/odometry_members.hpp"
#include "../src/rolling/rolling_members.hpp"
#include "rolled_sphere.hpp"

namespace tumble {
namespace {

template <class T>
concept TakesItselfApart = requires(const T& value, StateWriter& out) {
  value.save(out);
};

/// Records the addresses of an object's visited members. The elements of a vector or an optional have other addresses,
/// and are tested separately.
class Marks : public StateVisitor<Marks> {
 public:
  static constexpr bool kReads = false;
  static constexpr bool kDescribes = false;

  using StateVisitor::operator();
  template <class T>
  void operator()(const char* name, T& value) {
    using V = std::remove_const_t<T>;
    if constexpr (detail::is_sequence<V> || detail::is_optional<V> || TakesItselfApart<V>) {
      scratch(value);
    } else if constexpr (detail::is_array<V>) {
      for (auto& element : value) (*this)(name, element);
    } else {
      StateVisitor::operator()(name, value);
    }
  }
  template <class T>
  void operator()(const char* /*name*/, T& value, double /*low*/, double /*high*/) {
    scratch(value);
  }
  template <class T>
  requires std::is_enum_v<std::remove_const_t<T>>
  void operator()(const char* /*name*/, T& value, std::remove_const_t<T> /*last*/) { scratch(value); }
  template <class Array>
  void leading(const char* /*name*/, Array& array, std::size_t /*count*/) {
    scratch(array);
  }
  template <class T>
  void scratch(T& value) {
    mark(&value, sizeof value);
  }
  template <class N>
  void numbers(const char* /*name*/, const N* data, std::size_t count) {
    mark(data, count * sizeof(N));
  }
  std::size_t length(const char*, std::size_t) { return 0; }
  void bounded(const char*, double, double, double) {}
  static constexpr bool going() { return true; }

  /// Returns the length of the longest unvisited range of bytes in an object.
  std::size_t longest_hole(const void* object, std::size_t size) {
    const auto* const begin = static_cast<const std::byte*>(object);
    const std::byte* const end = begin + size;
    std::sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) { return std::less<>()(a.at, b.at); });
    const std::byte* until = begin;
    std::size_t longest = 0;
    for (const Piece& piece : pieces_) {
      if (std::less<>()(piece.at, begin) || !std::less<>()(piece.at, end))
        continue;  // a member of a copy, outside the object
      if (piece.at > until) longest = std::max(longest, static_cast<std::size_t>(piece.at - until));
      until = std::max(until, piece.at + piece.size);
    }
    return std::max(longest, static_cast<std::size_t>(end - until));
  }

 private:
  struct Piece {
    const std::byte* at;
    std::size_t size;
  };
  void mark(const void* at, std::size_t size) { pieces_.push_back({static_cast<const std::byte*>(at), size}); }
  std::vector<Piece> pieces_;
};

/// Padding is shorter than the alignment of the member after it. Eigen's types of fixed size have an alignment of at
/// most 32 bytes, and a member after such a type is at a multiple of 8.
template <class T>
constexpr std::size_t padding_below = alignof(T) > 8 ? 32 : 8;

template <class T>
void expect_whole(const T& object, const char* what) {
  Marks marks;
  marks("object", object);
  EXPECT_LT(marks.longest_hole(&object, sizeof object), padding_below<T>) << what;
}
template <class Params>
void expect_whole_params(const Params& params, const char* what) {
  Marks marks;
  visit_params(params, marks);
  EXPECT_LT(marks.longest_hole(&params, sizeof params), padding_below<Params>) << what;
}

TEST(StateMembers, AllOfATumblingOdometry) {
  TumblingOdometry::Params params;
  params.lever_arm_I_m.setZero();
  const TumblingOdometry odometry(params);
  Marks marks;
  TumblingOdometry::members(odometry, marks);
  EXPECT_LT(marks.longest_hole(&odometry, sizeof odometry), padding_below<TumblingOdometry>);
  RegimeStream::Params rate;
  rate.rate.model.nominal = {};
  expect_whole(OdometryPass(rate, TumblingOdometry::Params::Expert::mapping_defaults()), "pass");
  expect_whole(TumblingOdometry::Sweep{}, "done");
  expect_whole(RateStream::Knot{}, "rate.window");
  expect_whole(HandHeldStream::Reading{}, "carried.readings");
  expect_whole(HandHeldStream::Knot{}, "carried.window");
  expect_whole(HandHeldPipeline::State{}, "live");
  expect_whole(RateState{}, "smoothed");
  expect_whole(RateKnot{}, "left");
  expect_whole(RailPlane{}, "planes");
  expect_whole(RigCalibration{}, "calibration");
  expect_whole(AuxiliaryImu{}, "auxiliary_imus");
  expect_whole(ImuSample{}, "samples");
  expect_whole(LidarPoint{}, "points");
  expect_whole(WaitingSweep{}, "waiting");
  expect_whole(PositionFrame{}, "position_frame");
  expect_whole(FurtherLidars{}, "further_lidars");
  expect_whole(PositionReading{}, "positions");
  expect_whole(PositionAlignment::Pair{}, "pairs");
  expect_whole(PositionAlignment{}, "positions");
  expect_whole(PoseState{}, "trajectory");
}

TEST(StateMembers, AllOfAMapper) {
  using Impl = LidarInertialOdometry::Impl;
  const Impl impl{LidarInertialOdometry::Params{}};
  Marks marks;
  Impl::members(impl, marks);
  marks.scratch(impl.tracking);  // variants, whose types are tested below
  marks.scratch(impl.known);
  EXPECT_LT(marks.longest_hole(&impl, sizeof impl), padding_below<Impl>);
  expect_whole(mapping::Tracking{}, "tracking");
  expect_whole(mapping::Lost{}, "lost");
  expect_whole(mapping::Relocalised{}, "found again");
  expect_whole(mapping::KnownVelocity{}, "known");
  expect_whole(VelocityReading{}, "velocity");
  expect_whole(MotionReading{}, "motion");
  expect_whole(mapping::WindowSweep{}, "window");
  expect_whole(mapping::InsertedPoint{}, "inserted");
  expect_whole(MotionSample{}, "track");
  expect_whole(FlyingBody{}, "body");
}

TEST(StateMembers, AllOfARollingOdometry) {
  const RollingOdometry odometry(test::params_of(test::kPositions));
  expect_whole(ImuMerge::State{}, "merge");
  const auto state = std::make_unique<RollingSmoother::State>();
  expect_whole(*state, "rolling");
  expect_whole(RollingSmoother::NodeModes{}, "steps");
  expect_whole(RollingEstimate{}, "done");
}

TEST(StateMembers, AllOfTheParametersWithinAState) {
  expect_whole_params(RailPlaneFinder::Params{}, "rails");
  expect_whole_params(RailDetector::Params{}, "upright_rails");
  expect_whole_params(RateStream::Params{}, "rate");
  expect_whole_params(RegimeStream::Params{}, "regimes");
  expect_whole_params(HandHeldStream::Params{}, "carried");
  expect_whole_params(HandHeldPipeline::Params{}, "live");
  expect_whole_params(LidarInertialOdometry::Params{}, "mapping");
  expect_whole_params(TumblingOdometry::Params{}, "tumbling");
  expect_whole_params(ImuMerge::Params{}, "merge");
  expect_whole_params(RollingFilter::Params{}, "live");
  expect_whole_params(RollingSmoother::Params{}, "rolling");
}

struct Forgetful {
  double kept = 0.0, forgotten = 0.0;
  std::vector<int> list;
};
template <StateOf<Forgetful> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("kept", s.kept);
  visit("list", s.list);
}

TEST(StateMembers, OneThatIsForgottenIsFound) {  // negative control
  const Forgetful forgetful;
  Marks marks;
  marks("object", forgetful);
  EXPECT_EQ(marks.longest_hole(&forgetful, sizeof forgetful), sizeof(double));
}

TEST(StateLayout, TellsNamesWidthsAndOrder) {
  const auto digest = [](auto visit) {
    StateLayout layout;
    visit(layout);
    return layout.digest();
  };
  const double d = 0.0;
  const float f = 0.0f;
  const std::vector<int> none, three(3);
  const auto one = digest([&](auto& v) { v("a", d), v("b", f); });
  EXPECT_EQ(one, digest([&](auto& v) { v("a", d), v("b", f); }));
  EXPECT_NE(one, digest([&](auto& v) { v("b", f), v("a", d); }));
  EXPECT_NE(one, digest([&](auto& v) { v("a", f), v("b", f); }));
  EXPECT_NE(one, digest([&](auto& v) { v("a", d), v("c", f); }));
  EXPECT_EQ(digest([&](auto& v) { v("a", none); }), digest([&](auto& v) { v("a", three); })) << "not what is held";
}

}  // namespace
}  // namespace tumble
