"""Optional packages, imported when they are used."""

from __future__ import annotations

import importlib
from typing import Any

from .errors import MissingPackage


def optional(name: str, purpose: str) -> Any:
    """Imports an optional package.

    Raises:
        MissingPackage: It is not installed; the message says how to install it.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        package = name.partition(".")[0]
        text = f"{purpose} needs {package}, which is not installed\n  help: pip install {package}"
        raise MissingPackage(text, "import") from error
