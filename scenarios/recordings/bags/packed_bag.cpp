// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/packed_bag.hpp"

#include <fmt/format.h>

#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/packed.hpp"
#include "scenarios/recordings/scratch_folder.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

/// Messages of sensors compress by a factor of a few dozen at most.
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
            fmt::format("the unpacked bag has more than {} bytes, and {} has too little space; set TMPDIR to another "
                        "folder, or check that the file is a compressed bag",
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
      throw BadInput(fmt::format(
          "{}the content of the message is not a valid Zstandard frame; its stated size must be at most 64 MiB and at "
          "most 200 times the compressed size",
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
