#!/bin/sh
# Renders RECIPE into DIR on machines that share a file system, by ssh: shell.sh RECIPE DIR MACHINE...
# Without machines it takes the parts one after another here. PARTS says how many there are.
set -eu
recipe=$1 out=$2
shift 2
trove=${TROVE:-trove}
parts=${PARTS:-$(($# > 0 ? 4 * $# : 4))}

# Takes every part that is left over when the parts are dealt out to the machines.
work() { # WORKER WORKERS COMMAND...
    part=$1 workers=$2
    shift 2
    while [ "$part" -le "$parts" ]; do
        # A part that fails is tried once more; what is still missing then is made by the last run.
        "$@" "$trove" generate "$recipe" --part "$part/$parts" --out "$out" \
            || "$@" "$trove" generate "$recipe" --part "$part/$parts" --out "$out" || true
        part=$((part + workers))
    done
}

if [ $# -eq 0 ]; then
    work 1 1 env
else
    worker=1
    for machine in "$@"; do
        work "$worker" $# ssh -n "$machine" &
        worker=$((worker + 1))
    done
    wait
fi
"$trove" generate "$recipe" --out "$out"
