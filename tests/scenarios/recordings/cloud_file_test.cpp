// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/cloud_file.hpp"

#include <sys/stat.h>

#include <bit>

#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

template <class Number>
std::string bytes(Number number, bool swapped = false) {
  std::string out(sizeof(number), '\0');
  std::memcpy(out.data(), &number, sizeof(number));
  if (swapped) std::reverse(out.begin(), out.end());
  return out;
}

class CloudFile : public test::TemporaryFolder {
 protected:
  Cloud read(const std::string& name, const std::string& content) {
    fixture::put(folder_ / name, content);
    return read_cloud(folder_ / name);
  }
  std::string complaint_of(const std::string& name, const std::string& content) {
    return test::complaint([&] { read(name, content); });
  }
};

const std::string kAsciiPly =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 2\nproperty float x\nproperty float y\nproperty double z\n"
    "property uchar intensity\nproperty float scalar_time\nend_header\n";

TEST_F(CloudFile, AsciiPlyWithDoubleBytesAndNaN) {
  const Cloud cloud = read("a.ply", kAsciiPly + "1 2 3.5 200 0.25\nnan nan nan 0 0.5\n");
  ASSERT_EQ(cloud.points, 2u);
  EXPECT_THAT(cloud.names, ElementsAre("x", "y", "z", "intensity", "time"));
  EXPECT_EQ((*cloud.find("z"))[0], 3.5);
  EXPECT_EQ((*cloud.find("intensity"))[0], 200.0);
  EXPECT_EQ((*cloud.find("time"))[1], 0.5);
  EXPECT_TRUE(std::isnan((*cloud.find("x"))[1])) << (*cloud.find("x"))[1];
  EXPECT_EQ(cloud.find("ring"), nullptr);
}

const std::string kPcd =
    "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ";

TEST_F(CloudFile, WordsOfAnAsciiPcdAreNumbers) {
  EXPECT_EQ((*read("a.pcd", kPcd + "ascii\n1 +2 3e-1\n\nnan nan nan\r\n").find("y"))[0], 2.0);
  EXPECT_THAT(complaint_of("a.pcd", kPcd + "ascii\n1 2 3\n0,488 2,15 1,03\n"),
              HasSubstr("a.pcd:11: word 1 is not a number (use a decimal point)"));
  EXPECT_THAT(complaint_of("a.pcd", kPcd + "ascii\n1 2 3\nnever was one\n"), HasSubstr("is not a number"));
  EXPECT_THAT(complaint_of("a.pcd", kPcd + "ascii\n1 2 3\n1 2 3 4\n"), HasSubstr("4 numbers; it must have 3"));
}

TEST_F(CloudFile, WordsOfAnAsciiPlyAreNumbers) {
  EXPECT_THAT(complaint_of("a.ply", kAsciiPly + "1 2 3.5 200 0.25\n0,488 2 3 0 0.5\n"),
              HasSubstr("a.ply:12: word 1 is not a number (use a decimal point)"));
  EXPECT_THAT(complaint_of("a.ply", kAsciiPly + "1 2 3.5 200 0.25\n1 never 3 0 0.5\n"),
              HasSubstr("a.ply:12: word 2 is not a number (use a decimal point)"));
  EXPECT_THAT(complaint_of("a.ply", kAsciiPly + "1 2 3.5 200 0.25\n1 2 3 0\n"),
              HasSubstr("a.ply:12: the line has 4 numbers; it must have 5"));
}

TEST_F(CloudFile, AViewpointIsReportedOrRefused) {
  const auto with = [](const std::string& viewpoint) {
    std::string text = kPcd + "ascii\n1 2 3\n4 5 6\n";
    return text.replace(text.find("POINTS"), 0, "VIEWPOINT " + viewpoint + "\n");
  };
  EXPECT_EQ(read("a.pcd", with("0 0 0 1 0 0 0")).viewpoint, "");
  EXPECT_EQ(read("a.pcd", with("1 2 3 0 0 0 1")).viewpoint, "1 2 3 0 0 0 1");
  EXPECT_THAT(complaint_of("a.pcd", with("nan 0 0 1 0 0 0")),
              HasSubstr("VIEWPOINT's number 1 is 'nan'; it must be a finite number"));
  EXPECT_THAT(complaint_of("a.pcd", with("0 0 0 1")), HasSubstr("VIEWPOINT has 4 numbers; it must have 7"));
}

