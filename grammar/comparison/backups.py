"""The comparison of two backups or two files: the record that `krl diff` prints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, takewhile
from typing import Any

from grammar.comparison.content import CodeLine, Content, Datum, RoutineText, content_of
from grammar.comparison.matching import likest, line_operations
from grammar.comparison.points import POINT_TYPES, frame_numbers, point_change, without_frames
from grammar.comparison.renaming import names_in, renamed, renamings
from grammar.semantics.project_grouping import DRIVES, drive_roots
from grammar.syntax.source import Source

_Pair = tuple[Content, Content]
Record = dict[str, Any]


def compare(old: Sequence[Source], new: Sequence[Source]) -> Record:
    """Return the differences of two states, each given by its files with paths below its root.

    The record has ``files`` (numbers of those that are the ``same``, and that differ only in
    ``noise``; paths of those ``added``, ``removed`` and ``moved``), ``names`` that were renamed
    throughout, ``routines`` (changed, added, removed, moved, renamed, with ``hunks`` of
    statements), ``points`` and ``data``, each in the order of paths. If there is one file on each
    side, the two are compared whatever their names are.
    """
    before, after = _contents(old), _contents(new)
    pairs = _paired(before, after)
    silent = sum(one.keys == other.keys for one, other in pairs)
    known = [set().union(*map(names_in, side)) for side in (before, after)]
    names = renamings(pairs, *known)
    by_path = {one.path: renamed(one, names) for one in before}
    before = list(by_path.values())
    pairs = [(by_path[one.path], other) for one, other in pairs]
    mine, theirs = {one.path for one, _ in pairs}, {other.path for _, other in pairs}
    removed = [one for one in before if one.path not in mine]
    added = [one for one in after if one.path not in theirs]
    texts = {one.path: one.text for one in old}, {one.path: one.text for one in new}
    same = sum(texts[0][one.path] == texts[1][other.path] for one, other in pairs)
    return {
        "files": {
            "old": len(before),
            "new": len(after),
            "same": same,
            "noise": silent - same,
            "added": [one.path for one in added],
            "removed": [one.path for one in removed],
            "moved": [
                {"old": one.path, "new": other.path, "folders": _folders(one.path, other.path)}
                for one, other in pairs
                if _address(one.path) != _address(other.path) and len(before) + len(after) > 2
            ],
        },
        "names": [{"old": was, "new": now} for was, now in sorted(names.items())],
        "routines": list(_routines(before, after, pairs, names)),
        "points": [one for pair in pairs for one in _data(*pair, is_point=True)],
        "data": [one for pair in pairs for one in _data(*pair, is_point=False)],
    }


def _contents(sources: Sequence[Source]) -> list[Content]:
    return [content_of(one) for one in sorted(sources, key=lambda one: one.path.casefold())]


# ------------------------------------------------------------------------------------------- files


def _folders(old: str, new: str) -> list[str]:
    """Return the folder a file was moved from and the one it was moved to.

    The folders and the name that end both paths are left out.
    """
    parts = old.split("/"), new.split("/")
    ends = zip(*map(reversed, parts), strict=False)
    same = sum(1 for _ in takewhile(lambda pair: pair[0].casefold() == pair[1].casefold(), ends))
    return ["/".join(one[: len(one) - same]) or "." for one in parts]


def _address(path: str) -> str:
    """Return the path of a file from the drive of its controller on, with letter case folded.

    A folder called R1 may be all that there is of one robot, and hold the drive.
    """
    parts = tuple(path.casefold().split("/"))
    named = (n for n, part in enumerate(parts) if part in DRIVES)
    return "/".join(parts[next(chain(map(len, drive_roots(parts)), named), 0) :])


def _paired(old: Sequence[Content], new: Sequence[Content]) -> list[_Pair]:
    if len(old) == len(new) == 1:
        return [(old[0], new[0])]
    pairs: list[_Pair] = []
    left, right = list(old), list(new)
    for address in (str.casefold, _address, _folder_and_name, _name):
        there = _unique(right, address)
        here = _unique(left, address)
        for key, one in here.items():
            if key in there:
                pairs.append((one, there[key]))
        done = {one.path for one, _ in pairs}, {other.path for _, other in pairs}
        left = [one for one in left if one.path not in done[0]]
        right = [one for one in right if one.path not in done[1]]
    lines = {one.path: one.keys for one in left}, {one.path: one.keys for one in right}
    by_path = {one.path: one for one in left}, {one.path: one for one in right}
    for kind in (_address, _suffix):
        for before, after in likest(*lines, kind):
            pairs.append((by_path[0][before], by_path[1][after]))
            del lines[0][before], lines[1][after]
    return sorted(pairs, key=lambda pair: pair[1].path.casefold())


def _folder_and_name(path: str) -> tuple[str, ...]:
    return tuple(path.casefold().split("/")[-2:])


def _name(path: str) -> str:
    return path.casefold().rpartition("/")[2]


def _suffix(path: str) -> str:
    return path.casefold().rpartition(".")[2]


def _unique(contents: Sequence[Content], address: Any) -> dict[object, Content]:
    found: dict[object, list[Content]] = {}
    for one in contents:
        found.setdefault(address(one.path), []).append(one)
    return {key: some[0] for key, some in found.items() if len(some) == 1}


# ---------------------------------------------------------------------------------------- routines


@dataclass(frozen=True, slots=True)
class _Placed:
    """A routine and its file; ``number`` distinguishes routines of one name in a file."""

    path: str
    number: int
    routine: RoutineText


def _routines(
    old: Sequence[Content], new: Sequence[Content], pairs: Sequence[_Pair], names: Mapping[str, str]
) -> Iterator[Record]:
    gone = {_key(each): each for one in old for each in _placed(one)}
    come = {_key(each): each for one in new for each in _placed(one)}
    there = {one.path: other.path for one, other in pairs}
    found: list[tuple[_Placed, _Placed]] = []
    for path, name, number in list(gone):
        match = there.get(path, ""), names.get(name, name), number
        if match in come:
            found.append((gone.pop((path, name, number)), come.pop(match)))
    matches = likest(
        {key: (one.routine.signature, *one.routine.keys) for key, one in gone.items()},
        {key: (one.routine.signature, *one.routine.keys) for key, one in come.items()},
    )
    for before, after in matches:
        found.append((gone.pop(before), come.pop(after)))
    records = [_changed(one, other, there.get(one.path) == other.path) for one, other in found]
    records += [_alone("removed", each) for each in gone.values()]
    records += [_alone("added", each) for each in come.values()]
    yield from sorted(
        filter(None, records), key=lambda one: (one["file"].casefold(), one["line"], one["name"])
    )


def _placed(content: Content) -> Iterator[_Placed]:
    seen: dict[str, int] = {}
    for routine in content.routines:
        key = routine.name.upper()
        seen[key] = seen.get(key, 0) + 1
        yield _Placed(content.path, seen[key], routine)


def _key(one: _Placed) -> tuple[str, str, int]:
    return one.path, one.routine.name.upper(), one.number


def _alone(kind: str, one: _Placed) -> Record:
    routine = one.routine
    return {
        "kind": kind,
        "name": routine.name,
        "file": one.path,
        "line": routine.head.number,
        "statements": len(routine.body),
        "hunks": [],
    }


def _changed(old: _Placed, new: _Placed, is_same_file: bool) -> Record | None:
    """Return the record of a routine, or ``None`` if nothing of it changed."""
    before, after = old.routine, new.routine
    is_renamed = before.name.upper() != after.name.upper()
    hunks = list(_hunks(before, after))
    if not (hunks or is_renamed or not is_same_file):
        return None
    kind = "renamed" if is_renamed else "changed" if is_same_file else "moved"
    return {
        "kind": kind,
        "name": after.name,
        "file": new.path,
        "line": after.head.number,
        "old_name": before.name,
        "old_file": old.path,
        "statements": len(after.body),
        "hunks": hunks,
    }


def _hunks(old: RoutineText, new: RoutineText) -> Iterator[Record]:
    if old.signature != new.signature:
        yield _hunk([old.head], [new.head], old.head.number, new.head.number)
    for tag, first, last, start, end in line_operations(old.keys, new.keys):
        if tag != "equal":
            lines = old.body[first:last], new.body[start:end]
            yield _hunk(*lines, _line(old, first), _line(new, start))


def _line(routine: RoutineText, index: int) -> int:
    """Return the line number of a statement, or the one after the last statement."""
    if index < len(routine.body):
        return routine.body[index].number
    return (routine.body[-1] if routine.body else routine.head).number + 1


def _hunk(old: Sequence[CodeLine], new: Sequence[CodeLine], line: int, new_line: int) -> Record:
    return {
        "old_line": line,
        "new_line": new_line,
        "old": [one.text for one in old],
        "new": [one.text for one in new],
    }


# -------------------------------------------------------------------------------------------- data


def _data(old: Content, new: Content, *, is_point: bool) -> Iterator[Record]:
    """Yield the changes to the points of a data list, or to everything else in it.

    Tool and base of a point are reported with the point, and not again with its form.
    """
    before, after = _of_kind(old, is_point), _of_kind(new, is_point)
    renamed = {}
    if is_point:
        gone = {key: (one.key,) for key, one in before.items() if key not in after}
        come = {key: (one.key,) for key, one in after.items() if key not in before}
        renamed = {now: was for was, now in likest(gone, come)}
    for key, now in after.items():
        was = before.get(key) or before.get(renamed.get(key, ""))
        if was is None:
            yield _datum("added", new.path, now, None, now.text)
        elif key in renamed:
            yield {**_datum("renamed", new.path, now, was.text, now.text), "old_name": was.name}
        elif is_point:
            yield from _point(old, new, was, now)
        elif without_frames(new.data, was) != without_frames(old.data, now):
            yield _datum("changed", new.path, now, was.text, now.text)
    known = after.keys() | set(renamed.values())
    for key, was in before.items():
        if key not in known:
            yield _datum("removed", new.path, was, was.text, None)


def _of_kind(content: Content, is_point: bool) -> Mapping[str, Datum]:
    return {
        key: one
        for key, one in content.data.items()
        if (one.type.upper() in POINT_TYPES) == is_point
    }


def _datum(kind: str, path: str, one: Datum, old: str | None, new: str | None) -> Record:
    return {
        "kind": kind,
        "name": one.name,
        "type": one.type,
        "file": path,
        "line": one.line,
        "old": old,
        "new": new,
    }


def _point(old: Content, new: Content, was: Datum, now: Datum) -> Iterator[Record]:
    """Yield a point if its coordinates, its tool or its base changed."""
    frames = frame_numbers(old.data, was.name.upper()), frame_numbers(new.data, now.name.upper())
    if was.key == now.key and frames[0] == frames[1]:
        return
    change = point_change(was, now)
    yield {
        **_datum("changed", new.path, now, was.text, now.text),
        "distance_mm": None if change is None else change.distance,
        "angle_deg": None if change is None else change.angle,
        "axis_deg": None if change is None else change.axis,
        "components": {} if change is None else {k: list(v) for k, v in change.components.items()},
        "tool": [frames[0][0], frames[1][0]],
        "base": [frames[0][1], frames[1][1]],
    }
