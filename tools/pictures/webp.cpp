// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/webp.hpp"

#include <fmt/format.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <stdexcept>
#include <string>

namespace tumble::tools {

struct WebpAnimation::Impl {
  int width, height, time_ms = 0, pictures = 0;
  WebPConfig config;
  WebPAnimEncoder* encoder = nullptr;

  ~Impl() { WebPAnimEncoderDelete(encoder); }
};

namespace {

class WebpPicture {
 public:
  explicit WebpPicture(const sim::Picture& picture) {
    if (WebPPictureInit(&picture_) == 0)
      throw std::runtime_error(
          "the loaded library libwebp has another version than the headers that this program was compiled with");
    picture_.use_argb = 1;
    picture_.width = picture.width;
    picture_.height = picture.height;
    if (WebPPictureImportRGB(&picture_, picture.rgb.data(), 3 * picture.width) == 0)
      throw std::runtime_error("there is too little memory for a picture of the animation");
  }
  ~WebpPicture() { WebPPictureFree(&picture_); }
  WebpPicture(const WebpPicture&) = delete;
  WebpPicture& operator=(const WebpPicture&) = delete;
  WebPPicture* get() { return &picture_; }

 private:
  WebPPicture picture_;
};

}  // namespace

WebpAnimation::WebpAnimation(int width, int height, float quality) : impl_(std::make_unique<Impl>()) {
  if (width < 1 || height < 1 || width > WEBP_MAX_DIMENSION || height > WEBP_MAX_DIMENSION)
    throw std::invalid_argument(fmt::format("a WebP picture has {} by {} pixels; width and height must be from 1 to {}",
                                            width, height, WEBP_MAX_DIMENSION));
  if (!(quality >= 0.0f && quality <= 100.0f))
    throw std::invalid_argument(
        fmt::format("the quality of a WebP file is {}; it must be within [0, 100]", std::to_string(quality)));
  impl_->width = width;
  impl_->height = height;
  WebPAnimEncoderOptions options;
  if (WebPAnimEncoderOptionsInit(&options) == 0 || WebPConfigInit(&impl_->config) == 0)
    throw std::runtime_error(
        "the loaded library libwebp has another version than the headers that this program was compiled with");
  // Encoding with one thread and no time limit gives equal bytes for equal pictures.
  impl_->config.thread_level = 0;
  impl_->config.quality = quality;
  impl_->encoder = WebPAnimEncoderNew(width, height, &options);
  if (impl_->encoder == nullptr) throw std::runtime_error("there is too little memory for a WebP file");
}

WebpAnimation::~WebpAnimation() = default;
WebpAnimation::WebpAnimation(WebpAnimation&&) noexcept = default;

void WebpAnimation::add(const sim::Picture& picture, int duration_ms) {
  if (picture.width != impl_->width || picture.height != impl_->height)
    throw std::invalid_argument("all pictures of a WebP file must have the same size");
  if (duration_ms < 1) throw std::invalid_argument("the duration of a picture must be at least 1 ms");
  WebpPicture imported(picture);
  if (WebPAnimEncoderAdd(impl_->encoder, imported.get(), impl_->time_ms, &impl_->config) == 0)
    throw std::runtime_error(std::string("libwebp: ") + WebPAnimEncoderGetError(impl_->encoder));
  impl_->time_ms += duration_ms;
  ++impl_->pictures;
}

std::vector<std::uint8_t> WebpAnimation::bytes() {
  if (impl_->pictures == 0) throw std::logic_error("a WebP file needs at least one picture");
  WebPData data;
  WebPDataInit(&data);
  const bool made = WebPAnimEncoderAdd(impl_->encoder, nullptr, impl_->time_ms, nullptr) != 0 &&
                    WebPAnimEncoderAssemble(impl_->encoder, &data) != 0;
  if (!made) throw std::runtime_error(std::string("libwebp: ") + WebPAnimEncoderGetError(impl_->encoder));
  std::vector<std::uint8_t> out(data.bytes, data.bytes + data.size);
  WebPDataClear(&data);
  return out;
}

}  // namespace tumble::tools
