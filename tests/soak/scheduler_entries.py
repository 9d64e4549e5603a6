"""Entry points that work on a Dask cluster: addresses where none is."""

from __future__ import annotations

import socket
import threading
from functools import cache
from pathlib import Path

from tests.soak.foundry import Foundry
from tests.soak.given import PROGRAM, Entry, Given, krl, put

#: Nothing of it may reach a machine of somebody else: hosts are this one or cannot be.
ADDRESSES = [
    "tcp://nothing.invalid:8786",
    "nothing.invalid",
    "tcp://127.0.0.1:1",
    "127.0.0.1:1",
    "127.0.0.1:99999",
    "tcp://127.0.0.1:-1",
    "tcp://127.0.0.1:1e3",
    "tcp://127.0.0.1:" + "9" * 5_000,
    "tcp://[::1",
    "tcp://:0",
    "tcp://",
    "tls://127.0.0.1:1",
    "ucx://127.0.0.1:1",
    "ws://127.0.0.1:1",
    "http://127.0.0.1:1/",
    "inproc://",
    "inproc://1/2/3",
    "file:///etc/passwd",
    "tcp://a..b.invalid:1",
    "tcp://" + "a" * 70_000 + ".invalid:1",
    "tcp://é𝄞.invalid:8786",
    "tcp://a b.invalid:1",
    "tcp://a\nb.invalid:1",
    "tcp://\x00.invalid:1",
    "tcp://\udcff.invalid:1",
    "\x1b[31m",
    "\u202e//:pct",
    "",
    " ",
    "-",
    "://",
    "x" * 100_000,
]
#: What answers where a scheduler should: nothing at all, and things that are no answer.
ANSWERS = [
    b"",
    b"HTTP/1.1 400 Bad Request\r\n\r\n",
    b"\xff" * 64,
    b"\x00" * 64,
    (1 << 40).to_bytes(8, "little") * 8,
    b"\x80\x04\x95" * 30_000,
]
COMMANDS = [
    "recover --no-start --out = --scheduler ? !",
    "recover --no-start --out = --scheduler ? !",
    "fuzz --programs 1 --scheduler ?",
    "conform control/call_order --executor tree --robot none --scheduler ?",
    "conform control/call_order --metamorphic 1 --scheduler ?",
]


def scheduler(folder: Path, foundry: Foundry) -> Given:
    """Work for the cluster at an address that has none, or has something else."""
    chance = foundry.chance
    if chance.random() < 0.3:
        foundry.note("what answers at an address and is no scheduler")
        address = _impostor(chance.choice(ANSWERS))
    else:
        foundry.note("addresses of no scheduler")
        address = chance.choice(ADDRESSES)
        if chance.random() < 0.2:
            address = foundry.text(ADDRESSES[0]).decode("utf-8", "surrogateescape")
    places = {"?": address, "=": str(folder / "out"), "!": str(put(folder, "ok.src", PROGRAM))}
    return krl(*(places.get(word, word) for word in chance.choice(COMMANDS).split()))


@cache
def _impostor(answer: bytes) -> str:
    """The address of a server that answers so, and keeps whoever calls waiting for more."""
    listening = socket.create_server(("127.0.0.1", 0))
    threading.Thread(target=_answer, args=(listening, answer), daemon=True).start()
    host, port = listening.getsockname()
    return f"tcp://{host}:{port}"


def _answer(listening: socket.socket, answer: bytes) -> None:
    held = []
    while True:
        caller, _ = listening.accept()
        caller.sendall(answer)
        held.append(caller)


ENTRIES = {
    "scheduler": Entry(12, "an address where no scheduler is, or something else", scheduler),
}
