"""Decoding: from bytes to KRL text, or the reason why the bytes are no KRL.

`.src` and `.dat` are used for many other things, so a file counts as KRL only on evidence: a line
that opens a module or routine of KRL or, without one, several lines that occur only in KRL. A file
with such evidence counts as KRL even if no grammar can parse it, because finding these is the
purpose of the survey.
"""

from __future__ import annotations

import codecs
import hashlib
import re
from itertools import islice

from support.lazy_dataclass import dataclass

#: Lines looked at for KRL statements when no line opens a module. Openers are sought everywhere.
EVIDENCE_LINES = 2_000

_LINE_WIDTH = 400  # how many characters of a line are examined; enough to recognise a statement


@dataclass(frozen=True, slots=True)
class Decoded:
    """The text of a KRL file.

    `text` has its original line ends and no byte order mark. `encoding` is the Python name of the
    file's encoding: `text.encode(encoding)` gives the bytes of the file, except for the byte order
    mark of UTF-16 and UTF-32 and the padding that `decode` drops at the end.
    """

    text: str
    encoding: str

    def replaced(self, data: bytes, text: str) -> bytes:
        """Return the bytes of the file with another text; ``data`` are its present bytes.

        A byte order mark and padding at the end are kept. Raises `UnicodeEncodeError` if the
        encoding lacks a character of ``text``.
        """
        before, _, after = data.partition(self.text.encode(self.encoding))
        return before + text.encode(self.encoding) + after


def digest(data: bytes) -> str:
    """Return the SHA-256 of `data` in hexadecimal, by which equal files are recognised."""
    return hashlib.sha256(data).hexdigest()


def decode(data: bytes) -> Decoded | str:
    """Return the text of a KRL file, or one line on why `data` is no KRL text.

    The encoding is UTF-8 if the bytes are valid, else cp1252, else Latin-1, because cp1252 leaves
    five bytes undefined. It is UTF-16 or UTF-32 if the byte order mark says so or every other byte
    is zero. Ctrl-Z and NUL bytes at the very end, with which old controllers pad their files, are
    dropped, as is an incomplete character of UTF-16.
    """
    if not data:
        return "empty file"
    source = _text_of(data)
    if isinstance(source, str):
        return source
    return _why_not_krl(source.text) or source


# -- encodings -------------------------------------------------------------------------------------

# UTF-32 first: its little-endian mark begins with that of UTF-16.
_WIDE = (
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_PADDING = "\0\x1a"
# Position, in each pair of bytes, of the zeros of Latin letters.
_ZEROS = {"utf-16-le": 1, "utf-16-be": 0}
_LOOKED_AT = 64
_CONTROLS = bytes(set(range(32)) - set(b"\t\n\v\f\r")) + b"\x7f"
_MAGIC = (
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"\x89PNG", "a PNG image"),
    (b"GIF8", "a GIF image"),
    (b"BM", "a bitmap"),
    (b"%PDF", "a PDF document"),
    (b"PK\x03\x04", "a zip archive"),
    (b"\x1f\x8b", "gzip data"),
    (b"7z\xbc\xaf", "a 7z archive"),
    (b"Rar!", "a RAR archive"),
    (b"\x7fELF", "an ELF program"),
    (b"MZ", "a Windows program"),
    (b"regf", "a Windows registry hive"),
    (b"SQLite format 3", "an SQLite database"),
    (b"\xd0\xcf\x11\xe0", "an OLE document"),
)


