"""Builds the wheel with maturin, after the licences of the crates in it are written to the file that pyproject.toml names."""

import pathlib
import subprocess
import sys

from maturin import *  # noqa: F403 The hooks of PEP 517 are maturin's.

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCRIPT = ROOT / ".ci/notices"

# A source distribution has the file and lacks the script.
if SCRIPT.exists():
    notices = subprocess.run([sys.executable, SCRIPT, "toile-python"], check=True, stdout=subprocess.PIPE).stdout
    (ROOT / "THIRD-PARTY-NOTICES").write_bytes(notices)
