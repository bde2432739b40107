#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# slurm.sh BIN: starts Slurm on this machine (slurm-wlm, munge; as root), runs a study as a job array of 8 tasks, kills one,
# submits it again, merges, and compares the tables with those of one machine.
set -euo pipefail

bin=$(realpath "$1")
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
host=$(hostname -s)
stop() {
  pkill slurmctld || true
  pkill slurmd || true
  rm -rf "$work"
}
trap stop EXIT

mkdir -p /run/munge "$work/state" "$work/spool"
[ -f /etc/munge/munge.key ] || mungekey --create
chown -R munge:munge /run/munge /etc/munge
pgrep -x munged > /dev/null || runuser -u munge -- munged
cat > "$work/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
NodeName=$host CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$work/slurm.conf
slurmctld
slurmd
until sinfo -h -o %T | grep -q idle; do sleep 1; done

cp "$source/configs/box_bend.yaml" "$work/scene.yaml"
sed -i "s#\.\./data#$source/data#" "$work/scene.yaml"
cat > "$work/study.yaml" <<STUDY
scene: scene.yaml
vary: {material.young_modulus: [5e3, 1e4, 2e4, 4e4], body.radius: [0.014, 0.017, 0.02, 0.024]}
set: {solver.duration: 1}
STUDY
cat > "$work/job.sh" <<JOB
#!/bin/bash
exec "$bin/sinew" sweep "$work/study.yaml" --shard "\$SLURM_ARRAY_TASK_ID/8" --threads 1 -o "$work/part\$SLURM_ARRAY_TASK_ID"
JOB
cd "$work"
submit() { sbatch --parsable --array="$1" --cpus-per-task=1 --output=/dev/null job.sh; }
wait_for_all() { while squeue -h | grep -q .; do sleep 0.5; done; }
job=$(submit 1-8)
while [ ! -d part3/runs ]; do sleep 0.1; done
scancel --signal=KILL "${job}_3"
wait_for_all
submit 3 > /dev/null
wait_for_all
"$bin/sinew" sweep study.yaml --merge part1 part2 part3 part4 part5 part6 part7 part8 -o merged --quiet
"$bin/sinew" sweep study.yaml -o alone --quiet
cmp merged/results.csv alone/results.csv
test "$(grep -c finished merged/index.csv)" = 16
echo "16 runs by 8 tasks of Slurm, one killed and submitted again: the same results as on one machine"
