"""Colours of KRL for editors and documents, from the tokens and rules of the grammar.

`words` gives them to Pygments (`krl.pygments_lexer`); ``python -m krl.highlighting --write`` makes
the TextMate grammar of the VS Code extension and a syntax file for Vim, ``--check`` says whether
these are up to date.
"""

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from grammar.notation.krl_grammar import krl_grammar
from grammar.notation.model import Grammar, Reference, walk
from grammar.parser.lexer import regex_of
from grammar.semantics.predefined import System
from support.files.generated_files import main

_EDITORS = Path(__file__).parents[1] / "editors"
#: Rules of the grammar whose words have a colour of their own.
_MOTIONS = "motion splineMotion splineBlock approximatedSplineMotion emilyMotion criterion"
_TYPES = "predefinedType positionType"
_PATTERNS = "NAME ENUM_CONSTANT INTEGER REAL_NUMBER BIT_STRING STRING HEADER COMMENT"
_OPERATORS = "disjunction exclusion conjunction factor"


@dataclass(frozen=True, slots=True)
class Words:
    """The words of each colour, sorted, and the patterns of some tokens by name.

    ``contextual`` are keywords that can also be names: before ``[``, ``.`` or ``(``, after a dot,
    and before ``=`` where a statement, a declaration or a loop assigns to them.
    """

    keywords: tuple[str, ...]
    contextual: tuple[str, ...]
    motions: tuple[str, ...]
    types: tuple[str, ...]
    constants: tuple[str, ...]
    operators: tuple[str, ...]
    functions: tuple[str, ...]
    patterns: dict[str, str]

    @property
    def behind_statement(self) -> str:
        """A lookbehind that tells ``DELAY=`` of a TRIGGER from an assignment to ``DELAY``."""
        assigned = "".join(rf"(?<!\b{word}[ \t])" for word in (*self.types, "DO", "FOR"))
        return rf"(?<=[\w)\]][ \t]){assigned}"


@cache
def words() -> Words:
    """Return the words of the current grammar, and the predefined routines."""
    grammar = krl_grammar()
    left = {text for text in grammar.literal_tokens if text[0].isalpha()}

    def taken(rules: str) -> tuple[str, ...]:
        found = left & _tokens(grammar, rules.split())
        left.difference_update(found)
        return tuple(sorted(found))

    types, contextual = taken(_TYPES), taken("name")
    constants, operators, motions = taken("literal"), taken(_OPERATORS), taken(_MOTIONS)
    functions = tuple(sorted(System.load().functions.keys() - set(grammar.literal_tokens)))
    patterns = {
        name: regex_of(grammar, grammar.by_name[name]).replace("\\\n", r"\n").replace("\\\r", r"\r")
        for name in _PATTERNS.split()
    }
    keywords = tuple(sorted(left))
    return Words(keywords, contextual, motions, types, constants, operators, functions, patterns)


def _tokens(grammar: Grammar, rules: list[str]) -> set[str]:
    """Return the texts of the tokens in some rules."""
    texts = {name: text for text, name in grammar.literal_tokens.items()}
    return {
        texts[node.name]
        for rule in rules
        for alternative in grammar.by_name[rule].alternatives
        for node in walk(alternative)
        if isinstance(node, Reference) and node.name in texts
    }


# --------------------------------------------------------------------------------------- TextMate


