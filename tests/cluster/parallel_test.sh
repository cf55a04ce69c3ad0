#!/usr/bin/env bash
# Runs the command of tools/parallel/README.md and kills one of its three shards. The same command must resume the
# shard, and the merged database must equal that of one undisturbed sweep. Needs GNU parallel (tools/setup --for
# cluster); exits with 77 without it.
#   parallel_test.sh SOURCE_TREE PROGRAM
set -euo pipefail
root=$1 program=$2
command -v parallel >/dev/null || { echo "skipped: no parallel; tools/setup --for cluster"; exit 77; }

folder=$(mktemp -d /tmp/tumble_parallel_XXXXXX)
running=''
say() { printf 'parallel_test: %s\n' "$*"; }
finish() {
  local status=$?
  [ -z "$running" ] || kill -TERM "$running" 2>/dev/null || true
  [ "$status" -eq 0 ] || tail -n 20 "$folder/log" "$folder"/*.out 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
export TUMBLE_CACHE=${TUMBLE_CACHE:-$folder/cache} PARALLEL_HOME=$folder/settings
mkdir -p "$folder/settings" "$folder/shards"
touch "$folder/settings/will-cite"
same() { python3 "$root/tests/cluster/same_results.py" "$folder/whole.db" "$1" 18; }

# draws of a rolling sphere, which take a second each
words=(roll --seeds 1..18 --method rate/raw --method rolling --keep worst:2 --examples 0 --quiet)
say "one sweep, undisturbed"
"$program" sweep "${words[@]}" --jobs 2 --db "$folder/whole.db" >/dev/null

shards() {
  parallel --jobs 2 --joblog "$folder/log" --resume-failed \
    "$program" sweep "${words[@]}" --shard {}/3 --jobs 1 --db "$folder/shards/{}.db" ::: 1 2 3
}
say "three shards, one of which is killed"
shards > "$folder/first.out" 2>&1 & running=$!
victim=''
for _ in $(seq 600); do
  # waits until the shard has stored an outcome, and its lock file contains the process id
  lock=$folder/shards/2.db.lock
  if [ -s "$lock" ] && python3 -c "
import sqlite3, sys
sys.exit(0 if sqlite3.connect('file:$folder/shards/2.db?mode=ro', uri=True).execute('SELECT count(*) FROM outcomes').fetchone()[0] else 1)
" 2>/dev/null; then
    victim=$(awk '{ print $2 }' "$lock")
    break
  fi
  sleep 0.1
done
[ -n "$victim" ] || { say "the shard was not caught at work"; exit 1; }
kill -KILL "$victim"
status=0
wait "$running" || status=$?
running=''
[ "$status" = 1 ] || { say "parallel says $status, must be 1: the shards that have failed"; exit 1; }
"$program" merge "$folder/part.db" "$folder"/shards/*.db --quiet >/dev/null
! same "$folder/part.db" 2>/dev/null || { say "the killed shard was whole: the test says nothing"; exit 1; }

say "the same command again"
shards > "$folder/second.out" 2>&1
[ "$(awk '$7 != 0 || $8 != 0 { failed[$1] } END { for (s in failed) print s }' <(tail -n +2 "$folder/log"))" = 2 ] ||
  { say "another shard than the killed one had failed"; exit 1; }
[ "$(tail -n +2 "$folder/log" | wc -l)" = 4 ] || { say "a shard that was whole ran again"; exit 1; }
"$program" merge "$folder/out.db" "$folder"/shards/*.db --quiet >/dev/null
same "$folder/out.db"
diff -r "$folder/whole.db.files/kept" "$folder/out.db.files/kept"
say "and the same recordings kept"