TEST_F(CloudFile, SizesOfACompressedPcdAreComparedWithTheFile) {
  const auto with = [&](std::uint32_t compressed, std::uint32_t plain) {
    return complaint_of("a.pcd",
                        kPcd + "binary_compressed\n" + bytes(compressed) + bytes(plain) + std::string(20, 'x'));
  };
  EXPECT_THAT(with(20, 0), HasSubstr("states 0 bytes of uncompressed points, but its header requires 24 bytes"));
  EXPECT_THAT(with(20, 4000000000u), HasSubstr("requires 24 bytes"));
  EXPECT_THAT(with(0, 24), HasSubstr("states 0 bytes of compressed points"));
  EXPECT_THAT(with(21, 24), HasSubstr("but only 20 bytes follow"));
}

TEST_F(CloudFile, BinaryPlyOfBothByteOrders) {
  for (const bool big : {false, true}) {
    const std::string header = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                               "_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                               "property uint t\nend_header\n";
    const Cloud cloud = read("a.ply", header + bytes(1.5f, big) + bytes(-2.0f, big) + bytes(0.25f, big) +
                                          bytes(std::uint32_t{99999999}, big));
    ASSERT_EQ(cloud.points, 1u) << big;
    EXPECT_EQ((*cloud.find("y"))[0], -2.0) << big;
    EXPECT_EQ((*cloud.find("t"))[0], 99999999.0) << big;
  }
}

TEST_F(CloudFile, AsciiPcd) {
  const Cloud cloud = read("a.pcd",
                           "VERSION .7\nFIELDS x y z _ ring\nSIZE 4 4 4 1 2\nTYPE F F F U U\nCOUNT 1 1 1 2 1\nWIDTH 2\n"
                           "HEIGHT 1\nPOINTS 2\nDATA ascii\n1 2 3 0 0 15\nnan nan nan 0 0 3\n");
  ASSERT_EQ(cloud.points, 2u);
  EXPECT_THAT(cloud.names, ElementsAre("x", "y", "z", "ring"));
  EXPECT_THAT(*cloud.find("ring"), ElementsAre(15.0, 3.0));
}

TEST_F(CloudFile, KittiBin) {
  const Cloud cloud = read("a.bin", bytes(1.0f) + bytes(2.0f) + bytes(3.0f) + bytes(0.5f));
  ASSERT_EQ(cloud.points, 1u);
  EXPECT_EQ((*cloud.find("intensity"))[0], 0.5);
  EXPECT_THAT(
      complaint_of("a.bin", "123456789012345"),
      HasSubstr("a.bin: the .bin file has 15 bytes; its size must be a multiple of 16 (float32 x y z intensity); it "
                "may be truncated"));
}

/// Returns a sweep of 16 rings, ring by ring, as the first `columns` of the columns x y z intensity ring time 0.
template <class Number>
std::string sweep_of(std::size_t columns) {
  std::string out;
  for (int ring = 0; ring < 16; ++ring) {
    for (int k = 0; k < 40; ++k) {
      const double azimuth = 0.157 * k, elevation = 0.035 * (ring - 7.5), range = 5.0 + 3.0 * std::sin(2.0 * azimuth);
      const std::array<double, 7> point = {range * std::cos(azimuth),
                                           range * std::sin(azimuth),
                                           range * elevation,
                                           (k * 7 + ring * 5) % 100 / 100.0,
                                           1.0 * ring,
                                           0.0025 * k,
                                           0.0};
      for (std::size_t i = 0; i < columns; ++i) out += bytes(static_cast<Number>(point[i]));
    }
  }
  return out;
}

