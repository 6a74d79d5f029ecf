#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Starts slurmctld and slurmd on this machine, in a folder and on ports of their own, and runs a small array on them:
# sample crowns and an arch, in three tasks of which one is killed and requeued. Its results are those of one plain run,
# byte for byte.
# usage: test_slurm.sh PROGRAM. Ends with 77 (skipped) where Slurm or munge is not installed.
set -euo pipefail

program=$(realpath "$1")
root=$(realpath "$(dirname "$0")/../..")
PATH=$PATH:/usr/sbin:/sbin
for tool in munged slurmctld slurmd sbatch scontrol squeue; do
  command -v "$tool" >/dev/null || { echo "skipped: no $tool (Debian: slurmctld slurmd slurm-client munge)"; exit 77; }
done

work=$(mktemp -d)
daemons=()
end() {
  for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap end EXIT
fail() {
  echo "FAILED: $*"
  tail -n 20 "$work"/*.log "$work"/logs/* 2>/dev/null || true
  exit 1
}

# Authentication.
chmod 755 "$work"
mkdir -m 700 "$work/munge"
mkdir -m 755 "$work/socket" "$work/logs" "$work/state" "$work/spool"
head -c 128 /dev/urandom >"$work/munge/key"
chmod 400 "$work/munge/key"
munged --foreground --force --key-file="$work/munge/key" --socket="$work/socket/munge" --pid-file="$work/munge/pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" --num-threads=2 >"$work/munged.log" 2>&1 &
daemons+=($!)

read -r controller_port node_port < <(/usr/bin/python3 - <<'PY'
import socket
free = [socket.socket() for _ in range(2)]
for s in free: s.bind(("127.0.0.1", 0))
print(*(s.getsockname()[1] for s in free))
PY
)
user=$(id -un) host=$(hostname -s)
cat >"$work/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$work/socket/munge
SlurmctldPort=$controller_port
SlurmdPort=$node_port
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
MinJobAge=3600
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=1000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$work/slurm.conf
for _ in $(seq 50); do [ -S "$work/socket/munge" ] && break; sleep 0.1; done
slurmctld -D -f "$SLURM_CONF" >"$work/controller.log" 2>&1 &
daemons+=($!)
slurmd -D -f "$SLURM_CONF" -N "$host" >"$work/node.log" 2>&1 &
daemons+=($!)
for _ in $(seq 100); do
  [[ $(sinfo -h -o %T 2>/dev/null) == idle ]] && break
  sleep 0.2
done
[[ $(sinfo -h -o %T 2>/dev/null) == idle ]] || fail "Slurm's node did not come up"

# Seven cases: five crowns, one of them again elsewhere, and an arch of two.
cd "$work"
mkdir -p scans/arch
cp "$root"/samples/crown_* scans/
cp scans/crown_11.stl scans/again.stl
cp scans/crown_34.ply scans/arch/34.ply
{
  echo scan,fdi
  for crown in scans/crown_*; do
    number=${crown##*_}
    echo "$crown,${number%.*}"
  done
  echo scans/again.stl,11
  echo scans/arch,
} >manifest.csv

"$program" batch manifest.csv -o plain --e 1 --quiet || fail "the plain run ended with $?"

export RHIZODONT=$program
# What asks for memory and time asks a cluster; this one has what the machine has.
job=$(sbatch --parsable --array=1-3 --cpus-per-task=1 --mem=0 --time=10 --output="$work/logs/%a.log" \
  "$root/scripts/slurm/batch.sbatch" manifest.csv array --e 1)
for _ in $(seq 100); do
  grep -qs '"event":"begun"' array/ledger/1-of-3.*.jsonl && break
  sleep 0.1
done
scontrol requeue "${job}_1" || echo "task 1 was through before it could be requeued"
for _ in $(seq 300); do
  # A requeued task would wait two minutes for its next start.
  scontrol update jobid="${job}_1" starttime=now 2>/dev/null || true
  [ -z "$(squeue -h -j "$job" -t pending,running,completing,suspended 2>/dev/null)" ] && break
  sleep 0.5
done
for task in 1 2 3; do
  scontrol show job "${job}_$task" | grep -q 'JobState=COMPLETED' || fail "task $task: $(scontrol show job "${job}_$task" | grep JobState)"
done
diff -r plain/cases array/cases || fail "the array's results are not those of the plain run"
"$program" batch status array
"$program" batch status array | grep -q '^7 cases: 7 done, 0 in part, 0 failed, 0 running, 0 remaining' || fail "the status is not that all is done"
echo "an array of three tasks gave the results of a plain run: $(find array/cases -type f | wc -l) files, $(ls array/ledger | wc -l) runs"
