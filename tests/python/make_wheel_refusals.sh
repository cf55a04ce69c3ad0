#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What python/make_wheel refuses, before it makes or deletes anything: status 2, one line that says why.
#   make_wheel_refusals.sh SOURCES
set -euo pipefail
export LC_ALL=C  # mkdir's words
make_wheel=$1/python/make_wheel
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# expects WHAT-IT-SAYS ARGUMENTS...
expects() {
  local said=$1 status=0 text
  shift
  text=$("$make_wheel" "$@" 2>&1) || status=$?
  [ "$status" = 2 ] && [[ $text = *"$said"* ]] && return
  printf 'make_wheel %s: status %s, must be 2 with "%s":\n%s\n' "$*" "$status" "$said" "$text" >&2
  exit 1
}
# an interpreter of this version that makes no environments
interpreter() {
  printf '#!/bin/sh\ncase "$2" in *version_info*) echo "Python 3.%s" ;; *) exit 1 ;; esac\n' "$2" >"$1"
  chmod +x "$1"
}

for wrong in "" --help "a b c"; do
  [ -n "$wrong" ] && read -ra arguments <<<"$wrong" || arguments=("")
  expects 'Source distribution and wheel' "${arguments[@]}"
done
expects 'Source distribution and wheel'
mkdir -p foreign/dist
touch foreign/dist/precious file
expects 'foreign is not empty and not of an earlier make_wheel' foreign
[ -e foreign/dist/precious ]
expects 'File exists' file
expects 'Not a directory' file/below
expects '/nonexistent is no Python that runs' new /nonexistent
expects '/bin/ls is no Python that runs' new /bin/ls
expects '/bin/echo is no Python that runs' new /bin/echo
interpreter old 10
expects 'is Python 3.10, must be 3.11 or later' new ./old
interpreter bare 12
expects 'its modules venv and ensurepip are missing' new ./bare
mkdir -p earlier/tools/bin
touch earlier/.make_wheel
interpreter earlier/tools/bin/python 99
expects 'for another Python (Python 3.99' earlier
# nothing was made where it refused
[ ! -e new ] && [ "$(ls -A earlier)" = $'.make_wheel\ntools' ]

# and it is no refusal of everything: an empty folder, or one of its own, gets as far as the tools, which this interpreter lacks
mkdir empty
printf '#!/bin/sh\ncase "$2" in *version_info*) echo "Python 3.12" ;; venv) exit 7 ;; esac\n' >stops
chmod +x stops
for fine in empty empty; do
  status=0
  "$make_wheel" "$fine" ./stops || status=$?
  [ "$status" = 7 ] || { printf 'make_wheel %s: status %s, must get as far as the environment\n' "$fine" "$status" >&2; exit 1; }
done
