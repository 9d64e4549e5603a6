"""Names in a file that certainly nothing declares, and names that its lists of the controller lack.

A look-up returns `NotFound` if no file of the project is missing. Names that a missing file may
declare are the `grammar.check.names.open_names` of the file.
"""

from __future__ import annotations

from collections.abc import Iterator

from grammar.check.analysis.context import Context
from grammar.check.analysis.likely_names import system_typos
from grammar.check.names.misspelt_declarations import slips_in_file
from grammar.check.names.unresolved_name import SLUGS, WORDS, declaration_of, home_of
from grammar.diagnostics.codes import Severity
from grammar.diagnostics.diagnostic import Diagnostic, Fix, Region
from grammar.diagnostics.did_you_mean import one_of
from grammar.semantics.link import Project
from grammar.semantics.resolve import Resolution, Use
from grammar.semantics.scopes import Found, Module, NotFound, Reason, Undetermined
from grammar.semantics.symbols import Access, Kind
from grammar.semantics.types import SCALARS
from grammar.syntax import ast
from grammar.syntax.references import Space


def check(context: Context) -> Iterator[Diagnostic]:
    """Tell the names that are certain to be unknown, each once in a file.

    Where a # is missing is another mistake at each place.
    """
    slips = slips_in_file(context)
    yield from slips.values()
    for (space, key), some in context.open_uses.items():
        if space is None or space is Space.LABEL or (space is Space.VALUE and key in slips):
            continue
        if home := home_of(context, space, key):
            yield _local_type(context, some[0], home)
            continue
        unknown = [use for use in some if isinstance(use.answer, NotFound)]
        unsigned = [use for use in unknown if use.name in context.constants]
        for use in unsigned or unknown[:1]:
            yield _unknown(context, space, use)
    yield from _near_system_names(context)
    if lacks_data_list(context.project, context.module, context.resolution):
        message = f"no {context.module.name}.dat is at hand, which may declare what is unknown here"
        yield context.finding("data-list-missing", context.table.span, message)


def lacks_data_list(project: Project, module: Module, resolution: Resolution) -> bool:
    """Return whether the data list of a program is missing and the program uses unknown names."""
    if module.suffix == ".dat" or project.data_of(module) is not None:
        return False
    return any(
        use.space is Space.VALUE
        and isinstance(use.answer, Undetermined)
        and use.answer.reason is Reason.MODULES_MISSING
        and not use.name.text.startswith("$")
        for use in resolution.open_uses
    )


def _local_type(context: Context, use: Use, home: str) -> Diagnostic:
    message = f"the type {use.name.text} is local to {home}"
    reason = "declare it in the data list, where all routines see it"
    severity: Severity = "error" if isinstance(use.answer, NotFound) else "warning"
    return context.finding("unknown-type", use.name, message, reason=reason, severity=severity)


def _unknown(context: Context, space: Space, use: Use) -> Diagnostic:
    name, word = use.name, WORDS[space]
    hidden = use.answer.hidden if isinstance(use.answer, NotFound) else None
    if hidden and hidden.module and hidden.symbol.kind is not Kind.EXTERNAL:
        message = f"{name.text} of {hidden.module.path} cannot be seen from here"
        slug = "routine-not-global" if space is Space.ROUTINE else SLUGS[space]
        return context.finding(slug, name, message, reason=_why_hidden(hidden))
    fix = context.suggestions.suggest(name.text, _visible(context, space, name))
    if name in context.constants:
        fix = _sign_added(context, name)
    return context.finding(SLUGS[space], name, f"no {word} is called {name.text}", fix=fix)


def _sign_added(context: Context, name: ast.Name) -> Fix:
    """Return the fix that makes a name the constant of an enumeration."""
    meant = context.constants[name]
    return Fix(f"did you mean {meant}?", Region.of(context.source, name.span), meant)


def _why_hidden(hidden: Found) -> str:
    module = hidden.module
    if hidden.symbol.kind is Kind.ROUTINE or module is None or module.table is None:
        return "it is not GLOBAL"
    if module.table.is_public:
        return "it is not GLOBAL"
    return "its data list is not PUBLIC"


def _visible(context: Context, space: Space, name: ast.Name) -> Iterator[str]:
    """Yield the names that may be meant, nearest scope first.

    Of a system variable nobody forgets the dollar sign and makes another mistake, too.
    """
    for routine in context.routines:
        if routine.node.span[0] <= name.span[0] < routine.node.span[1]:
            yield from routine.table.table.names(space)
    yield from context.table.table.names(space)
    if context.own_data is not None:
        yield from context.own_data.names(space)
    near = (context.module, context.project.data_of(context.module))
    for module in context.project.modules:
        if module.table is not None and module not in near:
            yield from module.table.table.names(space, Access.GLOBAL)
    system = context.system
    match space:
        case Space.VALUE:
            is_system = name.text.startswith("$")
            signed = (one for one in system.variables if one.startswith("$"))
            yield from (one for one in signed if is_system or one == f"${name.key}")
        case Space.ROUTINE:
            yield from system.functions
        case Space.TYPE:
            yield from (*SCALARS, *system.types)


def _near_system_names(context: Context) -> Iterator[Diagnostic]:
    """Yield declarations in a system data list that are one slip away from a known system name."""
    if not context.table.is_data:
        return
    for key, symbol in context.table.table.spaces[Space.VALUE].items():
        if key.startswith("$") and key not in context.system.variables:
            near = [
                name
                for name in system_typos().meant(key)
                if not declaration_of(context, Space.VALUE, name)
            ]
            if near:
                message = f"no system variable is called {symbol.name}"
                fix = one_of(near)
                yield context.finding(
                    "unknown-system-name", symbol.span, message, severity="warning", fix=fix
                )
