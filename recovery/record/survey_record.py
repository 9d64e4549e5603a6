"""The record of a survey: the JSON that `krl recover` writes and the page reads.

Its fields are a contract (docs/survey-record.md): others read it from outside.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import asdict
from typing import cast

from grammar.parser.recognizer import Recognizer
from recovery.clustering.cluster import Cluster, Clusters
from recovery.clustering.distinct_lines import Member
from recovery.record.failure_records import failure_records
from recovery.record.proposal_review import Reviewer
from recovery.record.record_types import (
    ClusterRecord,
    CopyRecord,
    ExampleRecord,
    FilesRecord,
    LineRecord,
    OriginRecord,
    ReproducerRecord,
    SurveyRecord,
)
from recovery.reproducer.reduce import Reducer
from recovery.survey.survey import Survey

_CONTEXT_LINES = 3
_WIDEST_LINE = 1_000
_FILES_NAMED = 200


def record_of(found: Survey, clusters: Clusters, *, grammar_name: str) -> SurveyRecord:
    """Return all results of a survey as plain data.

    Counts of files include copies; ``distinct`` counts contents. ``failures`` and ``clusters`` name
    the first file with a content, ``copies`` the others.
    """
    recognizer = Recognizer(found.grammar)
    reviewer = Reviewer(found, clusters)
    reducer = Reducer(recognizer)
    return {
        **record_without_causes(found, grammar_name),
        "greedy": [{"cluster": c.id, "parsed": parsed} for c, parsed in clusters.order],
        "clusters": [_cluster(entry, reviewer, reducer) for entry in clusters.ranked],
        "failures": failure_records(found, clusters, recognizer.lexer),
    }


def record_without_causes(found: Survey, grammar_name: str) -> SurveyRecord:
    """Return the record of a survey before causes are searched: no clusters, no failures."""
    counts: dict[str, list[int]] = defaultdict(lambda: [0, 0])
    size = 0
    copies: list[CopyRecord] = []
    for file in found.files:
        size += file.size * len(file.places)
        copies += ({"path": path, "same_as": file.path} for path, _ in file.places[1:])
        for _, origin in file.places:
            counts[origin][bool(file.failures)] += 1
    origins: list[OriginRecord] = [
        {"name": name, "files": good + bad, "parsed": good, "failed": bad}
        for name, (good, bad) in sorted(counts.items())
    ]
    return {
        "grammar": grammar_name,
        "grammar_sha256": found.grammar.sha256,
        "files": sum(one["files"] for one in origins),
        "distinct": len(found.files),
        "parsed": sum(one["parsed"] for one in origins),
        "bytes": size,
        "parsed_bytes": size - sum(f.size * len(f.places) for f in found.failing),
        "seconds": round(found.seconds, 3),
        "skipped": [
            {"path": s.path, "reason": s.reason, "origin": s.origin} for s in found.skipped
        ],
        "origins": origins,
        "copies": copies,
        "greedy": [],
        "swallowed": [
            {"word": one.word, "files": one.files, "origins": one.origins}
            for one in found.unreserved
        ],
        "clusters": [],
        "failures": [],
    }


def _cluster(cluster: Cluster, reviewer: Reviewer, reducer: Reducer) -> ClusterRecord:
    files = [file for file, _ in cluster.files]
    example = cluster.example
    return {
        "id": cluster.id,
        "signature": cluster.signature,
        "title": cluster.title,
        "failures": cluster.failures,
        "lines": cluster.failures,
        "follows": cluster.following,
        "files": cluster.places,
        "distinct": len(files),
        "origins": len({origin for f in files for _, origin in f.places}),
        "unlocks": cluster.unlocks,
        "rule": cluster.context.rule,
        "rule_stack": list(cluster.context.rules),
        "expected": list(cluster.context.expected),
        "token": example.failed.token,
        "example": _example(example),
        "examples": list(map(_example, cluster.others)),
        "files_by_origin": _files_by_origin(cluster),
        "reproducer": _reproducer(cluster, reviewer, reducer),
        "proposals": reviewer.records(cluster),
    }


def _reproducer(cluster: Cluster, reviewer: Reviewer, reducer: Reducer) -> ReproducerRecord | None:
    if cluster.line.is_enormous:
        return None
    best = next((p for p in cluster.proposals if p.mended), None)
    mended = reviewer.wider(best) if best is not None else None
    found = reducer.reduce(cluster.line, cluster.example.failed.words, mended=mended)
    return cast("ReproducerRecord", asdict(found)) if found else None


def _example(member: Member) -> ExampleRecord:
    failed = member.failed
    return {
        "path": member.file.path,
        "line": failed.line,
        "column": failed.column,
        "token": failed.token,
        "text": failed.source,
        "context": _surroundings(member),
    }


def _files_by_origin(cluster: Cluster) -> list[FilesRecord]:
    places: dict[str, dict[str, int]] = defaultdict(dict)
    for file, line in cluster.files:
        for path, origin in file.places:
            places[origin].setdefault(path, line)
    out = []
    for origin in sorted(places, key=lambda o: (-len(places[o]), o)):
        listed = list(places[origin].items())
        entry: FilesRecord = {
            "origin": origin,
            "files": [{"path": path, "line": line} for path, line in listed[:_FILES_NAMED]],
        }
        if len(listed) > _FILES_NAMED:
            entry["more"] = len(listed) - _FILES_NAMED
        out.append(entry)
    return out


def _surroundings(member: Member) -> list[LineRecord]:
    """Return the numbered lines around a failure."""
    lines, line = member.file.lines(), member.failed.line
    first, last = max(1, line - _CONTEXT_LINES), min(len(lines), line + _CONTEXT_LINES)
    return [{"line": n, "text": lines[n - 1][:_WIDEST_LINE]} for n in range(first, last + 1)]
