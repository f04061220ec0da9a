"""Load cases: the table of the program, on this machine and on workers of Dask."""

import os
import pathlib
import signal
import subprocess
import sys
import time

import numpy as np
import pandas
import pytest

import moorline
from conftest import CHAIN, ROOT
from moorline import sweeps

CASES = "lines.line1.length [m],motion.fairlead.x[0][0]\n" + "".join(f"{450 + k},{1.0 + 0.1 * k}\n" for k in range(12))
BROKEN = CASES + "450,1e7\n"
FILES = ["cases.csv", "cases.parquet", "cases.units.csv"]


def files(folder):
    return [(folder / name).read_bytes() for name in FILES]


@pytest.fixture
def prepared(program, tmp_path):
    """The table of the program for all cases, of which one fails."""
    (tmp_path / "base.toml").write_text(CHAIN)
    (tmp_path / "cases.csv").write_text(BROKEN)
    done = program("sweep", "base.toml", "cases.csv", "-o", "expected")
    assert done.returncode == 1 and "1 of 13 cases failed" in done.stderr, done.stderr
    return files(tmp_path / "expected")


def test_a_sweep_writes_and_returns_the_table_of_the_program(prepared, tmp_path):
    reported = []
    table = moorline.sweep(tmp_path / "base.toml", tmp_path / "cases.csv", tmp_path / "out",
                           progress=lambda done, total: reported.append((done, total)))
    assert files(tmp_path / "out") == prepared
    assert reported[-1] == (13, 13)
    read = pandas.read_parquet(tmp_path / "out" / "cases.parquet")
    assert list(table) == list(read.columns)
    assert table["case"].tolist() == list(range(1, 14))
    assert np.array_equal(table["line1.tension_b.max"], read["line1.tension_b.max"], equal_nan=True)
    assert table.units["line1.tension_b.max"] == "N"
    assert [text != "" for text in table["failure"]] == [False] * 12 + [True]
    again = moorline.sweep(tmp_path / "base.toml", tmp_path / "cases.csv")
    pandas.testing.assert_frame_equal(pandas.DataFrame(again), pandas.DataFrame(table))


def test_remarks_on_the_scenes_of_cases_are_notes_of_the_table(tmp_path):
    (tmp_path / "base.toml").write_text(CHAIN)
    (tmp_path / "cases.csv").write_text("line_types.chain.drag_normal\n1.2\n120\n")
    notes = moorline.sweep(tmp_path / "base.toml", tmp_path / "cases.csv").notes
    assert [note for note in notes if note.startswith("case 2: ") and "drag_normal" in note], notes


def test_wrong_input_of_a_sweep_is_refused_with_its_place(tmp_path):
    (tmp_path / "base.toml").write_text(CHAIN)
    (tmp_path / "cases.csv").write_text("lines.line1.lenght\n450\n")
    with pytest.raises(moorline.SceneError, match="lenght"):
        moorline.sweep(tmp_path / "base.toml", tmp_path / "cases.csv")
    (tmp_path / "cases.csv").write_text("lines.line1.length\n450\n")
    with pytest.raises(moorline.InputError, match="output"):
        moorline.sweep(tmp_path / "base.toml", tmp_path / "cases.csv", series=True)
    with pytest.raises(moorline.InputError, match="start"):
        moorline.sweep(tmp_path / "base.toml", tmp_path / "cases.csv", start=float("nan"))
    moorline.sweep(tmp_path / "base.toml", tmp_path / "cases.csv", tmp_path / "out")
    (tmp_path / "cases.csv").write_text("lines.line1.length\n451\n")
    with pytest.raises(moorline.InputError, match="another base or other cases"):
        moorline.sweep(tmp_path / "base.toml", tmp_path / "cases.csv", tmp_path / "out")


def test_a_worker_that_reads_other_files_is_refused(tmp_path):
    (tmp_path / "base.toml").write_text(CHAIN)
    (tmp_path / "cases.csv").write_text(CASES)
    source = str(tmp_path / "base.toml"), str(tmp_path / "cases.csv"), None
    with pytest.raises(moorline.InputError, match="other cases or files"):
        sweeps._run_case(1, source, (moorline.__version__, "fingerprint"), None)


@pytest.mark.skipif(os.name == "nt", reason="kills by signals of POSIX")
def test_a_sweep_on_two_processes_of_dask_that_was_killed_goes_on_to_the_same_table(prepared, tmp_path):
    pytest.importorskip("distributed", reason="Dask is not installed")
    out = tmp_path / "out"
    journal = out / "sweep.journal"
    command = [sys.executable, ROOT / "examples" / "sweep_dask.py", tmp_path / "base.toml", tmp_path / "cases.csv", out, "--workers", "2"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    begun = None
    while process.poll() is None:  # until a few cases have ended, and not all
        size = journal.stat().st_size if journal.is_file() else 0
        begun = begun or size
        if begun and size > begun:
            os.killpg(process.pid, signal.SIGKILL)
            break
        time.sleep(0.001)
    process.wait()
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "13 cases, 1 failed" in done.stdout
    assert files(out) == prepared
    assert pathlib.Path(out / "sweep.journal").stat().st_size > size
