#!/usr/bin/env python3
"""Builds the wheel of the Python package: the FMU library is built and put into the package, then maturin does the rest.

    python3 python/build.py [-o FOLDER] [further arguments of maturin]

Needs a Rust toolchain, and maturin in the environment of the interpreter that runs this. The wheel holds for all versions of Python
from 3.11 on. `release/build` makes the wheels of a release.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
PACKAGE = HERE / "package" / "moorline"
LIBRARIES = ["libmoorline_fmu.so", "libmoorline_fmu.dylib", "moorline_fmu.dll"]


def fmu_library():
    """Builds the FMU library and returns its file.

    The module is built with it: with the same packages selected, the library of both is built once.
    """
    command = ["cargo", "build", "--release", "--locked", "--package", "moorline-fmu", "--package", "moorline-python", "--lib"]
    subprocess.run(command, cwd=HERE, check=True, env={**os.environ, "PYO3_BUILD_EXTENSION_MODULE": "1", "PYO3_PYTHON": sys.executable})
    command = ["cargo", "metadata", "--format-version", "1", "--no-deps", "--locked"]
    metadata = json.loads(subprocess.run(command, cwd=HERE, check=True, stdout=subprocess.PIPE).stdout)
    folder = pathlib.Path(metadata["target_directory"]) / "release"
    newest = max((folder / name for name in LIBRARIES if (folder / name).is_file()), key=lambda file: file.stat().st_mtime)
    return newest


def main():
    parser = argparse.ArgumentParser(description="Builds the wheel of the Python package.")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=HERE / "dist", help="folder for the wheel")
    options, others = parser.parse_known_args()
    library = fmu_library()
    for name in LIBRARIES:
        (PACKAGE / name).unlink(missing_ok=True)
    shutil.copy2(library, PACKAGE / library.name)
    maturin = [sys.executable, "-m", "maturin", "build", "--release", "--locked", "--interpreter", sys.executable]
    subprocess.run([*maturin, "--out", options.output.resolve(), *others], cwd=HERE, check=True)


if __name__ == "__main__":
    main()
