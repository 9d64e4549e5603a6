"""Checks one project in one or several processes: first its files are read, then checked.

A file is checked against the symbol tables of all files of its project and its own tree only, so
files can be distributed over processes: each process reads its share and keeps the trees, the
tables are sent to all, and each checks its share. For the same reason a file with known text is not
read again, and is checked again only if something changed on which its findings depend
(`dependencies`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache

from grammar.check.analysis.spelling import Spelling
from grammar.check.flow import advance_stops
from grammar.check.flow.effects import effects_of_unread
from grammar.check.names.misspelt_declarations import used_in_unread
from grammar.check.names.unresolved_name import Files
from grammar.check.project.dependencies import (
    NO_NEEDS,
    Contribution,
    Needs,
    contribution,
    needs_of,
)
from grammar.check.project.framework import Findings, check_module, check_project
from grammar.check.project.suppression_comments import Suppression, suppression_comments
from grammar.diagnostics.diagnostic import Diagnostic, Region, diagnose, in_order
from grammar.diagnostics.error_recovery import recover
from grammar.diagnostics.syntax_errors.findings import syntax_findings
from grammar.semantics.link import File, Project, link
from grammar.semantics.scopes import REST, Module
from grammar.semantics.symbol_table import table_of
from grammar.semantics.symbols import ModuleTable
from grammar.syntax import ast
from grammar.syntax.build import builder
from grammar.syntax.source import Source, names_in_text
from support.files.decode import decode
from support.gc_pause import gc_paused
from support.lazy_dataclass import dataclass

#: Bytes of the largest file that is checked: a tree takes some hundred times the memory.
LARGEST = 24_000_000
# Trees of so many bytes are kept between reading and checking; other files are read once more.
_MOST_KEPT = 12_000_000
#: New objects from which on a check collects garbage: some 200 MB, nine of ten of them alive.
MANY_OBJECTS = 2_000_000
# A longer line is not shown with its finding.
_LONGEST_LINE = 20_000

_NOTHING = Findings((), ())


@dataclass(frozen=True, slots=True)
class CheckOptions:
    """What to check: syntax only, or also what stops the advance run.

    With ``is_complete`` no files of a project are missing; otherwise its calls decide. ``packages``
    are installed option packages in addition to those that are called. If the results are not
    ``kept`` for a later check, nothing is worked out that only that would need.
    """

    syntax_only: bool = False
    stops: bool = False
    is_complete: bool = False
    packages: tuple[str, ...] = ()
    kept: bool = True

    @property
    def wanted_codes(self) -> tuple[str, ...]:
        """The prefixes of the selected codes; see `suppression_comments`."""
        if self.syntax_only:
            return ("KRL0",)
        return ("",) if self.stops else ("KSS", *(f"KRL{digit}" for digit in "01234579"))


@dataclass(frozen=True, slots=True)
class Content:
    """A file of a project: its displayed path, its origin, and its bytes.

    If ``is_unread``, the bytes are the reason.
    """

    path: str
    origin: str
    data: bytes
    is_unread: bool = False

    def source(self) -> Source:
        """Return the text of a file that is known to have one."""
        decoded = decode(self.data)
        assert not isinstance(decoded, str), "it was decoded before"
        return Source(decoded.text, self.path)


@dataclass(frozen=True, slots=True)
class FileResult:
    """The result of one file.

    ``skipped`` is why it is not KRL, otherwise ``None``. ``lines`` are the source lines of its
    findings by number, ``comments`` its suppression comments, ``words`` the names in unreadable
    text. ``contribution`` is what it provides to others; ``is_open`` if it uses an undeclared name.
    """

    findings: Findings = _NOTHING
    skipped: str | None = None
    table: ModuleTable | None = None
    lines: Mapping[int, str] | None = None
    comments: tuple[Suppression, ...] = ()
    words: frozenset[str] | None = None
    contribution: Contribution | None = None
    is_open: bool = False


@dataclass(frozen=True, slots=True)
class KnownFile:
    """A file that was checked before: the results of reading and checking, and its needs then."""

    read: FileResult
    checked: FileResult
    needs: Needs

    def stands(self, needs: Needs) -> bool:
        """Return whether its findings are still valid."""
        if self.read.table is None:  # its findings are those of its text alone
            return True
        return needs.keep(self.needs, is_open=self.checked.is_open)


@dataclass(frozen=True, slots=True)
class Reading:
    """A file as it was read for the check.

    ``syntax`` is its tree without the unreadable lines, whose findings are ``diagnostics``; `None`
    if nothing can be read. ``words`` are the names in unreadable lines, ``exchanged`` the lines
    that were replaced.
    """

    syntax: ast.Module | None
    diagnostics: tuple[Diagnostic, ...] = ()
    words: frozenset[str] | None = None
    exchanged: frozenset[int] = frozenset()

    def alone(self) -> Findings:
        """Return the findings from reading, and the possible effects of the unreadable text."""
        unread = effects_of_unread(self.words or frozenset())
        return Findings(self.diagnostics, (), unread, used_in_unread(self.words or ()))

    def completed(self, found: Findings) -> Findings:
        """Return the findings in the tree together with those from reading."""
        kept = (one for one in found.diagnostics if one.region.line not in self.exchanged)
        references = tuple(
            one
            for one in found.references
            if one.count > 1 or one.region.line not in self.exchanged
        )
        return replace(found, diagnostics=(*self.diagnostics, *kept), references=references)


def read_source(source: Source) -> Reading:
    """Read a file, as far as it can be read."""
    tree = builder().read(source.text, source.path)
    if isinstance(tree, ast.Module):
        return Reading(tree)
    if any(failure.reason for failure in tree):
        return Reading(None, tuple(syntax_findings(tree, source)), names_in_text(source.text))
    recovered = recover(source.text, source.path)
    found = tuple(syntax_findings(recovered.failures, source))
    meant = " ".join((one.fix and one.fix.replacement) or "" for one in found)
    words = names_in_text(f"{recovered.dropped} {meant}") | ({REST} if recovered.is_cut else set())
    return Reading(recovered.syntax, found, words, recovered.exchanged)


def found_in_project(contents: Sequence[Content], files: Sequence[KnownFile]) -> list[Diagnostic]:
    """Return all findings of a project whose files were checked, in order."""
    indices = {contents[index].path: index for index in reversed(range(len(contents)))}

    @cache
    def source(path: str) -> Source:
        return contents[indices[path]].source()

    def table(path: str) -> ModuleTable | None:
        return files[indices[path]].read.table

    given = {path: files[index].read.contribution for path, index in indices.items()}
    spelling = Spelling(lambda: [(path, one.words) for path, one in given.items() if one])
    findings = (one.checked.findings for one in files)
    return check_project(findings, Files(table, source, spelling))


@dataclass(frozen=True, slots=True)
class _Tree:
    """What a process keeps of a file between reading and checking; some have no tree."""

    source: Source
    comments: tuple[Suppression, ...]
    reading: Reading


#: By project, then by the index of the file in it.
_KEPT: dict[int, dict[int, _Tree]] = {}


def recheck(
    contents: Sequence[Content],
    options: CheckOptions,
    known: Mapping[int, KnownFile],
) -> list[KnownFile]:
    """Check a project in this process, except for ``known`` files that are still valid."""
    project, paths = -1, [content.path for content in contents]
    new = {index: one for index, one in enumerate(contents) if index not in known}
    looked = {index: one.read for index, one in known.items()}
    looked |= read_part(project, new, options)
    projects = linked(paths, looked, options)
    needed = needs(paths, looked, projects if options.kept else ())
    stale = {i: contents[i] for i, one in known.items() if not one.stands(needed[i])}
    return completed(looked, known, _check(project, projects, looked, stale, options), needed)


def linked(
    paths: Sequence[str], looked: Mapping[int, FileResult], options: CheckOptions
) -> tuple[Project, ...]:
    """Return the linked files that are KRL; ``looked`` is what reading them gave."""
    files = (
        File(path, None, table=looked[index].table, words=looked[index].words)
        for index, path in enumerate(paths)
        if looked[index].skipped is None
    )
    is_complete = options.is_complete or None
    return link(files, is_complete=is_complete, packages=frozenset(options.packages)).projects


def needs(
    paths: Sequence[str], looked: Mapping[int, FileResult], projects: Iterable[Project]
) -> list[Needs]:
    """Return the needs of each file, from the results of reading all files of some projects."""
    found = [NO_NEEDS] * len(paths)
    by_path = {path: index for index, path in enumerate(paths)}
    for project in projects:
        members = [by_path[module.path] for module in project.modules]
        given = [looked[index].contribution for index in members]
        for index, needed in zip(members, needs_of(project, given), strict=True):
            found[index] = needed
    return found


def completed(
    looked: Mapping[int, FileResult],
    known: Mapping[int, KnownFile],
    checked: Mapping[int, FileResult],
    needed: Sequence[Needs],
) -> list[KnownFile]:
    """Return the current results of all files of a project."""
    found = []
    for index, needs_now in enumerate(needed):
        before = known.get(index)
        if before and index not in checked and before.stands(needs_now):
            found.append(before)
        else:
            result = checked.get(index) or (before.checked if before else looked[index])
            found.append(KnownFile(looked[index], result, needs_now))
    return found


def read_part(
    project: int, part: Mapping[int, Content], options: CheckOptions
) -> dict[int, FileResult]:
    """Read a share of the files of a project, and keep their trees for `check_part`."""
    looked, _KEPT[project] = _read_all(part, options)
    return looked


def _read_all(
    part: Mapping[int, Content], options: CheckOptions
) -> tuple[dict[int, FileResult], dict[int, _Tree]]:
    """Read some files; return their results and what is kept of them."""
    looked, kept = {}, {}
    size = 0
    for index, content in part.items():
        with gc_paused(MANY_OBJECTS):
            looked[index], tree = _read(content, options)
        if tree is not None:
            size += len(content.data)
            if size > _MOST_KEPT:
                tree = replace(tree, reading=replace(tree.reading, syntax=None))
            kept[index] = tree
    return looked, kept


def _read(content: Content, options: CheckOptions) -> tuple[FileResult, _Tree | None]:
    path = content.path
    if content.is_unread:
        return FileResult(Reading(None, (), frozenset({REST})).alone()), None
    if len(content.data) > LARGEST:
        message = f"larger than {LARGEST // 1_000_000} MB, so it was not checked"
        large = diagnose("too-large", path, Region(1, 1, 1, 1), message)
        return FileResult(Reading(None, (large,), frozenset({REST})).alone()), None
    decoded = decode(content.data)
    if isinstance(decoded, str):
        return FileResult(skipped=decoded), None
    source = Source(decoded.text, path)
    if options.syntax_only and not builder().failures.find(source.text):
        return FileResult(comments=suppression_comments(source)), None
    reading = read_source(source)
    found, tree = reading.diagnostics, reading.syntax
    comments = suppression_comments(source)
    if options.syntax_only or tree is None:
        lines = _lines(source, (one.region.line for one in found))
        given = contribution(path, source.text, None, reading.words)
        looked = FileResult(reading.alone(), None, None, lines, comments, reading.words, given)
        return looked, None
    table = table_of(tree)
    given = contribution(path, source.text, table if options.kept else None, reading.words)
    looked = FileResult(Findings(found, ()), None, table, None, comments, reading.words, given)
    return looked, _Tree(source, comments, reading)


def check_part(
    project: int,
    paths: Sequence[str],
    looked: Mapping[int, FileResult],
    again: Mapping[int, Content],
    options: CheckOptions,
) -> dict[int, FileResult]:
    """Check those files of a project that `read_part` kept here, and some that were known.

    ``paths`` are those of all its files, in order, and ``looked`` what reading them gave, here or
    elsewhere: files that are no KRL belong to no project. ``again`` are files whose text was known,
    so that none of them was read now.
    """
    return _check(project, linked(paths, looked, options), looked, again, options)


def _check(
    number: int,
    projects: Iterable[Project],
    looked: Mapping[int, FileResult],
    again: Mapping[int, Content],
    options: CheckOptions,
) -> dict[int, FileResult]:
    kept = _KEPT.pop(number, {}) | _read_all(again, options)[1]
    # modules are identified by their tables, which are the same objects
    own = {id(looked[index].table): (index, tree) for index, tree in kept.items()}
    checked = {}
    for project in projects:
        for module in project.modules:
            if id(module.table) in own:
                index, tree = own[id(module.table)]
                syntax = tree.reading.syntax or _again(tree.source)
                whole = replace(module, syntax=syntax)
                with gc_paused(MANY_OBJECTS):
                    checked[index] = _checked(project, whole, tree, options)
        project.forget()
    return checked


def _again(source: Source) -> ast.Module:
    with gc_paused(MANY_OBJECTS):
        syntax = read_source(source).syntax
    assert syntax is not None, "it could be read before"
    return syntax


def _checked(project: Project, module: Module, tree: _Tree, options: CheckOptions) -> FileResult:
    done = check_module(project, module, tree.source)
    findings = done.findings
    if options.stops:
        found = in_order([*findings.diagnostics, *advance_stops.check(done)])
        advance_stops.add_stops(done, findings.effects.summaries)
        findings = replace(findings, diagnostics=tuple(found))
    findings = tree.reading.completed(findings)
    numbers = {one.region.line for one in findings.diagnostics}
    numbers |= {one.region.line for one in findings.references}
    lines = _lines(tree.source, numbers)
    is_open = bool(done.resolution.open_uses)
    return FileResult(findings, lines=lines, comments=tree.comments, is_open=is_open)


def _lines(source: Source, numbers: Iterable[int]) -> dict[int, str]:
    """Return source lines to show with findings."""
    lines = {number: source.line(number) for number in numbers}
    return {number: line for number, line in lines.items() if len(line) <= _LONGEST_LINE}
