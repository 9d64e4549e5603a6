"""A foundry of hostile input: our own programs, images and records, damaged in many ways."""

from __future__ import annotations

import contextlib
import copy
import io
import json
import random
import re
import struct
import zipfile
import zlib
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from tests.soak.pieces import BOMBS, KINDS, NAMES, NUMBERS, PIECES, TOKENS, VALUES

REPOSITORY = Path(__file__).parents[2]

_WORD = re.compile(rb"[A-Za-z_$][\w$]*|\d+(?:\.\d+)?")


class Foundry:
    """Makes inputs by chance; the same seed gives the same."""

    def __init__(self) -> None:
        self.chance = random.Random()  # seeded before each input; nobody's secret depends on it
        self.kinds: set[str] = set()
        own = [*(REPOSITORY / "corpus").rglob("*.src"), *(REPOSITORY / "corpus").rglob("*.dat")]
        own = [file for file in own if "open" not in file.relative_to(REPOSITORY).parts]
        self.own = [file.read_bytes() for file in sorted(own) if file.stat().st_size < 20_000]

    def begin(self, seed: int) -> None:
        """Begin an input: chance is seeded, and no kind of hostility is in it yet."""
        self.chance.seed(seed)
        self.kinds.clear()

    def one_of(self, kinds: dict[str, list[Any]]) -> Any:
        """One of the things of any kind, each as likely as the next; its kind is noted."""
        kind, thing = self.chance.choice([(k, one) for k, all_ in kinds.items() for one in all_])
        self.kinds.add(kind)
        return thing

    def note(self, kind: str) -> None:
        """Take down that the input holds this kind of hostility."""
        assert kind in KINDS, kind
        self.kinds.add(kind)

    @cached_property
    def cases(self) -> list[bytes]:
        """Conformance cases: programs that say what they expect and can be run."""
        folder = REPOSITORY / "conformance" / "cases"
        return [file.read_bytes() for file in sorted(folder.rglob("*.src"))]

    @cached_property
    def compiled(self) -> list[tuple[bytes, str]]:
        """Some of our programs as images and as text of the bytecode machine."""
        from interp.bytecode.assembly.disassembler import disassemble
        from interp.bytecode.compiler.project import compile_program
        from interp.bytecode.image.image import write_image
        from interp.values.faults import LinkError
        from krl.running.program_loading import load_program

        made = []
        for file in sorted((REPOSITORY / "conformance" / "cases" / "control").glob("*.src")):
            with contextlib.suppress(LinkError):
                program = compile_program(load_program(file)[0]).program
                made.append((write_image(program), disassemble(program)))
            if len(made) == 8:
                break
        return made

    def program(self) -> bytes:
        """A program: hardly readable any more, or readable and strange."""
        data = bytearray(self.chance.choice(self.own))
        if self.chance.random() < 0.5:
            for _ in range(self.chance.randrange(1, 6)):
                self._damage(data)
        else:
            for _ in range(self.chance.randrange(1, 5)):
                self._estrange(data)
        return bytes(data[:400_000])

    def runnable(self) -> bytes:
        """A program that can be run for the most part."""
        data = bytearray(self.chance.choice(self.cases))
        for _ in range(self.chance.randrange(3)):
            self._estrange(data)
        return bytes(data)

    def _damage(self, data: bytearray) -> None:
        chance = self.chance
        place = chance.randrange(len(data) + 1)
        match chance.randrange(9):
            case 0:
                data[place:place] = self._piece()
            case 1:
                self.note("text cut out, mixed or said many times")
                data[place : place + chance.randrange(200)] = b""
            case 2:
                self.note("junk bytes")
                data[place:place] = chance.randbytes(chance.randrange(1, 60))
            case 3:
                self.note("text cut out, mixed or said many times")
                other = chance.choice(self.own)
                start = chance.randrange(len(other))
                data[place:place] = other[start : start + 300]
            case 4:
                self.note("text cut out, mixed or said many times")
                lines = bytes(data).split(b"\n")
                chance.shuffle(lines)
                data[:] = b"\n".join(lines)
            case 5:
                self.note("text cut out, mixed or said many times")
                line = bytes(data).split(b"\n")[0]
                data[place:place] = line * chance.randrange(1, 200)
            case 6:
                self.note("enormous lines")
                data[place:place] = chance.choice([b"x", b"1", b";", b" "]) * (
                    chance.randrange(1, 60_000)
                )
            case 7:
                self.note("brackets and words that do not close")
                data[:] = bytes(data).replace(b"(", b"((", 3).replace(b"END", b"EN", 1)
            case 8:
                self.note("another encoding")
                with contextlib.suppress(UnicodeDecodeError):
                    text = bytes(data).decode("utf-8")
                    data[:] = text.encode(chance.choice(["utf-16", "utf-8-sig", "utf-32-be"]))

    def _estrange(self, data: bytearray) -> None:
        """Change a program so that it may well be read, checked and run still."""
        chance = self.chance
        lines = bytes(data).split(b"\n")
        place = chance.randrange(len(lines))
        words = list(_WORD.finditer(lines[place]))
        match chance.randrange(4):
            case 0:
                lines.insert(place, b"; " + self._piece().replace(b"\n", b" "))
            case 1 if words:
                self.note("numbers and names exchanged, lines repeated")
                word = chance.choice(words)
                new = chance.choice(NUMBERS).encode()
                if not word[0][:1].isdigit():
                    new = chance.choice(_WORD.findall(bytes(data)))
                lines[place] = lines[place][: word.start()] + new + lines[place][word.end() :]
            case 2:
                self.note("numbers and names exchanged, lines repeated")
                lines[place:place] = [lines[place]] * chance.choice([1, 1, 300])
            case _:
                lines[place] += b" ;" + self._piece().replace(b"\n", b" ")
        data[:] = b"\n".join(lines)

    def _piece(self) -> bytes:
        piece: str = self.one_of(PIECES)
        return piece.encode("utf-8", "surrogatepass")

    def archive(self, program: bytes = b"") -> bytes:
        """An archive whose names lead out of it, lie about sizes, are links, bombs, nested.

        A ``program`` lies in it as KRC/R1/x.src.
        """
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            if program:
                archive.writestr("KRC/R1/x.src", program)
            for _ in range(self.chance.randrange(1, 5)):
                self._member(archive)
        return self._damaged_archive(bytearray(stream.getvalue()))

    def _member(self, archive: zipfile.ZipFile) -> None:
        chance = self.chance
        entry = zipfile.ZipInfo(self.one_of(NAMES))
        entry.compress_type = zipfile.ZIP_DEFLATED
        match chance.randrange(7):
            case 0:
                self.note("links in archives")
                entry.external_attr = 0o120777 << 16
                archive.writestr(entry, chance.choice(["/etc/passwd", "../../up.src", "x.src"]))
            case 1:
                self.note("bombs in archives")
                size = chance.choice([1_000_000, 1_000_000, 80_000_000])
                archive.writestr(entry, b"DEF A()\n" + b" " * size)
            case 2:
                self.note("nested archives")
                content = b"DEF A()\nEND\n"
                for _ in range(chance.randrange(1, 5)):
                    inner = io.BytesIO()
                    with zipfile.ZipFile(inner, "w") as nested:
                        nested.writestr("n.zip" if content[:2] == b"PK" else "n.src", content)
                    content = inner.getvalue()
                entry.filename = "nested.zip"
                archive.writestr(entry, content)
            case 3:
                self.note("packing that is not supported")
                entry.compress_type = chance.choice([zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
                archive.writestr(entry, self.program())
            case 4:
                self.note("devices and pipes in archives")
                entry.external_attr = chance.choice([0o020666, 0o010666, 0o060666]) << 16
                archive.writestr(entry, b"DEF A()\nEND\n")
            case _:
                archive.writestr(entry, self.program())

    def _damaged_archive(self, data: bytearray) -> bytes:
        chance = self.chance
        place, listed = bytes(data).find(b"PK\x03\x04"), bytes(data).find(b"PK\x01\x02")
        match chance.randrange(8):
            case 0:
                self.note("damaged archives")
                for _ in range(chance.randrange(1, 30)):
                    data[chance.randrange(len(data))] = chance.randrange(256)
            case 1:
                self.note("damaged archives")
                data = data[: chance.randrange(len(data))]
            case 2:
                self.note("encrypted members of archives")
                data[place + 6 : place + 8] = data[listed + 8 : listed + 10] = struct.pack("<H", 1)
            case 3:
                self.note("wrong sizes in archives")
                size = struct.pack("<I", chance.choice([0, 1, 0x7FFFFFFF, 0xFFFFFFFE]))
                data[listed + 24 : listed + 28] = size
            case 4:  # its content lies elsewhere, or in itself
                self.note("members of archives that overlap or lie nowhere")
                data[listed + 42 : listed + 46] = struct.pack("<I", chance.randrange(1 << 20))
            case 5:  # the directory names the same content many times: a bomb without nesting
                self.note("members of archives that overlap or lie nowhere")
                end = bytes(data).rfind(b"PK\x05\x06")
                entry, times = bytes(data[listed:end]), chance.choice([3, 300])
                tail = bytearray(data[end:])
                tail[8:10] = tail[10:12] = struct.pack("<H", 4 * times)
                tail[12:16] = struct.pack("<I", len(entry) * times)
                data = data[:listed] + entry * times + tail
        return bytes(data)

    def image(self) -> bytes:
        """An image of the bytecode machine, some bytes of it changed."""
        self.note("damaged images")
        data = bytearray(self.chance.choice(self.compiled)[0])
        for _ in range(self.chance.randrange(9)):
            data[self.chance.randrange(len(data))] = self.chance.randrange(256)
        if self.chance.random() < 0.1:
            data = data[: self.chance.randrange(len(data))]
        if self.chance.random() < 0.8 and len(data) > 16:  # a wrong checksum would end it all
            data[8:16] = struct.pack("<II", len(data), zlib.crc32(data[16:]))
        return bytes(data)

    def bytes_of(self, data: bytes) -> bytes:
        """Bytes of any format, some of them changed, or cut."""
        self.note("damaged caches")
        changed = bytearray(data)
        for _ in range(self.chance.choice([1, 4, 40])):
            changed[self.chance.randrange(len(changed))] = self.chance.randrange(256)
        return bytes(changed[: self.chance.choice([len(changed), self.chance.randrange(9_000)])])

    def text(self, given: str) -> bytes:
        """A text of some format: words exchanged, damaged, or a bomb behind its first lines."""
        chance = self.chance
        if chance.random() < 0.1:
            self.note("bombs of TOML and JSON, and other texts that ask much")
            head = given.splitlines(keepends=True)[: chance.randrange(5)]
            return ("".join(head) + chance.choice(BOMBS)).encode()
        data = bytearray(given.encode())
        if chance.random() < 0.5:
            self.note("words of a document exchanged")
            for _ in range(chance.randrange(1, 4)):
                words = list(_WORD.finditer(data))
                if words:
                    word, other = chance.choice(words), chance.choice(words)[0]
                    new = chance.choice([other, chance.choice(TOKENS).encode()])
                    data[word.start() : word.end()] = new
        else:
            for _ in range(chance.randrange(1, 4)):
                self._damage(data)
        return bytes(data[:200_000])

    def record(self, given: Any) -> bytes:
        """A record as JSON, some of its values those of no record, or the text damaged."""
        if self.chance.random() < 0.3:
            return self.text(json.dumps(given))
        self.note("values that no record has")
        given = json.loads(json.dumps(given))
        for _ in range(self.chance.choice([0, 1, 1, 2])):
            self._exchange(given)
        return json.dumps(given).encode()

    def _exchange(self, node: Any) -> None:
        """Go down by chance, and put another value there."""
        while isinstance(node, dict | list) and node:
            key: Any = self.chance.choice(
                list(node) if isinstance(node, dict) else range(len(node))
            )
            deeper = isinstance(node[key], dict | list) and node[key]
            if not deeper and len(node) > 1 and self.chance.random() < 0.6:
                continue  # what lies deeper is met less often by itself
            if not deeper or self.chance.random() < 0.05:
                node[key] = copy.deepcopy(self.chance.choice(VALUES))
                return
            node = node[key]

    def messages(self, valid: Sequence[Any]) -> bytes:
        """Messages of the Language Server Protocol, some damaged, some with a wrong frame."""
        out = b""
        for message in valid:
            body = json.dumps(message).encode()
            if self.chance.random() < 0.4:
                self.note("damaged messages of an editor")
                body = self.record(message)
            length = len(body)
            if self.chance.random() < 0.05:
                self.note("damaged messages of an editor")
                length = self.chance.choice([0, -1, length + 7, 10**12])
            out += f"Content-Length: {length}\r\n\r\n".encode() + body
            if self.chance.random() < 0.05:
                out += self.chance.randbytes(40) + b"\r\n\r\n"
        return out
