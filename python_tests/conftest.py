"""Packages scenes with the command line: environment variable MOORLINE, default ../target/release/moorline."""

import os
import pathlib
import subprocess

import pytest

import scenes
from fmu_calls import Library, Slave, unpack

HERE = pathlib.Path(__file__).resolve().parent
MOORLINE = os.environ.get("MOORLINE", str(HERE.parent / "target" / "release" / "moorline"))


@pytest.fixture(scope="session")
def moorline():
    """Runs the command line and returns the finished process."""

    def run(*arguments):
        return subprocess.run([MOORLINE, *map(str, arguments)], capture_output=True, text=True)

    return run


@pytest.fixture(scope="session")
def package(moorline, tmp_path_factory):
    """Packages a scene of `scenes.py` once and returns the path of the .fmu file."""
    made = {}

    def make(name, version):
        if (name, version) not in made:
            folder = tmp_path_factory.mktemp(f"{name.lower()}{version}")
            scene, fmu = folder / "scene.toml", folder / f"{name.lower()}.fmu"
            scene.write_text(getattr(scenes, name))
            done = moorline("fmu", scene, "-o", fmu, "--fmi", version)
            assert done.returncode == 0, done.stderr
            made[name, version] = fmu
        return made[name, version]

    return make


@pytest.fixture(scope="session")
def library(package, tmp_path_factory):
    """Packages, unpacks and loads a scene once."""
    loaded = {}

    def load(name, version):
        if (name, version) not in loaded:
            folder = tmp_path_factory.mktemp("unpacked")
            loaded[name, version] = Library(unpack(package(name, version), folder))
        return loaded[name, version]

    return load


@pytest.fixture(params=[2, 3], ids=["fmi2", "fmi3"])
def version(request):
    return request.param


@pytest.fixture
def slave(library, version):
    """Makes instances of a scene and frees them after the test."""
    made = []

    def make(scene="CHAIN", **options):
        one = Slave(library(scene, version), **options)
        made.append(one)
        return one

    yield make
    for one in made:
        if one.handle:
            one.free()
