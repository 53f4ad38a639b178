#!/usr/bin/env bash
# parallel.sh CASES OUT [OPTIONS OF parallel]: the cases by GNU parallel in 64 shards, one per core, each on one thread.
# Given again after whatever happened, it goes on. On other machines that see the same folders: -S host1,host2
set -euo pipefail
cases=$1 out=$2
shift 2
mkdir -p "$out"
seq 0 63 | parallel --joblog "$out/parallel.log" --resume-failed "$@" \
  /usr/bin/python3 -m bullet_ambient --cases "$cases" --out "$out" --shard {}/64 --threads 1 --quiet
