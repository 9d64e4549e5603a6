"""Parsers of others: what they are asked, how they are run, and what is wrong with some."""

import shutil
import sys
from pathlib import Path

import pytest

from conformance.exchange.parser_comparison import OWN, ParserError, compared, parsers
from conformance.suite.case import CASES, read_case
from grammar.notation.generate import ANTLR_VERSION

_READ = read_case(CASES / "syntax" / "comment_anywhere.src")
_REFUSED = next(
    one
    for path in sorted((CASES / "syntax").glob("*.src"))
    if (one := read_case(path)).expects_syntax_error
)
#: Where antlr4-tools keeps what it has fetched: a test fetches nothing.
_ANTLR = Path.home().joinpath(
    *(".m2", "repository", "org", "antlr", "antlr4"),
    *(ANTLR_VERSION, f"antlr4-{ANTLR_VERSION}-complete.jar"),
)
_GRAMMAR = """grammar tiny; // all but what has a comment
file : 'DEF' WORD* EOF ;
WORD : [A-Za-z0-9_(){},=$.]+ ;
BLANK : [ \\r\\n\\t]+ -> skip ;
"""


def test_a_command_reads_by_its_status() -> None:
    """Status 0 is right where a case is to be read, and wrong where it is to be refused."""
    exits = f"{sys.executable} -c 'raise SystemExit(%d)'"
    commands = [f"yes={exits % 0}", f"no={exits % 1}"]
    with parsers(commands) as found:
        results = compared([_READ, _REFUSED], found)
    assert [
        [(OWN, "pass"), ("yes", "pass"), ("no", "fail")],
        [(OWN, "pass"), ("yes", "fail"), ("no", "pass")],
    ] == [[(one.executor, one.verdict) for one in each.results] for each in results]


def test_files_are_given_without_front_matter() -> None:
    """Many parsers want a file to begin with its first routine."""
    script = 'import sys; sys.exit(open(sys.argv[1]).read(3) != "DEF")'
    with parsers([f"first={sys.executable} -c '{script}' {{}}"]) as found:
        (result,) = compared([_READ], found)
    assert "pass" == result.verdict


def test_a_command_is_run_where_it_was_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its words may be paths from there: of a script, or of a grammar that it loads."""
    (tmp_path / "reads.py").write_text("", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    with parsers([f"mine={sys.executable} reads.py"]) as found:
        (result,) = compared([_READ], found)
    assert "pass" == result.verdict


@pytest.mark.skipif(
    not shutil.which("java") or not _ANTLR.exists(), reason="Java or ANTLR is not at hand"
)
def test_a_grammar_is_compiled_by_antlr(tmp_path: Path) -> None:
    """Its first rule reads a file; what it refuses is told with the line."""
    path = tmp_path / "tiny.g4"
    path.write_text(_GRAMMAR, encoding="utf-8")
    with parsers([f"tiny={path}"]) as found:
        (result,) = compared([_READ], found)
    (_, tiny) = result.results
    assert "fail" == tiny.verdict
    assert "comment_anywhere.src: line 1" in tiny.reason


@pytest.mark.parametrize(
    "wanted", ["no_name", "=a", "krl=a", "x=missing.g4", "x='", "x=no/such {}"]
)
def test_what_is_no_parser_is_refused(wanted: str) -> None:
    """One line says what is wrong with it."""
    with pytest.raises(ParserError), parsers([wanted]) as found:
        compared([_READ], found)
