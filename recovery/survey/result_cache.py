"""The cache of survey results, by content, grammar and code."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import Any

from grammar.notation.model import Grammar
from grammar.parser.failures import Form
from recovery.survey.failing_line import FailingLine, as_failing_line, as_values
from recovery.survey.unreserved_keywords import NameUse
from support.files.code_digest import code_digest
from support.files.result_store import ResultStore

#: The cached result for a content: failures, their forms, used names; or why it is no KRL.
Kept = tuple[tuple[FailingLine, ...], tuple[Form, ...], NameUse] | str


def key_of(grammar: Grammar) -> str:
    """Return the cache key: the grammar, and all code that influences a result."""
    return f"{grammar.sha256} {code_digest('support', 'grammar', 'recovery')}"


def recall(store: ResultStore, digest: str) -> Kept | None:
    """Return the cached result of a content, or ``None`` if it is missing or damaged."""
    try:
        data = store.get(digest)
        return None if data is None else _read(data)
    except (ValueError, TypeError):
        return None


def keep(store: ResultStore, results: Iterable[tuple[str, Kept]]) -> None:
    """Store results by the digests of their contents."""
    store.put((digest, _written(kept)) for digest, kept in results)


def _written(kept: Kept) -> object:
    if isinstance(kept, str):
        return kept
    failures, forms, names = kept
    return [list(map(as_values, failures)), [(f.before, f.kinds, f.index) for f in forms], names]


def _read(data: Any) -> Kept:
    if isinstance(data, str):
        return data
    failures, forms, (read, bound) = data
    names = NameUse(tuple(map(sys.intern, read)), tuple(map(sys.intern, bound)))
    found = (Form(tuple(map(tuple, before)), tuple(kinds), index) for before, kinds, index in forms)
    return tuple(map(as_failing_line, failures)), tuple(found), names
