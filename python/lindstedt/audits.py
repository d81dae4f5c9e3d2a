"""Claims of publications, computed again."""

from __future__ import annotations

from typing import Any

from .documents.audit import Audit as AuditDocument
from .documents.audit import AuditClaim
from .tables import Table


class Audit(AuditDocument):
    """Claims with their verdicts.

    >>> import lindstedt as ls
    >>> paper = ls.paper()
    >>> len(paper.rows) == sum(paper.counts.to_json().values())
    True
    """

    @property
    def rows(self) -> Table[AuditClaim]:
        """The claims as the rows of a table."""
        return Table(self.claims)

    def to_pandas(self) -> Any:
        """Returns the claims as a `pandas.DataFrame`."""
        return self.rows.to_pandas()
