"""A Pygments lexer for KRL, which Sphinx, MkDocs and others use; registered as an entry point."""

import re
from typing import Any, ClassVar

from pygments import token
from pygments.lexer import RegexLexer
from pygments.lexer import words as any_of

from krl.highlighting import words


def _rules() -> list[Any]:
    known = words()
    pattern = known.patterns

    def rule(
        listed: tuple[str, ...], type_: Any, after: str = "", before: str = ""
    ) -> tuple[Any, Any]:
        prefix, suffix = rf"(?<![\w$.]){before}", rf"(?![\w$]){after}"
        return any_of(listed, prefix=prefix, suffix=suffix), type_

    return [
        (rf"^{pattern['HEADER']}", token.Comment.Preproc),
        (r";\s*(?:END)?FOLD\b.*", token.Comment.Special),
        (pattern["COMMENT"], token.Comment.Single),
        (pattern["STRING"], token.String.Double),
        (pattern["BIT_STRING"], token.Number.Bin),
        (pattern["ENUM_CONSTANT"], token.Name.Constant),
        (r"\$[A-Z_][\w$]*", token.Name.Variable.Magic),
        (pattern["REAL_NUMBER"], token.Number.Float),
        (pattern["INTEGER"], token.Number.Integer),
        rule(known.types, token.Keyword.Type),
        rule(known.constants, token.Keyword.Constant),
        rule(known.operators, token.Operator.Word),
        rule(known.motions + known.keywords, token.Keyword),
        rule(known.contextual, token.Keyword, r"(?=\s*=[^=])", known.behind_statement),
        rule(known.contextual, token.Keyword, r"(?!\s*(?:[\[.(]|=[^=]))"),
        rule(known.functions, token.Name.Builtin, r"(?=\s*\()"),
        (rf"{pattern['NAME']}(?=\s*\()", token.Name.Function),
        (pattern["NAME"], token.Name),
        (r"[=<>+*/:\-]+", token.Operator),
        (r"[()\[\]{},.]", token.Punctuation),
        (r"\s+", token.Whitespace),
    ]


class KrlLexer(RegexLexer):
    """The KUKA Robot Language."""

    name = "KRL"
    aliases: ClassVar = ["krl"]
    filenames: ClassVar = ["*.src", "*.dat", "*.sub"]
    mimetypes: ClassVar = ["text/x-krl"]
    flags = re.IGNORECASE | re.MULTILINE
    tokens: ClassVar = {"root": _rules()}
