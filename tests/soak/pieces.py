"""What hostile input is made of, and the kinds of it that the counts tell."""

from typing import Any

#: What breaks readers, pages and terminals, by kind.
PIECES = {
    "markup and scripts in the text": [
        "</script><script>alert(1)</script>",
        "<img src=x onerror=alert(1)>",
        "<!--",
    ],
    "escapes of a terminal in the text": [
        "\x1b[2J\x1b[31m",
        "\x1b]0;title\x07",
        "\x9b31m",
        "\u202e\u2066",
    ],
    "strange characters in the text": ["\x00", "\ufeff", "𝄞", "é" * 50, "\r", "\r\n\r\n", "\x1a"],
    "deep nesting": [
        "(" * 500,
        "NOT " * 300,
        "[1," * 200,
        "IF TRUE THEN\n" * 120,
        "LOOP\n" * 400,
        ";FOLD " * 60,
    ],
    "numbers and sizes beyond all limits": [
        "9" * 400,
        "1E" + "9" * 30,
        "'HFFFFFFFFFFFFFFFF'",
        "DECL INT A[2147483647]\n",
        "DECL CHAR C[99999,99999,9]\n",
        "PTP {A1 1E38}\n",
        "LIN {X 1E30,Y 0,Z 0}\n",
        "FOR I=1 TO 9 STEP 0\nENDFOR\n",
        "WAIT SEC -1\n",
        "TRIGGER WHEN PATH=1E9 DELAY=-1E9 DO $OUT[1]=TRUE\n",
    ],
    "KRL in the wrong place": [
        "{A1 0,",
        '"' * 3,
        "DEF A()\nEND\n",
        "DEFDAT X\nENDDAT\n",
        "GOTO X\nX:\n",
        "$OV_PRO=0\n",
        "INTERRUPT DECL 5 WHEN TRUE DO X()\nINTERRUPT ON\n",
        "&ACCESS RVO\n&REL 1\n",
    ],
}
NUMBERS = ["0", "-1", "1", "7", "128", "32768", "2147483647", "1.0E38", "1E-40", "0.5", "1E9"]
#: What stands in the place of a number or a name, where a program shall stay readable.
TOKENS = [
    "0",
    "-1",
    "2147483647",
    "-2147483648",
    "1.0E38",
    "1E-40",
    "TRUE",
    "$POS_ACT",
    '"a"',
    "#X",
]
#: Texts that are small and ask much of a reader of TOML or JSON.
BOMBS = [
    "a = " + "[" * 50_000,
    "a" + ".a" * 20_000 + " = 1",
    "[" + "a." * 20_000 + "a]\n",
    "a = " + "9" * 6_000,
    "a = 0x" + "f" * 90_000,
    'a = """' + "\\" * 60_000,
    "[[a]]\n" * 20_000,
    "a = {" + "a = {" * 20_000,
    "[" * 100_000,
    '{"a":' * 50_000,
    '"' + "\\u0000" * 9_000 + '"',
    "9" * 6_000,
    "[1e999, NaN, -Infinity]",
]
#: Values that no record has.
VALUES: list[Any] = [None, -1, 1e308, 10**30, float("inf"), "", "\x1b[31m</script>", [], {}, [[]]]
#: Names of members of archives, by kind.
NAMES = {
    "names that lead out of the archive": [
        "../../up.src",
        "/etc/up.src",
        "C:\\up.src",
        "a/../../b.src",
        "..\\..\\up.dat",
    ],
    "names with control characters": ["a\x00b.src", "R1/\x1b[31m.dat", "R1/<b>\u202ecrs.src"],
    "names that some system cannot store": ["con.src", "a" * 300 + ".src", "x.src/", "é.src"],
    "names of a real backup": ["KRC/R1/x.src", "KRC/R1/x.dat", "KRC/R1/System/$config.dat"],
    "enormous paths": ["/".join("d" * 300) + "/x.src"],
}
#: Every kind of hostility; an input may hold several.
KINDS = [
    "strange names of files and folders",
    "pipes, devices, folders, loops of links and enormous files in the place of a file",
    "strange words on the command line",
    *PIECES,
    "enormous lines",
    "junk bytes",
    "another encoding",
    "text cut out, mixed or said many times",
    "brackets and words that do not close",
    "numbers and names exchanged, lines repeated",
    *NAMES,
    "links in archives",
    "devices and pipes in archives",
    "bombs in archives",
    "nested archives",
    "packing that is not supported",
    "encrypted members of archives",
    "wrong sizes in archives",
    "members of archives that overlap or lie nowhere",
    "damaged archives",
    "damaged images",
    "damaged caches",
    "damaged ledgers",
    "words of a document exchanged",
    "values that no record has",
    "bombs of TOML and JSON, and other texts that ask much",
    "damaged messages of an editor",
    "addresses of no scheduler",
    "what answers at an address and is no scheduler",
]
