// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

/// An example is one simulated run with pictures and plots, which a sweep (many simulated runs) creates next to its
/// results database.
namespace tumble::tools {

inline constexpr int kTruthColour = -1;

/// `x` and `y` are parallel; NaN marks a gap in the line.
struct PlotLine {
  std::string name;
  int colour = kTruthColour;
  double width = 1.8;  ///< line width [pixels]
  bool dotted = false;
  bool hidden = false;  ///< hidden until clicked in the legend
  std::vector<double> x, y;
};

struct Plot {
  std::string name;  ///< for example "path"; unique within the example
  std::string caption;
  std::string x_title, y_title;                   ///< titles of the axes, with unit
  bool equal_scales = false;                      ///< for a path seen from above
  bool from_zero = false;                         ///< the y axis includes 0
  bool over_time = false;                         ///< hovering shows all lines
  bool wide = true;                               ///< false: two plots share a row
  std::vector<std::pair<double, double>> shaded;  ///< shaded intervals of x
  std::vector<PlotLine> lines;
};

struct ExamplePicture {
  std::string name;  ///< for example "scene"; unique within the example
  std::string alternative, caption;
  std::vector<std::pair<std::string, int>> legend;  ///< name and colour index
  std::vector<std::uint8_t> png;
};

struct Example {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string motion;       ///< "tumble" or "roll"
  std::string choice;       ///< reason, in one sentence
  bool of_failure = false;  ///< shown with the failures
  std::string recording_digest, digest_without_lidars;
  std::string made_of;  ///< digest of the shown results
  std::vector<ExamplePicture> pictures;
  std::vector<Plot> plots;
  std::vector<std::uint8_t> moving;  ///< animated WebP; empty if absent
  std::string moving_caption;        ///< for example "2.5 s of it at half speed"
  std::string replay;                ///< file name; empty if absent
  std::string replay_page;           ///< HTML of the replay page
};

std::filesystem::path examples_folder(const std::filesystem::path& database);

std::string to_json(const Example& example);

void write_pictures(const std::filesystem::path& folder, const Example& example);

void discard_unfinished(const std::filesystem::path& folder);

std::string replay_file(const Example& example);

void write_examples(const std::filesystem::path& folder, const std::vector<std::string>& examples);

enum class Pictures { read, left_out };
struct FoundExamples {
  std::vector<Example> examples;        ///< in the order of the list
  std::vector<std::string> unreadable;  ///< path and reason
};
FoundExamples read_examples(const std::filesystem::path& folder, Pictures pictures);

std::filesystem::path set_damaged_aside(const std::filesystem::path& folder);

}  // namespace tumble::tools
