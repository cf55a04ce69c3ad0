// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/terrain/rocks.hpp"
#include "sim/world/terrain/trunks.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

Ground sloping_ground() {
  Ground ground(101, 10.0);
  ground.transform([](double x, double, double) { return -0.5 * x; });
  return ground;
}

RockField rock_field(int count) {
  RockField field;
  field.count = count;
  field.largest_m = 0.4;
  field.area = {-8.0, 8.0, -3.0, 3.0};
  field.clear = {{-6.0, 0.0}, 1.2};
  return field;
}

TEST(Rocks, KeepOffTheStartAndWithinTheirArea) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Stream stream(seed, "terrain.rocks");
    const std::vector<Rock> rocks = strew_rocks(stream, rock_field(100), sloping_ground());
    ASSERT_EQ(rocks.size(), 100u);
    for (const Rock& rock : rocks) {
      const double edge_m =
          (rock.centre_W_m.head<2>() - Eigen::Vector2d(-6.0, 0.0)).norm() - rock.half_axes_m.head<2>().maxCoeff();
      ASSERT_GE(edge_m, 1.2 - 1e-12);
      ASSERT_LE(std::abs(rock.centre_W_m.y()), 3.0);
      ASSERT_LE(std::abs(rock.centre_W_m.x()), 8.0);
    }
  }
}

TEST(Rocks, LieInTheGroundAndDoNotFloat) {
  Stream stream(1, "terrain.rocks");
  for (const Rock& rock : strew_rocks(stream, rock_field(100), sloping_ground())) {
    const double ground_m = -0.5 * rock.centre_W_m.x();
    EXPECT_LT(rock.centre_W_m.z() - rock.half_axes_m.z(), ground_m - 0.7 * rock.half_axes_m.z());
    EXPECT_GT(rock.centre_W_m.z() + rock.half_axes_m.z(), ground_m);
    EXPECT_LE(rock.half_axes_m.maxCoeff(), 0.4);
    EXPECT_GE(rock.half_axes_m.minCoeff(), 0.4 * 0.3 - 1e-12);
  }
}

TEST(Rocks, BelongToTheSeed) {
  Stream a(5, "terrain.rocks"), b(5, "terrain.rocks"), c(6, "terrain.rocks");
  const Ground ground = sloping_ground();
  const auto first = strew_rocks(a, rock_field(10), ground), again = strew_rocks(b, rock_field(10), ground),
             other = strew_rocks(c, rock_field(10), ground);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].centre_W_m, again[i].centre_W_m);
    EXPECT_EQ(first[i].yaw_rad, again[i].yaw_rad);
    EXPECT_NE(first[i].centre_W_m, other[i].centre_W_m);
  }
}

TEST(Rocks, WithoutRoomAreRefused) {
  RockField field = rock_field(1);
  field.clear.radius_m = 40.0;
  Stream stream(1, "terrain.rocks");
  EXPECT_THROW(strew_rocks(stream, field, sloping_ground()), InvalidSituation);
}

Stand stand(int count) {
  Stand out;
  out.count = count;
  out.largest_radius_m = 0.2;
  out.spacing_m = 0.8;
  out.lane_half_width_m = 0.5;
  out.area = {-9.0, 9.0, -9.0, 9.0};
  out.clear = {{-6.0, 0.0}, 2.0};
  return out;
}

TEST(Trunks, KeepTheirDistancesAndStandInTheGround) {
  Stream stream(2, "terrain.trunks");
  const std::vector<Trunk> trunks = plant_trunks(stream, stand(120), sloping_ground());
  ASSERT_EQ(trunks.size(), 120u);
  for (std::size_t i = 0; i < trunks.size(); ++i) {
    const Eigen::Vector2d at = trunks[i].centre_W_m.head<2>();
    EXPECT_GE(std::abs(at.y()), 0.5 + trunks[i].radius_m);
    EXPECT_GE((at - Eigen::Vector2d(-6.0, 0.0)).norm(), 2.0 + trunks[i].radius_m);
    EXPECT_NEAR(trunks[i].centre_W_m.z() - trunks[i].half_height_m, -0.5 * at.x() - 0.5, 1e-9);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((at - trunks[j].centre_W_m.head<2>()).norm(), 0.8);
  }
}

TEST(Trunks, BelongToTheSeedAndAreRefusedWithoutRoom) {
  Stream a(5, "terrain.trunks"), b(5, "terrain.trunks"), c(5, "terrain.trunks");
  const Ground ground = sloping_ground();
  const auto first = plant_trunks(a, stand(10), ground), again = plant_trunks(b, stand(10), ground);
  ASSERT_EQ(first.size(), 10u);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].centre_W_m, again[i].centre_W_m);
  EXPECT_THROW(plant_trunks(c, stand(2000), ground), InvalidSituation);
}

}  // namespace
}  // namespace tumble::sim
