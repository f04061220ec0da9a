#!/usr/bin/env python3
"""Builds the wheel of the Python package: its module, and the FMU library that it contains.

    python3 python/build.py [-o FOLDER] [--built FOLDER]

Needs a Rust toolchain, and maturin and wheel in the environment of the interpreter that runs this. The wheel holds for all versions of Python
from 3.11 on. `--built` names the folder in which cargo has built both already. `release/build` makes the wheels of a release.
"""

import argparse
import json
import os
import pathlib
import platform
import subprocess
import sys

import packing

HERE = pathlib.Path(__file__).resolve().parent
LIBRARY = {"Windows": "{}.dll", "Darwin": "lib{}.dylib"}.get(platform.system(), "lib{}.so")
SETTINGS = {"PYO3_BUILD_EXTENSION_MODULE": "1", "PYO3_PYTHON": sys.executable}
"""Environment of cargo for a module."""


def build():
    """Builds the module and the FMU library and returns their folder."""
    command = ["cargo", "build", "--release", "--locked", "--package", "moorline-fmu", "--package", "moorline-python", "--lib"]
    subprocess.run(command, cwd=HERE, check=True, env={**os.environ, **SETTINGS})
    command = ["cargo", "metadata", "--format-version", "1", "--no-deps", "--locked"]
    metadata = json.loads(subprocess.run(command, cwd=HERE, check=True, stdout=subprocess.PIPE).stdout)
    return pathlib.Path(metadata["target_directory"]) / "release"


def main():
    parser = argparse.ArgumentParser(description="Builds the wheel of the Python package.")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=HERE / "dist", help="folder for the wheel")
    parser.add_argument("--built", type=pathlib.Path, help="folder of the module and the FMU library, where cargo has built them")
    options = parser.parse_args()
    folder = options.built or build()
    module, library = (folder / LIBRARY.format(name) for name in ("_moorline", "moorline_fmu"))
    packing.wheel(module, options.output.resolve(), [library])


if __name__ == "__main__":
    main()
