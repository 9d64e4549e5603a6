"""Wrong usage, and input that cannot be used: one line, status 2, and nothing is written."""

import shlex
from pathlib import Path

import pytest

from krl.cli import main
from support.parallel import dask_cluster

FILES = {
    "brackets.json": b"[]",
    "cut.g4": b"grammar X;\ns : A",
    "cut.zip": b"PK\x03\x04 and no more",
    "damaged/0001-a.toml": b"title = ",
    "c/data.dat": b"DEFDAT data\nENDDAT\n",
    "left.g4": b"grammar X;\ns : s A | A ;\nA : 'A' ;\n",
    "noise.g4": b"\xff\xfe\x00\x01",
    "notes.txt": b"no KRL",
    "nothing.krla": b"bytecode 4\n",
    "odd/binary.src": bytes(range(256)) * 9,
    "odd/empty.src": b"",
    "c/ok.src": b"DEF ok ( )\nHALT\nEND\n",
    "s.toml": b'[[object]]\nname = "a"\n',
    "c/takes.src": b"DEF takes (A :IN )\nEND\n",
    "unfit/0001-a.toml": (
        b'title = "A"\nstate = "accepted"\n\n[[edit]]\nedit = "insert"\nrule = "nowhere"\n'
        b'at = [1, 1]\ntext = "X?"\n'
    ),
    "wordy.krla": b"bytecode 4\nnothing\n",
    "zeros.krlb": b"KRLI" + bytes(40),
}
NO_CORPUS = "krl: there is no corpus/ here: name files, folders or .zip archives"
OF_AUTO = "krl: --hold-out, --without, --seed, --target, --suffix, --resume and --strike belong to"

