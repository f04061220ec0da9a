#!/usr/bin/env python3
"""Runs all tests of moorline: those in Rust, those that drive its FMUs from Python, and the check of its C interface.

Which tests run where:

    cargo test                                 the fast suite, at most two minutes of processor time after building: all tests of the
                                               packages but those marked slow, which it counts as ignored
    cargo test --features moorline/slow-tests  all of them: `cfg_attr(not(feature = "slow-tests"), ignore = "slow")` marks a slow test
    run_tests.py                               all of them in the optimised build, fmu/conformance/run.sh and python_tests
    cargo test -- --ignored NAME               by hand only: tests that write tests/reference/*.csv anew, long surveys (ten thousand
                                               random scenes or lines, each with a shorter suite beside it) and those that show one scene

Needs a Rust toolchain and Python 3.11 or newer. Builds what it tests; Python packages go into .venv, in the versions that
python_tests/requirements.txt names. Arguments are passed on to pytest, such as -k or -x; the Rust tests run all the same.
"""

import hashlib
import json
import os
import pathlib
import subprocess
import sys
import time
import venv

ROOT = pathlib.Path(__file__).resolve().parent
VENV = ROOT / ".venv"
REQUIREMENTS = ROOT / "python_tests" / "requirements.txt"
CONFORMANCE = ROOT / "fmu" / "conformance" / "run.sh"
PYTHON_MIN = (3, 11)
# Does not change the program: it is built with the feature so that the library is built once.
SLOW_TESTS = "--features", "moorline/slow-tests,moorline-accuracy/slow-tests,moorline-c/slow-tests,moorline-fmu/slow-tests,moorline-moordyn/slow-tests"
# Needs libclang from .venv: has a script of its own.
LEFT_OUT = "--exclude", "moorline-conformance"


class Failure(Exception):
    """A step without which the others mean nothing."""


def run(*command, **environment):
    """Runs a command in the repository, shows it, and says whether it succeeded."""
    words = [str(word) for word in command]
    print("\n$", " ".join(words), flush=True)
    start = time.monotonic()
    done = subprocess.run(words, cwd=ROOT, env={**os.environ, **environment}, stdin=subprocess.DEVNULL)
    print(f"({time.monotonic() - start:.0f} s)", flush=True)
    return done.returncode == 0


def must(*command, **environment):
    if not run(*command, **environment):
        raise Failure(f"{command[0]} failed")


def python():
    """The interpreter of .venv, with exactly the pinned packages; made anew when the list or Python has changed."""
    scripts = VENV / ("Scripts" if os.name == "nt" else "bin")
    interpreter = scripts / ("python.exe" if os.name == "nt" else "python")
    wanted = hashlib.sha256(REQUIREMENTS.read_bytes() + sys.version.encode()).hexdigest()
    stamp = VENV / "requirements.sha256"
    if not stamp.is_file() or stamp.read_text() != wanted:
        print(f"making {VENV}", flush=True)
        try:
            venv.create(VENV, clear=True, with_pip=True)
        except subprocess.CalledProcessError:
            raise Failure("Python's venv and ensurepip are missing; on Debian: apt install python3-venv") from None
        quiet = ["--quiet", "--disable-pip-version-check"]
        must(interpreter, "-m", "pip", "install", *quiet, "--no-deps", "--requirement", REQUIREMENTS)
        must(interpreter, "-m", "pip", "check", "--disable-pip-version-check")
        stamp.write_text(wanted)
    return interpreter


def release_folder():
    """Where cargo puts the optimised build."""
    command = ["cargo", "metadata", "--format-version", "1", "--no-deps", "--locked"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise Failure("cargo metadata failed")
    return pathlib.Path(json.loads(done.stdout)["target_directory"]) / "release"


def run_all(arguments):
    """Runs every test and returns what failed."""
    interpreter = python()
    must("cargo", "build", "--release", "--locked", *SLOW_TESTS)
    program = release_folder() / ("moorline.exe" if os.name == "nt" else "moorline")
    failed = []
    # The optimised build, as the program: one build less, and the tests of whole systems run twice as fast.
    if not run("cargo", "test", "--release", "--workspace", *LEFT_OUT, "--locked", "--no-fail-fast", *SLOW_TESTS):
        failed.append("cargo test")
    if CONFORMANCE.is_file():
        path = os.pathsep.join([str(interpreter.parent), os.environ["PATH"]])
        if not run("bash", CONFORMANCE, interpreter, PATH=path, VIRTUAL_ENV=str(VENV), MOORLINE=str(program)):
            failed.append("fmu/conformance/run.sh")
    if not run(interpreter, "-m", "pytest", "python_tests", *arguments, MOORLINE=str(program)):
        failed.append("pytest")
    return failed


def main():
    if sys.version_info < PYTHON_MIN:
        sys.exit(f"Python {sys.version.split()[0]} is too old: the tests need {'.'.join(map(str, PYTHON_MIN))} or newer")
    try:
        failed = run_all(sys.argv[1:])
    except Failure as failure:
        sys.exit(f"error: {failure}")
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
