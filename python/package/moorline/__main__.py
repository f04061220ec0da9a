"""The command line: `moorline`, or `python -m moorline`."""

import sys

from moorline import _moorline


def main() -> int:
    """Runs the program with the arguments of this process and returns its exit code."""
    return _moorline.main(["moorline", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
