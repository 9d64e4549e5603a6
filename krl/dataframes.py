"""Results as tables, for notebooks: what the commands write as JSON, as pandas DataFrames.

::

    from krl import dataframes as tables

    survey = tables.record("recover", "D:/backups", "--no-start")
    tables.clusters(survey).sort_values("unlocks", ascending=False)

Each function takes a record, or the path of the file that holds it. docs/python.md lists them.
"""

from __future__ import annotations

import contextlib
import io
import json
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

Record = Mapping[str, Any] | Sequence[Mapping[str, Any]]


class CommandError(Exception):
    """A command failed; the message is what it wrote to stderr."""


def record(command: str, *arguments: str | Path) -> Any:
    """Run a ``krl`` command that has ``--json`` in this process, and return its record.

    For `krl check`, ``--format json`` is used instead. Findings are no error. Raises `CommandError`
    if the command ends with status 2.
    """
    from krl.cli import main

    out, errors = io.StringIO(), io.StringIO()
    with tempfile.TemporaryDirectory(prefix="krl-") as folder:
        target = Path(folder, "record.json")
        is_check = command == "check"
        wanted = ["--format", "json"] if is_check else ["--json", str(target)]
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            status = main([*command.split(), *map(str, arguments), *wanted])
        if status == 2:
            raise CommandError(errors.getvalue().strip() or "the command failed")
        text = out.getvalue() if is_check else target.read_text(encoding="utf-8")
    return json.loads(text)


def clusters(survey: Record | Path | str) -> pd.DataFrame:
    """Return a row for each cluster: id, title, rule, failures, files, origins and more."""
    columns = ("id", "title", "rule", "failures", "files", "origins", "unlocks", "reproducer")
    rows = (
        {**one, "reproducer": _text(one.get("reproducer"))} for one in _list(survey, "clusters")
    )
    return frame(rows, columns)


def proposals(survey: Record | Path | str) -> pd.DataFrame:
    """Return a row for each proposed edit, with the id of its cluster."""
    columns = ("cluster", "edit", "restores", "breaks", "accepts_negatives", "ambiguities")
    rows = (
        {"cluster": cluster["id"], **proposal}
        for cluster in _list(survey, "clusters")
        for proposal in cluster.get("proposals", ())
    )
    return frame(rows, columns)


def failures(survey: Record | Path | str) -> pd.DataFrame:
    """Return a row for each parse failure: path, line, column, token, text, rule and more."""
    columns = ("path", "line", "column", "token", "text", "rule", "cluster", "follows")
    return frame(_list(survey, "failures"), columns)


def growth(replay: Record | Path | str) -> pd.DataFrame:
    """Return a row for each step of the ledger: number, id, title, files, bytes, metrics."""
    columns = ("number", "id", "title", "parsed", "files", "parsed_bytes", "bytes", "restored")
    steps = _list(replay, "steps")
    rows = [{**step, **step.get("metrics", {})} for step in steps]
    metrics = list(dict.fromkeys(name for step in steps for name in step.get("metrics", {})))
    return frame(rows, (*columns, *metrics))


def findings(checked: Record | Path | str) -> pd.DataFrame:
    """Return a row for each finding of ``krl check``: path, position, severity, code, message."""
    columns = ("path", "line", "column", "end_column", "severity", "code", "message")
    return frame(_list(checked, None), columns)


def trace(file: Path | str) -> pd.DataFrame:
    """Return a row for each event of a trace (``krl run --trace``): t in µs, task, kind, at."""
    text = Path(file).read_text(encoding="utf-8")
    return frame(
        (json.loads(line) for line in text.splitlines()), ("t", "task", "kind", "at"), True
    )


def path(file: Path | str) -> pd.DataFrame:
    """Return a row for each interpolation cycle (``krl run --path``): t in µs, axes, pose.

    Axes are in degrees, the pose in mm.
    """
    import pandas as pd

    is_text = Path(file).suffix.lower() == ".csv"
    return pd.read_csv(file) if is_text else pd.read_parquet(file)


def cases(conformed: Record | Path | str) -> pd.DataFrame:
    """Return a row for each conformance case: name, suite, title, rules, phase, verdict …."""
    columns = ("name", "suite", "title", "rules", "phase", "verdict", "negative", "may_fail")
    return frame(_list(conformed, "cases"), columns)


def results(conformed: Record | Path | str) -> pd.DataFrame:
    """Return a row for each case on an executor and robot: verdict, reason, seconds and more."""
    columns = ("name", "executor", "robot", "verdict", "reason", "ending", "seconds")
    rows = (
        {"name": case["name"], **result}
        for case in _list(conformed, "cases")
        for result in case.get("results", ())
    )
    return frame(rows, columns)


def rules(conformed: Record | Path | str) -> pd.DataFrame:
    """Return a row for each rule of KRL: id, tier, may_fail, statement, cases and more."""
    columns = ("id", "tier", "may_fail", "profile", "source", "statement", "cases")
    return frame(_list(conformed, "rules"), columns)


def nightly_runs(history: Path | str = Path("reports", "history.jsonl")) -> pd.DataFrame:
    """Return a row for each nightly run: date, files that parse, verdicts, bench figures."""
    from reports.nightly.history import read_history

    rows = []
    for run in read_history(Path(history)):
        row = {"date": run.get("date")}
        for part in ("recover", "fuzz"):
            figures = run.get(part) or {}
            row |= {f"{part}.{k}": v for k, v in figures.items() if not isinstance(v, Mapping)}
        row |= {
            f"conform.{k}": v for k, v in ((run.get("conform") or {}).get("verdicts") or {}).items()
        }
        row |= {f"bench.{k}": v for k, v in (run.get("bench") or {}).items()}
        rows.append(row)
    return frame(rows, ("date",), True)


def _list(given: Record | Path | str, key: str | None) -> list[Mapping[str, Any]]:
    """Return the rows under a key of a record or of the file with the record."""
    loaded: Any = given
    if isinstance(given, str | Path):
        loaded = json.loads(Path(given).read_text(encoding="utf-8"))
    rows = loaded if key is None else loaded.get(key, [])
    return [row for row in rows if isinstance(row, Mapping)]


def _text(reproducer: Any) -> str:
    return (
        str(reproducer.get("text", ""))
        if isinstance(reproducer, Mapping)
        else str(reproducer or "")
    )


def frame(
    rows: Iterable[Mapping[str, Any]], columns: Sequence[str], is_open: bool = False
) -> pd.DataFrame:
    """Return the rows with these columns, which exist even without rows.

    With ``is_open``, other columns of the rows follow.
    """
    import pandas as pd

    table = pd.DataFrame(list(rows))
    others = [name for name in table.columns if name not in columns] if is_open else []
    return table.reindex(columns=[*columns, *others])
