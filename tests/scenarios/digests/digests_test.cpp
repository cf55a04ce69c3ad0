// SPDX-License-Identifier: BSD-3-Clause
// The test checks that draws give the same bits on every x86-64 machine with AVX2 and FMA: it compares their digests
// with those stored here. A change of the simulation, the models or the catalogue changes the digests, and then the new
// ones are accepted: the failure message prints the line to store.
#include "scenarios/draw/scenario.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

struct Kept {
  std::string scenario;
  std::uint64_t first, last;  ///< seeds
  std::string lidars;         ///< "lidars", or "none": only motion and IMUs
  std::string digest;         ///< of the draw; of several draws, the digest of their digests
};

void PrintTo(const Kept& draw, std::ostream* out) {
  *out << draw.scenario << ' ' << draw.first << ".." << draw.last << ' ' << draw.lidars;
}

std::vector<Kept> kept(const char* name = "digests.txt") {
  std::ifstream file((test::source_dir() / "tests/scenarios/digests" / name).string());
  std::vector<Kept> all;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    Kept each;
    words >> each.scenario >> each.first;
    each.last = each.first;
    if (char dot = 0; words.peek() == '.') words >> dot >> dot >> each.last;
    words >> each.lidars >> each.digest;
    all.push_back(each);
  }
  return all;
}

class Digests : public testing::TestWithParam<Kept> {};

std::string simulated_digest(const Kept& draw, std::uint64_t seed) {
  const DataRoot data{test::source_dir()};
  const Lidars lidars = draw.lidars == "none" ? Lidars::left_out : Lidars::simulated;
  return simulate_draw(data, load_scenario(data, draw.scenario), seed, 1, lidars).recording_digest;
}

TEST_P(Digests, AreTheKeptOnes) {
  const Kept& draw = GetParam();
  const std::string digest = simulated_digest(draw, draw.first);
  EXPECT_EQ(digest, draw.digest) << "the line is now\n"
                                 << draw.scenario << ' ' << draw.first << ' ' << draw.lidars << ' ' << digest;
}

std::string name_of(const testing::TestParamInfo<Kept>& of) {
  return of.param.scenario + "_" + std::to_string(of.param.first) + "_" + of.param.lidars;
}

INSTANTIATE_TEST_SUITE_P(, Digests, testing::ValuesIn(kept()), name_of);

// DigestsSoak tests more draws of each scenario, which take minutes.
class DigestsSoak : public Digests {};

TEST_P(DigestsSoak, AreTheKeptOnes) {
  const Kept& draws = GetParam();
  std::vector<std::string> digests;
  for (std::uint64_t seed = draws.first; seed <= draws.last; ++seed) digests.push_back(simulated_digest(draws, seed));
  const std::string digest = digest_of_texts(digests);
  EXPECT_EQ(digest, draws.digest) << testing::PrintToString(digests) << "\nthe line is now\n"
                                  << draws.scenario << ' ' << draws.first << ".." << draws.last << ' ' << draws.lidars
                                  << ' ' << digest;
}

INSTANTIATE_TEST_SUITE_P(, DigestsSoak, testing::ValuesIn(kept("digests_soak.txt")), name_of);

// every scenario of the catalogue has a draw here, and together with those of the long runs it has a dozen
TEST(DigestsOf, TheWholeCatalogueAreKept) {
  const std::vector<Kept> all = kept(), more = kept("digests_soak.txt");
  std::size_t with_lidars = 0;
  for (const Kept& each : all) with_lidars += each.lidars == "lidars";
  EXPECT_GE(with_lidars, 3u);
  for (const std::string& name : scenario_names({test::source_dir()})) {
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Kept& each) { return each.scenario == name; })) << name;
    EXPECT_TRUE(std::any_of(more.begin(), more.end(), [&](const Kept& each) {
      return each.scenario == name && each.last - each.first >= 10;
    })) << name;
  }
}

}  // namespace
}  // namespace tumble::scenarios
