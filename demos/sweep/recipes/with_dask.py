#!/usr/bin/python3
"""The cases by Dask in 64 shards, on the workers of a scheduler, or two here.

Given again after whatever happened, it goes on. Workers that die are replaced, and their shards run again.
"""

import argparse
import sys

from dask.distributed import Client, as_completed

import bullet_ambient as ba

SHARDS = 64


def run(shard, cases, out):
    return ba.run_cases(cases, out, shard=(shard, SHARDS), threads=1).failures


def main(cases, out, scheduler=None):
    client = Client(scheduler) if scheduler else Client(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with client:
        shards = client.map(run, range(SHARDS), cases=cases, out=out, pure=False, retries=3)
        failures = {index: error for done in as_completed(shards) for index, error in done.result().items()}
    for index, error in sorted(failures.items()):
        print(f"case {index}: {error}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", metavar="CASES")
    parser.add_argument("out", metavar="OUT")
    parser.add_argument("scheduler", nargs="?", metavar="SCHEDULER", help="its address; default: two workers here")
    sys.exit(main(**vars(parser.parse_args())))
