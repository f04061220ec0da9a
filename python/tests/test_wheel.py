"""Content of the wheel: the command line, the FMU library, types."""

import ast
import importlib.metadata
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

import pytest

import moorline
from moorline import _moorline
from conftest import CHAIN, ROOT


def test_the_program_is_on_the_path_and_under_python_m(program):
    script = pathlib.Path(sys.executable).with_name("moorline.exe" if os.name == "nt" else "moorline")
    called = subprocess.run([script, "--version"], capture_output=True, text=True)
    assert called.stdout == program("--version").stdout == f"moorline {moorline.__version__}\n"
    assert importlib.metadata.version("moorline") == moorline.__version__


def test_the_program_gives_the_exit_codes_and_messages_that_it_is_known_for(program, tmp_path):
    (tmp_path / "wrong.toml").write_text(CHAIN.replace("0.144", "-0.144"))
    done = program("check", "wrong.toml")
    assert done.returncode == 2 and "wrong.toml:12:12" in done.stderr and "line_types.chain.diameter" in done.stderr
    assert program("nonsense").returncode == 2
    assert program("--help").returncode == 0


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_fmu_of_python_is_that_of_the_program(chain, fmi, program, tmp_path):
    (tmp_path / "chain.toml").write_text(CHAIN)
    done = program("fmu", "chain.toml", "-o", "program.fmu", "--fmi", fmi)
    assert done.returncode == 0, done.stderr
    moorline.fmu(chain, tmp_path / "python.fmu", fmi)
    assert (tmp_path / "python.fmu").read_bytes() == (tmp_path / "program.fmu").read_bytes()
    names = zipfile.ZipFile(tmp_path / "python.fmu").namelist()
    assert "modelDescription.xml" in names and any("binaries/" in name for name in names)


def test_the_demo_runs_from_the_wheel(program, tmp_path):
    done = program("demo", "-o", "demo")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "demo" / "report.html").is_file()


def test_an_interrupted_run_of_the_program_keeps_its_rows(tmp_path):
    if os.name == "nt":
        pytest.skip("signals of POSIX")
    (tmp_path / "chain.toml").write_text(CHAIN.replace("duration = 10.0", "duration = 4e5"))
    command = [sys.executable, "-m", "moorline", "run", "chain.toml", "-o", "out"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    results = tmp_path / "out" / "results.csv"
    while not (results.exists() and results.stat().st_size > 100_000):  # it steps, and listens
        assert process.poll() is None
    process.send_signal(2)
    _, errors = process.communicate(timeout=20)
    assert process.returncode == 130 and "--resume" in errors


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="needs mypy")
def test_the_stubs_are_those_of_the_module_and_the_package_is_typed(tmp_path):
    stubtest = [sys.executable, "-m", "mypy.stubtest", "moorline._moorline", "--ignore-disjoint-bases"]
    done = subprocess.run(stubtest, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout
    script = tmp_path / "typed.py"
    script.write_text(snippet())
    mypy = [sys.executable, "-m", "mypy", "--strict", "--package", "moorline"]
    done = subprocess.run(mypy, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout


def snippet():
    """The Python code of the README's section on Python."""
    readme = (ROOT / "README.md").read_text()
    section = readme.split("\n## Python\n")[1].split("\n## ")[0]
    return re.search(r"```python\n(.*?)```", section, re.DOTALL).group(1)


def test_the_snippet_of_the_readme_runs(tmp_path):
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    environment = {**os.environ, "MPLBACKEND": "agg"}
    done = subprocess.run([sys.executable, "-c", snippet()], capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout.split()[0]) > 1e5


def test_help_and_stubs_have_the_same_text():
    tree = ast.parse(pathlib.Path(moorline.__file__).with_name("_moorline.pyi").read_text())
    compared = 0
    for node in tree.body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            owner = getattr(_moorline, node.name)
            inside = node.body if isinstance(node, ast.ClassDef) else []
            methods = [one for one in inside if isinstance(one, ast.FunctionDef) and not one.name.startswith("__")]
            for described, stub in [(owner, node), *((getattr(owner, one.name), one) for one in methods)]:
                assert described.__doc__.split() == ast.get_docstring(stub).split(), stub.name
                compared += 1
    assert compared > 30
