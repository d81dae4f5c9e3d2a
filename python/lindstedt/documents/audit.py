"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several


@dataclass(frozen=True, eq=False, repr=False)
class AuditCounts(Document):
    """How many claims have each verdict.

    Attributes:
        reproduced: Reproduced to every printed digit.
        reproduced_under_assumption: Reproduced by something that the publication does not say.
        not_reproducible: Not to be computed, for want of what is not printed.
        inconsistent: Something else is computed.
    """

    reproduced: int
    reproduced_under_assumption: int
    not_reproducible: int
    inconsistent: int


AuditCounts.FIELDS = (
    ("reproduced", "reproduced", None),
    ("reproduced_under_assumption", "reproduced_under_assumption", None),
    ("not_reproducible", "not_reproducible", None),
    ("inconsistent", "inconsistent", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class AuditEntry(Document):
    """One thing that is printed.

    Attributes:
        printed: As it is printed.
        computed: What is computed, in words; null where nothing is.
        value: The same as a number; null where it is none.
        reproduced: Whether it comes out as it is printed; of a trend, whether the whole of it
            does.
    """

    printed: str
    computed: str | None
    value: float | None
    reproduced: bool


AuditEntry.FIELDS = (
    ("printed", "printed", None),
    ("computed", "computed", None),
    ("value", "value", None),
    ("reproduced", "reproduced", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class AuditTried(Document):
    """The claim under some suppositions.

    Attributes:
        supposing: What is supposed; empty for the claim alone.
        reproduced: How many entries come out.
        values: What is computed for each entry; null where it is no number.
    """

    supposing: tuple[str, ...]
    reproduced: int
    values: tuple[float | None, ...]


AuditTried.FIELDS = (
    ("supposing", "supposing", tuple),
    ("reproduced", "reproduced", None),
    ("values", "values", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class AuditUnknown(Document):
    """What a claim asks of a number that is not printed.

    Attributes:
        name: Its name.
        value: A value that makes the claim come out.
        range: The least and the greatest such value beside it.
        within: Where it may lie.
        is_within: Whether it does.
    """

    name: str
    value: float
    range: tuple[float, float]
    within: tuple[float, float]
    is_within: bool


AuditUnknown.FIELDS = (
    ("name", "name", None),
    ("value", "value", None),
    ("range", "range", tuple),
    ("within", "within", tuple),
    ("is_within", "is_within", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class AuditClaim(Document):
    """One claim.

    Attributes:
        id: Its name in the file.
        place: Where it is printed.
        says: What is claimed, in words.
        printed: What is printed, in one line; empty where that is no text.
        computed: What is computed, in one line, with the assumption where there is one; empty
            where nothing is.
        verdict: The verdict.
        assumption: What is supposed where it is reproduced under an assumption; null where it is
            not.
        missing: What is needed and not printed.
        evidence: Why the verdict is what it is, sentence by sentence.
        expected: The verdict that the file expects; null where it says nothing, and the claim is
            expected to be reproduced.
        as_expected: Whether the verdict is the expected one.
        entries: What is printed, entry by entry, beside what is computed.
        tried: What was supposed in turn, the claim alone first.
        unknown: What the claim asks of a number that is not printed; null where none was solved
            for.
        note: What the file says beside it; null where it says nothing.
    """

    id: str
    place: str
    says: str
    printed: str
    computed: str
    verdict: Literal["reproduced", "reproduced-under-assumption", "not-reproducible", "inconsistent"]
    assumption: str | None
    missing: tuple[str, ...]
    evidence: tuple[str, ...]
    expected: str | None
    as_expected: bool
    entries: tuple[AuditEntry, ...]
    tried: tuple[AuditTried, ...]
    unknown: AuditUnknown | None
    note: str | None


AuditClaim.FIELDS = (
    ("id", "id", None),
    ("place", "place", None),
    ("says", "says", None),
    ("printed", "printed", None),
    ("computed", "computed", None),
    ("verdict", "verdict", None),
    ("assumption", "assumption", None),
    ("missing", "missing", tuple),
    ("evidence", "evidence", tuple),
    ("expected", "expected", None),
    ("as_expected", "as_expected", None),
    ("entries", "entries", several(AuditEntry.from_json)),
    ("tried", "tried", several(AuditTried.from_json)),
    ("unknown", "unknown", AuditUnknown.from_json),
    ("note", "note", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Audit(Answer):
    """Claims of a publication, computed again, with a verdict each.

    Attributes:
        schema: The kind of document.
        title: The publication; empty where the file names none.
        counts: How many claims have each verdict.
        passes: Whether every verdict is the expected one: the exit code is 0 then, and 3 if not.
        claims: The claims, in the order of the file.
    """

    schema: Literal["lindstedt/audit/1"]
    title: str
    counts: AuditCounts
    passes: bool
    claims: tuple[AuditClaim, ...]


Audit.FIELDS = (
    ("schema", "schema", None),
    ("title", "title", None),
    ("counts", "counts", AuditCounts.from_json),
    ("passes", "passes", None),
    ("claims", "claims", several(AuditClaim.from_json)),
)
