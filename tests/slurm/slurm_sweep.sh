#!/usr/bin/env bash
# A sweep as a job array under a real Slurm equals the same sweep on its own: starts munged, slurmctld and slurmd with
# files, ports and a key of the test's own, submits tools/sweep.sbatch as an array of 4, merges, and compares every
# table but the run times. Exit status 77: Slurm cannot be installed or started here, and the last line says why.
# usage: slurm_sweep.sh GLIDELAB SOURCE_DIR
set -euo pipefail
export PATH="$PATH:/usr/sbin:/sbin"
glidelab=$(realpath "$1")
source_dir=$(realpath "$2")

skip() { echo "skipped: $*"; exit 77; }
for program in slurmctld slurmd sbatch squeue scontrol munged mungekey sqlite3 python3; do
  command -v "$program" >/dev/null || skip "$program is not installed (packages in tools/packages-optional.txt)"
done
[ "$(id -u)" -eq 0 ] || skip "slurmd needs root"

work=$(mktemp -d "${TMPDIR:-/tmp}/glidelab-slurm-XXXXXX")
chmod 755 "$work"
started=()
finish() {
  for pid in "${started[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${started[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap finish EXIT

# Two ports that nobody listens on.
read -r controller_port node_port < <(python3 -c '
import socket
held = [socket.socket() for _ in range(2)]
for one in held: one.bind(("127.0.0.1", 0))
print(*(one.getsockname()[1] for one in held))')

mkdir "$work/state" "$work/spool" "$work/munge"
chmod 700 "$work/munge"
mungekey --create --keyfile "$work/munge/key"
munged --foreground --force --key-file "$work/munge/key" --socket "$work/munge.socket" --pid-file "$work/munge/pid" \
  --log-file "$work/munge/log" --seed-file "$work/munge/seed" >"$work/munged.out" 2>&1 &
started+=($!)

host=$(hostname -s)
cat >"$work/slurm.conf" <<CONF
ClusterName=glidelab
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=$controller_port
SlurmdPort=$node_port
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
CredType=cred/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
SlurmctldParameters=enable_configless
SchedulerParameters=sched_interval=2,batch_sched_delay=0
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP MaxTime=INFINITE
CONF
export SLURM_CONF="$work/slurm.conf"

until_true() {  # until_true SECONDS COMMAND…
  local left=$(($1 * 5))
  shift
  until "$@" >/dev/null 2>&1; do
    left=$((left - 1))
    [ "$left" -gt 0 ] || return 1
    sleep 0.2
  done
}
logs() { tail -n 5 "$work"/*.log "$work"/munge/log 2>/dev/null || true; }

until_true 20 test -S "$work/munge.socket" || { logs; skip "munged did not start"; }
slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.out" 2>&1 &
started+=($!)
slurmd -D -f "$SLURM_CONF" >"$work/slurmd.out" 2>&1 &
started+=($!)
node_idle() { [ "$(sinfo -h -o %T)" = idle ]; }
until_true 60 node_idle || { logs; skip "slurmctld and slurmd did not come up"; }

cat >"$work/sweep.toml" <<SWEEP
format = 1
name = "array"
scenario = "$source_dir/scenarios/laws/3-viscous-and-coulomb.toml"
replicates = 3
seed = 7
estimators = ["phase-diagram", "trajectory"]
[tracks]
noise_m = 2e-5
[[vary]]
key = "camera.frame_rate_hz"
values = [100, 150, 200]
SWEEP

export GLIDELAB="$glidelab"
job=$(cd "$work" && sbatch --parsable --array=1-4 "$source_dir/tools/sweep.sbatch" "$work/sweep.toml" "$work/array")
none_left() { [ -z "$(squeue -h -j "$job" 2>/dev/null)" ]; }
until_true 240 none_left || { squeue; logs; cat "$work"/slurm-*.out; exit 1; }
for part in 1 2 3 4; do
  [ -f "$work/array/sweep-$part-of-4.sqlite" ] || { echo "part $part is missing"; cat "$work"/slurm-*.out; logs; exit 1; }
done
"$glidelab" sweep "$work/sweep.toml" -o "$work/array" --quiet --merge "$work"/array/sweep-*-of-4.sqlite
"$glidelab" sweep "$work/sweep.toml" -o "$work/alone" --quiet

tables_of() {  # every table but the run times, each sorted by all of its columns
  local name
  for name in $(sqlite3 "$1" "select name from sqlite_master where type='table' and name <> 'timing' order by name"); do
    echo "-- $name"
    sqlite3 "$1" "select * from \"$name\"" | LC_ALL=C sort
  done
}
tables_of "$work/array/sweep.sqlite" >"$work/array.txt"
tables_of "$work/alone/sweep.sqlite" >"$work/alone.txt"
runs=$(sqlite3 "$work/array/sweep.sqlite" "select count(*) from run where status = 'done'")
[ "$runs" -eq 9 ] || { echo "$runs runs are done, expected 9"; exit 1; }
diff "$work/array.txt" "$work/alone.txt" || { echo "the array's database differs from the local one"; exit 1; }
echo "an array of 4 under Slurm and a local sweep: the same $runs runs"
