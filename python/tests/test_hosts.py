"""The recipes of docs/hosts.md: each block of code that the page does not mark with `skip` runs, but for Matlab's."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

from conftest import ROOT

PAGE = "\n" + (ROOT / "docs" / "hosts.md").read_text()
LIBRARIES = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"


def code(heading, language):
    """The one block of a language below a heading."""
    section = PAGE.split(f"\n{heading}\n")[1].split("\n## ")[0]
    (block,) = re.findall(rf"^```{language}\n(.*?)^```", section, re.DOTALL | re.MULTILINE)
    return block


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the scenes and the FMU of the page."""
    place = tmp_path_factory.mktemp("hosts")
    shutil.copytree(ROOT / "scenes", place / "scenes")
    words = [sys.executable, "-m", *code("# Hosts", "sh").split()]
    done = subprocess.run(words, cwd=place, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return place


def said(command, folder, **environment):
    """The number that a program prints after its name; libcosim writes lines of its own."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env={**os.environ, **environment})
    assert done.returncode == 0, done.stderr
    return float(re.search(r"^\S+ ([-+.e\d]+)$", done.stdout, re.MULTILINE).group(1))


@pytest.fixture(scope="module")
def tension(folder):
    """Tension [N] at the end of the motion of the page, from the recipe in Python."""
    return said([sys.executable, "-c", code("## Own code in Python", "python")], folder)


def test_the_recipe_of_libcosim_has_the_tension_of_the_recipe_in_python(folder, tension):
    pytest.importorskip("libcosimpy", reason="libcosim is not installed")
    assert said([sys.executable, "-c", code("## libcosim", "python")], folder) == pytest.approx(tension, rel=1e-9)


def test_the_recipe_of_fmpy_runs(folder, tension):
    pytest.importorskip("fmpy", reason="FMPy is not installed")
    greatest = said([sys.executable, "-c", code("## FMPy", "python")], folder)
    assert greatest > tension > 1e5 and np.isfinite(greatest)


def test_the_recipe_in_cpp_has_the_tension_of_the_recipe_in_python(folder, tension):
    if shutil.which("g++") is None:
        pytest.skip("there is no g++")
    if not (LIBRARIES / "libmoorline_c.so").is_file():
        pytest.skip("libmoorline_c is not built: cargo build --release")
    (folder / "host.cpp").write_text(code("## Own code in C and C++", "cpp"))
    include = ROOT / "capi" / "include"
    subprocess.run(["g++", "-Wall", "-Wextra", "-Werror", "-I", include, "host.cpp", "-L", LIBRARIES, "-lmoorline_c", "-o", "host"],
                   cwd=folder, check=True)
    assert said([folder / "host"], folder, LD_LIBRARY_PATH=str(LIBRARIES)) == pytest.approx(tension, rel=1e-9)


def test_every_block_of_the_page_is_of_a_language_that_runs_here_or_is_marked():
    languages = re.findall(r"^```(.+)$", PAGE, re.MULTILINE)
    assert sorted(set(languages)) == ["cpp", "matlab", "python", "python skip", "sh", "sh skip"]
    assert languages.count("python") == 3 and languages.count("sh") == 1