TEST_F(CloudFile, KittiBinOfOtherColumnsIsRefused) {
  EXPECT_EQ(read("a.bin", sweep_of<float>(4)).points, 640u);
  for (const std::size_t columns : {3u, 5u, 6u, 7u}) {
    EXPECT_THAT(complaint_of("a.bin", sweep_of<float>(columns)),
                AllOf(HasSubstr("a.bin: the numbers match " + std::to_string(columns) +
                                " columns of float32 better than the expected 4 (x y z intensity)"),
                      HasSubstr("--bin-columns to the columns in order")));
  }
  for (const std::size_t columns : {4u, 5u, 6u}) {
    EXPECT_THAT(complaint_of("a.bin", sweep_of<double>(columns)),
                AllOf(HasSubstr("% of the numbers, read as float32, have a magnitude above 1e+07 or below 1e-20; at "
                                "most 1 % may have such a magnitude"),
                      HasSubstr("the numbers match " + std::to_string(columns) + " columns of float64")));
  }
  // with one point more, the size is no multiple of 16 either
  EXPECT_THAT(
      complaint_of("a.bin", sweep_of<float>(5) + sweep_of<float>(5).substr(0, 20)),
      AllOf(HasSubstr("has 12820 bytes; its size must be a multiple of 16"), HasSubstr("5 columns of float32")));
}

TEST_F(CloudFile, ColumnsOfABinFileMayBeNamed) {
  const auto named = [&](const std::string& content, const std::string& columns) {
    fixture::put(folder_ / "a.bin", content);
    return read_cloud(folder_ / "a.bin", columns);
  };
  const Cloud plain = read("a.bin", sweep_of<float>(4));
  for (const auto& [content, columns] : {std::pair{sweep_of<float>(5), "x,y,z,intensity,ring"},
                                         {sweep_of<float>(6), "x,y,z,intensity,_,t"},
                                         {sweep_of<double>(4), "x:f8,y:f8,z:f8,intensity:f8"},
                                         {sweep_of<double>(5), "x:f8,y:f8,z:f8,intensity:f8,ring:f8"}}) {
    const Cloud cloud = named(content, columns);
    ASSERT_EQ(cloud.points, 640u) << columns;
    EXPECT_NEAR((*cloud.find("z"))[639], (*plain.find("z"))[639], 1e-6) << columns;
    const std::vector<double>* const rings = cloud.find("ring");
    EXPECT_TRUE(rings == nullptr || rings->back() == 15.0) << columns;
  }
  // some columns are integers, as some drivers store rings and times
  const Cloud mixed =
      named(bytes(1.0f) + bytes(2.0f) + bytes(3.0f) + bytes(std::uint32_t{70000}) + bytes(std::uint16_t{9}),
            "x,y,z,t:u4,ring:u2");
  EXPECT_EQ((*mixed.find("t"))[0], 70000.0);
  EXPECT_EQ((*mixed.find("ring"))[0], 9.0);
  const auto complaint = [&](const char* columns) {
    return test::complaint([&] { named(sweep_of<float>(5), columns); });
  };
  EXPECT_THAT(complaint("x,y,z,intensity"), "") << "as stated, whatever it looks like";
  EXPECT_THAT(complaint("x,y,intensity"), HasSubstr("'x,y,intensity' lacks the column z"));
  EXPECT_THAT(complaint("x,y,z,x"), HasSubstr("name 'x' is empty or occurs twice"));
  EXPECT_THAT(complaint("x,y,z:f2"), HasSubstr("the type 'f2' must be f4, f8"));
  EXPECT_THAT(complaint("x:f8,y:f8,z:f8"), HasSubstr("has 12800 bytes, but the size must be a multiple of 24"));
}

TEST_F(CloudFile, NoPointsAreNoError) {
  EXPECT_EQ(read("a.bin", "").points, 0u);
  EXPECT_EQ(read("a.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n").points, 0u);
}