#: What is asked of `krl`, and how the line begins that it says.
ASKED = [
    ("asm odd/binary.src", "krl: odd/binary.src: not a text in UTF-8"),
    ("asm empty", "krl: empty: a folder, not a file"),
    ("asm nothing.krla", "krl: nothing.krla: there is no code object"),
    ("asm wordy.krla", "krl: wordy.krla: line 2: nothing begins no section"),
    ("disasm empty", "krl: empty: a folder, not a file"),
    ("disasm odd/empty.src", "krl: odd/empty.src: not an image"),
    ("disasm zeros.krlb", "krl: zeros.krlb: the image has format 0"),
    ("bench check gone", "krl: gone: no such file or folder"),
    ("bench conform --group nothing", "krl: --group nothing: the groups are the clock, outputs, "),
    ("bench growth --entry brew", "krl: --entry brew: not one of check, check sarif, "),
    ("bench mutation --grammar none.g4", "krl: none.g4: No such file"),
    ("bench programs gone", "krl: gone: no such file or folder"),
    ("bench programs --damage cut,rust .", "krl bench programs: Invalid value for '--damage': "),
    ("bench real-code c/ok.src --executor abacus", "krl: --executor: there is no abacus here"),
    ("bench recover", NO_CORPUS),
    ("bench recover gone", "krl: gone: no such file or folder"),
    *(
        (f"bench scale c/ok.src --sizes '{sizes}'", f"krl: --sizes {sizes}: not a list of MB")
        for sizes in ("ten", "1,-1", "0", "1;2", "nan", "1e9")
    ),
    ("check", "krl check: Missing argument"),
    ("check gone", "krl: gone: no such file or folder"),
    ("check c/ok.src --select XYZ", "krl: no code begins with XYZ"),
    ("check c/ok.src --format xml", "krl check: Invalid value for '--format': 'xml' is not"),
    ("check c/ok.src --out .", "krl: .: a folder, not a file"),
    ("check c/ok.src --cache c/ok.src", "krl: c/ok.src: not a folder that can be written to"),
    ("check odd/empty.src", "krl: odd/empty.src: empty file"),
    ("check odd/binary.src", "krl: odd/binary.src: binary data"),
    ("conform nowhere/nothing", "krl: nowhere/nothing: no case, suite, rule or phase"),
    ("conform control/exit_for --executor cobol", "krl: cobol: the executor must be one of "),
    ("conform control/exit_for --robot marvin", "krl: marvin: the robot must be one of "),
    ("conform import", "krl: krl conform import takes one file"),
    ("conform import gone.json", "krl: gone.json: cannot be read"),
    ("conform --lint gone", "krl: gone: no such folder"),
    ("construct replay --check", "krl: grammar/preliminary.g4: No such file"),
    ("construct propose c-1 --survey brackets.json", "krl: brackets.json: not a survey"),
    *(
        (f"corpus synth '--size={size}'", f"krl: --size {size}: not a number of bytes such as ")
        for size in ("", "0", "-5", "ten", "10 MBit", "1e6", "0.0001kB")
    ),
    ("corpus synth --out c/ok.src", "krl: c/ok.src: not a folder"),
    ("debug", "krl: name a program: krl debug FILE"),
    ("debug c/ok.src --port 1", "krl: --port: only with --dap"),
    ("debug gone.src", "krl: gone.src: no such file"),
    ("diff empty", "krl: name two files, folders or archives"),
    ("diff gone gone", "krl: gone: no such file or folder"),
    ("diff --textconv c/ok.src c/ok.src", "krl: --textconv takes one file"),
    ("diff c/ok.src notes.txt", "krl: notes.txt: not a .src, .dat, .sub or .zip file"),
    ("explain KSS2295X", "krl: no finding has the code KSS2295X; did you mean KSS2295?"),
    ("format", "krl format: Missing argument"),
    ("format gone", "krl: gone: no such file or folder"),
    ("fuzz --executor tree", "krl: name two executors at least"),
    ("fuzz --executor nobody --executor tree", "krl: nobody: the executor must be one of "),
    ("fuzz --json .", "krl: .: a folder, not a file"),
    ("growth", NO_CORPUS),
    ("growth gone", "krl: gone: no such file or folder"),
    ("growth empty", "krl: empty: no .src, .dat or .sub file in it"),
    ("growth c/ok.src --constructs gone", "krl: gone: not a folder"),
    ("growth c/ok.src --constructs damaged", "krl: damaged/0001-a.toml: not TOML"),
    ("growth c/ok.src --constructs unfit", "krl: unfit/0001-a.toml: edit: there is no rule"),
    ("growth c/ok.src --out notes.txt", "krl: notes.txt: not a folder"),
    ("growth c/ok.src --json empty", "krl: empty: a folder, not a file"),
    ("growth c/ok.src --jobs 0", "krl growth: Invalid value for '--jobs': "),
    ("recover", NO_CORPUS),
    ("recover c/ok.src gone", "krl: gone: no such file or folder"),
    ("recover empty", "krl: empty: no .src, .dat or .sub file in it"),
    ("recover notes.txt", "krl: notes.txt: not a .src, .dat, .sub or .zip file"),
    ("recover cut.zip", "krl: cut.zip: truncated or damaged archive"),
    ("recover c/ok.src --grammar gone.g4", "krl: gone.g4: No such file"),
    ("recover c/ok.src --grammar cut.g4", "krl: cut.g4:2: syntax error at end"),
    ("recover c/ok.src --grammar noise.g4", "krl: noise.g4: not a grammar"),
    ("recover c/ok.src --grammar left.g4", "krl: left.g4:2: left recursion through s"),
    ("recover c/ok.src --grammar empty", "krl: empty: Is a directory"),
    ("recover c/ok.src --negatives gone", "krl: gone: no such folder"),
    ("recover c/ok.src --fast", "krl recover: No such option: --fast"),
    ("recover c/ok.src --jobs 0", "krl recover: Invalid value for '--jobs': "),
    ("recover c/ok.src --jobs 100000", "krl recover: Invalid value for '--jobs': "),
    ("recover c/ok.src --jobs many", "krl recover: Invalid value for '--jobs': "),
    ("recover c/ok.src --scheduler tcp://localhost:1", "krl: no Dask scheduler answers at tcp://"),
    ("recover c/ok.src --out notes.txt", "krl: notes.txt: not a folder"),
    ("recover c/ok.src --json empty", "krl: empty: a folder, not a file"),
    *(
        (f"recover c/ok.src {option}", OF_AUTO)
        for option in ("--resume", "--target X.g4", "--without 3", "--suffix .s", "--seed 4")
    ),
    ("recover c/ok.src --auto --hold-out 1", "krl: --hold-out 1: "),
    ("recover c/ok.src --auto --hold-out 0.1", "krl: --hold-out 0.1 holds no file out"),
    ("recover c/ok.src --auto --resume --out gone", "krl: gone: there is nothing to resume"),
    ("recover c/ok.src --auto --suffix .s", "krl: --suffix .s: a language other than KRL"),
    ("recover c/ok.src --auto --without 3000", "krl: --without 3000: there are "),
    ("recover c/ok.src --auto --without 3 --resume", "krl: --without starts from the grammar"),
    ("recover c/ok.src --auto --target gone.g4", "krl: gone.g4: No such file"),
    ("robot status-turn gone.json --machine notes.txt", "krl: notes.txt: not machine data"),
    ("run gone.src", "krl: gone.src: no such file"),
    ("run c/data.dat", "krl: data.dat has no routine"),
    ("run odd/binary.src", "krl: odd/binary.src: binary data"),
    ("run odd/empty.src", "krl: odd/empty.src: empty file"),
    ("run c/takes.src", "krl: takes has parameters"),
    ("run c/ok.src --executor lua", "krl run: Invalid value for '--executor': 'lua' is not"),
    ("run c/ok.src --routine gone", "krl: there is no routine gone"),
    ("run c/ok.src --submit gone", "krl: there is no routine gone"),
    ("run c/ok.src --profile kss99", "krl: there is no profile kss99"),
    ("run c/ok.src --profile gone.toml", "krl: gone.toml cannot be read"),
    ("run c/ok.src --io gone.io", "krl: gone.io: No such file"),
    ("run c/ok.src --max-time -1", "krl run: Invalid value for '--max-time'"),
    ("run c/ok.src --trace .", "krl: .: a folder, not a file"),
    ("run c/ok.src --trace -", "krl: -: output cannot go to standard output; name a file"),
    ("run c/ok.src --path path.csv", "krl: --path: the robot none takes no set-points"),
    ("run c/ok.src --robot kinematic --path p.txt", "krl: --path: p.txt ends neither in .parquet "),
    ("run c/ok.src --video film.gif", "krl: --video: only the MuJoCo arm can be filmed; say "),
    ("run c/ok.src --robot mujoco --video film.mov", "krl: film.mov: should end in "),
    ("run c/ok.src --png arm.png", "krl: --png: only the MuJoCo arm can be filmed; say "),
    ("run c/ok.src --robot mujoco --png arm.jpg", "krl: arm.jpg: should end in .png"),
    ("run c/ok.src --scene s.toml", "krl: --scene: the robot none has no position"),
    ("run c/ok.src --robot kinematic --scene s.toml", "krl: s.toml:1: shape of 'a' is none of"),
    ("run c/ok.src --robot kinematic --scene gone.toml", "krl: gone.toml: No such file"),
    ("run c/ok.src --machine s.toml --urdf s.toml", "krl: --machine, --urdf and --mjcf: only "),
    ("run c/ok.src --machine s.toml", "krl: s.toml: not machine data"),
    ("run c/ok.src --machine gone.dat", "krl: gone.dat: No such file"),
    ("run c/ok.src --mjcf s.toml", "krl: s.toml:1: not XML"),
]  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files, and an empty folder."""
    made = tmp_path_factory.mktemp("here")
    for name, data in FILES.items():
        (made / name).parent.mkdir(parents=True, exist_ok=True)
        (made / name).write_bytes(data)
    (made / "empty").mkdir()
    return made


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize(("asked", "said"), ASKED)
def test_it_is_one_line(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    asked: str,
    said: str,
) -> None:
    """It tells what is wrong; status 2, nothing on stdout, and all files are as they were."""
    monkeypatch.chdir(folder)
    monkeypatch.setattr(dask_cluster, "_GREETING", 0.1)  # no scheduler comes that late
    assert 2 == main(shlex.split(asked))
    out, err = capsys.readouterr()
    assert ("", 1) == (out, err.count("\n"))
    assert err.startswith(said)
    assert err.strip().isprintable()
    found = {file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file()}
    assert {*FILES} == found
