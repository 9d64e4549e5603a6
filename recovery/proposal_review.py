"""Review of proposals: the edit, its effect and cost, and the difference it makes."""

from __future__ import annotations

import difflib
from collections.abc import Sequence

from grammar.notation.edits import AddToken, apply, describe, to_data
from grammar.parser.ambiguity import is_ambiguous
from grammar.parser.recognizer import Recognizer
from grammar.parser.shortest_paths import Paths
from recovery.clustering.cause import Proposal
from recovery.clustering.cluster import Cluster, Clusters
from recovery.clustering.edit_trial import edited
from recovery.records import ProposalRecord
from recovery.survey.survey import Survey, SurveyedFile
from recovery.survey.unreserved_keywords import UnreservedKeyword, unreserved_keywords
from support.files.decode import decode
from support.files.discovery import Skipped, read

# Mended lines looked at for second readings; the first of them are the shortest.
_LINES_READ = 60


class _Program:
    """A program that parses: in how many files it is, the origin of the first, its text."""

    def __init__(self, places: int, origin: str, text: str) -> None:
        self.places = places
        self.origin = origin
        self.text = text
        self.folded = text.upper()


class Reviewer:
    """Works out what a proposal costs: programs it breaks, second readings it adds."""

    def __init__(self, found: Survey, clusters: Clusters) -> None:
        self.found = found
        self.clusters = clusters
        self.recognizer = Recognizer(found.grammar)
        self._paths = Paths(self.recognizer.network)
        self._parsed: list[_Program] | None = None

    def records(self, cluster: Cluster) -> list[ProposalRecord]:
        """The proposals of a cluster as plain data, the best first."""
        return [
            self._record(proposal, files)
            for proposal, files in zip(cluster.proposals, cluster.restores, strict=True)
        ]

    def wider(self, proposal: Proposal) -> Recognizer | None:
        """A recogniser of the grammar with the proposal."""
        return edited(self.recognizer, proposal.edits)

    def _record(self, proposal: Proposal, files: Sequence[SurveyedFile]) -> ProposalRecord:
        grammar = self.found.grammar
        last = proposal.edits[-1]
        return {
            "edit": "; ".join(describe(grammar, edit) for edit in proposal.edits),
            "kind": str(to_data(last)["edit"]),
            "restores": self._restores(proposal, files),
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

    def _restores(self, proposal: Proposal, files: Sequence[SurveyedFile]) -> int:
        """Files that really parse with the proposal alone: they are read again."""
        wider = self.wider(proposal)
        if wider is None:
            return 0
        return sum(len(f.places) for f in files if wider.accepts("\n".join(f.lines())))

    def _ambiguities(self, proposal: Proposal) -> int:
        """Of the lines the proposal mends, those that then have two readings."""
        wider = self.wider(proposal)
        if wider is None:
            return 0
        lines = sorted(
            (self.clusters.lines[n] for n in proposal.mended), key=lambda line: len(line.form.kinds)
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
            program.places
            for program in self._programs()
            if any(word in program.folded for word in words) and not wider.accepts(program.text)
        )

    def unreserved_keywords(self) -> list[UnreservedKeyword]:
        """Words of the programs that parse which may be keywords the grammar lacks."""
        programs = ((p.origin, p.text) for p in self._programs())
        return unreserved_keywords(programs, self.recognizer.lexer)

    def _programs(self) -> Sequence[_Program]:
        """The programs that parse."""
        if self._parsed is None:
            self._parsed = []
            for file in self.found.files:
                if not file.failures:
                    data = read(file.found)
                    source = None if isinstance(data, Skipped) else decode(data)
                    if source is not None and not isinstance(source, str):
                        self._parsed.append(
                            _Program(len(file.places), file.places[0][1], source.text)
                        )
        return self._parsed
