"""The package itself: generated files, types, imports."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest
from lindstedt import _lindstedt

PACKAGE = Path(__file__).resolve().parents[1]


def test_generated_files_are_what_the_program_says():
    script = [sys.executable, str(PACKAGE / "generate.py"), "--check"]
    checked = subprocess.run(script, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_the_stub_is_that_of_the_extension():
    stub = ast.parse((PACKAGE / "lindstedt" / "_lindstedt.pyi").read_text())
    told = {
        part.name: [argument.arg for argument in part.args.args]
        for part in stub.body
        if isinstance(part, ast.FunctionDef)
    }
    found = {
        name: list(inspect.signature(function).parameters)
        for name, function in vars(_lindstedt).items()
        if callable(function)
    }
    assert told == found


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
