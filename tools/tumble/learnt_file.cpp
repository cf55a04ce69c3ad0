// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/learnt_file.hpp"

#include <utility>

#include "scenarios/errors.hpp"

namespace tumble::tools {

LearntFile::LearntFile(std::filesystem::path path) : path_(std::move(path)) {
  if (path_.empty() || !std::filesystem::exists(path_)) return;
  if (!std::filesystem::is_regular_file(path_)) throw scenarios::BadInput(path_.string() + ": --learnt is no file");
  learning_.given = scenarios::read_learnt_rig(path_);
}

std::string LearntFile::learning_methods() {
  std::string names;
  for (const scenarios::Method& method : scenarios::methods()) {
    if (method.info.learns_rig) names += (names.empty() ? "'" : ", '") + full_name(method.info) + "'";
  }
  return names;
}

scenarios::Method LearntFile::wrap(const scenarios::Method& method) {
  return path_.empty() || !method.info.learns_rig ? method : scenarios::learning_method(method, learning_);
}

void LearntFile::keep(const Session& session) const {
  if (path_.empty()) return;
  if (learning_.found() != nullptr) return scenarios::write_learnt_rig(path_, *learning_.found());
  session.note(path_.string() + (std::filesystem::exists(path_) ? ": stays as it is" : ": not written") +
               ": nothing was learnt of the rig, which was held to what was known before: no free flight or contact "
               "told more of it, or the run failed");
}

}  // namespace tumble::tools
