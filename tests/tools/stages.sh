#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests, with fake cmake and ctest, that tools/test runs all stages even if one fails, and reports the failure with its
# exit status.
#   stages.sh TREE
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch/tools" "$scratch/bin"
cp "$1/tools/test" "$scratch/tools/test"

stand_in() { printf '#!/bin/sh\necho "%s $*" >> "%s/called"\n%s\n' "$1" "$scratch" "$2" > "$scratch/$1"; chmod +x "$scratch/$1"; }
stand_in tools/setup 'exit 0'
stand_in tools/lint '[ "${FAILING:-}" != lint ]'
stand_in tools/docs '[ "${FAILING:-}" != docs ]'
stand_in bin/ctest '[ "${FAILING:-}" != ctest ]'
# the fake cmake fails for the target in FAILING
stand_in bin/cmake 'case "$*" in *"--build --preset ${FAILING:-none} "*) exit 1 ;; esac'

# outcome FAILING ARGUMENT... prints the last lines of tools/test, then "exit STATUS"
outcome() {
  local failing=$1; shift
  local status=0
  rm -f "$scratch/called"
  FAILING=$failing PATH=$scratch/bin:$PATH "$scratch/tools/test" "$@" > "$scratch/said" 2>&1 || status=$?
  sed -n '/seconds processor/,$s/^test: \([a-z]*\)[ 0-9]*\(.*\)/\1 \2/p' "$scratch/said" | tail -n +2
  echo "exit $status"
}
expect() {
  [ "$2" = "$3" ] && return
  printf 'stages: %s\nexpected:\n%s\nfound:\n%s\n' "$1" "$3" "$2" >&2
  exit 1
}
lines() { printf '%s\n' "$@"; }

expect 'all pass' "$(outcome none --all)" "$(lines 'build passed' 'tests passed' 'long passed' \
  'cluster passed' 'sanitize passed' 'threads passed' 'fuzz passed' 'lint passed' 'arch passed' 'bench passed' 'exit 0')"
expect 'one fails, the others run' "$(outcome threads --all --from sanitize)" "$(lines 'sanitize passed' 'threads FAILED' \
  'fuzz passed' 'lint passed' 'arch passed' 'bench passed' 'failed : threads' 'exit 1')"
expect 'no release build: nothing is tested in it' "$(outcome release --all | grep -c 'not run: no build')" 4
expect 'as CI runs it' "$(outcome none)" "$(lines 'build passed' 'tests passed' 'exit 0')"
expect 'as CI runs it, a build that fails' "$(outcome release)" "$(lines 'build FAILED' 'tests not run: no build' \
  'failed : build tests' 'exit 1')"
expect 'an unknown stage' "$(outcome none --all --from nowhere)" 'exit 2'
expect 'a stage without --all' "$(outcome none --from long)" 'exit 2'
expect 'two stages as one' "$(outcome none --all --from 'tests long')" 'exit 2'
expect 'a test that fails' "$(outcome ctest --all --from long)" "$(lines 'long FAILED' 'cluster FAILED' 'sanitize FAILED' 'threads FAILED' 'fuzz FAILED' \
  'lint passed' 'arch FAILED' 'bench FAILED' 'failed : long cluster sanitize threads fuzz arch bench' 'exit 1')"
expect 'a finding of the linter' "$(outcome lint --all --from lint)" "$(lines 'lint FAILED' 'arch passed' 'bench passed' 'failed : lint' 'exit 1')"
expect 'a warning of Doxygen' "$(outcome docs --all --from lint)" "$(lines 'lint FAILED' 'arch passed' 'bench passed' 'failed : lint' 'exit 1')"
outcome none --all > /dev/null
jobs=$(nproc)
expect 'what was asked of CTest and the linter' "$(grep -E '^(bin/ctest|tools/lint|tools/docs)' "$scratch/called")" "$(lines \
  "bin/ctest --preset release -j $jobs -LE bench|browser|soak|peers|python|ros|cluster|threads|fuzz" "bin/ctest --preset release -j $jobs -L ^(browser|soak|peers|python|ros)\$" "bin/ctest --preset release -j $jobs -L cluster -j 1" \
  "bin/ctest --preset sanitize -j $jobs -L ^(fast|sim|methods)\$" "bin/ctest --preset threads -j $jobs -L threads" \
  "bin/ctest --preset sanitize -j $jobs -L fuzz" 'tools/lint --all' 'tools/docs ' \
  "bin/ctest --test-dir build/aarch64 -j $jobs --output-on-failure" "bin/ctest --preset release -j $jobs -L bench -j 1")"
