"""The page a survey ends with: one file, no network, opens from disk."""

import secrets
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined

from reports.embed import embedded_json, inline_source, script_hash
from reports.fields import records
from reports.survey_cluster import DETAILS, cluster_data
from reports.survey_view import counted, survey_view

# In the order of their use of one another.
_SCRIPTS = ("page", "source", "cards", "table", "chart")
_MAX_CLUSTERS = 2000
# The embedded data stays below this, which keeps the whole page below 5 MB.
_MAX_DATA_CHARACTERS = 3_500_000


def write_survey_page(record: Mapping[str, Any], folder: Path) -> Path:
    """Write ``folder``/index.html, the page of one survey, and return its path.

    ``record`` is what ``krl recover --json`` writes; every field may be absent. Lines and columns
    in it count from 1, columns in characters (a tab is one). The failures are not read: the page
    shows clusters with their examples. The same record gives the same bytes. The page appears whole
    or not at all: it is written beside its place and then moved there.

    Raises OSError when the folder cannot be made or written.
    """
    page = render_survey_page(record)
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / "index.html"
    draft = folder / f".index-{secrets.token_hex(8)}.tmp"
    try:
        draft.write_text(page, encoding="utf-8", newline="\n")
        draft.replace(target)
    finally:
        draft.unlink(missing_ok=True)
    return target


def render_survey_page(record: Mapping[str, Any]) -> str:
    """The page of ``record`` as text; see `write_survey_page`."""
    clusters = records(record, "clusters")[:_MAX_CLUSTERS]
    script = _script()
    environment = Environment(
        loader=FunctionLoader(_template),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["counted"] = counted
    environment.filters["thousands"] = "{:,}".format
    view = survey_view(record, clusters)
    for detail in DETAILS:
        data = embedded_json(
            {"files": view.files, "parsed": view.parsed, **cluster_data(clusters, detail)}
            | {"mending": [[step.id, step.parsed, step.place] for step in view.mending]}
        )
        if len(data) <= _MAX_DATA_CHARACTERS:
            break
    return environment.get_template("survey.html.j2").render(
        view=view,
        data=data,
        style=inline_source(_template("survey.css")),
        script=inline_source(script),
        script_hash=script_hash(script),
    )


def _script() -> str:
    parts = "\n".join(_template(f"survey-{name}.js") for name in _SCRIPTS)
    return f'"use strict";\n{{\n{parts}}}\n'


def _template(name: str) -> str:
    source = resources.files("reports") / "templates" / name
    return source.read_text(encoding="utf-8").replace("\r\n", "\n")
