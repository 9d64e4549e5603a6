"""Codecs: how parts of an image are read and written, both from one definition.

`WordReader` and `WordWriter` read and write the words of one section; a `Codec` says how something
consists of words. Images are not trusted: reading raises `ImageError` for any words that are not of
the format.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeVar

from grammar.semantics.types import Type
from interp.bytecode.cell_layout import bits_of, real_of
from interp.bytecode.program import printable

_T = TypeVar("_T")


class ImageError(Exception):
    """The bytes are not an image of this version, or are damaged; the message is one clear line."""

    def __init__(self, message: str) -> None:
        super().__init__(printable(message))


class WordReader:
    """Reads the words of the section ``name``.

    ``strings`` are those of the image, ``types`` the types of the program that are read already.
    """

    def __init__(self, name: str, data: bytes, strings: Sequence[str], types: list[Type]) -> None:
        self._name = name
        self._words: Sequence[int] = struct.unpack(f"<{len(data) // 4}I", data)
        self._next = 0
        self.strings = strings
        self.types = types
        #: The number of parts around the one that is read.
        self.depth = 0

    @property
    def left(self) -> int:
        """The number of words that are not read yet."""
        return len(self._words) - self._next

    def error(self, reason: str) -> ImageError:
        """Return an error in this section, for the caller to raise."""
        return ImageError(f"the image is damaged: section {self._name}, {reason}")

    def word(self) -> int:
        """Read a word."""
        if not self.left:
            raise self.error("it ends early")
        self._next += 1
        return self._words[self._next - 1]

    def choice(self, choices: Sequence[_T]) -> _T:
        """Read the index of one of some things, and return that."""
        number = self.word()
        if number >= len(choices):
            raise self.error("a number is out of range")
        return choices[number]


class WordWriter:
    """Collects the words of a section.

    ``strings`` are the indices of the strings of the image, ``types`` those of the program's types.
    """

    def __init__(self, strings: dict[str, int], types: dict[Type, int]) -> None:
        self._words: list[int] = []
        self._strings = strings
        self.types = types

    def put(self, *words: int) -> None:
        """Write words."""
        self._words += words

    def string(self, text: str) -> None:
        """Write the index of a string."""
        self.put(self._strings.setdefault(text, len(self._strings)))

    def data(self) -> bytes:
        """Return the words as bytes."""
        return struct.pack(f"<{len(self._words)}I", *(word & 0xFFFFFFFF for word in self._words))


class Codec(NamedTuple):
    """How something is read, and how it is written."""

    read: Callable[[WordReader], Any]
    write: Callable[[WordWriter, Any], None]


def _signed(reader: WordReader) -> int:
    word = reader.word()
    return word - 2**32 if word >= 2**31 else word


def _optional(reader: WordReader) -> int | None:
    number = reader.word()
    return number - 1 if number else None


WORD = Codec(WordReader.word, WordWriter.put)
SIGNED = Codec(_signed, WordWriter.put)
REAL = Codec(lambda reader: real_of(_signed(reader)), lambda to, real: to.put(bits_of(real)))
STRING = Codec(lambda reader: reader.choice(reader.strings), WordWriter.string)
OPTIONAL = Codec(_optional, lambda to, number: to.put(0 if number is None else number + 1))
#: A type by its number, which has to be read before.
TYPE = Codec(lambda reader: reader.choice(reader.types), lambda to, type_: to.put(to.types[type_]))


def one_of(choices: Sequence[Any]) -> Codec:
    """Return the codec of one of some things, by its place among them."""
    return Codec(lambda reader: reader.choice(choices), lambda to, one: to.put(choices.index(one)))


def list_of(item: Codec) -> Codec:
    """Return the codec of a tuple."""

    def read(reader: WordReader) -> tuple[Any, ...]:
        count = reader.word()
        if count > reader.left:  # whatever is read has a word at least
            raise reader.error("a list is longer than the section")
        return tuple(item.read(reader) for _ in range(count))

    def write(to: WordWriter, items: Sequence[Any]) -> None:
        to.put(len(items))
        for one in items:
            item.write(to, one)

    return Codec(read, write)


def record(kind: Callable[..., Any], /, **fields: Codec) -> Codec:
    """Return the codec of a data class, whose fields are written in this order."""

    def read(reader: WordReader) -> Any:
        return kind(**{name: codec.read(reader) for name, codec in fields.items()})

    def write(to: WordWriter, value: Any) -> None:
        for name, codec in fields.items():
            codec.write(to, getattr(value, name))

    return Codec(read, write)
