"""Parts of a release: exported functions, an archive of FMU libraries, a program that is copied alone."""

import pathlib
import platform
import shutil
import subprocess
import sys
import zipfile

import pytest

import scenes
from conftest import HERE, MOORLINE

lief = pytest.importorskip("lief", reason="lief is not installed: no reader of libraries")

sys.path.insert(0, str(HERE.parent / "release"))
import check  # noqa: E402

BUILT = pathlib.Path(MOORLINE).resolve().parent
ROOT = HERE.parent
ENDINGS = {"linux": "lib{}.so", "darwin": "lib{}.dylib", "win32": "{}.dll"}


def library(name):
    return BUILT / ENDINGS[sys.platform].format(name)


@pytest.mark.parametrize("name", ["moorline_fmu", "moorline_c", "moordyn"])
def test_a_library_exports_the_functions_of_its_headers_and_no_others(name):
    exported = check.exports(ROOT)[name]
    assert len(exported) > 30
    assert check.exported_names(lief.parse(str(library(name)))) == exported


@pytest.mark.skipif(sys.platform != "linux", reason="glibc is of Linux")
def test_what_must_not_be_published_is_refused_with_the_reason(tmp_path):
    path = library("moorline_c")
    exported = check.exports(ROOT)["moorline_c"]
    with pytest.raises(check.Wrong, match="younger than 2.0"):
        check.program(path, "2.0", ROOT)
    with pytest.raises(check.Wrong, match="not stripped"):
        check.program(path, "99.0", ROOT)
    if shutil.which("strip"):
        stripped = tmp_path / "stripped.so"
        subprocess.run(["strip", path, "-o", stripped], check=True)
        with pytest.raises(check.Wrong, match="lacks the functions .'another'. and exports .'moorline_step'."):
            check.library(stripped, exported - {"moorline_step"} | {"another"}, "99.0", tmp_path / "elsewhere")


@pytest.mark.skipif((sys.platform, platform.machine()) != ("linux", "x86_64"), reason="the names are those of Linux on x86-64")
def test_a_program_beside_an_archive_makes_an_fmu_for_all_its_platforms(tmp_path):
    program = pathlib.Path(shutil.copy2(MOORLINE, tmp_path))
    (tmp_path / "chain.toml").write_text(scenes.CHAIN)

    def fmu(version):
        return subprocess.run([program, "fmu", "chain.toml", "-o", "chain.fmu", "--fmi", version], cwd=tmp_path, capture_output=True, text=True)

    alone = fmu("2")
    assert alone.returncode == 1
    assert "libmoorline_fmu.so is not in" in alone.stderr and "cargo build --release -p moorline-fmu" in " ".join(alone.stderr.split())
    own = library("moorline_fmu").read_bytes()
    with zipfile.ZipFile(tmp_path / "moorline_fmu.zip", "w") as archive:
        archive.writestr("x86_64-linux/libmoorline_fmu.so", own)
        archive.writestr("x86_64-windows/moorline_fmu.dll", b"a library for Windows")
    for version, folders in (("2", ["linux64", "win64"]), ("3", ["x86_64-linux", "x86_64-windows"])):
        done = fmu(version)
        assert done.returncode == 0, done.stderr
        with zipfile.ZipFile(tmp_path / "chain.fmu") as made:
            libraries = {name.split("/")[1]: made.read(name) for name in made.namelist() if name.startswith("binaries/")}
            assert libraries == {folders[0]: own, folders[1]: b"a library for Windows"}
    from fmpy import simulate_fmu
    result = simulate_fmu(str(tmp_path / "chain.fmu"), stop_time=0.5, output_interval=0.05, output=["line1.tension_b"])
    assert result["line1.tension_b"][-1] > 0.0
