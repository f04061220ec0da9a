#!/usr/bin/env python3
"""Runs all tests of moorline: those in Rust, those of the Python package, those that drive its FMUs from Python, and the check of its C
interface. The last step counts instructions, where there is valgrind.

Which tests run where:

    cargo test                                 the fast suite, at most two minutes of processor time after building: all tests of the
                                               packages but those marked slow, which it counts as ignored
    cargo test --features moorline/slow-tests  all of them: `cfg_attr(not(feature = "slow-tests"), ignore = "slow")` marks a slow test
    run_tests.py                               all of them in the optimised build, with fmu/conformance; python_tests; and python/tests on the
                                               wheel of python/build.py
    cargo test -- --ignored NAME               by hand only: tests that write tests/reference/*.csv anew, long surveys (ten thousand
                                               random scenes or lines, each with a shorter suite beside it) and those that show one scene

Needs a Rust toolchain and Python 3.11 or newer. Builds what it tests; Python packages go into .venv, in the versions that
python_tests/requirements.txt and python/requirements.txt name. Arguments are passed on to pytest, such as -k or -x; the Rust tests run all
the same.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import venv

ROOT = pathlib.Path(__file__).resolve().parent
VENV = ROOT / ".venv"
REQUIREMENTS = [ROOT / "python_tests" / "requirements.txt", ROOT / "python" / "requirements.txt"]
PYTHON_MIN = (3, 11)
# All packages with their slow tests, which do not change the programs: one selection for all calls of cargo, so that the library is built once.
PACKAGES = "moorline", "moorline-accuracy", "moorline-c", "moorline-cli", "moorline-moordyn"
FEATURES = ",".join([*(f"{package}/slow-tests" for package in PACKAGES), "moorline-conformance/fmi-sys"])
EVERYTHING = "--workspace", "--locked", "--features", FEATURES


class Failure(Exception):
    """A step without which the others mean nothing."""


def run(*command, log=None, **environment):
    """Runs a command in the repository, shows it here or in a log, and says whether it succeeded."""
    words = [str(word) for word in command]
    print("\n$", " ".join(words), file=log, flush=True)
    began = time.monotonic()
    streams = {"stdin": subprocess.DEVNULL, "stdout": log, "stderr": log and subprocess.STDOUT}
    done = subprocess.run(words, cwd=ROOT, env={**os.environ, **environment}, **streams)
    print(f"({time.monotonic() - began:.0f} s)", file=log, flush=True)
    return done.returncode == 0


def must(*command, **environment):
    if not run(*command, **environment):
        raise Failure(f"{command[0]} failed")


def python():
    """The interpreter of .venv, with exactly the pinned packages; made anew when a list or Python has changed."""
    scripts = VENV / ("Scripts" if os.name == "nt" else "bin")
    interpreter = scripts / ("python.exe" if os.name == "nt" else "python")
    lists = b"".join(requirements.read_bytes() for requirements in REQUIREMENTS)
    wanted = hashlib.sha256(lists + sys.version.encode()).hexdigest()
    stamp = VENV / "requirements.sha256"
    if not stamp.is_file() or stamp.read_text() != wanted:
        print(f"making {VENV}", flush=True)
        try:
            venv.create(VENV, clear=True, with_pip=True)
        except subprocess.CalledProcessError:
            raise Failure("Python's venv and ensurepip are missing; on Debian: apt install python3-venv") from None
        quiet = ["--quiet", "--disable-pip-version-check"]
        required = [word for requirements in REQUIREMENTS for word in ("--requirement", requirements)]
        must(interpreter, "-m", "pip", "install", *quiet, "--no-deps", *required)
        must(interpreter, "-m", "pip", "check", "--disable-pip-version-check")
        stamp.write_text(wanted)
    return interpreter


def output(*command):
    """What a command prints."""
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise Failure(f"{command[0]} failed")
    return done.stdout.strip()


def release_folder():
    """Where cargo puts the optimised build."""
    metadata = output("cargo", "metadata", "--format-version", "1", "--no-deps", "--locked")
    return pathlib.Path(json.loads(metadata)["target_directory"]) / "release"


def libclang(interpreter):
    """Settings with which the bindings of fmu/conformance find libclang, from .venv, and the headers that it lacks."""
    folder = "import clang, pathlib; print(pathlib.Path(clang.__path__[0]) / 'native')"
    settings = {"LIBCLANG_PATH": output(interpreter, "-c", folder)}
    if shutil.which("gcc"):
        settings["BINDGEN_EXTRA_CLANG_ARGS"] = f"-I{output('gcc', '-print-file-name=include')}"
    return settings


def test_wheel(interpreter, built, arguments, log):
    """Packs the wheel of the Python package around what cargo built, installs it into .venv and runs its tests; returns whether they passed."""
    with tempfile.TemporaryDirectory() as folder:
        if not run(interpreter, ROOT / "python" / "build.py", "--built", built, "-o", folder, log=log):
            return False
        (wheel,) = pathlib.Path(folder).glob("*.whl")
        quiet = ["--quiet", "--disable-pip-version-check"]
        if not run(interpreter, "-m", "pip", "install", *quiet, "--no-deps", "--no-index", "--force-reinstall", wheel, log=log):
            return False
    return run(interpreter, "-m", "pytest", "python/tests", *arguments, log=log)


def test_python(interpreter, built, program, arguments, log):
    """Runs all tests in Python; returns whether those of the FMUs and those of the package passed."""
    of_fmus = run(interpreter, "-m", "pytest", "python_tests", *arguments, log=log, MOORLINE=str(program))
    return of_fmus, test_wheel(interpreter, built, arguments, log)


def run_all(arguments):
    """Runs every test and returns what failed."""
    interpreter = python()
    built = release_folder()
    program = built / ("moorline.exe" if os.name == "nt" else "moorline")
    module = {"PYO3_BUILD_EXTENSION_MODULE": "1", "PYO3_PYTHON": str(interpreter)}
    settings = {**libclang(interpreter), **module, "MOORLINE": str(program)}
    # Programs, tests and bench in one build: dependencies of the tests add features to those of the library, which would then be built twice.
    # The library and its unit tests are each one unit of code, which takes one core for minutes: they are built side by side.
    must("cargo", "build", "--release", *EVERYTHING, "--lib", "--bins", "--tests", "--bench", "instructions", **settings)
    with concurrent.futures.ThreadPoolExecutor() as aside, tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as log:
        # Beside those in Rust, some of which run alone and use one core.
        tests = aside.submit(test_python, interpreter, built, program, arguments, log)
        # The optimised build, as the program: one build less, and the tests of whole systems run twice as fast.
        rust = run("cargo", "test", "--release", *EVERYTHING, "--no-fail-fast", **settings)
        of_fmus, of_package = tests.result()
        log.seek(0)
        sys.stdout.write(log.read())
    passed = {
        "cargo test": rust,
        "pytest": of_fmus,
        "pytest of the Python package": of_package,
        "instructions": run("cargo", "bench", *EVERYTHING, "--bench", "instructions", **settings),
    }
    return [name for name, passed in passed.items() if not passed]


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
