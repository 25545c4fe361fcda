"""Runs notebooks from their first cell to their last; a cell that fails, fails this.

    python engine/python/tests/notebooks.py [--renew-notebooks] NOTEBOOK...

With --renew-notebooks they are written with what they gave.
"""

import argparse
import pathlib
import sys
import time

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

LONGEST_S = 120


def run(path, renew):
    notebook = nbformat.read(path, as_version=4)
    began = time.monotonic()
    client = NotebookClient(notebook, timeout=LONGEST_S, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}})
    try:
        client.execute()
    except CellExecutionError as error:
        sys.exit(f"notebooks: {path.name}: {error}")
    outputs = sum(len(cell.get("outputs", ())) for cell in notebook.cells)
    if not outputs:
        sys.exit(f"notebooks: {path.name} shows nothing")
    print(f"notebooks: {path.name}, {len(notebook.cells)} cells, {outputs} outputs, {time.monotonic() - began:.1f} s")
    if renew:
        for cell in notebook.cells:
            cell.get("metadata", {}).pop("execution", None)
        notebook.metadata = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
        nbformat.write(notebook, path)


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--renew-notebooks", action="store_true")
parser.add_argument("notebooks", nargs="+", type=pathlib.Path)
given = parser.parse_args()
for notebook in given.notebooks:
    run(notebook.resolve(), given.renew_notebooks)