TEST_F(CloudFile, WhatAHeaderStatesIsComparedWithTheFile) {
  const std::string tail = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  const auto ply = [&](const std::string& count) {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + count + tail;
  };
  EXPECT_THAT(complaint_of("a.ply", ply("2") + std::string(23, 'x')),
              HasSubstr("a.ply:7: the header states 2 points of at least 12 bytes, but only 23 bytes follow; the file "
                        "may be truncated"));
  EXPECT_EQ(complaint_of("a.ply", ply("2") + std::string(24, 'x')), "");
  EXPECT_THAT(complaint_of("a.ply", ply("4000000000")),
              HasSubstr("a.ply:7: the file states 4000000000 points; at most 67108864"));
  EXPECT_THAT(complaint_of("a.ply", ply("99999999999999999999")),
              HasSubstr("a.ply:3: the header states count of vertex as"));
  EXPECT_THAT(complaint_of("a.ply", ply("-1")),
              HasSubstr("a.ply:3: the header states count of vertex as '-1'; it must be a whole number"));
  EXPECT_THAT(complaint_of("a.ply", kAsciiPly + "1 2 3\n"), HasSubstr("the file may be truncated"));
  const auto pcd = [](const std::string& width, const std::string& data) {
    return "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + width + "\nHEIGHT 1\nPOINTS " + width +
           "\nDATA " + data + "\n";
  };
  EXPECT_THAT(complaint_of("a.pcd", pcd("3", "binary") + std::string(35, 'x')),
              HasSubstr("a.pcd:8: the header states 3 points of at least 12 bytes, but only 35 bytes follow"));
  EXPECT_THAT(complaint_of("a.pcd", pcd("60000000", "binary_compressed") + std::string(100, 'x')),
              HasSubstr("a.pcd:8"));
  EXPECT_THAT(complaint_of("a.pcd", pcd("5000000000", "binary")),
              HasSubstr("WIDTH states 5000000000; it must state at most"));
  EXPECT_THAT(complaint_of("a.pcd", pcd("1", "zip")), HasSubstr("DATA is 'zip'"));
}

// opening a pipe for reading would wait for a writer
TEST_F(CloudFile, APipeIsRefusedAndNotWaitedFor) {
  for (const char* name : {"pipe.ply", "pipe.pcd", "pipe.bin", "pipe.vtk"}) {
    ASSERT_EQ(mkfifo((folder_ / name).c_str(), 0600), 0);
    EXPECT_THAT(test::complaint([&] { read_cloud(folder_ / name); }),
                HasSubstr(std::string(name) + ": is a pipe; it must be a regular file"));
  }
}

TEST_F(CloudFile, DamageIsOneClearLine) {
  EXPECT_THAT(test::complaint([&] { read_cloud(folder_ / "none.ply"); }), HasSubstr("none.ply: no such file"));
  EXPECT_THAT(test::complaint([&] { read_cloud(folder_ / "a.las"); }),
              HasSubstr("must end in .ply, .pcd, .vtk or .bin"));
  EXPECT_THAT(complaint_of("a.ply", ""), HasSubstr("a.ply:0: the file ends within its header"));
  EXPECT_THAT(complaint_of("a.ply", "plyy\n"), HasSubstr("a.ply:1: the file does not begin with 'ply'"));
  EXPECT_THAT(complaint_of("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n"),
              HasSubstr("ends within its header; it may be truncated"));
  EXPECT_THAT(complaint_of("a.ply", "ply\nformat ascii 1.0\nend_header\n"), HasSubstr("the file has no points"));
  EXPECT_THAT(complaint_of("a.ply", "ply\nelement vertex 1\nproperty quad x\nend_header\n"),
              HasSubstr("a.ply:3: unknown type"));
  EXPECT_THAT(complaint_of("a.ply", "ply\nelement vertex 1\nproperty list uchar int x\nend_header\n"),
              HasSubstr("list"));
  EXPECT_THAT(complaint_of("a.ply", "ply\n" + std::string(70000, 'c') + "\n"),
              HasSubstr("longer than the maximum of 65536 bytes"));
  EXPECT_THAT(complaint_of("a.pcd", "FIELDS x\nDATA ascii\n"), HasSubstr("the header has no line SIZE"));
  EXPECT_THAT(complaint_of("a.pcd", "FIELDS x y\nSIZE 4\nTYPE F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n"),
              HasSubstr("SIZE has 1 words"));
}

// a header may state more than the body contains: no byte of a truncated file may be invented, wherever the file ends
TEST_F(CloudFile, EveryCutOfAFileIsNoticed) {
  std::string whole =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  for (int i = 0; i < 9; ++i) whole += bytes(static_cast<float>(i));
  ASSERT_EQ(complaint_of("a.ply", whole), "");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THAT(complaint_of("a.ply", whole.substr(0, size)), HasSubstr("a.ply:")) << size;
  }
}

}  // namespace
}  // namespace tumble::scenarios
