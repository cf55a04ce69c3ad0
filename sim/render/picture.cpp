// SPDX-License-Identifier: BSD-3-Clause
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <new>
#include <stdexcept>
#include <string>

#include "sim/render/renderer.hpp"

namespace tumble::sim {

namespace {

void append_bytes(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}

void check(const Picture& picture) {
  const auto pixels =
      static_cast<std::size_t>(std::max(0, picture.width)) * static_cast<std::size_t>(std::max(0, picture.height));
  if (pixels == 0 || picture.rgb.size() != 3 * pixels) {
    throw std::invalid_argument("picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                                " with " + std::to_string(picture.rgb.size()) + " bytes");
  }
}

}  // namespace

Picture film_strip(std::span<const Picture> pictures, int columns) {
  if (pictures.empty() || columns < 1)
    throw std::invalid_argument("film_strip: there must be at least one picture and one column");
  const int width = pictures[0].width, height = pictures[0].height;
  const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
  columns = std::min(columns, static_cast<int>(pictures.size()));
  constexpr int kGap = 4;
  Picture strip{columns * (width + kGap) - kGap, rows * (height + kGap) - kGap, {}};
  strip.rgb.assign(3 * static_cast<std::size_t>(strip.width) * static_cast<std::size_t>(strip.height), 255);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const Picture& picture = pictures[i];
    check(picture);
    if (picture.width != width || picture.height != height)
      throw std::invalid_argument("film_strip: the pictures differ in size; they must have the same size");
    const int left = static_cast<int>(i) % columns * (width + kGap),
              top = static_cast<int>(i) / columns * (height + kGap);
    for (int row = 0; row < height; ++row) {
      const auto from = picture.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(row) * width;
      std::copy(from, from + 3 * width,
                strip.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(top + row) * strip.width + left));
    }
  }
  return strip;
}

std::vector<std::uint8_t> png_bytes(const Picture& picture) {
  check(picture);
  std::vector<std::uint8_t> bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) {
    png_destroy_write_struct(&png, nullptr);
    throw std::bad_alloc();
  }
  if (setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    throw std::runtime_error("PNG: encoding failed");
  }
  png_set_write_fn(png, &bytes, append_bytes, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int row = 0; row < picture.height; ++row) {
    png_write_row(png,
                  picture.rgb.data() + 3 * static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width));
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace tumble::sim