def _text_of(data: bytes) -> Decoded | str:
    """Return the decoded text, or why `data` is no text."""
    unmarked = ((b"", encoding) for encoding, place in _ZEROS.items() if _is_wide(data, place))
    for mark, encoding in (*_WIDE, *unmarked):
        if data.startswith(mark):
            width = 4 if "32" in encoding else 2
            try:
                text = data[len(mark) : len(data) // width * width].decode(encoding)
            except UnicodeDecodeError:
                continue
            text = text.rstrip(_PADDING)
            return _why_binary(text.encode("utf-8")) or Decoded(text, encoding)
    body = data.rstrip(_PADDING.encode("ascii"))
    if reason := _why_binary(body):
        return reason
    marked = body.startswith(codecs.BOM_UTF8)
    body = body.removeprefix(codecs.BOM_UTF8)
    for encoding in ("utf-8", "cp1252"):
        try:
            text = body.decode(encoding)
        except UnicodeDecodeError:
            continue
        return Decoded(text, "utf-8-sig" if marked and encoding == "utf-8" else encoding)
    return Decoded(body.decode("latin-1"), "latin-1")


def _is_wide(data: bytes, place: int) -> bool:
    """Return whether every other byte at the start is zero, beginning with `place`."""
    start = data[: _LOOKED_AT // 2 * 2]
    return len(start) > 1 and not any(start[place::2]) and all(start[1 - place :: 2])


def _why_binary(body: bytes) -> str | None:
    """Return why `body` is binary data, or None. Real KRL may have a few control characters."""
    controls = len(body) - len(body.translate(None, _CONTROLS))
    if b"\0" in body:
        what = "NUL bytes"
    elif controls > max(8, len(body) // 50):
        what = f"{controls:,} control characters"
    else:
        return None
    known = next((name for magic, name in _MAGIC if body.startswith(magic)), None)
    return f"binary data: {known}" if known else f"binary data: {what} in it"


# -- evidence --------------------------------------------------------------------------------------

_FLAGS = re.IGNORECASE | re.ASCII
_NEWLINE = re.compile(r"\r\n|\r|\n")

# Other languages open functions with DEF too: there the parameters are followed by a colon, a brace
# or an equals sign, hold parentheses, or continue in the next line.
_OPENER = re.compile(
    r"(?:\A|[\r\n])[ \t]*(?:GLOBAL[ \t]+)?"
    r"(?:(?:DEFFCT|DEFDAT|DEFTP)[ \t]+[A-Z_${<%]"
    r"|DEF[ \t]+[\w${}<>%.-]+[ \t]*\([^;()\r\n]*\)[ \t]*(?:[;\r\n]|\Z))",
    _FLAGS,
)

# DEF with a typing error, which alone must not make a program count as other text.
_MISSPELT_OPENER = re.compile(
    r"(?:GLOBAL\s+)?(?:\w?DE\w?|\w?EF\w?|\w?D\w?F\w?|EDF)\s+[\w$]+\s*\([^;()]*\)\s*(?:;|\Z)", _FLAGS
)
_HEADER = re.compile(r"&(?:ACCESS|REL|COMMENT|PARAM|USER)\b", _FLAGS)
_FOLD = re.compile(r";\s{0,9}(?:END)?FOLD\b", _FLAGS)
_SYSTEM = (  # `$` starts a variable in Perl, PHP and PowerShell too: these are set in programs
    "OUT|ANOUT|VEL|VEL_AXIS|ACC|ACC_AXIS|APO|BASE|TOOL|LOAD|ADVANCE|TIMER|TIMER_STOP|FLAG|CYCFLAG"
    "|ORI_TYPE|CIRC_TYPE|IPO_MODE|OV_PRO"
)
_STATEMENT = re.compile(
    "|".join(
        (
            r"(?:S?PTP|S?LIN|S?CIRC|SPL)(?:_REL)?\s+(?:\{|[A-Z_$][\w$]*\s*(?:[\[.,:;]|C_|WITH\b|\Z))",
            r"(?:GLOBAL\s+)?DECL\s+(?:GLOBAL\s+|CONST\s+)*[A-Z_$][\w$]*\s*(?:\[[^\]]*\]\s*)?[A-Z_$]",
            r"(?:GLOBAL\s+)?STRUC\s+[A-Z_$]\w*\s+[A-Z_$]",
            r"(?:GLOBAL\s+)?E[36]?(?:POS|AXIS)\s+[A-Z_$]",
            r"SIGNAL\s+[A-Z_$][\w$]*\s+\$",
            r"EXT(?:FCT)?P?\s+(?:[A-Z_$]\w*(?:\[[^\]]*\])?\s+)?[A-Z_$]\w*\s*\(",
            rf"\$(?:{_SYSTEM})(?:\[[^\]]*\])?(?:\.[A-Z]\w*)*\s*=(?!=)(?!.*;\Z)",
            r"(?:ENDFCT|ENDDAT|ENDLOOP|ENDSWITCH)\s*(?:;|\Z)",
            r"(?:GLOBAL\s+)?INTERRUPT\s+(?:DECL|ON|OFF)\b",
            r"TRIGGER\s+WHEN\b|WAIT\s+SEC\b|WAIT\s+FOR\s*[($]|BAS\s*\(#",
            r"[A-Z_]\w*(?:\[[^\]]*\])?\s*=\s*\{\s*[A-Z]\w*(?:\[\])?\s+(?:[\"'#]|[+-]?[\d.])",
        )
    ),
    _FLAGS,
)
# Keywords that KRL shares with Fortran and others; they count only beside specific ones.
_SHARED = re.compile(r"(?:END|ENDIF|ENDFOR|ENDWHILE|CONTINUE)\s*(?:;|\Z)", _FLAGS)

_MARKUP = re.compile(r"<[?!/A-Z]", _FLAGS)
_MARKED_LINE = re.compile(r"(?:\A|[\r\n])\s*<[?!/A-Z]", re.IGNORECASE)
_LOOKS = (
    ("a shell script or the like", re.compile(r"#!")),
    ("Windows registry text", re.compile(r"Windows Registry Editor|REGEDIT4", _FLAGS)),
    (
        "C source",
        re.compile(
            r"#\s*(?:include|define|if|ifdef|ifndef|pragma)\b|/\*|//|typedef\b|extern\b"
            r"|\w[\w\s*]*\([^;]*\)\s*\{"
        ),
    ),
    (
        "Fortran source",
        re.compile(
            r"(?:PROGRAM|SUBROUTINE|COMMON|DIMENSION|IMPLICIT|REAL\*8|INTEGER\*\d|"
            r"(?:[A-Z]+\s+)?FUNCTION|CALL|WRITE\s*\(|FORMAT\s*\()",
            _FLAGS,
        ),
    ),
    ("JSON", re.compile(r"[{\[]\s*(?:[\"{\[}\]]|-?\d|\Z)|\"[^\"]*\"\s*:")),
    ("INI settings", re.compile(r"\[[^\[\]=]+\]\s*\Z")),
    ("a log", re.compile(r"\[?(?:\d{4}-\d\d-\d\d|\d\d[./]\d\d[./]\d{2,4}|\d\d:\d\d:\d\d)\b")),
)
_NUMBERS = re.compile(r"(?:[-+]?(?:\d+\.?\d*|\.\d+)(?:[ED][-+]?\d+)?|NAN|INF)\Z", _FLAGS)
_SEPARATORS = re.compile(r"[\s,;|]+")


def _why_not_krl(text: str) -> str | None:
    """Return why `text` is no KRL, or None if it is."""
    opener = _OPENER.search(text)
    if opener and not _MARKED_LINE.search(text, 0, opener.start()):
        return None
    lines = [line[:_LINE_WIDTH].strip() for line in islice(_lines(text), EVIDENCE_LINES)]
    code = [line for line in lines if line and line[0] not in "&;"]
    if code and _MARKUP.match(code[0]):
        return f"no KRL statement in {_extent(lines)}: looks like XML or HTML"
    if opener:
        return None
    if not code:
        if len(lines) == EVIDENCE_LINES:
            return f"no statements in {_extent(lines)}, only header and comment lines"
        return "no statements, only header, comment or blank lines"
    if _MISSPELT_OPENER.match(code[0]) and _SHARED.match(code[-1]):
        return None
    krl = sum(bool(_STATEMENT.match(line)) for line in code)
    signs = krl + sum(bool(_HEADER.match(line) or _FOLD.match(line)) for line in lines)
    # One line may look like KRL by chance; a data table of a thousand lines holds two of them.
    shared = sum(bool(_SHARED.match(line)) for line in code)
    if signs and signs + shared >= max(2, len(code) // 50):
        return None
    return f"no KRL statement in {_extent(lines)}: looks like {_likeness(code)}"


def _lines(text: str) -> list[str]:
    """Return the first lines of `text`, split where KRL splits: at CRLF, LF and CR alone."""
    return _NEWLINE.split(text, EVIDENCE_LINES)


def _extent(lines: list[str]) -> str:
    whole = len(lines) < EVIDENCE_LINES
    if whole and len(lines) == 1:
        return "its only line"
    return f"its {len(lines):,} lines" if whole else f"its first {len(lines):,} lines"


def _likeness(code: list[str]) -> str:
    """Return what `code`, lines without comments, looks like; only shown to people."""
    sample = code[:50]
    rows = [line for line in sample if not line.startswith(("#", "%", "!", "*"))]
    if rows and 2 * sum(map(_is_row, rows)) > len(rows):
        return "a data table"
    for name, pattern in _LOOKS:
        if any(pattern.match(line) for line in sample[:10]):
            return name
    if sum("=" in line for line in sample) * 2 > len(sample):
        return "settings"
    if len(sample) > 1 and any(_same_count(sample, mark) for mark in ",;\t|"):
        return "a data table"
    return "other text"


def _same_count(sample: list[str], mark: str) -> bool:
    counts = {line.count(mark) for line in sample}
    return len(counts) == 1 and 0 not in counts


def _is_row(line: str) -> bool:
    fields = [field for field in _SEPARATORS.split(line) if field]
    return bool(fields) and 2 * sum(bool(_NUMBERS.match(field)) for field in fields) > len(fields)
