"""`krl asm` and `krl disasm`: programs of the bytecode machine as text and as image."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from krl.door import Unusable

if TYPE_CHECKING:
    from interp.bytecode.program import Program

__all__ = ["assemble_file", "disassemble_image"]

_LARGEST = 64 << 20  # bytes; no program that fits into the machine is nearly as large


def assemble_file(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A program as text.")],
    output: Annotated[
        Path | None,
        typer.Option("-o", metavar="IMAGE", help="The image; FILE with the ending .krlb."),
    ] = None,
) -> None:
    """Assemble a program of the bytecode machine, verify it, and write its image."""
    from interp.bytecode.assembler import AssemblyError, assemble

    try:
        program = assemble(_read(file).decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise Unusable(f"{file}: not a text in UTF-8") from None
    except AssemblyError as error:
        raise Unusable(f"{file}: {error}") from error
    write_image_of(program, file, output or file.with_suffix(".krlb"))


def disassemble_image(
    image: Annotated[Path, typer.Argument(metavar="IMAGE", help="An image.")],
) -> None:
    """Print an image as the text that `krl asm` makes it from."""
    from interp.bytecode.disassembler import disassemble
    from interp.bytecode.image import ImageError, read_image
    from interp.bytecode.verify import VerificationError, verify

    try:
        program = read_image(_read(image))
        verify(program)
    except (ImageError, VerificationError) as error:
        raise Unusable(f"{image}: {error}") from error
    typer.echo(disassemble(program), nl=False)


def write_image_of(program: "Program", source: Path, target: Path) -> None:
    """Verify a program and write its image, whole or not at all."""
    from interp.bytecode.image import write_image
    from interp.bytecode.verify import VerificationError, verify

    try:
        verify(program)
    except VerificationError as error:
        raise Unusable(f"{source}: {error}") from error
    if target.is_dir():
        raise Unusable(f"{target}: a folder, not a file")
    target.parent.mkdir(parents=True, exist_ok=True)
    scratch = target.with_name(target.name + ".part")
    scratch.write_bytes(write_image(program))
    scratch.replace(target)


def _read(file: Path) -> bytes:
    if file.is_dir():
        raise Unusable(f"{file}: a folder, not a file")
    with file.open("rb") as stream:
        data = stream.read(_LARGEST + 1)
    if len(data) > _LARGEST:
        raise Unusable(f"{file}: larger than {_LARGEST >> 20} MB")
    return data
