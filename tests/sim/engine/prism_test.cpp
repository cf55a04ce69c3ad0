// SPDX-License-Identifier: BSD-3-Clause
// The test checks the closest points of an axis and a prism where they are known by hand: above the top, next to a
// face, at an edge, at a corner, across and along an edge.
#include "sim/engine/prism.hpp"

#include "tests/testing.hpp"

namespace tumble::sim::engine {
namespace {

// this prism has a right angle at the origin, legs of 1 m, and a level top at 0
const Prism kLevel{{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)}, -5.0};
// this prism is the same, and its top rises by 1 in 1 along x
const Prism kRising{{Vector3d(0, 0, 0), Vector3d(1, 0, 1), Vector3d(0, 1, 0)}, -5.0};

void expect_near(const Prism& prism, const Vector3d& a_m, const Vector3d& b_m, const Vector3d& axis_m,
                 const Vector3d& prism_m) {
  for (const bool swapped : {false, true}) {
    Closest closest;
    ASSERT_EQ(meet(swapped ? b_m : a_m, swapped ? a_m : b_m, prism, 0.5, closest), Meeting::near);
    EXPECT_NEAR((closest.axis_m - axis_m).norm(), 0.0, 1e-12);
    EXPECT_NEAR((closest.prism_m - prism_m).norm(), 0.0, 1e-12);
    EXPECT_NEAR(closest.distance_m, (axis_m - prism_m).norm(), 1e-12);
  }
}

TEST(Prism, AnEndAboveTheTop) {
  expect_near(kLevel, {0.2, 0.2, 0.3}, {0.3, 0.3, 2.0}, {0.2, 0.2, 0.3}, {0.2, 0.2, 0.0});
  const Vector3d up = Vector3d(-1, 0, 1).normalized(), foot_m(0.4, 0.3, 0.4);
  expect_near(kRising, foot_m + 0.2 * up, foot_m + 3.0 * up, foot_m + 0.2 * up, foot_m);
}

TEST(Prism, AnEndBesideAFace) {
  expect_near(kLevel, {0.4, -0.3, -1.0}, {0.4, -2.0, -1.0}, {0.4, -0.3, -1.0}, {0.4, 0.0, -1.0});
  expect_near(kRising, {1.0, 1.0, -0.5}, {0.8, 0.8, -0.5}, {0.8, 0.8, -0.5}, {0.5, 0.5, -0.5});
}

TEST(Prism, AcrossAnEdgeOfTheTopAndAnUprightOne) {
  expect_near(kLevel, {0.3, -0.5, 0.1}, {0.3, 0.1, 0.7}, {0.3, -0.3, 0.3}, {0.3, 0.0, 0.0});
  expect_near(kLevel, {-0.4, 0.2, -1.0}, {0.2, -0.4, -1.0}, {-0.1, -0.1, -1.0}, {0.0, 0.0, -1.0});
}

TEST(Prism, ACorner) {
  expect_near(kLevel, {-0.1, -0.2, 0.2}, {-1.0, -2.0, 2.0}, {-0.1, -0.2, 0.2}, {0.0, 0.0, 0.0});
}

TEST(Prism, OfAnAxisAlongTheTopTheDistanceIsReported) {
  Closest closest;
  ASSERT_EQ(meet({-0.5, 0.2, 0.3}, {2.0, 0.2, 0.3}, kLevel, 0.5, closest), Meeting::near);
  EXPECT_NEAR(closest.distance_m, 0.3, 1e-12);
}

TEST(Prism, OutOfReachAndWithin) {
  Closest closest;
  EXPECT_EQ(meet({0.2, 0.2, 0.51}, {0.3, 0.3, 2.0}, kLevel, 0.5, closest), Meeting::apart);
  EXPECT_EQ(meet({0.4, -0.51, -1.0}, {0.4, -2.0, -1.0}, kLevel, 0.5, closest), Meeting::apart);
  EXPECT_EQ(meet({0.2, 0.2, -0.1}, {0.3, 0.3, 2.0}, kLevel, 0.5, closest), Meeting::pierced);
  EXPECT_EQ(meet({-1.0, 0.3, -0.2}, {2.0, 0.3, -0.2}, kLevel, 0.5, closest), Meeting::pierced);  // through the prism
  EXPECT_EQ(meet({0.2, 0.2, 1e-6}, {0.3, 0.3, 2.0}, kLevel, 0.5, closest), Meeting::pierced);    // nearly touching
  EXPECT_EQ(meet({-0.6, 0.3, -0.2}, {-0.1, -0.7, -0.2}, kLevel, 0.1, closest), Meeting::apart);  // past the corner
}

}  // namespace
}  // namespace tumble::sim::engine
