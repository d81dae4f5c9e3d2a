"""What every result of a command has: its forms, and how it shows itself."""

from __future__ import annotations

import html as markup
import os
from typing import TYPE_CHECKING, Any

from ._document import Document
from ._optional import optional

if TYPE_CHECKING:
    from ._call import Call, Result

#: The format of a file by its ending.
ENDINGS = {"txt": "text", "tex": "latex", "htm": "html"}


class Answer(Document):
    """The result of a command: its document, and the same in every format of the program.

    Attributes:
        call: The call that it is the result of.
        notes: Notes and warnings of the program.
        passed: Whether its verdict is a pass; `None` where it has none.
        partial: Whether the work stopped before its end, so that this is only a part.
    """

    @property
    def call(self) -> Call:
        """The call that it is the result of."""
        return self.__dict__["_call"]  # type: ignore[no-any-return]

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes and warnings of the program."""
        return self.__dict__["_result"].notes  # type: ignore[no-any-return]

    @property
    def passed(self) -> bool | None:
        """Whether its verdict is a pass; `None` where it has none."""
        return self.__dict__["_result"].passed  # type: ignore[no-any-return]

    @property
    def partial(self) -> bool:
        """Whether the work stopped before its end, so that this is only a part."""
        return self.__dict__["_result"].partial  # type: ignore[no-any-return]

    def _came_of(self, call: Call, result: Result) -> None:
        self.__dict__.update(_call=call, _result=result)

    def __getstate__(self) -> dict[str, Any]:
        kept = {name for name, _, _ in self.FIELDS} | {"_call", "_result"}
        return {name: value for name, value in self.__dict__.items() if name in kept}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)

    def text(self) -> str:
        """Returns what the program prints."""
        return self.call.form("text")

    def latex(self, standalone: bool = False) -> str:
        """Returns the result in LaTeX, as a whole document if `standalone`.

        Raises:
            UsageError: This kind of result has no formulas.
        """
        return self.call.form("latex", *(["--standalone"] if standalone else []))

    def html(self) -> str:
        """Returns the page that stands alone, with its picture."""
        return self.call.form("html")

    def svg(self) -> str:
        """Returns the picture of the program.

        Raises:
            UsageError: This kind of result has no picture.
        """
        return self.call.form("svg")

    def csv(self) -> str:
        """Returns the table of the program, with a line of units before it.

        Raises:
            UsageError: This kind of result has no table.
        """
        return self.call.form("csv")

    def json(self) -> str:
        """Returns the JSON document."""
        return self.call.form("json")

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the result to a file, in the format of its ending: .json, .html, .tex, .svg, .csv,
        .txt, or that of a program."""
        ending = os.fspath(path).rpartition(".")[2].lower()
        languages = {"py": "python", "jl": "julia", "m": "matlab", "rs": "rust", "c": "c"}
        name = ENDINGS.get(ending) or languages.get(ending, ending)
        text = self.call.form(name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def equals(self, other: object) -> bool:
        """Returns whether another result has the same document, byte for byte."""
        return isinstance(other, Answer) and self.json() == other.json()

    def to_pandas(self) -> Any:
        """Returns the table as a `pandas.DataFrame`; the units are in `attrs["units"]`.

        Raises:
            MissingPackage: pandas is not installed.
            UsageError: This kind of result has no table.
        """
        from .tables import columns_of

        pandas = optional("pandas", "a frame")
        text = self.csv()
        told = [
            pair
            for line in text.splitlines()
            if line.startswith("# units: ")
            for pair in line.removeprefix("# units: ").split(", ")
        ]
        frame = pandas.DataFrame(columns_of(text))
        frame.attrs["units"] = {
            name: pair.removeprefix(name + " ")
            for name in frame.columns
            for pair in told
            if pair.startswith(name + " ")
        }
        return frame

    def __str__(self) -> str:
        return self.text().rstrip("\n")

    def __repr__(self) -> str:
        first = next((line.strip() for line in self.text().splitlines() if line.strip()), "")
        return f"<{type(self).__name__}: {first}>"

    def _repr_html_(self) -> str:
        page = markup.escape(self.html(), quote=True)
        return (
            f'<iframe srcdoc="{page}" style="width: 100%; height: 34em; border: 0" '
            f'title="{type(self).__name__}"></iframe>'
        )

    def _repr_latex_(self) -> str | None:
        from .errors import UsageError

        try:
            text = self.latex()
        except UsageError:
            return None
        return "\n".join(line for line in text.splitlines() if not line.startswith("%"))

    def _repr_mimebundle_(
        self, include: Any = None, exclude: Any = None
    ) -> dict[str, str]:
        bundle = {"text/plain": str(self), "text/html": self._repr_html_()}
        if (latex := self._repr_latex_()) is not None:
            bundle["text/latex"] = latex
        return bundle
