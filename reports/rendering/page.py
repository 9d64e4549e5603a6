"""Shared by all pages: rendering from a template into one self-contained file."""

from collections.abc import Sequence
from functools import cache
from importlib import resources
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined
from markupsafe import Markup

from reports.rendering.embedding import inline_source, script_hash
from reports.rendering.number_format import counted


def render(template: str, *, script: str, styles: Sequence[str], data: Markup, view: Any) -> str:
    """The page of a template, with our ``script`` and style sheets inside it.

    ``data`` is what the script reads, as `embedding.embedded_json` made it; ``view`` is
    what the template shows. Foreign text is escaped.
    """
    return (
        _environment()
        .get_template(template)
        .render(
            view=view,
            data=data,
            style=inline_source("\n".join(map(source, styles))),
            script=inline_source(script),
            script_hash=script_hash(script),
        )
    )


@cache
def _environment() -> Environment:
    """One for all pages: it compiles each template once."""
    environment = Environment(
        loader=FunctionLoader(source),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["counted"] = counted
    environment.filters["thousands"] = "{:,}".format
    return environment


def source(name: str) -> str:
    """The text of a template, script or style sheet."""
    file = resources.files("reports") / "templates" / name
    return file.read_text(encoding="utf-8").replace("\r\n", "\n")
