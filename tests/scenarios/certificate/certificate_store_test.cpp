// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/certificate/certificate_store.hpp"

#include "scenarios/provenance/build_id.hpp"
#include "scenarios/sweep/certified_results.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

class CertificateStoreTest : public test::TemporaryFolder {
 protected:
  static Certificate sample() {
    return {build_id(),
            {{"free_flight_energy", "rig", "law", "1", 1.0 / 3.0, 0.0, 1e-8, ""},
             {"digest_restart", "slip", "law", "1", 0.0, 0.0, 0.0, "a note"}}};
  }
  CertificateStore store() const { return {folder_ / "cache", test::tree_data()}; }
  Results results() const { return Results(folder_ / "r.db", Results::Mode::create_or_append); }
};

TEST_F(CertificateStoreTest, TextComesBackToTheBit) {
  EXPECT_EQ(certificate_from_json(to_json(sample()), "here"), sample());
  Certificate unmeasured = sample();
  unmeasured.entries[0].value = std::nan("");
  EXPECT_TRUE(std::isnan(certificate_from_json(to_json(unmeasured), "here").entries[0].value));
  EXPECT_THROW(certificate_from_json("{}", "here"), BadInput);
  EXPECT_THROW(certificate_from_json(to_json(sample()).substr(0, 40), "here"), BadInput);
}

TEST_F(CertificateStoreTest, KeepsOnePerBuildAndSurvivesDamage) {
  EXPECT_FALSE(store().find().has_value());
  store().keep(sample());
  ASSERT_TRUE(store().find().has_value());
  EXPECT_EQ(*store().find(), sample());
  for (const auto& entry : fs::directory_iterator(folder_ / "cache")) {
    std::ofstream(entry.path()) << "{\"build\": ";
  }
  EXPECT_FALSE(store().find().has_value()) << "a file that was cut off";
  EXPECT_FALSE(CertificateStore({}, test::tree_data()).find().has_value());
}

TEST_F(CertificateStoreTest, AFolderThatCannotBeWrittenIsNoError) {
  std::ofstream(folder_ / "file") << "x";
  const CertificateStore below(folder_ / "file" / "cache", test::tree_data());
  below.keep(sample());
  EXPECT_FALSE(below.find().has_value());
}

TEST_F(CertificateStoreTest, OnlyARegularFileIsReplaced) {
  store().keep(sample());
  const auto file = fs::directory_iterator(folder_ / "cache")->path();
  fs::remove(file);
  fs::create_symlink("/dev/null", file);
  store().keep(sample());  // must not throw; the certificate is not cached
  EXPECT_TRUE(fs::is_symlink(file));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "cache"), {}), 1) << "nothing is left beside it";
}

TEST_F(CertificateStoreTest, ResultsGetItOnceAndKeepIt) {
  const CertificateInput input{test::tree_data(), ""};
  CertifyOptions options;
  options.rows = {"free_fall"};
  int measured = 0;
  options.on_row = [&](const CertificateRow&, double) { ++measured; };
  Results first = results();
  const Certificate certificate = certify_results(first, store(), input, options);
  EXPECT_TRUE(certificate.passes());
  EXPECT_EQ(measured, 1);
  EXPECT_EQ(certify_results(first, CertificateStore({}, input.data), input, options), certificate)
      << "out of the results";
  Results other(folder_ / "other.db", Results::Mode::create_or_append);
  EXPECT_EQ(certify_results(other, store(), input, options), certificate) << "out of the store";
  EXPECT_EQ(measured, 1);
  ASSERT_EQ(other.certificates().size(), 1u);
  EXPECT_EQ(other.certificates().front(), certificate);
}

TEST_F(CertificateStoreTest, WhatIsKnownIsFoundAndNothingIsMeasured) {
  Results all = results();
  EXPECT_FALSE(known_certificate(all, store()).has_value());
  EXPECT_TRUE(all.certificates().empty());
  const Certificate certificate{build_id(), {{"row", "a", "law", "m", 0.5, 0.0, 1.0, ""}}};
  store().keep(certificate);
  ASSERT_TRUE(known_certificate(all, store()).has_value());
  ASSERT_EQ(all.certificates().size(), 1u) << "it goes with the results";
  EXPECT_EQ(all.certificates().front(), certificate);
  EXPECT_EQ(known_certificate(all, CertificateStore({}, test::tree_data())), certificate);
}

TEST_F(CertificateStoreTest, AStoppedMeasuringIsKeptNowhere) {
  std::atomic<bool> stop = true;
  CertifyOptions options;
  options.stop = &stop;
  Results all = results();
  EXPECT_TRUE(certify_results(all, store(), {test::tree_data(), ""}, options).entries.empty());
  EXPECT_TRUE(all.certificates().empty());
  EXPECT_FALSE(store().find().has_value());
}

}  // namespace
}  // namespace tumble::scenarios
