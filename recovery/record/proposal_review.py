"""Review of proposals: the edit, its effect and cost, and the difference it makes."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from functools import cached_property

from grammar.notation.edits import AddToken, apply, describe, to_data
from grammar.parser.ambiguity import is_ambiguous
from grammar.parser.recognizer import Recognizer
from grammar.parser.shortest_paths import Paths
from recovery.clustering.cause import Proposal
from recovery.clustering.cluster import Cluster, Clusters
from recovery.clustering.edit_trial import edited
from recovery.record.record_types import ProposalRecord
from recovery.survey.survey import Survey
from recovery.survey.surveyed_files import SurveyedFile

# Mended lines looked at for second readings; the first of them are the shortest.
_LINES_READ = 60


class Reviewer:
    """Determines the cost of a proposal: programs that it breaks, second readings that it adds."""

    def __init__(self, found: Survey, clusters: Clusters) -> None:
        self.found = found
        self.clusters = clusters
        self.recognizer = Recognizer(found.grammar)
        self._paths = Paths(self.recognizer.network)

    def records(self, cluster: Cluster) -> list[ProposalRecord]:
        """Return the proposals of a cluster as plain data, the best first."""
        return [
            self._record(proposal, files)
            for proposal, files in zip(cluster.proposals, cluster.restores, strict=True)
        ]

    def wider(self, proposal: Proposal) -> Recognizer | None:
        """Return a recogniser for the grammar with the proposal."""
        return edited(self.recognizer, proposal.edits)

    def _record(self, proposal: Proposal, files: Sequence[SurveyedFile]) -> ProposalRecord:
        grammar = self.found.grammar
        last = proposal.edits[-1]
        wider = self.wider(proposal)
        return {
            "edit": "; ".join(describe(grammar, edit) for edit in proposal.edits),
            "kind": str(to_data(last)["edit"]),
            "restores": self._restores(wider, files),
            "mends": len(proposal.mended),
            "advances": len(proposal.advanced),
            "accepts_negatives": proposal.accepts_negatives,
            "ambiguities": self._ambiguities(wider, proposal),
            "breaks": self._breaks(wider, proposal),
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

    def _restores(self, wider: Recognizer | None, files: Sequence[SurveyedFile]) -> int:
        """Return files that really parse with the proposal alone: they are read again."""
        if wider is None:
            return 0
        return sum(len(f.places) for f in files if wider.accepts("\n".join(f.lines())))

    def _ambiguities(self, wider: Recognizer | None, proposal: Proposal) -> int:
        """Return the lines that the proposal makes readable in two ways."""
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

    def _breaks(self, wider: Recognizer | None, proposal: Proposal) -> int:
        """Return files that parse now and would not: only a newly reserved word can do that."""
        words = _reserved(proposal)
        if not words:
            return 0
        assert wider is not None
        files = {file.digest: file for word in words for file in self._readers_of[word]}
        return sum(
            len(file.places)
            for file in files.values()
            if not wider.accepts("\n".join(file.lines()))
        )

    @cached_property
    def _readers_of(self) -> dict[str, list[SurveyedFile]]:
        """Return the places in parsing files of the words that a proposal reserves."""
        proposals = [proposal for one in self.clusters.ranked for proposal in one.proposals]
        words = sorted({word for proposal in proposals for word in _reserved(proposal)})
        found: dict[str, list[SurveyedFile]] = {word: [] for word in words}
        for file in self.found.files if words else ():
            if not file.failures:
                folded = "\n".join(file.lines()).upper()
                for word in words:
                    if word in folded:
                        found[word].append(file)
        return found


def _reserved(proposal: Proposal) -> list[str]:
    return [edit.name for edit in proposal.edits if isinstance(edit, AddToken)]
