// SPDX-License-Identifier: BSD-3-Clause
#include "sim/render/renderer.hpp"

#include <png.h>

#include "sim/render/framing.hpp"
#include "tests/sim/render/built_world.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

View small_view() {
  View view;
  view.width = 320;
  view.height = 180;
  DrawnPath path;
  path.rgba = {1.0f, 0.0f, 0.9f, 1.0f};
  path.width_m = 0.1;
  for (int i = 0; i <= 100; ++i) path.points_W_m.emplace_back(-2.0 + 0.04 * i, 0.0, 2.0 + 0.3 * std::sin(0.1 * i));
  view.paths.push_back(path);
  return view;
}

/// Returns the number of pixels near the path's colour: much red and blue, little green.
int magenta_pixels(const Picture& picture) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
    count += picture.rgb[i] > 150 && picture.rgb[i + 1] < 90 && picture.rgb[i + 2] > 130;
  }
  return count;
}

std::size_t colours(const Picture& picture) {
  std::set<std::array<std::uint8_t, 3>> seen;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3)
    seen.insert({picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]});
  return seen.size();
}

TEST(Renderer, DrawsWorldAndPathWithoutADisplay) {
  unsetenv("DISPLAY");
  Renderer renderer(built_world("hill", "rig"));
  View view = small_view();
  const Picture with_path = renderer.draw(view);
  ASSERT_EQ(with_path.rgb.size(), 320u * 180u * 3u);
  EXPECT_GT(colours(with_path), 500u);
  EXPECT_GT(magenta_pixels(with_path), 300);
  // the same frame without the path lacks the colour
  const Framing framing = frame(view, 0.4, 45.0 * M_PI / 180.0);
  view.paths.clear();
  view.look_at_W_m = framing.look_at_W_m;
  view.distance_m = framing.distance_m;
  EXPECT_EQ(magenta_pixels(renderer.draw(view)), 0);
}

TEST(Renderer, DrawsTheRobotAtEveryPose) {
  Renderer renderer(built_world("floor", "sphere"));
  View view;
  view.width = 320;
  view.height = 180;
  view.look_at_W_m = Vector3d(0, 0, 0.2);
  view.distance_m = 4.0;
  const Picture empty = renderer.draw(view);
  const auto changed = [&](const Picture& other) {
    int count = 0;
    for (std::size_t i = 0; i < empty.rgb.size(); i += 3) {
      count += std::abs(empty.rgb[i] - other.rgb[i]) + std::abs(empty.rgb[i + 1] - other.rgb[i + 1]) > 30;
    }
    return count;
  };
  view.robots_T_WB.emplace_back(Eigen::Translation3d(0.0, 0.0, 0.145));
  const int one = changed(renderer.draw(view));
  view.robots_T_WB.emplace_back(Eigen::Translation3d(0.7, 0.0, 0.145));
  view.robots_T_WB.emplace_back(Eigen::Translation3d(-0.7, 0.0, 0.145));
  const int three = changed(renderer.draw(view));
  EXPECT_GT(one, 50);
  EXPECT_GT(three, 2 * one);
}

TEST(Renderer, TwiceInOneProcessAndOnAnotherThreadGivesTheSamePicture) {
  Picture first, second, third;
  {
    Renderer renderer(built_world("hill", "rig"));
    first = renderer.draw(small_view());
    View large = small_view();
    large.width = 400;
    large.height = 300;
    EXPECT_EQ(renderer.draw(large).rgb.size(), 400u * 300u * 3u);
    std::thread([&] { second = renderer.draw(small_view()); }).join();
  }
  Renderer again(built_world("hill", "rig"));
  third = again.draw(small_view());
  EXPECT_EQ(first.rgb, second.rgb);
  EXPECT_EQ(first.rgb, third.rgb);
}

TEST(Renderer, BadInput) {
  Renderer renderer(built_world("floor", "sphere"));
  View view;
  view.width = 0;
  EXPECT_THROW(renderer.draw(view), std::invalid_argument);
  EXPECT_THROW(Renderer(built_world("no_such_world", "rig")), InvalidSituation);
}

TEST(Framing, APathThatRanAwayDoesNotShrinkTheRobots) {
  View view = small_view();
  view.robots_T_WB.resize(2, Eigen::Isometry3d::Identity());
  view.robots_T_WB[1].translation() = Vector3d(6, 0, -3);
  const double before = frame(view, 0.4, 0.785).distance_m;
  view.paths.push_back({{Vector3d(0, 0, 0), Vector3d(0, 0, -1e4)}});
  EXPECT_EQ(frame(view, 0.4, 0.785).distance_m, before);
  view.robots_T_WB.clear();
  EXPECT_GT(frame(view, 0.4, 0.785).distance_m, 1e3) << "without robots the paths are the content";
}

/// Every point of the content projects into the picture, and the content fills a large part of it.
TEST(Framing, KeepsTheContentInThePicture) {
  for (const double azimuth : {-2.0, 0.3, 1.9}) {
    View view = small_view();
    view.azimuth_rad = azimuth;
    const double fovy = 0.785;
    const Framing framing = frame(view, 0.4, fovy);
    const Vector3d forward(std::cos(view.elevation_rad) * std::cos(azimuth),
                           std::cos(view.elevation_rad) * std::sin(azimuth), std::sin(view.elevation_rad));
    const Vector3d right(std::sin(azimuth), -std::cos(azimuth), 0.0);
    const Vector3d eye = framing.look_at_W_m - framing.distance_m * forward;
    double widest = 0.0;
    for (const Vector3d& p : view.paths[0].points_W_m) {
      const double depth = forward.dot(p - eye);
      const double x = right.dot(p - eye) / depth / (std::tan(fovy / 2) * 320 / 180);
      const double y = right.cross(forward).dot(p - eye) / depth / std::tan(fovy / 2);
      widest = std::max({widest, std::abs(x), std::abs(y)});
    }
    EXPECT_LT(widest, 0.85);
    EXPECT_GT(widest, 0.5);
  }
}

Picture plain(int width, int height, std::uint8_t value) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), value)};
}

TEST(Pictures, FilmStripPlacesPicturesRowByRow) {
  const std::vector<Picture> pictures = {plain(10, 6, 10), plain(10, 6, 20), plain(10, 6, 30)};
  const Picture strip = film_strip(pictures, 2);
  EXPECT_EQ(strip.width, 24);
  EXPECT_EQ(strip.height, 16);
  const auto at = [&](int x, int y) {
    return static_cast<int>(strip.rgb[static_cast<std::size_t>(3 * (y * strip.width + x))]);
  };
  EXPECT_EQ(at(0, 0), 10);
  EXPECT_EQ(at(23, 5), 20);
  EXPECT_EQ(at(9, 15), 30);
  EXPECT_EQ(at(23, 15), 255);
  EXPECT_THROW(film_strip({}, 2), std::invalid_argument);
  EXPECT_THROW(film_strip(std::vector<Picture>{plain(3, 3, 0), plain(4, 3, 0)}, 2), std::invalid_argument);
}

TEST(Pictures, PngComesBackAsItWas) {
  Picture picture = plain(7, 5, 0);
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = static_cast<std::uint8_t>(37 * i);
  const std::vector<std::uint8_t> bytes = png_bytes(picture);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, back.data(), 0, nullptr), 0);
  EXPECT_EQ(back, picture.rgb);
  EXPECT_THROW(png_bytes(Picture{3, 3, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace tumble::sim
