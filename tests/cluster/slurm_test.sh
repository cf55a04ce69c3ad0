#!/usr/bin/env bash
# Runs tools/slurm/submit on three nodes of one machine and kills one node with all its processes. The result must equal
# that of one undisturbed sweep. Needs root, Debian's slurm-wlm and munge (tools/setup --for cluster); exits with 77
# without them.
#   slurm_test.sh SOURCE_TREE PROGRAM
set -euo pipefail
root=$1 program=$2
for command in slurmctld slurmd munged sbatch; do
  command -v "$command" >/dev/null || { echo "skipped: no $command; tools/setup --for cluster"; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "skipped: slurmd needs root"; exit 77; }

folder=$(mktemp -d /tmp/tumble_slurm_XXXXXX)
declare -A node
killed=0
others=()
say() { printf 'slurm_test: %s\n' "$*"; }
# Prints the processes of a node. Their environment names the node, but the environment of their parent, slurmstepd,
# does not
processes_of() {
  local file pid parent said
  for file in /proc/[0-9]*/environ; do
    said=$(tr '\0' '\n' 2>/dev/null < "$file" | grep -cx -e "SLURMD_NODENAME=$1" -e "SLURM_CONF=$SLURM_CONF") || true
    [ "$said" = 2 ] || continue
    pid=${file#/proc/}; pid=${pid%/environ}
    echo "$pid"
    parent=$(ps -o ppid= -p "$pid" | tr -d ' ') || continue
    [ "$(ps -o comm= -p "$parent")" != slurmstepd ] || echo "$parent"
  done
}
# kills the daemon of a node, its steps and all processes of the steps
kill_node() {
  local all
  all=$(processes_of "$1")
  kill -KILL "${node[$1]}" $all 2>/dev/null || true
  wait "${node[$1]}" 2>/dev/null || true
  unset "node[$1]"
  killed=$(wc -w <<< "$all")
}
finish() {
  local status=$?
  for name in "${!node[@]}"; do kill_node "$name"; done
  for pid in "${others[@]}"; do kill -KILL "$pid" 2>/dev/null || true; done
  [ "$status" -eq 0 ] || tail -n 20 "$folder"/*.log "$folder"/*/logs/*.log 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT

dd if=/dev/urandom of="$folder/key" bs=1024 count=1 status=none
chmod 400 "$folder/key"
chmod 755 "$folder"
export SLURM_CONF=$folder/slurm.conf
port=$((20000 + $$ % 20000))
host=$(hostname -s)
cat > "$SLURM_CONF" <<END
ClusterName=tumble
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
SlurmUser=root
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SlurmdTimeout=15
JobRequeue=1
ReturnToService=2
MpiDefault=none
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd_%n.pid
SlurmdSpoolDir=$folder/spool_%n
StateSaveLocation=$folder/state
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd_%n.log
NodeName=n[1-3] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 3))] CPUs=1 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
mkdir "$folder/state"
munged --foreground --force --key-file="$folder/key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
  --log-file="$folder/munged.log" --seed-file="$folder/munged.seed" > "$folder/munged.out.log" 2>&1 & others+=($!)
for _ in $(seq 50); do [ -S "$folder/munge.socket" ] && break; sleep 0.2; done
slurmctld -D -c > "$folder/slurmctld.out.log" 2>&1 & others+=($!)
for name in n1 n2 n3; do slurmd -D -N "$name" > "$folder/slurmd_$name.out.log" 2>&1 & node[$name]=$!; done
for _ in $(seq 100); do [ "$(sinfo -h -t idle -o %D 2>/dev/null || true)" = 3 ] && break; sleep 0.3; done
[ "$(sinfo -h -t idle -o %D)" = 3 ] || { say "the three nodes do not come up"; exit 1; }

# draws of a rolling sphere, which take a second each
words=(--seeds 1..18 --method rate/raw --method rolling --keep worst:2)
export TUMBLE_CACHE=${TUMBLE_CACHE:-$folder/cache} TUMBLE_SLURM_EVERY_S=1
say "one sweep, undisturbed"
"$program" sweep roll "${words[@]}" --jobs 2 --examples 0 --quiet --db "$folder/whole.db" >/dev/null

say "three shards, a node of which dies"
"$root/tools/slurm/submit" roll --db "$folder/out.db" --shards 3 --report "$folder/out.html" --program "$program" -- "${words[@]}"
dead='' array=''
for _ in $(seq 600); do
  # finds a node whose shard has copied a part of its results and is not complete
  for part in "$folder"/out.db.shards/shard_*.part.db; do
    [ -f "$part" ] || continue
    task=${part##*shard_}; task=${task%.part.db}
    dead=$(squeue -h -r -t running -o '%a %K %N' 2>/dev/null | awk -v t="$task" '$2 == t { print $3 }')
    [ -z "$dead" ] || break 2
  done
  sleep 0.1
done
[ -n "$dead" ] || { say "no shard was caught at work"; exit 1; }
say "node $dead dies, with task $task"
kill_node "$dead"
[ "$killed" -ge 3 ] || { say "the node ran too little to mean anything: $killed processes"; exit 1; }
[ ! -f "$folder/out.db.shards/shard_$task.db" ] || { say "the task had ended before"; exit 1; }
for _ in $(seq 900); do [ -z "$(squeue -h 2>/dev/null || echo busy)" ] && break; sleep 0.5; done
grep -q "shard $task: done" "$folder/out.db.shards/logs/shard_$task.log" || { say "task $task was not done again"; exit 1; }
[ -s "$folder/out.html" ] || { say "there is no report"; exit 1; }
grep -q "data:image/webp" "$folder/out.html" || { say "nothing moves in the report"; exit 1; }

python3 "$root/tests/cluster/same_results.py" "$folder/whole.db" "$folder/out.db" 18
diff -r "$folder/whole.db.files/kept" "$folder/out.db.files/kept"
[ "$(find "$folder/whole.db.files/kept" -name recording.h5 | wc -l)" -ge 2 ] || { say "nothing was kept"; exit 1; }
say "and the same recordings kept"

say "what a shard cannot do is refused"
if "$root/tools/slurm/submit" roll --db "$folder/no.db" --program "$program" -- --until a:b:c 2> "$folder/refused"; then exit 1; fi
grep -q "needs all earlier draws" "$folder/refused"
