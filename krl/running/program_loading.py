"""The program of a file on the command line, checked or compiled, made once and then kept."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from krl.running.project_sources import read_sources

if TYPE_CHECKING:
    from grammar.syntax.source import Source
    from interp.program.load import CheckedProgram

_T = TypeVar("_T")


def load_program(
    file: Path, *, strict: bool = False, stands_in: bool = False, routine: str | None = None
) -> "tuple[CheckedProgram, list[str]]":
    """Return the program that starts with a file, and why files of its project were left out.

    ``archive.zip/folder/name.src`` is a file in an archive. Without ``strict`` an error found by
    the checker does not prevent a run: the statement fails when it is reached. With ``stands_in``
    the project gets stand-ins for missing parts, also for the arguments of ``routine`` (default:
    the first one) if the run starts there. A program that was loaded before comes from the cache
    (`support.files.kept_values`). Raises `InputError` if it cannot be read, and
    `interp.values.faults.LinkError` if it cannot be run.
    """
    from interp.program.load import load
    from interp.program.routine_callers import with_caller

    def loaded(sources: "list[Source]", main: str, unread: list[str]) -> "CheckedProgram":
        program = load(sources, main, strict=strict, stands_in=stands_in, unread=unread)
        return with_caller(program, routine) if stands_in else program

    return _made_once(file, f"{strict} {stands_in} {routine}", loaded)


class Image(NamedTuple):
    """A program compiled from ``files`` files.

    ``refusals`` are statements that end it when reached.
    """

    data: bytes
    files: int
    codes: int
    instructions: int
    refusals: tuple[str, ...]


def compile_project(file: Path, *, strict: bool = False) -> tuple[Image, list[str]]:
    """Return the image of the program, and why files were left out; like `load_program`, cached."""

    def compiled(sources: "list[Source]", main: str, unread: list[str]) -> Image:
        from interp.bytecode.compiler.project import compile_program
        from interp.bytecode.verifier.verify import VerificationError, verify
        from interp.program.load import load
        from interp.values.faults import LinkError

        made = compile_program(load(sources, main, strict=strict, unread=unread))
        try:
            data = verify(made.program).image
        except VerificationError as error:
            raise LinkError(str(error)) from error
        codes = made.program.codes
        refusals = tuple(f"{one.path}:{one.line}: {one.reason}" for one in made.refusals)
        return Image(
            data, len(sources), len(codes), sum(len(code.instructions) for code in codes), refusals
        )

    return _made_once(file, f"image of files {strict}", compiled)


def _made_once(
    file: Path, how: str, make: "Callable[[list[Source], str, list[str]], _T]"
) -> "tuple[_T, list[str]]":
    """Return what ``make`` returns for the project of a file, cached, and the files left out."""
    from interp.executors import CODE
    from support.files.kept_values import kept

    sources, main, left = read_sources(file)

    def made() -> "tuple[_T, list[str]]":
        unread = left.copy()
        return make(sources, main, unread), unread

    texts = (text for one in sources for text in (one.path, one.text))
    return kept(CODE, (main, how, *left, *texts), made)
