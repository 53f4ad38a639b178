#!/usr/bin/env bash
# sbatch --array=0-63 slurm.sh CASES OUT: the cases by Slurm in 64 shards, each on the cores of its job. Submitted again, it
# goes on; with --requeue Slurm does so itself when a node is lost.
#SBATCH --cpus-per-task=8 --time=1:00:00 --requeue
exec /usr/bin/python3 -m bullet_ambient --cases "$1" --out "$2" --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" \
  --threads "$SLURM_CPUS_PER_TASK" --quiet
