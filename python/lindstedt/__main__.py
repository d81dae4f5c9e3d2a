"""The program: `python -m lindstedt derive pendulum`, and the command `lindstedt`."""

import sys

from ._lindstedt import main as run_program


def main() -> int:
    """Runs the program with the words of the command line, and returns its exit code."""
    return run_program(sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
