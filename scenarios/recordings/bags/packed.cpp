// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/packed.hpp"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/scratch_file.hpp"
#include "scenarios/regular_file.hpp"

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
    throw BadInput(fmt::format("the decompressed {} frame has {}: its stated size is {} bytes; the data are damaged",
                               what, no_more_input ? "too few bytes" : "too many bytes", promised_));
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

namespace {

using std::filesystem::path;

/// Returns the largest accepted size of decompressed data. Sensor messages compress by a factor of a few dozen at most.
constexpr std::uint64_t most_of(std::uint64_t packed_bytes) {
  constexpr std::uint64_t kAlways = 64u << 20, kBagRatioMax = 200;
  return kAlways + kBagRatioMax * packed_bytes;
}

std::uint64_t most_bytes(const path& file, const path& folder) {
  constexpr std::uint64_t kLeftFree = 64u << 20;
  const std::uint64_t free = std::filesystem::space(folder).available;
  const std::uint64_t room = free > kLeftFree ? free - kLeftFree : 0;
  return std::min(room, most_of(std::filesystem::file_size(file)));
}

void unpack(const path& file, const path& to) {
  const auto fail = [&](const std::string& what) { throw BadInput(file.string() + ": " + what); };
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  std::ifstream source = open_regular_file(file);
  std::ofstream unpacked(to, std::ios::binary);
  std::string taken(ZSTD_DStreamInSize(), '\0'), given(ZSTD_DStreamOutSize(), '\0');
  const std::uint64_t most = most_bytes(file, to.parent_path());
  std::uint64_t bytes = 0;
  std::size_t left = 1;
  while (source.read(taken.data(), static_cast<std::streamsize>(taken.size())) || source.gcount() > 0) {
    ZSTD_inBuffer in{taken.data(), static_cast<std::size_t>(source.gcount()), 0};
    for (bool full = false; in.pos < in.size || full;) {
      ZSTD_outBuffer out{given.data(), given.size(), 0};
      left = ZSTD_decompressStream(context.get(), &out, &in);
      if (ZSTD_isError(left) != 0) fail(fmt::format("the Zstandard frame is damaged: {}", ZSTD_getErrorName(left)));
      bytes += out.pos;
      if (bytes > most)
        fail(
            fmt::format("the unpacked bag has more than {} bytes. Either {} has too little space (set TMPDIR to "
                        "another folder), or the file is not a compressed bag",
                        most, to.parent_path().string()));
      unpacked.write(given.data(), static_cast<std::streamsize>(out.pos));
      full = out.pos == out.size;
    }
  }
  if (left != 0) fail("the Zstandard frame is truncated");
  if (!unpacked.flush()) fail("cannot be unpacked into " + to.parent_path().string());
}

class UnpackedFiles : public BagReader {
 public:
  UnpackedFiles(const std::vector<path>& files,
                const std::function<std::unique_ptr<BagReader>(const std::vector<path>&)>& open) {
    std::vector<path> unpacked;
    for (const path& file : files) {
      unpacked.push_back(folder_.path() / file.stem());
      unpack(file, unpacked.back());
    }
    bag_ = open(unpacked);
    notes = bag_->notes;
  }
  std::vector<BagTopic> topics() override { return bag_->topics(); }
  void read(const std::string& topic, const Take& take) override { bag_->read(topic, take); }
  bool cdr(const std::string& topic) const override { return bag_->cdr(topic); }

 private:
  ScratchFolder folder_{"bag"};
  std::unique_ptr<BagReader> bag_;  ///< destroyed before its files
};

class UnpackedMessages : public BagReader {
 public:
  UnpackedMessages(std::unique_ptr<BagReader> bag, std::string place) : bag_(std::move(bag)), place_(std::move(place)) {
    notes = bag_->notes;
  }
  std::vector<BagTopic> topics() override { return bag_->topics(); }
  void read(const std::string& topic, const Take& take) override {
    std::size_t number = 0;
    bag_->read(topic, [&](ros::Bytes& bytes, std::int64_t record_ns) {
      ros::Bytes plain = unpacked(bytes, topic, number++);
      take(plain, record_ns);
    });
  }
  bool cdr(const std::string& topic) const override { return bag_->cdr(topic); }

 private:
  ros::Bytes unpacked(const ros::Bytes& bytes, const std::string& topic, std::size_t number) const {
    const std::string where = fmt::format("{}: message {} of {}: ", place_, number, topic);
    const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > most_of(bytes.size()))
      throw BadInput(
          fmt::format("{}the content of the message is not a valid Zstandard frame, or the stated size exceeds 64 MiB "
                      "plus 200 times the compressed size",
                      where));
    try {
      const std::string plain = unpacked_zstd({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, size);
      return {plain.begin(), plain.end()};
    } catch (const BadInput& error) {
      throw BadInput(where + error.what());
    }
  }

  std::unique_ptr<BagReader> bag_;
  std::string place_;
};

}  // namespace

std::unique_ptr<BagReader> open_packed_files(
    const std::vector<path>& files, const std::function<std::unique_ptr<BagReader>(const std::vector<path>&)>& open) {
  return std::make_unique<UnpackedFiles>(files, open);
}

std::unique_ptr<BagReader> with_packed_messages(std::unique_ptr<BagReader> bag, std::string place) {
  return std::make_unique<UnpackedMessages>(std::move(bag), std::move(place));
}

}  // namespace tumble::scenarios
