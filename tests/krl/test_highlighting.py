"""Colours of what the grammar names, in Pygments, VS Code and Vim; snippets that can be read."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pygments import token

from grammar.check.project.project_check import read_source
from grammar.notation.g4 import read_file
from grammar.notation.generate import GRAMMAR
from grammar.syntax.source import Source
from krl.highlighting import files, words
from krl.pygments_lexer import KrlLexer
from support.files.decode import decode
from support.files.generated_files import stale

ROOT = Path(__file__).parents[2]
SNIPPETS = json.loads((ROOT / "editors/vscode/snippets.json").read_text(encoding="utf-8"))


def test_files_of_editors_are_up_to_date() -> None:
    """They are what `python -m krl.highlighting --write` makes."""
    assert [] == stale(files())


def test_every_word_of_the_grammar_has_one_colour() -> None:
    """A keyword that is added has one without being named anywhere else."""
    known = words()
    rows = (known.keywords, known.contextual, known.motions, known.types, known.constants)
    listed = [word for row in (*rows, known.operators) for word in row]
    assert sorted(listed) == sorted(
        text for text in read_file(GRAMMAR).literal_tokens if text[0].isalpha()
    )


def test_programs_have_colours_throughout() -> None:
    """Of our own programs every character is coloured, and none is an error."""
    for file in sorted((ROOT / "corpus/programs/palletiser").rglob("*.src")):
        decoded = decode(file.read_bytes())
        assert not isinstance(decoded, str)
        text = decoded.text.replace("\r\n", "\n")
        found = list(KrlLexer(ensurenl=False, stripnl=False).get_tokens(text))
        assert text == "".join(part for _, part in found)
        assert [] == [part for kind, part in found if kind is token.Error and part.isascii()]


@given(st.text(alphabet="aA$#\"'; .[]()=10\n&{}é", max_size=60))
def test_no_text_stops_the_colours(text: str) -> None:
    """Whatever is written, nothing of it is lost."""
    found = KrlLexer(ensurenl=False, stripnl=False).get_tokens(text)
    assert text == "".join(part for _, part in found)


#: Lines with a word that can be a name, and whether it is a keyword there.
LINES = (
    ("PART=1", "PART", False),
    ("  DELAY = 1", "DELAY", False),
    ("DECL INT DELAY=1", "DELAY", False),
    ("FOR STEP=1 TO 3", "STEP", False),
    ("IF PATH[1] == 2 THEN", "PATH", False),
    ("Job.START = 1", "START", False),
    ("TRIGGER WHEN DISTANCE=0 DELAY=1 DO PART=TRUE", "PART", False),
    ("TRIGGER WHEN PATH=0 DELAY=-8 DO WORK( ) PRIO=-1", "PATH", True),
    ("TRIGGER WHEN PATH=0 DELAY=-8 DO WORK( ) PRIO=-1", "DELAY", True),
    ("TRIGGER WHEN PATH=0 DELAY=-8 DO WORK( ) PRIO = -1", "PRIO", True),
    ("TIME_BLOCK PART=30", "PART", True),
    ("WAIT SEC 0.5", "SEC", True),
)


@pytest.mark.parametrize(("line", "word", "is_keyword"), LINES)
def test_a_word_that_can_be_a_name_is_one_where_it_is(
    line: str, word: str, is_keyword: bool
) -> None:
    """It is one where a value is assigned to it, and a keyword as an argument of a statement."""
    found = {part: kind for kind, part in KrlLexer().get_tokens(f"END\n{line}\n")}
    assert (token.Keyword if is_keyword else token.Name) == found[word]


@pytest.mark.skipif(shutil.which("vim") is None, reason="no Vim here")
def test_vim_tells_keywords_from_names_too(tmp_path: Path) -> None:
    """Vim itself colours the lines; a predefined function has a colour only where it is called."""
    lines = (*LINES, ("Abs = SIN(x)", "SIN", True), ("Abs = SIN(x)", "Abs", False))
    program, script, said = (tmp_path / name for name in ("a.src", "look.vim", "said"))
    program.write_text("\n".join(line for line, *_ in lines) + "\n", encoding="utf-8")
    places = [(n, line.index(word) + 1) for n, (line, word, _) in enumerate(lines, start=1)]
    asked = ", ".join(f"synIDattr(synID({n}, {column}, 1), 'name')" for n, column in places)
    commands = [
        "syntax on",
        "runtime syntax/krl.vim",
        f"call writefile([{asked}], '{said}')",
        "qa!",
    ]
    script.write_text("\n".join(commands), encoding="utf-8")
    vim = ["vim", "-Nu", "NONE", "--cmd", f"set runtimepath^={ROOT / 'editors/vim'}", "-es"]
    subprocess.run([*vim, "-S", str(script), str(program)], check=True, timeout=60)
    found = said.read_text(encoding="utf-8").splitlines()
    assert [keyword for *_, keyword in lines] == [bool(name) for name in found]


@pytest.mark.parametrize("name", SNIPPETS)
def test_snippets_can_be_read(name: str) -> None:
    """With the words that stand in them at first, each is a piece of a program."""
    text = "\n".join(SNIPPETS[name]["body"])
    given: dict[str, str] = {}
    for number, chosen, shown in re.findall(r"(?<!\\)\$\{(\d+)(?:\|([^|]*)\||:([^}]*))\}", text):
        given[number] = chosen.partition(",")[0] if chosen else shown.replace("\\$", "$")
    text = text.replace("${TM_FILENAME_BASE:${1:name}}", "Cell")
    text = re.sub(r"(?<!\\)\$\{(\d+)(?:\|[^|]*\||:[^}]*)\}", lambda one: given[one[1]], text)
    text = re.sub(r"(?<!\\)\$(\d+)", lambda one: given.get(one[1], ""), text).replace("\\$", "$")
    program = text if text.startswith(("DEF ", "DEFFCT ")) else f"DEF Cell( )\n{text}\nEND"
    found = read_source(Source(f"{program}\n", "Cell.src"))
    assert ((), False) == (found.diagnostics, found.syntax is None)
    assert text.count(";FOLD") == text.count(";ENDFOLD")
