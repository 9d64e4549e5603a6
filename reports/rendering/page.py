"""Rendering of a template into one self-contained file, for all pages."""

from collections.abc import Iterable, Sequence
from functools import cache
from importlib import resources
from typing import Any, Final

from jinja2 import Environment, FunctionLoader, StrictUndefined
from markupsafe import Markup

from reports.rendering import number_format, record_fields
from reports.rendering.embedding import embedded_json, inline_source, script_hash
from reports.rendering.sanitizing import shown

#: What templates read records and format figures with, by their own names.
_FILTERS: Final = (
    record_fields.count,
    record_fields.nested,
    record_fields.number,
    record_fields.records,
    record_fields.text,
    record_fields.texts,
    number_format.counted,
    number_format.moment,
    number_format.percent,
    number_format.share,
    shown,
)


def render(
    template: str, *, view: Any, styles: Sequence[str], script: str = "", data: Markup | None = None
) -> str:
    """Return the page of a template with our style sheets and ``script`` inlined.

    ``view`` is the data of the template; ``data`` is read by the script and made by
    `embedding.embedded_json`. Untrusted text is escaped.
    """
    return (
        _environment()
        .get_template(template)
        .render(
            view=view,
            data=embedded_json({}) if data is None else data,
            style=inline_source("\n".join(map(template_text, styles))),
            script=inline_source(script),
            script_hash=script_hash(script),
        )
    )


def joined(names: Iterable[str]) -> str:
    """Return the scripts with these names, without their suffix, as one."""
    scripts = "\n".join(template_text(f"{name}.js") for name in names)
    return f'"use strict";\n{{\n{scripts}}}\n'


@cache
def _environment() -> Environment:
    """Return the environment of all pages, which compiles each template once."""
    environment = Environment(
        loader=FunctionLoader(template_text),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters.update({each.__name__: each for each in _FILTERS}, thousands="{:,}".format)
    return environment


def template_text(name: str) -> str:
    """Return the text of a template, script or style sheet."""
    file = resources.files("reports") / "templates" / name
    return file.read_text(encoding="utf-8").replace("\r\n", "\n")
