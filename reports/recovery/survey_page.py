"""The page of a survey: one file without network access."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from reports.recovery.construct_data import construct_data
from reports.recovery.survey_cluster import DETAILS, Detail, cluster_data, cluster_id
from reports.recovery.survey_view import survey_view
from reports.rendering.embedding import embedded_json
from reports.rendering.page import render, template_text
from reports.rendering.record_fields import Record, nested, records, text
from support.files.atomic_write import write_atomic

# The embedded data stays below this, which keeps the whole page below 5 MB.
_MAX_DATA_CHARACTERS = 3_500_000


def write_survey_page(record: Mapping[str, Any], folder: Path) -> Path:
    """Write ``folder``/index.html, the page of one survey, and return its path.

    ``record`` is what ``krl recover --json`` writes; every field may be absent. Its lines and
    columns count from 1, columns in characters (a tab is one). Its failures are not used: the page
    shows clusters with their examples. Equal records give equal bytes. The page is written
    atomically.

    Raises OSError if the folder cannot be made or written.
    """
    return write_atomic(folder / "index.html", render_survey_page(record))


def render_survey_page(record: Mapping[str, Any]) -> str:
    """Return the page of ``record`` as text; see `write_survey_page`."""
    view = survey_view(record)
    for detail in DETAILS:
        sections = [_section(record, view["section"], detail)]
        if view["start"] is not None:
            sections.append(_section(nested(record, "start"), view["start"], detail))
        data = embedded_json({"sections": sections})
        if len(data) <= _MAX_DATA_CHARACTERS:
            break
    return render(
        "survey.html.j2",
        script=_script(),
        styles=["vendor/uPlot.min.css", "page.css"],
        data=data,
        view=view,
    )


def _section(record: Record, shown: Record, detail: Detail) -> dict[str, Any]:
    """Return a section as the page's script reads it."""
    clusters = records(record, "clusters")[: len(shown["rows"])]
    constructs = {text(c, "id"): construct_data(c) for c in records(record, "constructs")}
    answers = {cluster_id(c): text(c, "answered_by") for c in clusters}
    return {
        **{name: shown[name] for name in ("prefix", "files", "parsed")},
        "mending": [[step["id"], step["parsed"], step["place"]] for step in shown["mending"]],
        "answers": {
            name: constructs[answer] for name, answer in answers.items() if answer in constructs
        },
        **cluster_data(clusters, detail),
    }


def _script() -> str:
    """Return the page's scripts: a function of a section's data and prefix shows the section."""
    parts = "\n".join(template_text(f"survey-{name}.js") for name in ("cards", "table", "chart"))
    return f""""use strict";
{{
{template_text("vendor/uPlot.iife.min.js")}
{template_text("page.js")}
{template_text("source.js")}
{template_text("construct.js")}
{template_text("line-chart.js")}
function present(data, prefix) {{
const byId = (id) => document.getElementById(prefix + id);
const {{ clusters, strings }} = data;
{parts}
if (data.mending.length) chart();
if (rows.length) connect();
return rows.length ? readHash : null;
}}
{template_text("survey-sections.js")}}}
"""
