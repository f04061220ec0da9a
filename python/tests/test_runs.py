"""Runs: the rows of the program, batches, interrupts, tables in pandas, polars and pyarrow."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pandas
import polars
import pyarrow.parquet
import pytest

import moorline
from conftest import CHAIN, SEMI


def same(table, other):
    """Two tables have the same columns, to the last bit."""
    assert list(table) == list(other)
    for name in table:
        assert np.array_equal(np.asarray(table[name]), np.asarray(other[name])), name


@pytest.mark.parametrize("text", [CHAIN, SEMI], ids=["chain", "semi"])
def test_a_run_has_the_rows_of_the_program_to_the_last_bit(text, program, tmp_path):
    text = text.replace("[output]", '[output]\nformat = "parquet"')
    (tmp_path / "scene.toml").write_text(text)
    assert program("run", "scene.toml", "-o", "out").returncode == 0
    written = pyarrow.parquet.read_table(tmp_path / "out" / "results.parquet")
    same(moorline.run(moorline.Scene.from_toml(text)), {name: written[name].to_numpy() for name in written.column_names})


def test_a_motion_from_memory_is_a_motion_file(chain, program, tmp_path):
    t = np.arange(0.0, 8.0, 0.1)
    motion = {"time": t, "fairlead.x": 2.0 * np.sin(0.6 * t), "fairlead.z": 0.5 * np.sin(0.9 * t)}
    pandas.DataFrame(motion).to_csv(tmp_path / "motion.csv", index=False)
    text = CHAIN.replace("[output]", '[output]\nformat = "parquet"')
    (tmp_path / "scene.toml").write_text(text)
    done = program("run", "scene.toml", "-o", "out", "--motion", "motion.csv")
    assert done.returncode == 0, done.stderr
    written = pyarrow.parquet.read_table(tmp_path / "out" / "results.parquet")
    expected = {name: written[name].to_numpy() for name in written.column_names}
    structured = np.array(list(zip(*motion.values())), dtype=[(name, float) for name in motion])
    indexed = pandas.DataFrame(motion).set_index("time")
    for given in (motion, pandas.DataFrame(motion), indexed, polars.DataFrame(motion), structured):
        same(moorline.run(chain, given), expected)


def test_a_table_is_a_frame_of_pandas_polars_and_arrow_as_it_is(chain):
    table = moorline.run(chain, duration=1.0)
    for frame in (pandas.DataFrame(table), polars.DataFrame(table)):
        assert list(frame.columns) == list(table) and len(frame) == 21
        assert np.array_equal(frame["line1.tension_b"].to_numpy(), table["line1.tension_b"])
    assert pyarrow.table(table).num_rows == 21
    assert table.units["line1.tension_b"] == "N" and table["solver.substeps"].dtype == np.int64
    assert table.substeps == table["solver.substeps"].sum() > 0


def test_a_run_keeps_the_columns_and_shapes_requested(chain):
    table = moorline.run(chain, duration=2.0, columns=["line1.tension_b"], shapes=0.5)
    assert list(table) == ["time", "line1.tension_b"]
    line = table.shapes.lines["line1"]
    assert table.shapes.time.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    assert line.position.shape == (5, 21, 3) and line.tension.shape == (5, 21)
    assert line.tension[-1, -1] == table["line1.tension_b"][-1]


def test_a_batch_is_its_single_runs_to_the_last_bit(chain, semi):
    t = np.linspace(0.0, 4.0, 41)
    motions = [{"time": t, "fairlead.x": amplitude * np.sin(t)} for amplitude in (0.5, 1.0, 2.0, 3.0)]
    cases = [(chain,), (semi,), *((chain, motion) for motion in motions), moorline.Case(semi, duration=2.0)]
    singles = [moorline.run(*case) for case in cases]
    for threads in (None, 1, 3):
        for table, single in zip(moorline.batch(cases, threads=threads), singles, strict=True):
            same(table, single)


def test_a_case_that_fails_gives_its_error_and_the_others_go_on(chain):
    jump = {"time": [0.0, 1.0, 1.0001, 2.0], "fairlead.x": [0.0, 0.0, 1e5, 1e5]}
    results = moorline.batch([chain, (chain, jump), (chain, {"time": [0.0, 1.0], "nothing.x": [0.0, 1.0]}), "no such file.toml", chain])
    same(results[0], results[4])
    assert [isinstance(result, moorline.Error) for result in results] == [False, True, True, True, False]
    assert isinstance(results[2], moorline.SceneError) and isinstance(results[3], moorline.SceneError)


def test_a_failed_run_keeps_its_rows(chain):
    jump = {"time": [0.0, 1.0, 1.0001, 2.0], "fairlead.x": [0.0, 0.0, 1e5, 1e5]}
    with pytest.raises(moorline.Error) as caught:
        moorline.run(chain, jump)
    partial = caught.value.partial
    assert 0 < len(partial["time"]) < 41 and np.isfinite(partial["line1.tension_b"]).all()


def test_other_threads_of_python_run_meanwhile(chain):
    counted = [0]
    done = threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    moorline.run(chain, duration=600.0)
    done.set()
    counter.join()
    assert counted[0] > 20


def test_progress_is_reported_and_can_end_a_run(chain):
    reported = []
    moorline.run(chain, duration=600.0, progress=lambda done, total: reported.append((done, total)))
    assert reported and reported[-1] == (12000, 12000) and sorted(reported) == reported

    class Enough(Exception):
        pass

    def stop(done, total):
        raise Enough

    with pytest.raises(Enough):
        moorline.run(chain, duration=1e5, progress=stop)


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("call", ["moorline.run(scene, duration=4e5)", "moorline.batch([(scene, None, 4e5)] * 4)"])
def test_ctrl_c_ends_a_run_within_a_second(call, tmp_path):
    (tmp_path / "chain.toml").write_text(CHAIN)
    script = f"import moorline\nscene = moorline.Scene.load('chain.toml')\nprint('begun', flush=True)\n{call}\n"
    process = subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=20)
    assert time.monotonic() - sent < 1.0
    assert "KeyboardInterrupt" in errors


def test_a_run_of_a_path_and_of_a_dict_is_that_of_the_scene(chain, tmp_path):
    path = pathlib.Path(tmp_path / "chain.toml")
    path.write_text(CHAIN)
    expected = moorline.run(chain, duration=1.0)
    same(moorline.run(path, duration=1.0), expected)
    same(moorline.run(str(path), duration=1.0), expected)
    same(moorline.run(chain.to_dict(), duration=1.0), expected)
