#!/bin/bash
# A study as an array of 64 parts. Submit: sbatch slurm_study.sh study.toml out
# Afterwards: toile study merge out && toile study report out
#SBATCH --job-name=toile-study
#SBATCH --array=1-64
#SBATCH --cpus-per-task=2
#SBATCH --mem=2G
#SBATCH --requeue
set -euo pipefail
exec toile study "$1" --out "$2" --shard "$SLURM_ARRAY_TASK_ID/64" --workers "$SLURM_CPUS_PER_TASK" --quiet
