// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

/// A single draw as people are shown it: pictures and plots, made by a sweep and left beside its database. What is in
/// them is decided where they are made; whoever shows them need not know.
namespace tumble::tools {

/// Of the truth, or of the index-th method of a picture or plot (pictures/colours.hpp).
inline constexpr int kTruthColour = -1;

/// One line of a plot; x and y are parallel, NaN is a gap.
struct PlotLine {
  std::string name;
  int colour = kTruthColour;
  double width = 1.8;  ///< pixels
  bool dotted = false;
  bool hidden = false;  ///< until the reader asks for it in the legend
  std::vector<double> x, y;
};

struct Plot {
  std::string name;  ///< "path": unique within its example
  std::string caption;
  std::string x_title, y_title;                   ///< with unit
  bool equal_scales = false;                      ///< of both axes: a path seen from above
  bool from_zero = false;                         ///< the y axis holds 0
  bool over_time = false;                         ///< all lines are read at one x
  bool wide = true;                               ///< a row of its own; else two in a row
  std::vector<std::pair<double, double>> shaded;  ///< spans of x
  std::vector<PlotLine> lines;
};

struct ExamplePicture {
  std::string name;  ///< "scene": unique within its example
  std::string alternative, caption;
  std::vector<std::pair<std::string, int>> legend;  ///< name, colour
  std::vector<std::uint8_t> png;
};

struct Example {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string motion;       ///< what the draw is one of: "tumble", "roll"
  std::string choice;       ///< why this draw: one sentence
  bool of_failure = false;  ///< one picture and a replay, shown where the draw's failures are told
  std::string recording_digest, digest_without_lidars;
  std::string made_of;  ///< digest of the rows of the results that it shows
  std::vector<ExamplePicture> pictures;
  std::vector<Plot> plots;
  std::vector<std::uint8_t> moving;  ///< a WebP that plays a part of it; empty: there is none
  std::string moving_caption;        ///< "2.5 s of it at half speed"
  std::string replay;       ///< name of the file of its replay, which stands beside the list; "": there is none
  std::string replay_page;  ///< what is in it; not read back
};

/// Where the examples of a results database stand: FILE.db.files.
std::filesystem::path examples_folder(const std::filesystem::path& database);

/// One example as text, its pictures by the names of their files (README.md).
std::string to_json(const Example& example);

/// Writes the pictures of an example, SCENARIO-SEED-NAME.png, what moves, SCENARIO-SEED-moving.webp, and its replay,
/// SCENARIO-SEED-replay.html, where they wait for the list: FOLDER/.unfinished. Throws BadInput.
void write_pictures(const std::filesystem::path& folder, const Example& example);

/// Removes the pictures that no list came to name.
void discard_unfinished(const std::filesystem::path& folder);

/// The name of the file of an example's replay.
std::string replay_file(const Example& example);

/// Joins what `to_json` gave into the folder's list, then moves its unfinished pictures into place and removes the
/// pictures that the list before had and this one has not. Throws BadInput.
void write_examples(const std::filesystem::path& folder, const std::vector<std::string>& examples);

enum class Pictures { read, left_out };
struct FoundExamples {
  std::vector<Example> examples;        ///< in the order of the list
  std::vector<std::string> unreadable;  ///< of the list or of one example: path and reason
};
/// None where there is no list. What cannot be read costs the others nothing: not such a list, one that is cut off (the
/// examples before the cut are found), a picture that is missing, a name that leads out of the folder.
FoundExamples read_examples(const std::filesystem::path& folder, Pictures pictures);

/// Keeps a copy of a list that cannot be read, or not whole, before another is written: examples.json.damaged. Returns
/// its path.
std::filesystem::path set_damaged_aside(const std::filesystem::path& folder);

}  // namespace tumble::tools
