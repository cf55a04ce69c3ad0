// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <cstdio>

#include "scenarios/recordings/unfinished.hpp"
#include "tools/tumble/program.hpp"

int main(int argc, char** argv) {
  // A write beyond the file-size limit must cause an error message and not end the program.
  std::signal(SIGXFSZ, SIG_IGN);
  tumble::scenarios::remove_unfinished_on_signals();
  return tumble::tools::run_program(argc, argv);
}
