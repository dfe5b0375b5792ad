#!/bin/sh
# Renders RECIPE into DIR as a Slurm job array and merges it: slurm.sh RECIPE DIR PARTS [SBATCH OPTION...]
# Both are paths on a file system that all nodes share. Prints the number of the job that merges.
set -eu
recipe=$(realpath "$1") out=$(realpath -m "$2") parts=$3
shift 3
trove=${TROVE:-trove}
mkdir -p "$out"

# A task that fails, or whose node does, is queued once more; a frame that is finished is not made again.
array=$(sbatch --parsable --requeue --array="1-$parts" --job-name=trove --output="$out-%a.log" "$@" <<SBATCH
#!/bin/sh
run() { '$trove' generate '$recipe' --part "\$SLURM_ARRAY_TASK_ID/$parts" --out '$out' --threads "\${SLURM_CPUS_PER_TASK:-0}"; }
run || { [ "\${SLURM_RESTART_COUNT:-0}" -ge 1 ] || scontrol requeue "\$SLURM_JOB_ID"; exit 1; }
SBATCH
)
# It renders what parts have left, so it waits for their end, not for their success.
sbatch --parsable --dependency="afterany:${array%%;*}" --job-name=trove-merge --output="$out-merge.log" "$@" <<SBATCH
#!/bin/sh
exec '$trove' generate '$recipe' --out '$out' --threads "\${SLURM_CPUS_PER_TASK:-0}"
SBATCH
