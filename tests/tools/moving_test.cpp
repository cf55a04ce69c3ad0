// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/moving.hpp"

#include <webp/demux.h>

#include "scenarios/errors.hpp"
#include "tests/testing.hpp"
#include "tools/pictures/webp.hpp"

namespace tumble::tools {
namespace {

sim::Picture plain(std::uint8_t red, std::uint8_t green, std::uint8_t blue, int width = 64, int height = 48) {
  sim::Picture picture{width, height, {}};
  for (int i = 0; i < width * height; ++i) picture.rgb.insert(picture.rgb.end(), {red, green, blue});
  return picture;
}

/// Decoded contains what a reader finds in the file: frames with the time at which each ends.
struct Decoded {
  int width = 0, height = 0;
  std::vector<int> end_ms;
  std::vector<std::array<int, 3>> first_pixel;
};

Decoded decoded(const std::vector<std::uint8_t>& bytes) {
  const WebPData data = {bytes.data(), bytes.size()};
  const std::unique_ptr<WebPAnimDecoder, decltype(&WebPAnimDecoderDelete)> decoder(WebPAnimDecoderNew(&data, nullptr),
                                                                                   WebPAnimDecoderDelete);
  Decoded out;
  WebPAnimInfo info;
  if (decoder == nullptr || WebPAnimDecoderGetInfo(decoder.get(), &info) == 0) return out;
  out.width = static_cast<int>(info.canvas_width);
  out.height = static_cast<int>(info.canvas_height);
  while (WebPAnimDecoderHasMoreFrames(decoder.get()) != 0) {
    std::uint8_t* rgba = nullptr;
    int end_ms = 0;
    if (WebPAnimDecoderGetNext(decoder.get(), &rgba, &end_ms) == 0) break;
    out.end_ms.push_back(end_ms);
    out.first_pixel.push_back({rgba[0], rgba[1], rgba[2]});
  }
  return out;
}

TEST(WebpAnimation, HoldsPicturesForTheirTime) {
  WebpAnimation animation(64, 48, 90.0f);
  animation.add(plain(200, 30, 30), 80);
  animation.add(plain(30, 30, 200), 500);
  const Decoded read = decoded(animation.bytes());
  EXPECT_EQ(read.width, 64);
  EXPECT_EQ(read.height, 48);
  ASSERT_EQ(read.end_ms, (std::vector<int>{80, 580}));
  EXPECT_NEAR(read.first_pixel[0][0], 200, 12) << "red, but for the compression";
  EXPECT_NEAR(read.first_pixel[1][2], 200, 12) << "blue";
  EXPECT_LT(read.first_pixel[1][0], 60) << "negative control: no red is left";
}

TEST(WebpAnimation, IsTheSameBytesForTheSamePictures) {
  const auto made = [](std::uint8_t red) {
    WebpAnimation animation(64, 48, 60.0f);
    for (std::uint8_t i = 0; i < 5; ++i) animation.add(plain(red, static_cast<std::uint8_t>(40 * i), 9), 40);
    return animation.bytes();
  };
  EXPECT_EQ(made(10), made(10));
  EXPECT_NE(made(10), made(250)) << "negative control";
}

TEST(WebpAnimation, RefusesWhatItCannotHold) {
  EXPECT_THROW(WebpAnimation(0, 48, 60.0f), std::invalid_argument);
  EXPECT_THROW(WebpAnimation(64, 16384, 60.0f), std::invalid_argument);
  EXPECT_THROW(WebpAnimation(64, 48, 101.0f), std::invalid_argument);
  WebpAnimation animation(64, 48, 60.0f);
  EXPECT_THROW(animation.add(plain(0, 0, 0, 48, 64), 40), std::invalid_argument);
  EXPECT_THROW(animation.add(plain(0, 0, 0), 0), std::invalid_argument);
  EXPECT_THROW(animation.bytes(), std::logic_error);
}

/// Returns 10 s that turn at 1 rad/s, and between 6 and 7 s at 20 rad/s.
sim::Truth turning() {
  sim::Truth truth;
  truth.period_ns = 10'000'000;
  for (int k = 0; k <= 1000; ++k) {
    truth.p_WB_m.emplace_back(0.001 * k, 0.0, 0.0);
    truth.q_WB.push_back(Eigen::Quaterniond::Identity());
    truth.v_WB_m_s.emplace_back(0.1001, 0.0, 0.0);
    truth.w_WB_B_rad_s.emplace_back(0.0, k >= 600 && k < 700 ? 20.0 : 1.0, 0.0);
  }
  return truth;
}

TEST(LiveliestSpan, IsWhereTheBodyTurnsMost) {
  const Span one = liveliest_span(turning(), 1.0);
  EXPECT_EQ(one.begin_ns, 6'000'000'000);
  EXPECT_EQ(one.end_ns, 7'000'000'000);
  const Span two = liveliest_span(turning(), 2.0);
  EXPECT_LE(two.begin_ns, 6'000'000'000);
  EXPECT_GE(two.end_ns, 7'000'000'000);
  EXPECT_EQ(two.end_ns - two.begin_ns, 2'000'000'000);
}

TEST(LiveliestSpan, OfAShortMotionIsAllOfIt) {
  const Span whole = moving_span(turning(), 0.1), all = liveliest_span(turning(), 60.0);
  EXPECT_EQ(all.begin_ns, whole.begin_ns);
  EXPECT_EQ(all.end_ns, whole.end_ns);
}

TEST(FrameCount, FollowsFromSpeedAndRate) {
  MovingOptions options;
  options.frames_per_s = 20.0;
  options.speed = 0.5;
  // 2 s at half speed take 4 s: 80 steps, and the frame from which they begin
  EXPECT_EQ(frame_count({0, 2'000'000'000}, options), 81u);
  EXPECT_EQ(frame_count({5, 5}, options), 1u);
}

TEST(MovingPicture, NeedsATruth) {
  EXPECT_THROW(moving_picture({}, {}, {}), scenarios::BadInput);
}

}  // namespace
}  // namespace tumble::tools
