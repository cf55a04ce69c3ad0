// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/keep.hpp"
#include "scenarios/sweep/run_again.hpp"

namespace tumble::scenarios {

namespace {

namespace fs = std::filesystem;

using Notes = std::map<std::string, std::string>;

std::string text_of(const Notes& notes, const std::string& key) {
  const auto found = notes.find(key);
  return found == notes.end() ? std::string() : found->second;
}

void require_same_origin(const Notes& first, const Notes& other, const fs::path& path) {
  const std::pair<const char*, const char*> origins[] = {{"build", "program build"},
                                                         {"data", "digest of models and scenarios"}};
  for (const auto& [key, words] : origins) {
    if (text_of(first, key) == text_of(other, key)) continue;
    throw BadInput(fmt::format(
        "{}: the {} of this database is '{}', but '{}' in the first database; to join the databases anyway, "
        "set --mixed-builds",
        path.string(), words, text_of(other, key), text_of(first, key)));
  }
}

void join_method_notes(const Notes& shard, const fs::path& path, bool mixed, Results& into) {
  for (const auto& [key, theirs] : shard) {
    if (!is_method_note(key)) continue;
    const std::string known = into.note(key);
    if (!known.empty() && known != theirs && !mixed)
      throw BadInput(
          fmt::format("{}: {} is '{}', but '{}' in another database; to join the databases anyway, set --mixed-builds",
                      path.string(), key, theirs, known));
    into.set_note(key, known.empty() || known == theirs ? theirs : "mixed");
  }
}

void join_place_notes(const Notes& shard, Results& into) {
  for (const auto& [key, place] : shard) {
    if (is_place_note(key) && into.note(key).empty()) into.set_note(key, place);
  }
}

void join_command_notes(const std::vector<Notes>& notes, Results& into) {
  std::string commands = into.note(kCommandNote);
  for (const Notes& own : notes) commands = with_commands(commands, text_of(own, kCommandNote));
  if (!commands.empty()) into.set_note(kCommandNote, commands);
}

std::vector<Notes> checked_notes(std::span<const fs::path> in, bool mixed) {
  std::vector<Notes> notes;
  for (const fs::path& path : in) {
    notes.push_back(Results(path, Results::Mode::read_only).notes());
    if (!mixed) require_same_origin(notes.front(), notes.back(), path);
  }
  return notes;
}

std::string common_rule(const std::vector<Notes>& notes) {
  const std::string rule = text_of(notes.front(), kKeepNote);
  const auto is_it = [&](const Notes& each) { return text_of(each, kKeepNote) == rule; };
  return std::all_of(notes.begin(), notes.end(), is_it) ? rule : std::string();
}

}  // namespace

MergeCounts merge_results(const DatabaseOwner& owner, std::span<const fs::path> in, bool mixed) {
  const fs::path& out = owner.database();
  require_not_an_input(out, in);
  const std::vector<Notes> notes = checked_notes(in, mixed);
  const bool exists = fs::exists(out);
  const Notes own = exists ? Results(out, Results::Mode::create_or_append).notes() : Notes();
  if (exists && !mixed && !notes.empty() && !text_of(own, "data").empty()) require_same_origin(notes.front(), own, out);
  OutputFile file(out);
  if (exists) fs::copy_file(out, file.unfinished(), fs::copy_options::overwrite_existing);
  MergeCounts counts;
  {
    Results results(file.unfinished(), Results::Mode::join);
    if (!mixed && !notes.empty() && !results.has_rows()) results.set_note(kKeepNote, common_rule(notes));
    for (std::size_t i = 0; i < in.size(); ++i) {
      results.absorb(Results(in[i], Results::Mode::read_only), mixed, counts);
      join_method_notes(notes[i], in[i], mixed, results);
    }
    for (const Notes& each : notes) join_place_notes(each, results);
    join_command_notes(notes, results);
    for (const char* key : {"suite", "build", "data"}) {
      std::string text;
      for (std::size_t i = 0; i < notes.size() && text.empty(); ++i) text = text_of(notes[i], key);
      if (!text.empty()) results.set_note(key, mixed && std::string_view(key) == "build" ? kMixedBuilds : text);
    }
  }
  file.move_into_place();
  return counts;
}

}  // namespace tumble::scenarios
