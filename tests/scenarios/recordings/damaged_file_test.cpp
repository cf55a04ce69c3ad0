// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

/// DamagedFile has a small recording as bytes, and a folder for damaged copies.
class DamagedFile : public test::TemporaryFolder {
 protected:
  DamagedFile() : path_(folder_ / "a.h5") {
    const sim::Recording recording = fixture::recording();
    write_recording(path_, fixture::info(), recording.sensors, &recording.truth);
    bytes_ = test::read_file(path_);
    digest_ = digest(recording.sensors, &recording.truth);
  }
  /// Reads the whole file and returns the digest of what was read.
  std::string read_all() const {
    read_info(path_);
    const sim::Sensors sensors = read_sensors(path_);
    const sim::Truth truth = read_truth(path_);
    return digest(sensors, &truth);
  }
  fs::path path_;
  std::string bytes_;
  std::string digest_;
};

TEST_F(DamagedFile, TheWholeFileIsReadBack) {
  EXPECT_EQ(read_all(), digest_);
}

TEST_F(DamagedFile, TruncationIsRecognisedAtEveryLength) {
  ASSERT_GT(bytes_.size(), 10000u);
  int lengths = 0;
  // the test cuts at every length at the start, where the superblock is, then in prime steps, then at every length at
  // the end
  for (std::size_t length = 0; length < bytes_.size();
       length += (length < 128 || length + 64 > bytes_.size()) ? 1 : 499) {
    fixture::put(path_, bytes_.substr(0, length));
    for (const std::string& message :
         {test::complaint([&] { read_info(path_); }), test::complaint([&] { read_sensors(path_); }),
          test::complaint([&] { read_truth(path_); })}) {
      EXPECT_THAT(message, StartsWith(path_.string() + ": the file is " + (length == 0 ? "empty" : "truncated")))
          << length;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    ++lengths;
  }
  EXPECT_GT(lengths, 200);
}

// A flipped byte is rejected, or lies in a gap without data: it never gives other data, and never a crash.
TEST_F(DamagedFile, FlippedBytesNeverGiveOtherData) {
  int refused = 0;
  int flips = 0;
  std::uint64_t state = 1;
  for (int i = 0; i < 500; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    // half of the flipped bytes are in the first 2 KiB, where the metadata of the groups are
    const std::size_t at = (state >> 20) % (i % 2 == 0 ? bytes_.size() : 2048);
    std::string spoiled = bytes_;
    spoiled[at] = static_cast<char>(static_cast<unsigned char>(spoiled[at]) ^ (1u << ((state >> 60) & 7u)));
    fixture::put(path_, spoiled);
    ++flips;
    try {
      EXPECT_EQ(read_all(), digest_) << "byte " << at;
    } catch (const BadInput&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, flips / 3) << "the flips hit hardly anything";
}

TEST_F(DamagedFile, ADamagedReadingIsNamedAsSuch) {
  // T_BI is stored uncompressed: the test finds its last row 0 0 0 1, and the byte before that row belongs to the
  // translation
  const std::string last_row("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\xf0\x3f", 32);
  const std::size_t at = bytes_.find(last_row);
  ASSERT_NE(at, std::string::npos);
  std::string spoiled = bytes_;
  spoiled[at - 8] = static_cast<char>(spoiled[at - 8] ^ 1);  // lowest bit of a double
  fixture::put(path_, spoiled);
  EXPECT_THAT(test::complaint([&] { read_sensors(path_); }),
              HasSubstr("damaged or was changed: the digest of its data is"));
}

}  // namespace
}  // namespace tumble::scenarios
