"""The examples of the docstrings give what stands there."""

import doctest
import importlib
import pkgutil
from pathlib import Path

import lindstedt
import pytest

MODULES = sorted(
    module.name
    for module in pkgutil.walk_packages(lindstedt.__path__, "lindstedt.")
    if module.name != "lindstedt.__main__"
)


@pytest.mark.parametrize("name", ["lindstedt", *MODULES])
def test_examples(name):
    if name == "lindstedt.symbolic":
        pytest.importorskip("sympy")
    found = doctest.testmod(importlib.import_module(name))
    assert found.failed == 0


def test_the_page_on_python():
    for package in ("pandas", "xarray"):
        pytest.importorskip(package)
    page = Path(__file__).resolve().parents[2] / "docs" / "python.md"
    found = doctest.testfile(str(page), module_relative=False)
    assert found.failed == 0 and found.attempted > 10


def test_there_are_examples():
    finder = doctest.DocTestFinder(exclude_empty=True)
    found = [test for name in MODULES for test in finder.find(importlib.import_module(name))]
    assert sum(bool(test.examples) for test in found) >= 15
