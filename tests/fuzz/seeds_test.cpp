// SPDX-License-Identifier: BSD-3-Clause
// Every reader accepts its seeds, and only rejects truncated and corrupted copies. fuzz_target.cpp runs for hours; this
// test is its short version.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "tests/fuzz/readers.hpp"
#include "tests/tree.hpp"

namespace tumble::fuzz {

void PrintTo(const Reader& reader, std::ostream* out) {
  *out << reader.name;
}

namespace {

struct Seed {
  std::string name, bytes;
};

std::vector<Seed> seeds_of(const Reader& reader) {
  std::vector<Seed> seeds;
  const std::filesystem::path folder = test::source_dir() / "tests/fuzz/seeds" / reader.name;
  if (!std::filesystem::exists(folder)) return seeds;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    seeds.push_back({entry.path().filename().string(), {std::istreambuf_iterator<char>(stream), {}}});
  }
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) { return a.name < b.name; });
  return seeds;
}

/// Returns what a reader does with bytes: "taken", "refused", or what it threw.
std::string answer(const Reader& reader, const std::string& bytes, const std::filesystem::path& folder) {
  try {
    return takes(reader, bytes, folder) ? "taken" : "refused";
  } catch (const std::exception& error) {
    return std::string("defect: ") + error.what();
  }
}

bool is_defect(const std::string& answer) {
  return answer.starts_with("defect");
}

class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::path(testing::TempDir()) / ("tumble_seeds_" + name)) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class Readers : public testing::TestWithParam<Reader> {};

TEST_P(Readers, TakeTheirSeeds) {
  const Folder folder("take_" + std::string(GetParam().name));
  const std::vector<Seed> seeds = seeds_of(GetParam());
  ASSERT_FALSE(seeds.empty());
  for (const Seed& seed : seeds) {
    // the fuzzer found the seeds with this prefix: they must be rejected
    const std::string expected = seed.name.starts_with("refused") ? "refused" : "taken";
    EXPECT_EQ(answer(GetParam(), seed.bytes, folder.path()), expected) << seed.name;
  }
}

// every length of a short seed; for a long seed, the lengths at its ends and a hundred between
TEST_P(Readers, BearASeedCutAtAnyLength) {
  const Folder folder("cut_" + std::string(GetParam().name));
  std::size_t refused = 0, cuts = 0;
  for (const Seed& seed : seeds_of(GetParam())) {
    const std::size_t size = seed.bytes.size(), step = std::max<std::size_t>(1, size / 101);
    for (std::size_t length = 0; length < size; length += (length < 40 || length + 40 > size) ? 1 : step) {
      const std::string said = answer(GetParam(), seed.bytes.substr(0, length), folder.path());
      ASSERT_FALSE(is_defect(said)) << seed.name << " cut to " << length << ": " << said;
      refused += said == "refused";
      ++cuts;
    }
  }
  EXPECT_GT(cuts, 0u);
  EXPECT_GT(refused, 0u) << "the cuts hurt nothing";
}

/// Corrupted copies have these bytes at one position.
constexpr unsigned char kSpoiled[] = {0x00, 0xff, 0x7f, 0x80};

TEST_P(Readers, BearSpoiledBytes) {
  const Folder folder("spoil_" + std::string(GetParam().name));
  std::size_t refused = 0;
  std::uint64_t state = 1;
  for (const Seed& seed : seeds_of(GetParam())) {
    for (int i = 0; i < 200 && !seed.bytes.empty(); ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      // every second byte near the beginning, where headers are
      const std::size_t at =
          (state >> 20) % (i % 2 == 0 ? seed.bytes.size() : std::min<std::size_t>(seed.bytes.size(), 400));
      std::string spoiled = seed.bytes;
      char& byte = spoiled[at];
      const unsigned kind = (state >> 60) & 7u;
      byte = kind < 4 ? static_cast<char>(kSpoiled[kind])
                      : static_cast<char>(static_cast<unsigned char>(byte) ^ (1u << ((state >> 57) & 7u)));
      const std::string said = answer(GetParam(), spoiled, folder.path());
      ASSERT_FALSE(is_defect(said)) << seed.name << ", byte " << at << ": " << said;
      refused += said == "refused";
    }
  }
  // a KITTI cloud consists only of numbers, so any bytes are valid
  if (GetParam().name != "kitti_cloud") {
    EXPECT_GT(refused, 0u) << "the spoiled bytes hurt nothing";
  }
}

INSTANTIATE_TEST_SUITE_P(, Readers, testing::ValuesIn(readers().begin(), readers().end()),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(Answer, TellsADefectFromARefusal) {
  const Folder folder("negative");
  const Reader throws{"throws", "a", [](const std::filesystem::path&) { throw std::out_of_range("at"); }};
  const Reader refuses{"refuses", "a", [](const std::filesystem::path&) { throw scenarios::BadInput("no"); }};
  EXPECT_TRUE(is_defect(answer(throws, "x", folder.path())));
  EXPECT_EQ(answer(refuses, "x", folder.path()), "refused");
}

TEST(Seeds, BelongToAReaderEach) {
  std::size_t folders = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() / "tests/fuzz/seeds")) {
    EXPECT_NE(find_reader(entry.path().filename().string()), nullptr) << entry.path();
    ++folders;
  }
  EXPECT_EQ(folders, readers().size());
}

}  // namespace
}  // namespace tumble::fuzz
