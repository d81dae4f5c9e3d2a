"""The package itself: generated files, types, imports."""

import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]


def test_generated_files_are_what_the_program_says():
    script = [sys.executable, str(PACKAGE / "generate.py"), "--check"]
    checked = subprocess.run(script, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_types():
    pytest.importorskip("mypy")
    words = ["-m", "mypy", "--strict", "--no-error-summary", str(PACKAGE / "lindstedt")]
    checked = subprocess.run([sys.executable, *words], capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_what_is_not_used_is_not_imported():
    code = (
        "import sys, lindstedt as ls; ls.derive('pendulum').judge(A=1)\n"
        "heavy = {'numpy', 'sympy', 'pandas', 'matplotlib', 'xarray', 'numba', 'jax'}\n"
        "sys.exit(str(heavy & set(sys.modules)) if heavy & set(sys.modules) else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
