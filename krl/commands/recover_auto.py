"""`krl recover --auto`: extends a grammar automatically, round by round."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from krl.construct_ledger import expected_errors
from krl.errors import FINE, InputError, as_input_errors
from krl.terminal.output_files import write_json
from reports.rendering.number_format import counted

if TYPE_CHECKING:
    from grammar.notation.edits import Edit
    from grammar.notation.model import Grammar
    from recovery.induction.growth_folder import GrowthFolder
    from recovery.induction.induced_ledger import InducedLedger
    from recovery.induction.rounds import Induction
    from recovery.induction.target_comparison import Share
    from recovery.negatives.negatives import Negative

# The number of generated negatives that edits are tested with, drawn evenly from more, and their
# seed, which neither a bench nor the comparison with the target uses.
_NEGATIVES = 1_500
_SEED = 11


def recover_auto(
    roots: Sequence[Path],
    grammar: Path | None,
    out: Path,
    json_file: Path | None,
    negatives: Path | None,
    target: Path | None,
    *,
    without: int,
    hold_out: float | None,
    seed: int | None,
    strike: Sequence[str],
    resume: bool,
    suffix: str,
) -> int:
    """Grow a grammar from a corpus and write it, its ledger, its record and its page to ``out``.

    It starts from ``grammar``, or from the restrictive start, or from the grammar in force less
    ``without`` constructs. ``suffix`` is the file extension for languages other than KRL.
    Everything is written after each round, so that an interruption loses no more than one. A growth
    is continued with the settings that ``out`` holds, the folder of ``negatives`` and ``target``
    too. At the end the grown grammar is compared with ``target``.
    """
    from grammar.parser.lexer import ABSENT, lexer_of
    from recovery.induction.corpus_lines import drawn_origins, held_out
    from recovery.induction.growth_folder import GrowthFolder, GrowthFolderError
    from recovery.induction.induced_ledger import InducedLedger
    from recovery.induction.language import KRL, language_of
    from recovery.induction.rounds import Induction
    from recovery.induction.target_comparison import compared
    from recovery.negatives.generate import evenly
    from recovery.negatives.negatives import NegativeSet

    began = time.monotonic()
    is_continued = resume or bool(strike)
    _check(grammar, without, hold_out, suffix, is_continued=is_continued)
    given = {"hold_out": hold_out, "seed": seed, "suffix": suffix or None}
    folder = GrowthFolder(out)
    with expected_errors(), as_input_errors(GrowthFolderError):
        known = folder.settings() if is_continued else {}
        settings = _settings(given, known, out)
        if is_continued:
            ledger, struck = _ledger_so_far(grammar, folder, strike)
        else:
            start, names = _start(grammar, without, settings["seed"])
            settings |= names
            ledger, struck = InducedLedger(start, start), []
        rejected, goal, read = _negatives_and_target(negatives, target, known, out)
        settings |= read
        language = language_of(settings["suffix"]) if settings["suffix"] else KRL
        files = language.files(roots)
    lexer = lexer_of(ledger.start)
    for kind, what in ((lexer.line_kind, "line ends"), (lexer.name_kind, "names")):
        if kind == ABSENT:
            raise InputError(
                f"the grammar to start from has no token of {what}, which growing needs"
            )
    if not files:
        raise InputError("no readable source was found")
    if not is_continued:
        settings["held_out"] = drawn_origins(files, settings["hold_out"], settings["seed"])
    shown, held = held_out(files, settings["held_out"])
    if settings["hold_out"] and not held:
        raise InputError(
            f"--hold-out {settings['hold_out']:g} holds no file out: there are too few origins"
        )
    if not shown:
        raise InputError("no file is left to learn from: hold out less")
    generated = evenly(language.negatives(4 * _NEGATIVES, _SEED), _NEGATIVES)
    every = NegativeSet((*rejected, *generated))
    induction = Induction(
        ledger.grammar, shown, held, every, language=language, struck=struck, start=ledger.start
    )
    written = _Output(ledger, struck, folder, json_file, settings, began)
    is_finished = _grow(induction, written)
    reached = None
    if goal:
        reached = {
            "name": Path(settings["target_path"]).name,
            **compared(ledger.grammar, goal, shown, held, language),
        }
    page = written.write(is_finished, reached)
    typer.echo(f"{out / 'grammar.g4'}: {counted(len(ledger.constructs), 'step')}; {page}")
    return FINE


def _check(
    grammar: Path | None, without: int, hold_out: float | None, suffix: str, *, is_continued: bool
) -> None:
    """Raise `InputError` if options contradict one another."""
    if suffix and not (grammar or is_continued):
        raise InputError(f"--suffix {suffix}: a language other than KRL needs --grammar FILE")
    if without and (grammar or is_continued):
        raise InputError("--without starts from the grammar in force: give it alone")
    if not 0 <= (hold_out or 0) < 1:
        raise InputError(f"--hold-out {hold_out:g}: not from 0 to less than 1")


def _negatives_and_target(
    negatives: Path | None, target: Path | None, known: Mapping[str, Any], out: Path
) -> "tuple[Sequence[Negative], Grammar | None, dict[str, Any]]":
    """Return the written negatives, the grammar to compare with, and both as settings.

    What is not given is that of the ``known`` settings of a growth in ``out``. What that was begun
    without may be given later. Raises `InputError` if it was begun with another text.
    """
    from grammar.notation.foreign import read_foreign
    from grammar.notation.g4 import read_file
    from recovery.negatives.negatives import load
    from support.files.decode import digest

    folder = negatives or Path(known.get("negatives_path") or "")
    file = target or Path(known.get("target_path") or "")
    rejected = load(folder) if folder.name else ()
    goal = read_file(file, read_foreign) if file.name else None
    settings: dict[str, Any] = {}
    for option, path, text in (
        ("negatives", folder, "\0".join(f"{n.phase} {n.line} {n.text}" for n in rejected)),
        ("target", file, goal.text if goal else ""),
    ):
        found = digest(text.encode()) if path.name else ""
        if known.get(f"{option}_sha256") not in (None, "", found):
            raise InputError(f"--{option} {path}: {out} was begun with another")
        settings[f"{option}_path"] = str(path) if path.name else ""
        settings[f"{option}_sha256"] = found
    return rejected, goal, settings


def _settings(given: Mapping[str, Any], known: Mapping[str, Any], out: Path) -> dict[str, Any]:
    """Return the settings of a growth: those ``known`` of one in ``out``, then those given.

    ``None`` is not given. Raises `InputError` if one that is given differs from the known one.
    """
    from recovery.induction.growth_folder import SETTINGS

    given = {name: value for name, value in given.items() if value is not None}
    for name, value in given.items():
        if value != known.get(name, value):
            option = name.replace("_", "-")
            raise InputError(f"--{option} {value}: {out} was begun with {known[name] or 'none'}")
    return {**SETTINGS, **given, **known}


def _start(grammar: Path | None, without: int, seed: int) -> "tuple[Grammar, dict[str, Any]]":
    """Return the grammar to start from, and as settings its name and what was taken out of it."""
    from grammar.notation.foreign import read_foreign
    from grammar.notation.g4 import read_file
    from grammar.notation.generate import GRAMMAR
    from recovery.induction.induced_ledger import without_some
    from recovery.ledger.ledger import Ledger

    file = grammar or GRAMMAR.with_name("preliminary.g4")
    start = read_file(file, read_foreign)
    if not without:
        return start, {"start": file.name}
    accepted = Ledger.read(GRAMMAR.with_name("constructs")).accepted
    if without > len(accepted):
        raise InputError(f"--without {without}: there are {len(accepted)} constructs")
    less, gone = without_some(start, accepted, without, seed)
    for construct in gone:
        typer.echo(f"taken out: {construct.id} {construct.title}")
    ids = tuple(construct.id for construct in gone)
    return less, {"start": f"KRL.g4 less {len(gone)} constructs", "without": ids}


def _ledger_so_far(
    grammar: Path | None, folder: "GrowthFolder", strike: Sequence[str]
) -> "tuple[InducedLedger, list[tuple[Edit, ...]]]":
    """Return where to continue, and the edits that must not be taken again.

    Raises `InputError` if ``grammar`` is not the one that the growth began with.
    """
    from grammar.notation.foreign import read_foreign
    from grammar.notation.g4 import read_file

    ledger, struck, gone = folder.continued(strike)
    if grammar and read_file(grammar, read_foreign).text != ledger.start.text:
        raise InputError(f"--grammar {grammar}: {folder.path} was begun with another grammar")
    for construct in gone:
        typer.echo(f"struck out: {construct.id} {construct.title}")
    return ledger, struck


def _grow(induction: "Induction", written: "_Output") -> bool:
    """Write what each round accepts; return whether nothing more is worth taking."""
    ledger = written.ledger
    try:
        for done in induction.rounds():
            ledger.add(done)
            _say(len(ledger.rounds), ledger)
            written.write()
    except KeyboardInterrupt:
        typer.echo(
            f"interrupted; {written.folder.path} holds the results so far, --resume continues",
            err=True,
        )
        return False
    if not induction.is_finished:
        typer.echo("stopped at the limit of rounds; --resume continues", err=True)
    return induction.is_finished


@dataclass(frozen=True)
class _Output:
    """What a run has reached, and where it is written."""

    ledger: "InducedLedger"
    struck: "Sequence[Sequence[Edit]]"
    folder: "GrowthFolder"
    json_file: Path | None
    settings: Mapping[str, Any]
    began: float  # by the monotonic clock, in s

    def write(self, is_finished: bool = False, reached: dict[str, Any] | None = None) -> Path:
        """Write everything; return the path of the page. ``reached`` is the comparison."""
        from recovery.induction.auto_record import record_of
        from reports.recovery.auto_page import write_auto_page

        ledger, out = self.ledger, self.folder.path
        record = record_of(
            ledger,
            self.settings,
            seconds=time.monotonic() - self.began,
            is_finished=is_finished,
            target=reached,
        )
        if reached:
            _say_target(record)
        self.folder.write(ledger, self.struck)
        write_json(record, out / "auto.json")
        write_json(record, self.json_file)
        return write_auto_page(record, out)


def _say(number: int, ledger: "InducedLedger") -> None:
    last = ledger.rounds[-1]
    typer.echo(
        f"round {number}: {_share(last['shown'])} of the files shown parse"
        + (f", {_share(last['held'])} of those held out" if last["held"]["files"] else "")
        + f"; {counted(len(last['taken']), 'step')} taken"
    )


def _say_target(record: dict[str, Any]) -> None:
    name, target = record["target"]["name"], record["target"]
    held = f", {_part(target['held'])} of those held out" if target["held"]["of"] else ""
    reach = (
        f" ({_part(target['held_within_reach'])} of those within reach, "
        f"{_part(target['held_known_words'])} of those with known words)"
        if held
        else ""
    )
    unseen = target["words_not_shown"]
    typer.echo(
        f"of the files that {name} parses: {_part(target['shown'])} of those shown{held}{reach}\n"
        + (f"words that no file shown has: {', '.join(unseen)}\n" if unseen else "")
        + f"random sentences that {name} rejects: {_part(target['sentences_rejected'])}; "
        f"negatives accepted: {_part(target['negatives_accepted'])}; {record['rules']} rules"
    )


def _part(share: "Share") -> str:
    return f"{share['count']:,} of {share['of']:,}"


def _share(reading: dict[str, int]) -> str:
    return f"{reading['parsed']:,} of {reading['files']:,}"
