"""Edits that add blocks of several lines where their first line is allowed."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import cached_property

from grammar.notation.edits import AddAlternative
from grammar.parser.recognizer import Recognizer
from recovery.forms.keywords import Vocabulary
from recovery.forms.symbols import Symbol, Token
from recovery.induction.inferred_keywords import InferredKeywords
from recovery.induction.line_hosts import LineHosts
from recovery.induction.line_symbols import LineSymbols
from recovery.induction.steps import InferredStep
from recovery.induction.supported_forms import SupportedForms
from recovery.proposals.blocks import BlockLines, SourceFile, find_blocks
from recovery.tuning import BALANCED_FILES, SEVERAL


class BlockEdits:
    """Infers the blocks of the corpus that the grammar lacks."""

    def __init__(
        self, at: LineSymbols, forms: SupportedForms, hosts: LineHosts, blocks: Sequence[BlockLines]
    ) -> None:
        self.at = at
        self.forms = forms
        self.hosts = hosts
        self.blocks = blocks

    def edits(self) -> Iterator[InferredStep]:
        """Yield blocks of several lines where their first line may stand."""
        for block in self.blocks:
            members = self._opening(block)
            for host in self._hosts_of_block(block):
                for body in self._bodies(host):
                    text = self._block_text(block, body)
                    if text:
                        added = AddAlternative(host, text + self.hosts.ending(host))
                        edits = (*self.forms.reserving(text), added)
                        title = f"{block.opener} to {block.closer} as {host}"
                        yield InferredStep(
                            title, edits, members, is_block=True, is_known=block.is_spelt
                        )

    def _opening(self, block: BlockLines) -> tuple[int, ...]:
        """Return the lines that open a block."""
        return tuple(
            n
            for n, symbols in enumerate(self.at.symbols)
            if symbols and block.opener in [s.text for s in symbols[:2]]
        )

    def _hosts_of_block(self, block: BlockLines) -> dict[str, None]:
        """Return the rules to which a block may be added as an alternative."""
        return dict.fromkeys(host for n in self._opening(block) for host in self._block_hosts(n))

    def _block_hosts(self, number: int) -> list[str]:
        entered = self.hosts.entered(number)
        found = sorted(
            entered & self.at.profile.choices_of_lines or entered & self.at.profile.blocks
        )
        # where some rules have blocks among their lines the others have none
        return [host for host in found if self._has_blocks(host)] or found

    def _has_blocks(self, rule: str) -> bool:
        blocks = self.at.profile.blocks
        return rule in blocks or not blocks.isdisjoint(self.at.profile.near(rule))

    def _bodies(self, host: str) -> list[str]:
        """Return the possible bodies of a block: those of the blocks that a rule already has.

        Where these have lines of several kinds in order, those of one kind are enough.
        """
        bodies = self.at.profile.bodies or [
            (f"{rule}*",)
            for rule in sorted(self.at.profile.loops & self.at.profile.choices_of_lines)
        ]
        written = " ".join(self.at.grammar.by_name[host].text.split())
        found = [body for body in bodies if " ".join(body) in written]
        parts = (part for body in found for part in body)
        return list(dict.fromkeys([*map(" ".join, found or bodies[:1]), *parts]))

    def _block_text(self, block: BlockLines, body: str) -> str | None:
        end = self.at.profile.line_end
        header, closer = self._line_form(block.headers), self._line_form(block.closers)
        if not header or not closer:
            return None
        parts = [header, end, *([body] if block.has_body else [])]
        for word, often in block.often.items():
            middle = self._line_form(block.middles[word])
            if not middle:
                return None
            text = f"{middle} {end} {body}"
            parts.append(f"({text}){often}" if often else text)
        return " ".join((*parts, closer))

    def _line_form(self, lines: Mapping[tuple[Token, ...], Collection[str]]) -> str | None:
        shapes: dict[tuple[Symbol, ...], set[str]] = defaultdict(set)
        for tokens, origins in lines.items():
            shapes[self.at.known_groups(self.at.reader.symbols(tokens))].update(origins)
        return self.forms.writer.form([shape for shape in self.forms.supported(shapes) if shape])

    @cached_property
    def words(self) -> frozenset[str]:
        """Return the words of the blocks that could be added.

        If no rule has blocks, or sequences of lines that could be a body, each line stands alone.
        """
        having = [b for b in self.blocks if any(map(self._bodies, self._hosts_of_block(b)))]
        return frozenset[str]().union(*(block.words for block in having))


def blocks_of(keywords: InferredKeywords, recognizer: Recognizer) -> list[BlockLines]:
    """Return the blocks of a corpus that the grammar of the recogniser lacks."""
    vocabulary = Vocabulary(recognizer)
    origins, least = keywords.least
    found: list[BlockLines] = []
    # where few lines show which words are prefixes any word may be one that begins no block
    for is_any in (False, True):
        files = led_files(keywords, is_any=is_any)
        opened = Counter(lead for file in files for lead, _ in file.lines)
        free = {w for w in opened if w.isidentifier() and not vocabulary.is_written(w)}
        free -= frozenset().union(*(block.words for block in found))
        needed = origins, BALANCED_FILES if least > 1 else 1
        found += (
            block
            for block in find_blocks(files, free, needed, keywords.spelt)
            if opened[block.opener] >= SEVERAL or block.is_spelt
        )
    return found


def led_files(keywords: InferredKeywords, *, is_any: bool = False) -> list[SourceFile]:
    """Return the files of the corpus, with the word that leads each line.

    That is the word behind a prefix, or with ``is_any`` a new keyword that leads other lines.
    """
    lexer, lines = keywords.lexer, keywords.corpus.lines
    name, leading = lexer.name_kind, keywords.words & {line[0] for line in lines}
    led = []
    for line in lines:
        meant = dict(keywords.in_line(line))
        is_led = line[0] in keywords.prefixes or (is_any and leading.issuperset(line[1:2]))
        at = int(len(line) > 1 and is_led)
        lead = line[at]
        if lead in keywords.words and lexer.kinds[lead] == name:
            meant.setdefault(at, lead)
        tokens = tuple((lexer.kinds[word], meant.get(i)) for i, word in enumerate(line))
        kind = lexer.kinds[lead]
        # a token may have another name than its word
        led.append((meant.get(at, "") if kind == name else lexer.spelled(kind), tokens))
    return [
        SourceFile(tuple(led[n] for n in numbers), file.origins)
        for file, numbers in zip(keywords.corpus.files, keywords.corpus.of_file, strict=True)
    ]
