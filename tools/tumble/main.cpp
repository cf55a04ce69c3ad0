// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <cstdio>

#include "tools/tumble/program.hpp"

int main(int argc, char** argv) {
  // a file-size limit shall fail the write, with its one clear line, and not end the program by a signal
  std::signal(SIGXFSZ, SIG_IGN);
  return tumble::tools::run_program(argc, argv);
}
