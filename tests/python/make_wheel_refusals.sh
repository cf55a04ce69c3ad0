#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests that python/make_wheel rejects invalid arguments before it writes or deletes anything: status 2 and one line with the reason.
#   make_wheel_refusals.sh SOURCES
set -euo pipefail
export LC_ALL=C  # English messages of mkdir
make_wheel=$1/python/make_wheel
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# expects MESSAGE ARGUMENTS... checks that make_wheel rejects the arguments with this message
expects() {
  local said=$1 status=0 text
  shift
  text=$("$make_wheel" "$@" 2>&1) || status=$?
  [ "$status" = 2 ] && [[ $text = *"$said"* ]] && return
  printf 'make_wheel %s: status %s, must be 2 with "%s":\n%s\n' "$*" "$status" "$said" "$text" >&2
  exit 1
}
# writes a fake interpreter of this version that cannot create environments
interpreter() {
  printf '#!/bin/sh\ncase "$2" in *version_info*) echo "Python 3.%s" ;; *) exit 1 ;; esac\n' "$2" >"$1"
  chmod +x "$1"
}

for wrong in "" --help "a b c"; do
  [ -n "$wrong" ] && read -ra arguments <<<"$wrong" || arguments=("")
  expects 'Builds the source distribution' "${arguments[@]}"
done
expects 'Builds the source distribution'
mkdir -p foreign/dist
touch foreign/dist/precious file
expects 'foreign is not empty and was not created by make_wheel' foreign
[ -e foreign/dist/precious ]
expects 'File exists' file
expects 'Not a directory' file/below
expects '/nonexistent does not run as a Python interpreter' new /nonexistent
expects '/bin/ls does not run as a Python interpreter' new /bin/ls
expects '/bin/echo does not run as a Python interpreter' new /bin/echo
interpreter old 10
expects 'is Python 3.10, must be 3.11 or later' new ./old
interpreter bare 12
expects 'its modules venv and ensurepip are missing' new ./bare
mkdir -p earlier/tools/bin
touch earlier/.make_wheel
interpreter earlier/tools/bin/python 99
expects 'for another Python (Python 3.99' earlier
# a rejected call wrote nothing
[ ! -e new ] && [ "$(ls -A earlier)" = $'.make_wheel\ntools' ]

# negative control: an empty folder or a folder of an earlier call passes the checks, and then this interpreter fails
mkdir empty
printf '#!/bin/sh\ncase "$2" in *version_info*) echo "Python 3.12" ;; venv) exit 7 ;; esac\n' >stops
chmod +x stops
for fine in empty empty; do
  status=0
  "$make_wheel" "$fine" ./stops || status=$?
  [ "$status" = 7 ] || { printf 'make_wheel %s: status %s, must get as far as the environment\n' "$fine" "$status" >&2; exit 1; }
done
