#!/usr/bin/env bash
# Checks the FMI interface against the crates fmi-sys and fmi. They need libclang, which the venv of python_tests has.
#
#   fmu/conformance/run.sh PYTHON      PYTHON: the python of a venv with python_tests/requirements.txt
set -euo pipefail

if [ $# -ne 1 ]; then
    echo "usage: $0 PYTHON   (of a venv with python_tests/requirements.txt)" >&2
    exit 2
fi
python=$1

LIBCLANG_PATH=$("$python" -c 'import clang, pathlib; print(pathlib.Path(clang.__path__[0]) / "native")')
BINDGEN_EXTRA_CLANG_ARGS="-I$(gcc -print-file-name=include)" # stddef.h, which libclang from PyPI comes without
export LIBCLANG_PATH BINDGEN_EXTRA_CLANG_ARGS

cd "$(dirname "$0")/../.."
# The program and the library beside it that it packages, built here unless MOORLINE names the program.
if [ -z "${MOORLINE:-}" ]; then
    cargo build --release
    MOORLINE=$PWD/target/release/moorline
fi
export MOORLINE
cargo test -p moorline-conformance --features fmi-sys
