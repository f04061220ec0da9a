#!/usr/bin/env python3
"""Load cases on many machines: Dask distributes them, moorline runs them.

    python3 examples/sweep_dask.py BASE CASES OUTPUT                      processes of this machine, one a core
    python3 examples/sweep_dask.py BASE CASES OUTPUT --workers 2          two of them
    python3 examples/sweep_dask.py BASE CASES OUTPUT --scheduler ADDRESS  the workers of a scheduler, such as tcp://10.0.0.1:8786

Needs `pip install moorline distributed`. Workers elsewhere need the same version of moorline, and the files by the same paths. A cluster with
SLURM, PBS or a cloud has a class of dask-jobqueue or dask-cloudprovider, which takes the place of LocalCluster. Called again after it was
ended or killed, the same command goes on; the table is that of `moorline sweep BASE CASES -o OUTPUT`, to the last bit.
"""

import argparse
import contextlib

import moorline
from distributed import Client, LocalCluster


def main() -> None:
    parser = argparse.ArgumentParser(description="Load cases, distributed by Dask.")
    parser.add_argument("base", help="scene or deck")
    parser.add_argument("cases", help="CSV or TOML file of cases")
    parser.add_argument("output", help="folder")
    parser.add_argument("--workers", type=int, help="processes on this machine (default: one a core)")
    parser.add_argument("--scheduler", help="address of a scheduler of Dask")
    options = parser.parse_args()
    with contextlib.ExitStack() as stack:
        where = options.scheduler
        if where is None:
            # one thread each: a case computes on one core
            where = stack.enter_context(LocalCluster(n_workers=options.workers, threads_per_worker=1, dashboard_address=None))
        client = stack.enter_context(Client(where))
        table = moorline.sweep(options.base, options.cases, options.output, client=client, progress=True)
    failed = sum(reason != "" for reason in table["failure"])
    print(f"{len(table['case'])} cases, {failed} failed: {options.output}/cases.csv")


if __name__ == "__main__":  # the processes of LocalCluster import this file
    main()
