#!/usr/bin/env bash
# Tests a plan on a private Slurm with two virtual nodes on this machine, in a temporary directory.
# The script kills tasks, cancels half of an array, drains a node, fills the disk and stops the controller. No task may be lost
# or done twice, and the results must equal those of a local run, apart from their times.
#   .ci/slurm.sh PROGRAM [TASKS]
set -euo pipefail
program="$(realpath "$1")"
tasks="${2:-300}"
for command in slurmctld slurmd munged sbatch squeue scancel scontrol; do
    command -v "$command" >/dev/null || { echo "$command is missing: plans cannot be tested on Slurm." >&2; exit 1; }
done
((EUID == 0)) || { echo "Only root can start the nodes of Slurm: plans cannot be tested on Slurm." >&2; exit 1; }

here="$(mktemp -d)"
place="$here/slurm"
stop() {
    for name in slurmd.n1 slurmd.n2 slurmctld munged; do
        [[ -e "$place/run/$name.pid" ]] && kill "$(cat "$place/run/$name.pid")" 2>/dev/null
    done
    mountpoint -q "$here/small" && umount "$here/small"
    rm -rf "$here"
}
trap stop EXIT
chmod 755 "$here"
mkdir -p "$place"/{spool/n1,spool/n2,state,log,run}
dd if=/dev/urandom of="$place/munge.key" bs=1024 count=1 status=none
chmod 600 "$place/munge.key"
port=$((20000 + RANDOM % 10000))
name="$(hostname -s)"
cat >"$place/slurm.conf" <<CONF
ClusterName=grainbench
SlurmctldHost=$name(127.0.0.1)
SlurmUser=root
SlurmctldPort=$port
AuthType=auth/munge
AuthInfo=socket=$place/run/munge.sock
CredType=cred/munge
StateSaveLocation=$place/state
SlurmdSpoolDir=$place/spool/%n
SlurmctldPidFile=$place/run/slurmctld.pid
SlurmdPidFile=$place/run/slurmd.%n.pid
SlurmctldLogFile=$place/log/slurmctld.log
SlurmdLogFile=$place/log/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1,bf_interval=2,defer
MaxArraySize=1001
KillWait=2
AccountingStorageType=accounting_storage/none
NodeName=n[1-2] NodeHostname=$name NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 2))] CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
CONF
export SLURM_CONF="$place/slurm.conf"
munged --key-file="$place/munge.key" --socket="$place/run/munge.sock" --pid-file="$place/run/munged.pid" \
    --log-file="$place/log/munged.log" --seed-file="$place/run/munged.seed" --force
slurmctld -c
slurmd -N n1
slurmd -N n2
for _ in $(seq 60); do
    [[ "$(sinfo --noheader --format=%D --states=idle 2>/dev/null)" == 2 ]] && break
    sleep 0.5
done
sinfo

# A few hundred runs of about 0.01 s each, without the cache.
export GRAINBENCH_CACHE=off
cd "$here"
cat >sweep.toml <<SWEEP
title = "Slopes"
scene = "incline-disc/60deg-mu.3"
design = "latin-hypercube"
points = $tasks
[factors]
mu = { key = "contacts.plane.friction", from = 0.1, to = 0.9 }
theta = { key = "gravity.slope_deg", from = 10.0, to = 60.0 }
[set]
duration = 0.3
[[gates]]
quantity = "displacement at the end"
allowed = 0.01
[[solvers]]
solver = "dem"
levels = ["dt=.00003"]
SWEEP
# The plan has its own small disk, so that the script can fill it.
mkdir small
mount -t tmpfs -o size=$((4 + tasks / 200))m tmpfs small
shards=12
"$program" simulate sweep.toml --plan here >/dev/null
"$program" simulate sweep.toml --plan small/plan --shards $shards
plan=small/plan
# Time until the tasks of a killed worker are free (s).
sed -i 's/^lease_seconds = .*/lease_seconds = 6.0/' $plan/plan.toml
"$program" run --resume here
"$program" report here >/dev/null

told() { "$program" report $plan --progress --json | python3 -c "import json, sys; print(json.load(sys.stdin)['$1'])"; }
wait_for_queue() { while [[ -n "$(squeue --noheader)" ]]; do sleep 0.3; done; }
wait_for_done() { for _ in $(seq 300); do (($(told done) >= $1)) && return; sleep 0.1; done; }
# Process ids of the workers, from their leases.
workers() { python3 -c "
import glob, json
for path in glob.glob('$plan/running/*.json'):
    try: print(json.load(open(path))['process'])
    except (OSError, ValueError): pass"; }

# Killed workers, a cancelled half, a drained node.
"$program" run --resume $plan --on slurm -- --time=10
killed=0
for _ in $(seq 200); do
    for process in $(workers); do kill -9 "$process" 2>/dev/null && killed=$((killed + 1)); done
    ((killed >= 3)) && break
    sleep 0.3
done
((killed >= 3)) || { echo "Only $killed workers could be killed." >&2; exit 1; }
job="$(tail -n 1 $plan/slurm/jobs.jsonl | python3 -c "import json, sys; print(json.load(sys.stdin)['job'])")"
scancel "${job}_[$((shards / 2 + 1))-$shards]"
scontrol update NodeName=n2 State=DRAIN Reason=trial
wait_for_queue
echo "after $killed kills, half cancelled and a node drained: $(told done) of $tasks"
(($(told done) < tasks)) || { echo "Nothing was lost: too much was done before." >&2; exit 1; }

# A full disk while two workers run. Then the drained node returns.
before="$(told done)"
"$program" run --resume $plan --on slurm --resubmit
wait_for_done $((before + 1))
dd if=/dev/zero of=small/full bs=4k status=none || true
wait_for_queue
echo "after a full disk: $(told done) of $tasks"
grep -lq "No space left" $plan/slurm/*.out || { echo "No worker met the full disk." >&2; exit 1; }
rm small/full
scontrol update NodeName=n2 State=RESUME
rounds=0
while (($(told done) < tasks)); do
    rounds=$((rounds + 1))
    ((rounds < 6)) || { echo "Not whole after $rounds rounds." >&2; exit 1; }
    "$program" run --resume $plan --on slurm --resubmit
    wait_for_queue
    echo "after round $rounds: $(told done) of $tasks"
done
"$program" run --resume $plan --on slurm --resubmit | grep -qx "every missing task is queued or running"

# A controller that does not answer must not count as an empty queue.
kill "$(cat "$place/run/slurmctld.pid")"
for _ in $(seq 50); do squeue >/dev/null 2>&1 || break; sleep 0.2; done
before="$(wc -l <$plan/slurm/jobs.jsonl)"
"$program" report $plan --progress | grep -q '^queued    not known: squeue failed' ||
    { echo "A queue that does not answer is taken for empty." >&2; exit 1; }
if "$program" run --resume $plan --on slurm --resubmit 2>/dev/null || (($(wc -l <$plan/slurm/jobs.jsonl) != before)); then
    echo "Something was submitted though the queue is not known." >&2
    exit 1
fi

# No task is lost or done twice, and the results are equal.
"$program" report $plan --out collected >/dev/null
[[ "$(told done)" == "$tasks" && "$(told twice)" == 0 ]] || { "$program" report $plan --progress >&2; exit 1; }
# The last column is a time.
if ! cmp <(sed 's/,[^,]*$//' here/report/rows.csv) <(sed 's/,[^,]*$//' collected/rows.csv); then
    echo "Rows differ from those of a local run." >&2
    exit 1
fi
echo "$tasks tasks on Slurm: none lost, none twice, rows as of a local run"
echo "1 passed, 0 failed"
