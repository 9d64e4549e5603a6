"""`krl compile`, `krl asm` and `krl disasm`: programs of the bytecode machine."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from krl.errors import FINDINGS, FINE, InputError, say
from krl.running.program_loading import compile_project
from krl.running.run_options import FileArgument
from krl.terminal.output_files import check_files
from support.files.atomic_write import write_atomic

_LARGEST = 64 << 20  # bytes; no program that fits into the machine is nearly as large
_MOST_LISTED = 20
_ImageOption = Annotated[
    Path | None,
    typer.Option("-o", metavar="IMAGE", help="The image; FILE with the ending .krlb."),
]


def compile_file(
    file: FileArgument,
    output: _ImageOption = None,
    strict: bool = False,
    native: bool = False,
) -> int:
    """Compile a program with its whole project to bytecode, verify it, and write its image.

    The image can start with any routine of the file without parameters, or of a submit program.
    Causes that would end a run are reported on stderr with exit status 1, such as a missing routine
    or a variable of unknown type; the image is still written.

    Options:
        strict: Write nothing if the checker finds an error.
        native: Add native code, for krl run --executor compiled.
    """
    from interp.values.faults import LinkError

    with _about(file, LinkError):
        image, left = compile_project(file, strict=strict)
    target = output or file.with_suffix(".krlb")
    _write(image.data, target)
    notes = [f"left out: {why}" for why in left]
    if native:
        notes += _native_code(image.data)
    notes += image.refusals
    for line in notes[:_MOST_LISTED]:
        say(line, err=True)
    if len(notes) > _MOST_LISTED:
        typer.echo(f"and {len(notes) - _MOST_LISTED} more", err=True)
    count = f"{image.codes:,} code objects, {image.instructions:,} instructions"
    if image.files > 1:
        count += f", from {image.files:,} files of the project"
    say(f"{target}: {count}")
    return FINDINGS if image.refusals else FINE


def _native_code(image: bytes) -> Iterator[str]:
    """Compile and store the native code; yield the reason if that fails."""
    from interp.bytecode.image.image import read_image
    from interp.bytecode.verifier.verify import verify
    from interp.native import AVAILABLE

    if not AVAILABLE:
        yield "no native code: the machine in C was not built"
        return
    from interp.native.c_backend.compiled import keep

    try:
        keep(verify(read_image(image)))
    except OSError as error:
        yield f"no native code: {error}"


def assemble_file(
    file: Annotated[Path, typer.Argument(metavar="FILE")],
    output: _ImageOption = None,
) -> None:
    """Assemble a program of the bytecode machine, verify it, and write its image.

    Options:
        file: A program as text.
    """
    from interp.bytecode.assembly.assembler import AssemblyError, assemble
    from interp.bytecode.verifier.verify import VerificationError, verify

    try:
        text = _read(file).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{file}: not a text in UTF-8") from None
    with _about(file, AssemblyError, VerificationError):
        image = verify(assemble(text)).image
    _write(image, output or file.with_suffix(".krlb"))


def disassemble_image(
    image: Annotated[Path, typer.Argument(metavar="IMAGE")],
    steps: bool = False,
) -> None:
    """Print an image as the text that `krl asm` makes it from.

    Options:
        image: An image.
        steps: Print the register code of the machine in C instead.
    """
    from interp.bytecode.assembly.disassembler import disassemble
    from interp.bytecode.image.codec import ImageError
    from interp.bytecode.image.image import read_image
    from interp.bytecode.verifier.verify import VerificationError, verify
    from interp.native import AVAILABLE

    with _about(image, ImageError, VerificationError):
        verified = verify(read_image(_read(image)))
    if not steps:
        typer.echo(disassemble(verified.program), nl=False)
        return
    if not AVAILABLE:
        raise InputError("--steps: the machine in C was not built")
    from interp.native.c_backend.register_code import listing

    for line in listing(verified):
        typer.echo(line)


@contextmanager
def _about(file: Path, *kinds: type[Exception]) -> Iterator[None]:
    """Raise exceptions of these kinds as `InputError` that names the file."""
    try:
        yield
    except kinds as error:
        raise InputError(f"{file}: {error}") from error


def _write(image: bytes, target: Path) -> None:
    check_files(target)
    write_atomic(target, image)


def _read(file: Path) -> bytes:
    from support.files.untrusted import read_bytes

    if file.is_dir():
        raise InputError(f"{file}: a folder, not a file")
    return read_bytes(file, _LARGEST)
