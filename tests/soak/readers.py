"""What reads bytes of other people, each as a function of bytes that fails where a law is broken.

Whatever the bytes: a reader gives its result or refuses in one line. `tests.soak.fuzz_readers`
looks for bytes that break one; those in ``reader_inputs`` are read with every run of the tests.
"""

from __future__ import annotations

import io
import tempfile
import traceback
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path, PurePosixPath
from unittest.mock import patch

from pygls.exceptions import JsonRpcInvalidParams

from conformance.exchange.recording import Recording, RecordingError
from grammar.check.project.project_check import read_source
from grammar.notation import g4
from grammar.notation.krl_grammar import krl_grammar
from grammar.notation.model import GrammarError
from grammar.parser.failures import FailureFinder
from grammar.parser.network import network_of
from grammar.parser.recognizer import Recognizer
from grammar.syntax.source import Source
from interp.bytecode.image.image import read_image, write_image
from interp.bytecode.instruction_set.table import MAGIC
from krl.baseline_file import read_baseline
from krl.commands.lsp import Bounded
from krl.errors import InputError, one_line
from krl.language_server.server import server
from krl.project_settings import read_settings
from support.files import archives
from support.files.decode import decode
from tests.interp.bytecode.damaged_images import run_on_machines, sealed

KEPT = Path(__file__).parent / "reader_inputs"


def kept(reader: str) -> Iterator[bytes]:
    """The inputs that are kept for a reader."""
    for file in sorted((KEPT / reader).glob("*")):
        yield file.read_bytes()


def _refused(reason: object) -> None:
    assert str(reason), "refused without a reason"
    assert len(str(reason).splitlines()) == 1, f"not one line: {reason!r}"


def _text(data: bytes) -> None:
    """The bytes come back from the text, whatever mark and padding they have."""
    source = decode(data)
    if isinstance(source, str):
        _refused(source)
    else:
        assert data == source.replaced(data, source.text)


def _archive(data: bytes) -> None:
    """Members have paths of their own that lead nowhere else, and hold no more than they claim."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "a.zip"
        file.write_bytes(data)
        try:
            found = archives.members(file, lambda _: True)
        except archives.ArchiveError as error:
            _refused(error)
            return
        paths = [member.path for member in found]
        assert len(paths) == len(set(paths))
        assert not any(
            PurePosixPath(path).is_absolute() or ".." in path.split("/") for path in paths
        )
        try:
            for member in found:
                if member.problem is None and member.size < 1 << 20:
                    content = archives.read(file, member.address, member.size)
                    assert member.size >= len(content)
        except archives.ArchiveError as error:
            _refused(error)
        finally:
            archives.close_archives()


@cache
def _finder() -> FailureFinder:
    return FailureFinder(Recognizer(krl_grammar()))


def _program(data: bytes) -> None:
    """A text has failures where it is no program; each lies in it; the check reads it too."""
    source = decode(data)
    if isinstance(source, str):
        return
    text = source.text
    found = _finder().find(text)
    assert bool(found) != _finder().recognizer.accepts(text)
    offsets = [failure.offset for failure in found]
    assert sorted(set(offsets)) == offsets
    assert all(0 <= offset <= len(text) for offset in offsets)
    reading = read_source(Source(text, "a.src"))
    assert bool(reading.diagnostics) == bool(found)


def _grammar(data: bytes) -> None:
    """A grammar that is read can be made a network."""
    try:
        network_of(g4.read(data.decode("utf-8", "replace")))
    except GrammarError as error:
        _refused(error)


def _file_of(data: bytes, read: Callable[[Path], object], *refusals: type[Exception]) -> None:
    """Let something read the bytes as a file."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "given"
        file.write_bytes(data)
        try:
            read(file)
        except refusals as error:
            _refused(one_line(str(error)))


def _image(data: bytes) -> None:
    """A program that is read is written as it was, and both machines do the same with it."""
    if data.startswith(MAGIC):
        data = sealed(data[16:])  # chance finds no checksum
    program = run_on_machines(data)
    if program is not None:
        assert program == read_image(write_image(program))


def _messages(data: bytes) -> None:
    """Each line is a message of an editor; no answer to one fails in our code."""
    framed = b"".join(
        b"Content-Length: %d\r\n\r\n%s" % (len(line), line) for line in data.split(b"\n")
    )
    ours, told = server(), list[Exception]()
    with patch.object(ours, "report_server_error", lambda error, _: told.append(error)):
        ours.start_io(Bounded(io.BytesIO(framed)), io.BytesIO())  # type: ignore[arg-type]
    for error in told:
        if isinstance(error, JsonRpcInvalidParams):
            continue  # said on purpose
        place = f"{getattr(error, 'data', '')}{''.join(traceback.format_exception(error))}"
        assert "/krl/language_server/" not in place, place


#: The readers by name.
READERS: Mapping[str, Callable[[bytes], None]] = {
    "text": _text,
    "archive": _archive,
    "program": _program,
    "grammar": _grammar,
    "settings": lambda data: _file_of(data, read_settings, InputError),
    "baseline": lambda data: _file_of(data, read_baseline, InputError),
    "image": _image,
    "recording": lambda data: _file_of(data, Recording.read, RecordingError),
    "messages": _messages,
}
