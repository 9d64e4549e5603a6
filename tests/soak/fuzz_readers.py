"""Looks for bytes that break a reader, guided by the branches that they take; needs Atheris.

    python -m tests.soak.fuzz_readers [READER...] [OPTION...]

An option is one of libFuzzer, such as ``-max_total_time=600``; each reader is given all of them. A
reader begins with programs, grammars and images of ours and with what is kept for it in
``reader_inputs``, and goes on with what it found before, in reports/out/fuzz-readers/READER. Input
that breaks it is written there, and belongs into ``reader_inputs`` with its mend. The status is 1
where one broke.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

import atheris

from tests.soak.foundry import Foundry
from tests.soak.given import REPOSITORY

_LOOKED_AT = (
    *("grammar", "interp.bytecode", "krl.language_server", "krl.project_settings"),
    *("conformance.exchange.recording", "support.files", "tomllib", "zipfile"),
)
# Atheris cannot instrument what the finder of an editable install loads, and says nothing: let the
# finder of folders, which finds the same files, come first.
sys.meta_path.sort(key=lambda finder: type(finder).__module__.startswith("_editable"))
with atheris.instrument_imports(include=list(_LOOKED_AT)):
    from support.files.decode import digest
    from tests.soak.readers import READERS, kept
assert "_trace_branch" in digest.__code__.co_names, "Atheris sees no branch of the readers"

#: How long an input may grow, and after how many seconds it hangs; options given later count.
_OPTIONS = ("-max_len=4096", "-timeout=120", "-rss_limit_mb=3000", "-print_final_stats=1")


def _begins_with(reader: str) -> Iterator[bytes]:
    """Inputs of ours for a reader; a short program says as much as a long one."""
    yield from kept(reader)
    foundry = Foundry()
    foundry.begin(1)
    if reader in ("text", "program"):
        yield from (data for data in foundry.own if len(data) < 1500)
    elif reader == "archive":
        yield from (data for _ in range(200) if len(data := foundry.archive()) < 4000)
    elif reader == "image":
        yield from (image for image, _ in foundry.compiled)
    elif reader == "grammar":
        yield (REPOSITORY / "grammar" / "preliminary.g4").read_bytes()


def _fuzz(reader: str, options: list[str]) -> None:
    """Look until an option says stop; never returns."""
    found = REPOSITORY / "reports" / "out" / "fuzz-readers" / reader
    inputs = found / "inputs"
    inputs.mkdir(parents=True, exist_ok=True)
    for data in _begins_with(reader):
        (inputs / digest(data)).write_bytes(data)
    atheris.Setup(
        [reader, *_OPTIONS, f"-artifact_prefix={found}/", *options, str(inputs)], READERS[reader]
    )
    atheris.Fuzz()


def main() -> None:
    """Look at the readers that are named, each in a process of its own; at all where none is."""
    options = [word for word in sys.argv[1:] if word.startswith("-")]
    chosen = [word for word in sys.argv[1:] if word not in options] or list(READERS)
    unknown = [name for name in chosen if name not in READERS]
    if unknown:
        sys.exit(f"no reader is called {unknown[0]}; there are {', '.join(READERS)}")
    if len(chosen) == 1:
        _fuzz(chosen[0], options)
    broken = []
    for name in chosen:
        command = [sys.executable, "-m", "tests.soak.fuzz_readers", name, *options]
        if subprocess.run(command, check=False).returncode:
            broken.append(name)
    if broken:
        sys.exit(f"broken: {', '.join(broken)}")


if __name__ == "__main__":
    main()
