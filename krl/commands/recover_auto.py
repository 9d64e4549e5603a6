"""`krl recover --auto`: extends a grammar automatically, round by round."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from krl.errors import FINE, InputError, as_input_errors
from krl.terminal.output_files import write_json
from reports.rendering.number_format import counted

if TYPE_CHECKING:
    from grammar.notation.edits import Edit
    from grammar.notation.model import Grammar
    from recovery.induction.induced_ledger import InducedLedger
    from recovery.induction.induction_folder import InductionFolder, InductionSettings
    from recovery.induction.language import CorpusFile
    from recovery.induction.rounds import Induction
    from recovery.induction.target_comparison import Share
    from recovery.negatives.negatives import Negative

# The number of generated negatives that edits are tested with, drawn evenly from more, and their
# seed, which neither a bench nor the comparison with the target uses.
_NEGATIVES = 1_500
_SEED = 11


@dataclass(frozen=True, slots=True)
class AutoOptions:
    """The options of `krl recover --auto`; one that is ``None``, empty or 0 is not given."""

    grammar: Path | None
    out: Path
    json_file: Path | None
    negatives: Path | None
    target: Path | None
    without: int
    hold_out: float | None
    seed: int | None
    strike: Sequence[str]
    resume: bool
    suffix: str

    @property
    def is_continued(self) -> bool:
        """Whether it goes on with what is in ``out``."""
        return self.resume or bool(self.strike)

    def check(self) -> None:
        """Raise `InputError` if options contradict one another."""
        if self.suffix and not (self.grammar or self.is_continued):
            raise InputError(
                f"--suffix {self.suffix}: a language other than KRL needs --grammar FILE"
            )
        if self.without and (self.grammar or self.is_continued):
            raise InputError("--without starts from the grammar in force: give it alone")
        part = self.hold_out or 0
        if part < 0 or 1 <= part < 2:
            raise InputError(f"--hold-out {part:g}: neither a share below 1 nor a number of files")


def recover_auto(roots: Sequence[Path], options: AutoOptions) -> int:
    """Infer a grammar from a corpus and write it, its ledger, its record and its page.

    It starts from a given grammar, or from the restrictive start, or from the grammar in force less
    some constructs. Everything is written after each round, so that an interruption loses no more
    than one. A run is continued with the settings that its folder holds. At the end the inferred
    grammar is compared with the target.
    """
    from recovery.induction.induction_folder import InductionFolder, InductionFolderError
    from recovery.induction.language import KRL, language_of
    from recovery.induction.rounds import Induction
    from recovery.induction.target_comparison import compared
    from recovery.negatives.generate import evenly
    from recovery.negatives.negatives import NegativeSet

    began = time.monotonic()
    options.check()
    folder = InductionFolder(options.out)
    with as_input_errors(InductionFolderError):
        start = _continued(options, folder) if options.is_continued else _begun(options)
        written_negatives, target, settings = _negatives_and_target(options, start.settings)
        language = language_of(settings.suffix) if settings.suffix else KRL
        files = language.files(roots)
    ledger = start.ledger
    _check_tokens(ledger.start)
    shown, held, settings = _parted(files, settings, is_continued=options.is_continued)
    generated = evenly(language.negatives(4 * _NEGATIVES, _SEED), _NEGATIVES)
    negatives = NegativeSet((*written_negatives, *generated))
    induction = Induction(
        ledger.grammar,
        shown,
        held,
        negatives,
        language=language,
        struck=start.struck,
        start=ledger.start,
    )
    written = _Output(ledger, start.struck, folder, options.json_file, settings, began)
    is_finished = _run(induction, written)
    reached: dict[str, Any] | None = None
    if target:
        reached = {
            "name": Path(settings.target_path).name,
            **compared(ledger.start, ledger.grammar, target, shown, held, language),
        }
    page = written.write(is_finished, reached)
    where = options.out / "grammar.g4"
    typer.echo(f"{where}: {counted(len(ledger.constructs), 'step')}; {page}")
    return FINE


# ------------------------------------------------------------------------------- where to start


@dataclass(frozen=True, slots=True)
class _Start:
    """Where a run starts: steps so far, edits that must not be taken, and its settings."""

    ledger: "InducedLedger"
    struck: "Sequence[tuple[Edit, ...]]"
    settings: "InductionSettings"


def _begun(options: AutoOptions) -> _Start:
    """Return the beginning of a new run, with the settings as given."""
    from grammar.notation.foreign import read_foreign
    from grammar.notation.g4 import read_file
    from grammar.notation.generate import GRAMMAR
    from recovery.induction.induced_ledger import InducedLedger, without_some
    from recovery.induction.induction_folder import InductionSettings
    from recovery.ledger.ledger import Ledger

    file = options.grammar or GRAMMAR.with_name("preliminary.g4")
    start = read_file(file, read_foreign)
    settings = replace(InductionSettings(start=file.name), **_given(options))
    if options.without:
        accepted = Ledger.read(GRAMMAR.with_name("constructs")).accepted
        if options.without > len(accepted):
            raise InputError(f"--without {options.without}: there are {len(accepted)} constructs")
        start, gone = without_some(start, accepted, options.without, settings.seed)
        for construct in gone:
            typer.echo(f"taken out: {construct.id} {construct.title}")
        name, ids = f"KRL.g4 less {len(gone)} constructs", tuple(one.id for one in gone)
        settings = replace(settings, start=name, without=ids)
    return _Start(InducedLedger(start, start), (), settings)


def _continued(options: AutoOptions, folder: "InductionFolder") -> _Start:
    """Return where a run goes on, with its settings.

    Raises `InputError` if an option differs from what the run was begun with.
    """
    from grammar.notation.foreign import read_foreign
    from grammar.notation.g4 import read_file

    settings = folder.settings()
    for name, value in _given(options).items():
        if value != (known := getattr(settings, name)):
            option = name.replace("_", "-")
            raise InputError(f"--{option} {value}: {folder.path} was begun with {known or 'none'}")
    ledger, struck, gone = folder.continued(options.strike)
    if options.grammar and read_file(options.grammar, read_foreign).text != ledger.start.text:
        raise InputError(
            f"--grammar {options.grammar}: {folder.path} was begun with another grammar"
        )
    for construct in gone:
        typer.echo(f"struck out: {construct.id} {construct.title}")
    return _Start(ledger, struck, settings)


def _given(options: AutoOptions) -> dict[str, Any]:
    """Return the settings that are given as options."""
    given = {"hold_out": options.hold_out, "seed": options.seed, "suffix": options.suffix or None}
    return {name: value for name, value in given.items() if value is not None}


def _negatives_and_target(
    options: AutoOptions, settings: "InductionSettings"
) -> "tuple[Sequence[Negative], Grammar | None, InductionSettings]":
    """Return the written negatives, the grammar to compare with, and the settings with both.

    What is not given is that of the ``settings``. What a run was begun without may be given later.
    Raises `InputError` if it was begun with another text.
    """
    from grammar.notation.foreign import read_foreign
    from grammar.notation.g4 import read_file
    from recovery.negatives.negatives import load
    from support.files.decode import digest

    folder = options.negatives or Path(settings.negatives_path)
    file = options.target or Path(settings.target_path)
    negatives = load(folder) if folder.name else ()
    target = read_file(file, read_foreign) if file.name else None
    found: dict[str, Any] = {}
    for option, path, text in (
        ("negatives", folder, "\0".join(f"{n.phase} {n.line} {n.text}" for n in negatives)),
        ("target", file, target.text if target else ""),
    ):
        name = f"{option}_sha256"
        found[f"{option}_path"] = str(path) if path.name else ""
        found[name] = digest(text.encode()) if path.name else ""
        if getattr(settings, name) not in ("", found[name]):
            raise InputError(f"--{option} {path}: {options.out} was begun with another")
    return negatives, target, replace(settings, **found)


def _check_tokens(start: "Grammar") -> None:
    """Raise `InputError` if a grammar lacks tokens on which the inference rests."""
    from grammar.parser.lexer import ABSENT, lexer_of

    lexer = lexer_of(start)
    for kind, what in ((lexer.line_kind, "line ends"), (lexer.name_kind, "names")):
        if kind == ABSENT:
            raise InputError(
                f"the grammar to start from has no token of {what}, which growing needs"
            )


def _parted(
    files: "Sequence[CorpusFile]", settings: "InductionSettings", *, is_continued: bool
) -> "tuple[Sequence[CorpusFile], Sequence[CorpusFile], InductionSettings]":
    """Return the files to learn from, those held out, and the settings with the origins of these.

    Origins are drawn where a run begins. Raises `InputError` if one of the parts lacks files.
    """
    from recovery.induction.corpus_lines import drawn_origins, held_out

    if not files:
        raise InputError("no readable source was found")
    if not is_continued:
        drawn = drawn_origins(files, settings.hold_out, settings.seed)
        settings = replace(settings, held_out=drawn)
    shown, held = held_out(files, settings.held_out)
    if settings.hold_out and not held:
        raise InputError(
            f"--hold-out {settings.hold_out:g} holds no file out: there are too few origins"
        )
    if not shown:
        raise InputError("no file is left to learn from: hold out less")
    return shown, held, settings


# ---------------------------------------------------------------------------------- the rounds


def _run(induction: "Induction", written: "_Output") -> bool:
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
    folder: "InductionFolder"
    json_file: Path | None
    settings: "InductionSettings"
    began: float  # by the monotonic clock, in s

    def write(self, is_finished: bool = False, reached: dict[str, Any] | None = None) -> Path:
        """Write everything; return the path of the page. ``reached`` is the comparison."""
        from recovery.induction.induction_folder import record_of
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
