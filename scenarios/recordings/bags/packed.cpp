// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/packed.hpp"

#include <fmt/format.h>

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

/// An LZ4 block compresses by at most a factor of 255.
constexpr std::uint64_t kRatioMax = 255;
constexpr std::uint64_t kFirstRoom = 1u << 20;

class Room {
 public:
  explicit Room(std::uint64_t promised) : promised_(promised), out_(std::min(promised, kFirstRoom), '\0') {}
  char* at() { return out_.data() + given_; }
  std::size_t left() {
    if (given_ == out_.size() && given_ < promised_) out_.resize(std::min<std::uint64_t>(promised_, 2 * out_.size()));
    return out_.size() - given_;
  }
  void take(std::size_t bytes) { given_ += bytes; }
  std::string whole(const char* what) {
    if (given_ != promised_) {
      throw BadInput(
          fmt::format("the decompressed {} frame has {} bytes, but its stated size is {} bytes; the data are damaged",
                      what, given_, promised_));
    }
    return std::move(out_);
  }
  [[noreturn]] void stuck(const char* what, bool no_more_input) const {
    throw BadInput(fmt::format("the decompressed {} frame {} the stated size of {} bytes; the data are damaged", what,
                               no_more_input ? "ends before" : "is longer than", promised_));
  }

 private:
  std::uint64_t promised_;
  std::string out_;
  std::size_t given_ = 0;
};

}  // namespace

std::string packed_lz4(std::string_view plain) {
  LZ4F_preferences_t how{};
  how.frameInfo.blockMode = LZ4F_blockIndependent;
  how.frameInfo.blockSizeID = LZ4F_max4MB;
  std::string out(LZ4F_compressFrameBound(plain.size(), &how), '\0');
  const std::size_t bytes = LZ4F_compressFrame(out.data(), out.size(), plain.data(), plain.size(), &how);
  if (LZ4F_isError(bytes) != 0) throw std::bad_alloc();  // only memory can fail
  out.resize(bytes);
  return out;
}

std::string unpacked_lz4(std::string_view packed, std::uint64_t bytes) {
  if (bytes / kRatioMax > packed.size()) {
    throw BadInput(
        fmt::format("the LZ4 frame of {} bytes cannot hold the {} bytes that the chunk states", packed.size(), bytes));
  }
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> owner(context, LZ4F_freeDecompressionContext);
  Room room(bytes);
  for (std::size_t left = 1; left != 0;) {
    std::size_t given = room.left(), taken = packed.size();
    left = LZ4F_decompress(context, room.at(), &given, packed.data(), &taken, nullptr);
    if (LZ4F_isError(left) != 0)
      throw BadInput(fmt::format("the LZ4 library reports that a frame is damaged: {}", LZ4F_getErrorName(left)));
    room.take(given);
    packed.remove_prefix(taken);
    if (left != 0 && given == 0 && taken == 0) room.stuck("LZ4", packed.empty());
  }
  return room.whole("LZ4");
}

std::string unpacked_zstd(std::string_view packed, std::uint64_t bytes) {
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  Room room(bytes);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  for (std::size_t left = 1; left != 0 || in.pos < in.size;) {
    const std::size_t before = in.pos;
    const std::size_t size = room.left();
    ZSTD_outBuffer out{room.at(), size, 0};
    left = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(left) != 0)
      throw BadInput(fmt::format("the Zstandard library reports that a frame is damaged: {}", ZSTD_getErrorName(left)));
    room.take(out.pos);
    if (out.pos == 0 && in.pos == before) room.stuck("Zstandard", in.pos == in.size);
  }
  return room.whole("Zstandard");
}

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace tumble::scenarios