def _textmate() -> str:
    known = words()
    token = known.patterns

    def one_of(listed: tuple[str, ...]) -> str:
        return rf"(?i)(?<![\w$.])(?:{'|'.join(listed)})(?![\w$])"

    head_of_routine = r"(?i)\b(DEF|DEFFCT|DEFDAT)\b(?:\s+(\w+)(?=\s+\w|\s*\[))?\s+"
    patterns = [
        {"name": "meta.preprocessor.krl", "match": f"^{token['HEADER']}"},
        {"name": "comment.line.fold.krl", "match": r"(?i);\s*(?:END)?FOLD\b.*"},
        {"name": "comment.line.semicolon.krl", "match": token["COMMENT"]},
        {"name": "string.quoted.double.krl", "match": token["STRING"]},
        {"name": "constant.numeric.bits.krl", "match": token["BIT_STRING"]},
        {"name": "variable.other.enummember.krl", "match": token["ENUM_CONSTANT"]},
        {
            "match": f"{head_of_routine}({token['NAME']})",
            "captures": {
                "1": {"name": "keyword.control.krl"},
                "2": {"name": "storage.type.krl"},
                "3": {"name": "entity.name.function.krl"},
            },
        },
        {"name": "variable.language.krl", "match": r"\$[A-Za-z_][\w$]*"},
        {"name": "constant.numeric.krl", "match": rf"(?<![\w$])(?:{token['REAL_NUMBER']})"},
        {"name": "constant.numeric.krl", "match": rf"(?<![\w$]){token['INTEGER']}(?!\w)"},
        {"name": "keyword.other.motion.krl", "match": one_of(known.motions)},
        {"name": "storage.type.krl", "match": one_of(known.types)},
        {"name": "constant.language.krl", "match": one_of(known.constants)},
        {"name": "keyword.operator.word.krl", "match": one_of(known.operators)},
        {"name": "keyword.control.krl", "match": one_of(known.keywords)},
        {
            "name": "keyword.other.krl",
            "match": rf"(?i){known.behind_statement}(?:{'|'.join(known.contextual)})(?=\s*=[^=])",
        },
        {
            "name": "keyword.other.krl",
            "match": one_of(known.contextual) + r"(?!\s*(?:[\[.(]|=[^=]))",
        },
        {"name": "support.function.krl", "match": one_of(known.functions) + r"(?=\s*\()"},
        {"name": "entity.name.function.call.krl", "match": rf"(?:{token['NAME']})(?=\s*\()"},
        {"name": "variable.other.krl", "match": token["NAME"]},
        {"name": "keyword.operator.krl", "match": r"[=<>+*/:\-]+"},
    ]
    head = {"comment": _NOTE, "name": "KRL", "scopeName": "source.krl", "patterns": patterns}
    return json.dumps(head, indent=1) + "\n"


# -------------------------------------------------------------------------------------------- Vim

_NOTE = "made by python -m krl.highlighting --write from grammar/KRL.g4; do not edit"


def _vim() -> str:
    known = words()
    groups = {
        "krlStatement": ("Statement", known.keywords),
        "krlMotion": ("Function", known.motions),
        "krlType": ("Type", known.types),
        "krlBoolean": ("Boolean", known.constants),
        "krlOperator": ("Operator", known.operators),
    }

    def one_of(listed: tuple[str, ...], after: str, before: str = "") -> str:
        return rf"\v{before}[.$]@1<!<%({'|'.join(listed)})>%(\s*{after}"

    # as `Words.behind_statement`
    statement = rf"%([[:alnum:]_)\]]\s)@<=%(<%({'|'.join((*known.types, 'DO', 'FOR'))})\s)@<!"
    matches = {
        "krlFunction": ("Function", one_of(known.functions, r"\()@=")),
        "krlWord": ("Statement", one_of(known.contextual, r"%([\[.(]|\=[^=]))@!")),
        "krlArgument": ("Statement", one_of(known.contextual, r"\=[^=])@=", statement)),
        "krlSystem": ("Identifier", r"\$\h[[:alnum:]_$]*"),
        "krlEnum": ("Constant", r"#\h[[:alnum:]_$]*"),
        "krlNumber": ("Number", r"\<\d\+\(\.\d\+\)\=\([eE][+-]\=\d\+\)\=\>"),
        "krlBits": ("Number", r"'[bBhH] *[0-9A-Fa-f ]*'"),
        "krlString": ("String", '"[^"]*"'),
        "krlHeader": ("PreProc", "^&.*"),
        "krlComment": ("Comment", ";.*"),
        "krlFold": ("SpecialComment", r";\s*\(END\)\=FOLD\>.*"),
    }
    lines = [
        f'" {_NOTE}',
        "if exists('b:current_syntax')",
        "  finish",
        "endif",
        "syntax case ignore",
    ]
    lines += [f"syntax keyword {name} {' '.join(row)}" for name, (_, row) in groups.items()]
    lines += [f"syntax match {name} ~{pattern}~" for name, (_, pattern) in matches.items()]
    linked = {name: group for name, (group, _) in {**groups, **matches}.items()}
    lines += [f"highlight default link {name} {group}" for name, group in linked.items()]
    return "\n".join([*lines, "let b:current_syntax = 'krl'", ""])


def files() -> Mapping[Path, str]:
    """Return the text of each generated file."""
    return {
        _EDITORS / "vscode" / "syntaxes" / "krl.tmLanguage.json": _textmate(),
        _EDITORS / "vim" / "syntax" / "krl.vim": _vim(),
    }


if __name__ == "__main__":
    sys.exit(main("krl.highlighting", files))
