// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/python_method.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdlib>

#include "scenarios/draw/strict_yaml.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/command_run.hpp"
#include "scenarios/methods/external_method.hpp"
#include "scenarios/methods/python_exchange.hpp"
#include "scenarios/methods/python_runner.hpp"
#include "scenarios/recordings/scratch_folder.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kVersions = R"(
import sys
try:
    import numpy
except ImportError:
    sys.exit(sys.executable + " has no numpy, which a Python method needs: install numpy, or "
             "name another Python with the key `interpreter:` or with $TUMBLE_PYTHON")
print("Python", sys.version.split()[0] + ", numpy", numpy.__version__)
)";

Command interpreter(const ExternalDescription& description, const ScratchFolder& scratch,
                    const std::vector<std::string>& words) {
  Command command{.words = description.interpreter,
                  .folder = scratch.path(),
                  .environment = description.environment,
                  .transcript = scratch.path() / "transcript.txt",
                  .time_limit_s = description.time_limit_s,
                  .memory_limit_mib = description.memory_limit_mib};
  const char* own = std::getenv("TUMBLE_PYTHON");
  if (command.words.empty()) command.words = {own != nullptr && *own != '\0' ? own : "python3"};
  command.environment.emplace("PYTHONDONTWRITEBYTECODE", "1");  // no __pycache__ at the user's file
  command.words.insert(command.words.end(), words.begin(), words.end());
  return command;
}

}  // namespace

Estimate call_python(const ExternalDescription& description, const sim::Sensors& sensors, std::string& transcript) {
  SharedMemory given("tumble-sensors"), answer("tumble-answer");
  write_sensors(sensors, given);
  const ScratchFolder scratch("method");
  Command command =
      interpreter(description, scratch,
                  {"-c", kPythonRunner, description.python.string(), description.function, to_string(description.kind),
                   std::to_string(given.descriptor()), std::to_string(answer.descriptor())});
  command.descriptors = {given.descriptor(), answer.descriptor()};
  return without_folder(scratch.path(), [&] {
    const CommandEnd end = run_command(command);
    transcript = end.transcript;
    require_done(end);
    return read_answer(answer, description.kind, description.frame, sensors);
  });
}

std::string python_version(const ExternalDescription& description) {
  const ScratchFolder scratch("method");
  const std::string said =
      reported_version(interpreter(description, scratch, {"-c", kVersions}), description.file.string() + ": ");
  const std::string text = read_text_file(description.python);
  return fmt::format("{}; {} {:016x}", said, description.python.filename().string(),
                     XXH3_64bits(text.data(), text.size()));
}

}  // namespace tumble::scenarios
