"""Proposals as people review them: the edit, what it brings, what it costs, the difference it makes."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from typing import Any

from grammar.ambiguity import is_ambiguous
from grammar.edits import AddToken, apply, describe, to_data
from grammar.paths import Paths
from grammar.recognizer import Recognizer
from recovery.causes import Proposal
from recovery.cluster import Cluster, Clusters
from recovery.ingest import Skipped, decode, read
from recovery.survey import Survey
from recovery.trial import edited

__all__ = ["Reviewer"]

# Mended lines looked at for second readings; the first of them are the shortest.
_LINES_READ = 60


class Reviewer:
    """Works out what a proposal costs: programs it breaks, second readings it brings."""

    def __init__(self, found: Survey, clusters: Clusters) -> None:
        self.found = found
        self.clusters = clusters
        self.recognizer = Recognizer(found.grammar)
        self._paths = Paths(self.recognizer.network)
        self._parsed: list[tuple[int, str]] | None = None

    def records(self, cluster: Cluster) -> list[dict[str, Any]]:
        """The proposals of a cluster as plain data, the best first."""
        return [
            self._record(proposal, restores)
            for proposal, restores in zip(cluster.proposals, cluster.restores, strict=True)
        ]

    def wider(self, proposal: Proposal) -> Recognizer | None:
        """A recogniser of the grammar with the proposal."""
        return edited(self.recognizer, proposal.edits)

    def _record(self, proposal: Proposal, restores: int) -> dict[str, Any]:
        grammar = self.found.grammar
        last = proposal.edits[-1]
        return {
            "edit": "; ".join(describe(grammar, edit) for edit in proposal.edits),
            "kind": str(to_data(last)["edit"]),
            "restores": restores,
            "mends": len(proposal.mended),
            "advances": len(proposal.advanced),
            "accepts_negatives": proposal.accepts_negatives,
            "ambiguities": self._ambiguities(proposal),
            "breaks": self._breaks(proposal),
            "edits": [to_data(edit) for edit in proposal.edits],
            "diff": self._diff(proposal),
        }

    def _diff(self, proposal: Proposal) -> str:
        grammar = self.found.grammar
        old, new = grammar.text, apply(grammar, proposal.edits).text
        lines = difflib.unified_diff(
            old.splitlines(), new.splitlines(), "KRL.g4", "KRL.g4", lineterm="", n=1
        )
        return "\n".join(lines)

    def _ambiguities(self, proposal: Proposal) -> int:
        """Of the lines the proposal mends, those that then have two readings."""
        wider = self.wider(proposal)
        if wider is None:
            return 0
        lines = sorted(
            (self.clusters.lines[n] for n in proposal.mended), key=lambda l: len(l.form.kinds)
        )
        count = 0
        for line in lines[:_LINES_READ]:
            prefix = min(map(self._paths.prefix, line.form.before), key=len)
            start, failed = wider.run(wider.start, prefix)
            if failed is None:
                kinds = list(line.form.kinds)
                for place, word in line.keywords:
                    kinds[place] = wider.lexer.kind_of.get(word, kinds[place])
                count += is_ambiguous(wider, start, kinds)
        return count

    def _breaks(self, proposal: Proposal) -> int:
        """Files that parse now and would not: only a newly reserved word can do that."""
        words = [edit.name for edit in proposal.edits if isinstance(edit, AddToken)]
        if not words:
            return 0
        wider = self.wider(proposal)
        assert wider is not None
        return sum(
            places
            for places, text in self._texts()
            if any(word in text.upper() for word in words) and not wider.accepts(text)
        )

    def _texts(self) -> Sequence[tuple[int, str]]:
        """The programs that parse, with how many files each is."""
        if self._parsed is None:
            self._parsed = []
            for file in self.found.files:
                if not file.failures:
                    data = read(file.found)
                    source = None if isinstance(data, Skipped) else decode(data)
                    if source is not None and not isinstance(source, str):
                        self._parsed.append((len(file.places), source.text))
        return self._parsed
