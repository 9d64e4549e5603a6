"""The order of proposals: which of several edits for the same lines comes first."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from grammar.notation.edits import AddToken, Edit
from recovery import tuning
from recovery.clustering.cause import Proposal
from recovery.clustering.edit_trial import EditTrial
from recovery.clustering.file_trial import FileTrial
from recovery.clustering.negative_score import NegativeCounter
from recovery.clustering.regression import ParsedFiles
from recovery.clustering.worth import Sought


class ProposalOrder:
    """Sorts the proposals for lines of one grammar."""

    def __init__(
        self,
        trial: EditTrial,
        file_trial: FileTrial,
        count_negatives: NegativeCounter,
        parsed_files: ParsedFiles,
    ) -> None:
        self._trial = trial
        self._file_trial = file_trial
        self._count_negatives = count_negatives
        self._parsed_files = parsed_files

    def in_order(
        self, proposals: Sequence[Proposal], sought: Sought, alike: Collection[int]
    ) -> list[Proposal]:
        """Return the proposals for the lines that are sought, the best first.

        ``alike`` are the open lines that fail at the same token as the heaviest of these.
        """
        share = {p.edits: self.readable_share(p.edits, sought.heaviest) for p in proposals}

        def key(proposal: Proposal) -> tuple[int, float, str]:
            """Return negatives, for which no worth makes up, then the worth."""
            edits, own = proposal.edits, share[proposal.edits]
            # what reads the first line of a block but not the block accepts no program with it
            further = [other for other, read in share.items() if read > own]
            negatives = self._count_negatives(edits, further)
            return negatives, -self._worth(proposal, sought, own, alike), str(edits)

        return sorted(proposals, key=key)

    def _worth(
        self, proposal: Proposal, sought: Sought, share: float, alike: Collection[int]
    ) -> float:
        worth = sought.worth(proposal.edits, proposal.breadth, proposal)
        # a line may be readable and the rest of its file not
        worth *= tuning.LINE_WEIGHT + (1 - tuning.LINE_WEIGHT) * share
        if proposal.mended.issuperset(alike):  # none is left to explain
            worth *= tuning.ALL_ALIKE_FACTOR
        if self.loses(proposal.edits):
            worth *= tuning.FLAW_FACTOR
        if self._trial.is_ambiguous(proposal.edits, proposal.mended & sought.lines):
            worth *= tuning.FLAW_FACTOR
        return worth

    def readable_share(self, edits: Sequence[Edit], lines: Iterable[int]) -> float:
        """Return the share of files that fail first at these lines and can then be read further."""
        wider = self._trial.wider(edits)
        return 0.0 if wider is None else self._file_trial.readable_share(wider, lines)

    def loses(self, edits: Sequence[Edit]) -> bool:
        """Return whether some files that parse now would not, since a word is reserved."""
        words = [edit.name for edit in edits if isinstance(edit, AddToken)]
        wider = self._trial.wider(edits) if words else None
        return wider is not None and self._parsed_files.breaks(wider, words)
