// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/arguments.hpp"

#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::tools {
namespace {

using scenarios::BadInput;
using ::testing::ThrowsMessage;

TEST(ParseSeed, TakesWholeNumbersAlone) {
  EXPECT_EQ(parse_seed("0"), 0u);
  EXPECT_EQ(parse_seed("18446744073709551615"), 18446744073709551615u);
  EXPECT_EQ(parse_seed("010"), 10u) << "decimal, whatever it begins with";
  for (const char* bad : {"", "-1", "+1", "1.0", "1e3", "0x10", " 1", "1 ", "18446744073709551616", "one"}) {
    EXPECT_THAT([&] { parse_seed(bad); }, ThrowsMessage<BadInput>(HasSubstr("--seed is '" + std::string(bad) + "'")))
        << bad;
  }
}

TEST(RequireKnown, NamesTheNearestOrAll) {
  const std::vector<std::string> known = {"qx", "stamp_s"};
  const auto said = [&](const char* name) { return [&known, name] { require_known("column", name, known); }; };
  EXPECT_NO_THROW(said("qx")());
  EXPECT_THAT(said("stamp"), ThrowsMessage<BadInput>("unknown column 'stamp'; did you mean 'stamp_s'?"));
  EXPECT_THAT(said("qy"), ThrowsMessage<BadInput>(HasSubstr("did you mean 'qx'?")));
  const std::vector<std::string> sheets = {"os1_128", "os1_64", "rs16"};
  EXPECT_THAT([&] { require_known("device", "os1", sheets); },
              ThrowsMessage<BadInput>("unknown device 'os1'; did you mean 'os1_64' or 'os1_128'?"));
  EXPECT_THAT([&] { require_known("device", "OS1-64", sheets); },
              ThrowsMessage<BadInput>("unknown device 'OS1-64'; did you mean 'os1_64'?"));
  for (const char* far : {"t", "", "gy"})
    EXPECT_THAT(said(far), ThrowsMessage<BadInput>(HasSubstr("; known: qx stamp_s"))) << far;
}

TEST(ParseSeeds, TakesARangeOrOne) {
  EXPECT_EQ(parse_seeds("3..9"), std::make_pair(std::uint64_t{3}, std::uint64_t{9}));
  EXPECT_EQ(parse_seeds("7"), std::make_pair(std::uint64_t{7}, std::uint64_t{7}));
  for (const char* bad : {"", "..", "1..", "..5", "1...5", "1-5", "9..3", "a..b"})
    EXPECT_THROW(parse_seeds(bad), BadInput) << bad;
}

TEST(ParseShard, IsOneOfN) {
  EXPECT_EQ(parse_shard("2/8").index, 2u);
  EXPECT_EQ(parse_shard("2/8").count, 8u);
  for (const char* bad : {"", "0/4", "5/4", "1/0", "1", "1/", "/1", "-1/2", "1/1000001"})
    EXPECT_THROW(parse_shard(bad), BadInput) << bad;
}

TEST(ShardSeeds, PartitionTheRange) {
  // every seed is in exactly one shard, in order, and the lengths differ by at most one; with more shards than seeds,
  // some are empty
  for (const std::uint64_t count : {1u, 2u, 3u, 7u, 10u, 13u}) {
    std::uint64_t next = 5;
    std::size_t empty = 0;
    for (std::uint64_t i = 1; i <= count; ++i) {
      std::uint64_t first = 5, last = 14;
      if (!shard_seeds({i, count}, first, last)) {
        ++empty;
        continue;
      }
      EXPECT_EQ(first, next) << i << "/" << count;
      EXPECT_GE(last - first + 1, 10 / count);
      EXPECT_LE(last - first + 1, 10 / count + 1);
      next = last + 1;
    }
    EXPECT_EQ(next, 15u) << count << " shards";
    EXPECT_EQ(empty, count > 10 ? count - 10 : 0);
  }
}

// the number of all seeds does not fit into 64 bits
TEST(ShardSeeds, PartitionAllSeedsThereAre) {
  constexpr std::uint64_t kLast = 18446744073709551615u;
  for (const std::uint64_t count : {1u, 2u, 3u, 1000000u}) {
    std::uint64_t next = 0;
    for (const std::uint64_t i : {std::uint64_t{1}, count / 2 + 1, count}) {
      std::uint64_t first = 0, last = kLast;
      ASSERT_TRUE(shard_seeds({i, count}, first, last)) << i << "/" << count;
      EXPECT_GE(first, next);
      EXPECT_GE(last - first, kLast / count - 1);
      next = first;
      EXPECT_EQ(first == 0, i == 1);
      EXPECT_EQ(last == kLast, i == count);
    }
  }
}

TEST(SelectMethods, TakesEachOnceAndRefusesUnknownOnes) {
  EXPECT_EQ(select_methods({}).size(), scenarios::methods().size());
  const auto selected = select_methods({"raw", "rate/raw", "saave"});
  ASSERT_EQ(selected.size(), 2u);
  EXPECT_EQ(selected[0]->info.name, "raw");
  EXPECT_EQ(selected[1]->info.name, "saave");
  EXPECT_THAT([] { select_methods({"saavee"}); }, ThrowsMessage<BadInput>(HasSubstr("saave")));
}

using OutputFolder = test::TemporaryFolder;

TEST_F(OutputFolder, IsRefusedBelowAFileAndLeavesNothing) {
  const fs::path folder = folder_ / "made";
  make_folder(folder);
  scenarios::replace_file(folder / "a.txt", "content");
  EXPECT_EQ(test::read_file(folder / "a.txt"), "content");
  // a path below a regular file cannot be written, even by root
  EXPECT_THAT([&] { scenarios::replace_file(folder / "a.txt" / "b", "x"); },
              ThrowsMessage<BadInput>(HasSubstr("a.txt/b")));
  EXPECT_THAT([&] { make_folder(folder / "a.txt" / "b"); }, ThrowsMessage<BadInput>(HasSubstr("a.txt/b")));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "no partial file stays";
}

// the program rejects the path before it computes anything
TEST_F(OutputFolder, PrepareFileRefusesWhatCannotBeOneAndLeavesNothing) {
  const fs::path folder = folder_;
  make_folder(folder / "a.h5");
  EXPECT_THAT([&] { prepare_file(folder / "a.h5", {}, {".h5"}); },
              ThrowsMessage<BadInput>(HasSubstr("Is a directory")));
  EXPECT_THAT([&] { prepare_file(folder / (std::string(300, 'a') + ".h5"), {}, {".h5"}); },
              ThrowsMessage<BadInput>(HasSubstr("cannot be written")));
  EXPECT_THAT([&] { prepare_file("/proc/self/x.h5", {}, {".h5"}); },
              ThrowsMessage<BadInput>(HasSubstr("cannot be written")));
  EXPECT_THAT(
      [&] {
        prepare_file(folder / "none" / "x.yaml", {}, {".h5", ".hdf5"});
      },
      ThrowsMessage<BadInput>(HasSubstr("x.yaml: the name of this output must end in .h5 or .hdf5")));
  EXPECT_FALSE(fs::exists(folder / "none"));
  EXPECT_NO_THROW(prepare_file(folder / "below" / "x.h5", {}, {".h5"}));
  EXPECT_TRUE(fs::is_empty(folder / "below"));
}

}  // namespace
}  // namespace tumble::tools
