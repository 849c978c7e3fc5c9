#!/bin/bash
# A campaign as a Slurm job array: each task makes one shard, and a last job puts them together.
#
#   hairpin plan quadrotor.toml --cases 10000 --out /shared/wide
#   sbatch examples/cluster/slurm-array.sh /shared/wide
#
# The folder must lie where all nodes can write. Which shard a task makes, hairpin reads from Slurm's own variables.
# A task that was killed or requeued makes what its shard still lacks.
#SBATCH --job-name=hairpin
#SBATCH --array=0-15
#SBATCH --cpus-per-task=4
#SBATCH --mem=4G
#SBATCH --time=02:00:00
#SBATCH --requeue
set -euo pipefail

plan=${1:?usage: sbatch slurm-array.sh PLAN_FOLDER}

# Once per array, by its first task: what comes after all shards are there.
if [[ ${SLURM_ARRAY_TASK_ID} -eq ${SLURM_ARRAY_TASK_MIN} && ${SLURM_RESTART_COUNT:-0} -eq 0 ]]; then
  sbatch --dependency="afterok:${SLURM_ARRAY_JOB_ID}" --job-name=hairpin-merge --cpus-per-task=4 --mem=8G \
    --wrap="hairpin merge '${plan}' --threads 4 && hairpin judge '${plan}'"
fi

hairpin run-shard --shard from-env "${plan}" --threads "${SLURM_CPUS_PER_TASK}"
