"""The blocks of a corpus that a grammar lacks (`recovery.proposals.blocks`)."""

from __future__ import annotations

from grammar.parser.recognizer import Recognizer
from recovery.forms.keywords import Vocabulary
from recovery.induction.inferred_keywords import InferredKeywords
from recovery.proposals.blocks import BlockLines, SourceFile, find_blocks
from recovery.tuning import BALANCED_FILES


def blocks_of(
    keywords: InferredKeywords,
    recognizer: Recognizer,
    prefixes: frozenset[str],
) -> list[BlockLines]:
    """Return the blocks of a corpus that the grammar of the recogniser lacks."""
    lexer, corpus = recognizer.lexer, keywords.corpus
    name = lexer.name_kind
    tokens = []
    leads = []
    for line in corpus.lines:
        meant = dict(keywords.in_line(line))
        at = int(len(line) > 1 and line[0] in prefixes)
        lead = line[at]
        if lead in keywords.words and lexer.kinds[lead] == name:
            meant.setdefault(at, lead)
        leads.append(lead if lexer.kinds[lead] != name or at in meant else "")
        tokens.append(tuple((lexer.kinds[word], meant.get(i)) for i, word in enumerate(line)))
    files = [
        SourceFile(tuple((leads[n], tokens[n]) for n in numbers), file.origins)
        for file, numbers in zip(corpus.files, corpus.of_file, strict=True)
    ]
    vocabulary = Vocabulary(recognizer)
    free = {w for w in leads if w.isidentifier() and not vocabulary.is_written(w)}
    origins, least = keywords.least
    return find_blocks(files, free, (origins, min(BALANCED_FILES, 1 + least)))
