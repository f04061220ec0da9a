#!/usr/bin/env python3
"""Make the tables and figures of speed against error anew on this machine, and the part of docs/accuracy.md that shows them.

Builds the command line, runs `moorline accuracy` over the public scenes, or those given, into a folder named after the
processor, which keeps its other scenes, and puts the summaries of all folders between the marks of docs/accuracy.md.
`--page-only` does the last part alone.
"""

import argparse
import csv
import platform
import re
import shutil
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


def processor():
    """Return the name of this processor."""
    names = re.findall(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.MULTILINE)
    return names[0].strip() if names else platform.machine()


def folder_of(name):
    """Return the folder of a processor."""
    return HERE / re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def measure(scenes, peers):
    """Run the study, and add its results to those of this processor."""
    subprocess.run(["cargo", "build", "--release"], cwd=ROOT, check=True)
    with tempfile.TemporaryDirectory() as directory:
        command = [ROOT / "target/release/moorline", "accuracy", *scenes, "--add", "-o", directory]
        for table in HERE.glob("*/accuracy.csv"):
            if machine(table.parent) == processor():
                shutil.copy(table, directory)
        subprocess.run(command + (["--peers", peers] if peers else []), check=True)
        folder = folder_of(machine(Path(directory)))
        folder.mkdir(exist_ok=True)
        for pattern in KEPT:
            for file in Path(directory).glob(pattern):
                (folder / file.name).write_bytes(file.read_bytes())


def show():
    """Put the summaries and the figures of all folders between the marks of the page."""
    page = HERE.parent / "accuracy.md"
    before, rest = page.read_text(encoding="utf-8").split(MARKS[0])
    _, after = rest.split(MARKS[1])
    parts = [part(summary.parent) for summary in sorted(HERE.glob("*/summary.md"))]
    text = "\n".join(parts)
    page.write_text(f"{before}{MARKS[0]}\n{text}{MARKS[1]}{after}", encoding="utf-8")


def part(folder):
    """Return the part of the page on the scenes that were measured on one processor."""
    place = folder.relative_to(HERE.parent).as_posix()
    text = f"Measured on {machine(folder)}; tables and figures in [{place}]({place}).\n\n"
    text += f"![cost against error]({place}/overview.svg)\n\n"
    text += f"In a host:\n\n![cost against error in a host]({place}/in_host.svg)\n\n"
    return text + (folder / "summary.md").read_text(encoding="utf-8")


def main():
    """Measure where wanted, and show."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--peers", help="Python interpreter or virtual environment with the peers' packages")
    parser.add_argument("--page-only", action="store_true", help="show the tables that are there, measure nothing")
    parser.add_argument("scenes", nargs="*", help="scenes in place of the public ones")
    arguments = parser.parse_args()
    if not arguments.page_only:
        measure(arguments.scenes, arguments.peers)
    show()


if __name__ == "__main__":
    main()
