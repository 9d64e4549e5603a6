"""Names in an editor: their places, renaming, and completion.

Only names that a file of the project declares have places and can be renamed; predefined names are
completed, too.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

from grammar.diagnostics.diagnostic import Region
from grammar.diagnostics.expected_tokens import is_reserved, names
from grammar.semantics.predefined import System
from grammar.semantics.scopes import Answer, Found
from grammar.semantics.symbols import Kind, Table, TypeSymbol
from grammar.semantics.types import Enumeration
from grammar.syntax.build import builder
from grammar.syntax.references import Space
from grammar.syntax.source import names_in_text
from krl.language_server.hover import found_at
from krl.language_server.symbols import seen_everywhere, type_name
from krl.language_server.workspace import AnalysedFile, OpenProject, certain

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_$]{0,23}")
_WORD = re.compile(r"[$\w]*")
_TEXT = re.compile(r'"[^"]*"')
_TOKEN = re.compile(r"[$A-Za-z_][\w$]*|\d[\w.]*|\S")


class RenameError(ValueError):
    """A name that is not possible; the text says why."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A name for completion, with its kind and its type if it has one.

    ``kind`` is ``None`` for a keyword.
    """

    name: str
    kind: Kind | None
    detail: str = ""


# ------------------------------------------------------------------------------- places of a name


def places(project: OpenProject, looked: AnalysedFile, offset: int) -> list[tuple[str, Region]]:
    """Return all places of the name at an offset, including declarations, by path and line.

    The list is empty if no file declares the name.
    """
    found = found_at(looked, offset)
    if found is None or found.module is None:
        return []
    key = found.symbol.key
    listed = set()
    for path in project.paths():
        source = project.source(path)
        if source is None or key not in names_in_text(source.text):
            continue
        there = project.look(path)
        if there is not None:
            listed |= {(path, region) for region in highlights(there, found)}
    return sorted(listed)


def highlights(looked: AnalysedFile, found: Found) -> set[Region]:
    """Return the places of a declared name in one file."""
    return {
        Region.of(looked.source, name.span)
        for name, other in looked.names()
        if other.symbol is found.symbol
    }


def renaming(
    project: OpenProject, looked: AnalysedFile, offset: int, name: str
) -> list[tuple[str, Region]]:
    """Return the places at which to write ``name`` instead of the name at an offset.

    Raises `RenameError`.
    """
    found = found_at(looked, offset)
    if found is None or found.module is None:
        raise RenameError("no file of the project declares it")
    if not _NAME.fullmatch(name):
        raise RenameError(f"{name} is no name: a letter, then at most 23 letters, digits, _ or $")
    if is_reserved(name.upper()):
        raise RenameError(f"{name} is a keyword")
    symbol, module = found.symbol, found.module
    if symbol.kind is Kind.ROUTINE and symbol.key == module.name:
        raise RenameError(f"{symbol.name} is named as its file, which has to be renamed with it")
    if symbol.name.startswith("$"):
        raise RenameError("names with a dollar sign belong to the controller")
    listed = places(project, looked, offset)
    for path in {path for path, _ in listed}:
        there, file = project.look(path), path.rpartition("/")[2]
        if there is None or there.checked is None:
            continue
        if name.upper() != symbol.key and _is_taken(there, name.upper()):
            raise RenameError(f"{file} has a {name} already")
        for answer in there.checked.resolution.answers.values():
            meant = certain(answer)
            if answer is not meant and isinstance(meant, Found) and meant.symbol is symbol:
                raise RenameError(f"a line of {file} that cannot be read may mean it, too")
    return listed


def _is_taken(looked: AnalysedFile, key: str) -> bool:
    """Return whether a file uses, declares or can see a name."""
    if key in names_in_text(looked.source.text):
        return True
    if looked.project is None or looked.module is None:
        return False
    scope = looked.project.scope(looked.module)
    return any(isinstance(scope.find(space, key), Found) for space in _SPACES)


_SPACES = (Space.VALUE, Space.ROUTINE, Space.TYPE)


# ------------------------------------------------------------------------------------ completion


def completions(looked: AnalysedFile, offset: int) -> list[Candidate]:
    """Return the words that can be written at an offset: keywords, then names, nearest first.

    After ``#`` these are the constants of the enumeration of the variable in front, or of all
    enumerations; after a dot the members of the structure, after GOTO the labels of the routine.
    There are none in comments and texts.
    """
    line, column = looked.source.place(offset)
    before = looked.source.line(line)[: column - 1]
    if set(_TEXT.sub("", before)) & {";", '"'}:
        return []
    start = _word_start(before)
    front = before[:start].rstrip()
    if front.endswith("#"):
        value = front[:-1].rstrip()
        compared = _place_at_end(value.rstrip("<>=")) if value.endswith(("<", ">", "=")) else ()
        type_ = _type_of(looked, line, compared)
        if type_ is not None and type_.kind is Kind.ENUMERATION:
            found = _constants_of(type_)
        else:
            found = _constants(looked)
    elif front.endswith(".") and (place := _place_at_end(front[:-1])):
        found = _members(looked, line, place)
    elif re.search(r"\bGOTO$", front, re.IGNORECASE) and len(front) < start:
        found = _labels(looked, line)
    else:
        begun = offset - len(before) + start
        found = chain(_keywords(looked.source.text[:begun]), _visible(looked, line))
    return list({one.name.upper(): one for one in reversed([*found])}.values())[::-1]


def _word_start(text: str) -> int:
    """Return where the word begins with which a text ends."""
    found = _WORD.match(text[::-1])  # from the front, each letter of a word would be tried
    return len(text) - (found.end() if found else 0)


def _place_at_end(text: str) -> tuple[str, ...]:
    """Return the variable and the members with which a text ends, without indices: A, B in A[1].B.

    The tuple is empty if it ends with something else.
    """
    outer: list[list[str]] = []
    place: list[str] = []
    last = ""
    for token in _TOKEN.findall(text):
        is_name = token[0].isalpha() or token[0] in "$_"
        if token == "[":
            outer.append(place)
            place = []
        elif token == "]":
            place = outer.pop() if outer else []
        elif is_name and last == "." and place:
            place.append(token.upper())
        elif token != "." or last == ".":
            place = [token.upper()] if is_name else []
        last = token
    return tuple(place) if last != "." else ()


def _keywords(before: str) -> Iterator[Candidate]:
    """Yield the keywords that the grammar allows after a text whose last line is valid so far."""
    failures, recognizer = builder().failures.find(before), builder().failures.recognizer
    if failures and failures[-1].text:  # the line fails before
        return
    kinds = recognizer.kinds(before)[:-1]
    state = failures[-1].state if failures else recognizer.run(recognizer.start, kinds)[0]
    expected, lexer = recognizer.expected(state), recognizer.lexer
    words = {lexer.display[kind] for kind in expected if lexer.is_keyword(kind)}
    if lexer.kind_of["NAME"] in expected:  # then these would be names
        words -= names()
    for word in sorted(words):
        yield Candidate(word, None)


def _labels(looked: AnalysedFile, line: int) -> Iterator[Candidate]:
    scope = looked.scope(line)
    if scope is not None and scope.routine is not None:
        for symbol in scope.routine.table.spaces[Space.LABEL].values():
            yield Candidate(symbol.name, Kind.LABEL)


def _visible(looked: AnalysedFile, line: int) -> Iterator[Candidate]:
    scope, module, project = looked.scope(line), looked.module, looked.project
    if scope is not None and module is not None and project is not None and module.table:
        if scope.routine is not None:
            yield from _declared(scope.routine.table)
        yield from _declared(module.table.table)
        data = project.data_of(module)
        if data is not None and data.table is not None:
            yield from _declared(data.table.table)
        for other in project.modules:
            if other.table is not None and other not in (module, data):
                yield from _declared(other.table.table, other.name)
    system = System.load()
    for variable in system.variables.values():
        yield Candidate(variable.name, Kind.VARIABLE, str(variable.type))
    for function in system.functions.values():
        yield Candidate(function.name, Kind.ROUTINE)
    for name in system.types:
        yield Candidate(name, Kind.STRUCTURE)


def _declared(table: Table, file: str | None = None) -> Iterator[Candidate]:
    """Yield the symbols in a table; of another file only those that are visible everywhere."""
    for _, symbol in table.symbols():
        is_seen = file is None or seen_everywhere(symbol, file)
        if is_seen and symbol.kind is not Kind.LABEL:
            yield Candidate(symbol.name, symbol.kind, type_name(symbol))


def _constants(looked: AnalysedFile) -> Iterator[Candidate]:
    modules = looked.project.modules if looked.project else ()
    for module in modules:
        for _, symbol in module.table.table.symbols() if module.table else ():
            if isinstance(symbol, TypeSymbol) and symbol.kind is Kind.ENUMERATION:
                yield from _constants_of(symbol)
    for type_ in System.load().types.values():
        if isinstance(type_, Enumeration):
            for name in type_.constants:
                yield Candidate(name, Kind.ENUM_CONSTANT, type_.name)


def _constants_of(type_: TypeSymbol) -> Iterator[Candidate]:
    for member in type_.members.values():
        yield Candidate(member.name, Kind.ENUM_CONSTANT, type_.name)


def _members(looked: AnalysedFile, line: int, place: Sequence[str]) -> Iterator[Candidate]:
    type_ = _type_of(looked, line, place)
    for member in type_.members.values() if type_ is not None else ():
        yield Candidate(member.name, Kind.MEMBER, type_name(member))


def _type_of(looked: AnalysedFile, line: int, place: Sequence[str]) -> TypeSymbol | None:
    """Return the type of a variable or of its member if it is a structure or enumeration."""
    scope = looked.scope(line)
    if scope is None or not place:
        return None
    found: Answer = certain(scope.find(Space.VALUE, place[0]))
    for name in place[1:]:
        structure = found.type_symbol() if isinstance(found, Found) else None
        symbol = structure.symbol if isinstance(structure, Found) else None
        member = symbol.members.get(name) if isinstance(symbol, TypeSymbol) else None
        if member is None or not isinstance(structure, Found):
            return None
        found = Found(member, structure.scope)
    structure = found.type_symbol() if isinstance(found, Found) else None
    symbol = structure.symbol if isinstance(structure, Found) else None
    return symbol if isinstance(symbol, TypeSymbol) else None
