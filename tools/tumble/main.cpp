// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <cstdio>

#include "scenarios/recordings/unfinished.hpp"
#include "tools/tumble/program.hpp"

int main(int argc, char** argv) {
  // a file-size limit shall fail the write, with its one clear line, and not end the program by a signal
  std::signal(SIGXFSZ, SIG_IGN);
  // an interrupted verb leaves nothing that is half done
  tumble::scenarios::remove_unfinished_on_signals();
  return tumble::tools::run_program(argc, argv);
}
