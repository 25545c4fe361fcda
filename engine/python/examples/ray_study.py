#!/usr/bin/env python3
"""A study on a Ray cluster: each part is computed by whichever machine is free, and tried again where one is lost.

Usage: ray_study.py STUDY.toml DIR [--parts 64] [--rows]

The parts are those of `toile study --shard I/N`: functions of the study and of I alone, written whole or not at all into DIR, which every
machine sees. A part that was computed twice is the same file. `toile study merge DIR` then gives the same bytes as one process would.

With --rows the machines need no common folder: each row is `toile.study_row(STUDY.toml, index)` as a Parquet file in memory, and Ray writes
what comes back. The values are the same; the file's bytes are then Ray's own.

Needs: pip install "ray[data]" pyarrow, and the program `toile`, or the Python module of the same name.
"""

import argparse
import io
import os
import subprocess

import ray


def part(row, study, folder, parts):
    """Computes a part; what was done before a machine was lost is kept."""
    number = int(row["id"]) + 1
    workers = str(int(ray.get_runtime_context().get_assigned_resources().get("CPU", 1)))
    shard = f"{number}/{parts}"
    command = ["toile", "study", study, "--out", folder, "--shard", shard, "--workers", workers, "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        # A lost machine is Ray's matter; a study that cannot be used stops here with its sentence.
        raise RuntimeError(done.stderr.strip())
    return {"part": number}


def row_table(row, study):
    """One row as a table."""
    import pyarrow.parquet
    import toile

    return pyarrow.parquet.read_table(io.BytesIO(toile.study_row(study, int(row["id"])))).to_pylist()[0]


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("study")
    arguments.add_argument("folder")
    arguments.add_argument("--parts", type=int, default=64)
    arguments.add_argument("--cpus", type=float, default=1, help="cores of a part")
    arguments.add_argument("--rows", type=int, help="compute so many single rows instead")
    given = arguments.parse_args()
    study, folder = os.path.abspath(given.study), os.path.abspath(given.folder)
    ray.init()
    # Parts that were lost with a machine are begun again, however often.
    ray.data.DataContext.get_current().max_errored_blocks = 0
    options = {"num_cpus": given.cpus, "max_retries": -1}
    if given.rows:
        rows = ray.data.range(given.rows, override_num_blocks=max(1, given.rows // 16))
        rows.map(row_table, fn_args=(study,), **options).write_parquet(folder)
        return
    parts = ray.data.range(given.parts, override_num_blocks=given.parts)
    parts.map(part, fn_args=(study, folder, given.parts), **options).materialize()
    subprocess.run(["toile", "study", "merge", folder], check=True)
    subprocess.run(["toile", "study", "report", folder], check=True)


if __name__ == "__main__":
    main()
