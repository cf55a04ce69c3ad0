#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests which arguments tools/slurm/submit passes to a fake sbatch, and which it rejects. tests/cluster uses the real
# Slurm.
#   slurm_submit.sh TREE
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
printf '#!/bin/sh\necho "$*" >> "%s/called"\necho 7\n' "$scratch" > "$scratch/bin/sbatch"
printf '#!/bin/sh\n' > "$scratch/bin/tumble"
chmod +x "$scratch/bin"/*
export PATH=$scratch/bin:$PATH
db=$scratch/out.db

fail() { printf 'slurm_submit: %s\n' "$1" >&2; cat "$scratch/said" >&2; exit 1; }
# submits ARGUMENT... checks that the script submits both jobs
submits() {
  rm -f "$scratch/called"
  "$1/tools/slurm/submit" "${@:2}" > "$scratch/said" 2>&1 || fail "refused: ${*:2}"
  [ "$(wc -l < "$scratch/called")" = 2 ] || fail 'not two jobs'
}
# refuses WORDS ARGUMENT... checks that the script exits with 2 and this message, and submits nothing
refuses() {
  local status=0
  rm -f "$scratch/called"
  "$1/tools/slurm/submit" "${@:3}" > "$scratch/said" 2>&1 || status=$?
  [ "$status" = 2 ] || fail "status $status of: ${*:3}"
  grep -q -- "$2" "$scratch/said" || fail "does not say '$2'"
  [ ! -e "$scratch/called" ] || fail 'sent all the same'
}

submits "$1" roll --db "$db" --shards 3 -- --seeds 1..18 --method rate/raw
grep -q -- '--array=1-3 ' "$scratch/called" && grep -q -- '--dependency=afterok:7 ' "$scratch/called" || fail 'not an array and what follows it'
submits "$1" roll --db "$db" --shards 4 -- --seeds 1..18 --method rate/raw  # no shard has copied results
touch "$db.shards/shard_1.db"
submits "$1" roll --db "$db" --shards 4 -- --seeds 1..18 --method rate/raw  # resumes
refuses "$1" 'shards of another sweep: roll --shards 4 --seeds 1..18 --method rate/raw' roll --db "$db" --shards 4 -- --seeds 1..36 --method rate/raw
refuses "$1" 'shards of another sweep' roll --db "$db" --shards 3 -- --seeds 1..18 --method rate/raw
refuses "$1" 'shards of another sweep' slip --db "$db" --shards 4 -- --seeds 1..18 --method rate/raw
refuses "$1" 'SUITE is missing' --db "$db"
refuses "$1" 'whole numbers from 1' roll --db "$db" --shards 0
refuses "$1" 'needs all earlier draws' roll --db "$db" -- --until a:b:c
refuses "$1" 'submit sets this option' roll --db "$db" -- --shard 1/2
refuses "$1" 'was not found' roll --db "$db" --program "$scratch/none"
refuses "$1" 'one argument too many' roll slip --db "$db"
