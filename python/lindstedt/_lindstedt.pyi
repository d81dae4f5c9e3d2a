from collections.abc import Callable, Sequence

def run(
    words: Sequence[str],
    input: str | None = None,
    watch: Callable[[int, int], object] | None = None,
) -> tuple[str, list[str], list[tuple[str, str]], bool | None, bool]:
    """Runs a command with the interpreter lock released: its text, its notes, its text in other
    formats where the work took long, whether its verdict is a pass, whether it is a part only."""

def read(problem: str, input: str | None = None) -> tuple[str, str, list[str]]:
    """Reads the equation of a problem: its text in the grammar, its coordinate, its parameters."""

def commands() -> str:
    """The commands with their arguments, as JSON."""

def main(words: Sequence[str]) -> int:
    """Runs the program with the words of the command line, and returns its exit code."""
