// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/provenance/data_digest.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "scenarios/provenance/hasher.hpp"

namespace tumble::scenarios {

std::string data_digest(const DataRoot& data) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& folder : {data.models(), data.catalogue(), data.regressions()}) {
    std::error_code error;
    for (std::filesystem::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->is_regular_file()) files.push_back(entry->path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const std::filesystem::path& path : files) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    texts.push_back(std::filesystem::relative(path, data.root).string());
    texts.push_back(text.str());
  }
  return digest_of_texts(texts);
}

std::string digest_of_texts(std::span<const std::string> texts) {
  Hasher hasher;
  for (const std::string& text : texts) hasher.text(text);
  return hasher.hex();
}

}  // namespace tumble::scenarios
