#!/usr/bin/env python3
"""Make the tables and figures of speed against error anew on this machine, and the part of docs/accuracy.md that shows them.

Builds the command line, runs `moorline accuracy` over the public scenes into a folder named after the processor,
and puts its summary between the marks of docs/accuracy.md. `--page-only` does the last part alone, from the folder's tables.
"""

import argparse
import csv
import re
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
MARKS = "<!-- accuracy: begin -->", "<!-- accuracy: end -->"
# What the repository keeps of a run; the script of the peers is there already.
KEPT = "*.csv", "*.md", "*.svg"


def machine(folder):
    """Return the processor that the tables in `folder` name."""
    with open(folder / "accuracy.csv", newline="", encoding="utf-8") as table:
        return next(csv.DictReader(table))["machine"]


def folder_of(name):
    """Return the folder of a processor."""
    return HERE / re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def measured(peers):
    """Run the study and return the folder that its results have been moved to."""
    subprocess.run(["cargo", "build", "--release"], cwd=ROOT, check=True)
    with tempfile.TemporaryDirectory() as directory:
        command = [ROOT / "target/release/moorline", "accuracy", "-o", directory]
        subprocess.run(command + (["--peers", peers] if peers else []), check=True)
        folder = folder_of(machine(Path(directory)))
        folder.mkdir(exist_ok=True)
        for pattern in KEPT:
            for file in Path(directory).glob(pattern):
                (folder / file.name).write_bytes(file.read_bytes())
    return folder


def shown(folder):
    """Put the summary and the figure of `folder` between the marks of the page."""
    page = HERE.parent / "accuracy.md"
    before, rest = page.read_text(encoding="utf-8").split(MARKS[0])
    _, after = rest.split(MARKS[1])
    place = folder.relative_to(HERE.parent).as_posix()
    summary = (folder / "summary.md").read_text(encoding="utf-8")
    text = f"Measured on {machine(folder)}; tables and figures in [{place}]({place}).\n\n"
    text += f"![cost against error]({place}/overview.svg)\n\n"
    text += f"In a host:\n\n![cost against error in a host]({place}/in_host.svg)\n\n{summary}"
    page.write_text(f"{before}{MARKS[0]}\n{text}{MARKS[1]}{after}", encoding="utf-8")


def main():
    """Measure where wanted, and show."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--peers", help="Python interpreter or virtual environment with the peers' packages")
    parser.add_argument("--page-only", metavar="FOLDER", help="show a folder's tables, measure nothing")
    arguments = parser.parse_args()
    only = arguments.page_only
    shown(Path(only).resolve() if only else measured(arguments.peers))


if __name__ == "__main__":
    main()
