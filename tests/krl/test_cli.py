"""The command line as a whole."""

import json
import os
import re
import subprocess
import sys
import sysconfig
from importlib import metadata
from pathlib import Path
from unittest.mock import Mock

import pytest

import krl
from krl.cli import main
from krl.errors import InputError
from krl.extras import need


def test_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    """`krl --version` prints the installed version."""
    assert 0 == main(["--version"])
    assert f"krl {metadata.version('krl-workbench')}\n" == capsys.readouterr().out


@pytest.mark.parametrize("arguments", [[], ["-h"], ["--help"]])
def test_help_lists_the_commands(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    """`krl` alone and `krl --help` list the commands on stdout, with whole sentences."""
    assert 0 == main(arguments)
    said = capsys.readouterr().out
    assert "..." not in said.partition("Commands:")[2]
    assert all(f"\n  {command} " in said for command in ("recover", "growth", "corpus"))


def test_the_shell_completes_what_could_be_typed() -> None:
    """Completion knows commands and their options."""
    asked = {"_KRL_COMPLETE": "complete_bash", "COMP_CWORD": "2", "COMP_WORDS": "krl run --ro"}
    command = [sys.executable, "-m", "krl"]
    done = subprocess.run(
        command, env=os.environ | asked, capture_output=True, text=True, check=False
    )
    assert (0, ["--routine", "--robot"]) == (done.returncode, done.stdout.split())


def test_the_demonstration_writes_its_page_and_opens_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The arm is on it, and the program ran to its end."""
    pytest.importorskip("mujoco")
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    page = tmp_path / "demo.html"
    assert 0 == main(["demo", "--html", str(page)])
    assert [page.as_uri()] == opened
    assert "search_demo.src" in page.read_text(encoding="utf-8")


def test_module_runs_as_the_command(tmp_path: Path) -> None:
    """`python -m krl` is `krl`, in any folder."""
    command = [sys.executable, "-m", "krl", "corpus", "list"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert 2 == done.returncode
    assert "krl: no corpus folder here: run this in a checkout of the workbench\n" == done.stderr


@pytest.mark.parametrize(
    ("words", "before", "status"),
    [
        (("-m", "krl", "check"), "krl: ", 2),
        (("-c", "import krl; krl.check"), "ImportError: ", 1),
        (("-m", "pytest"), "", 2),
    ],
)
def test_a_package_of_the_same_name_is_named(
    tmp_path: Path, words: tuple[str, ...], before: str, status: int
) -> None:
    """Where another project's `support` is found first, one line says so, whoever asks."""
    (tmp_path / "support").mkdir()
    (tmp_path / "support" / "__init__.py").write_text("raise ValueError\n", encoding="utf-8")
    (tmp_path / "test_a.toml").write_text("[[test]]\n", encoding="utf-8")
    folders = [tmp_path, Path(krl.__file__).parents[1], sysconfig.get_path("purelib")]
    done = subprocess.run(
        [sys.executable, "-S", *words],  # an editable install of the workbench is found first
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, folders))},
        capture_output=True,
        text=True,
        check=False,
    )
    [line] = re.findall(".*should be.*", done.stderr or done.stdout)
    assert (status, True) == (done.returncode, line.startswith(f"{before}support should be "))
    assert f"and is {tmp_path / 'support'}, of another project" in line


@pytest.mark.parametrize(
    ("mark", "origin", "cure"),
    [
        ("", None, "pip install 'krl-workbench[arm]'"),
        ("", {"url": "file:///a/b.whl"}, "pip install 'krl-workbench[arm] @ file:///a/b.whl'"),
        ("", {"url": "file:///a", "dir_info": {"editable": True}}, "pip install -e '.[arm]'"),
        ("uv-receipt.toml", None, "uv tool install 'krl-workbench[arm,lsp]'"),
        ("pipx_metadata.json", None, "pipx install --force 'krl-workbench[arm,lsp]'"),
    ],
)
def test_a_missing_extra_is_installed_by_the_tool_that_installed_us(
    mark: str,
    origin: dict[str, object] | None,
    cure: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Tools that make an environment anew are told the extras that are there already, too."""
    (tmp_path / (mark or "pyvenv.cfg")).touch()
    monkeypatch.setattr("sys.prefix", str(tmp_path))
    monkeypatch.setattr("krl.extras.find_spec", lambda name: name == "pygls" or None)
    ours = Mock(read_text=Mock(return_value=origin and json.dumps(origin)))
    monkeypatch.setattr("importlib.metadata.distribution", lambda _: ours)
    with pytest.raises(InputError) as error:
        need("mujoco")
    assert f"this needs mujoco, which is not installed: {cure}" == str(error.value)
    with pytest.raises(InputError, match=r"needs scipy and PIL, which are .*\[arm,.*video\]"):
        need("pygls", "scipy", "PIL")


def test_start_is_quick() -> None:
    """Asking for help loads no other package and no parser."""
    program = (
        "import sys; from krl.cli import main; main(['--help']);"
        "print([room for room in ('antlr4', 'lark', 'pandas', 'jinja2', 'recovery.survey.survey')"
        " if room in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert "[]\n" == done.stderr


@pytest.mark.parametrize(
    ("words", "unwanted"),
    [
        (["--version"], ("krl.commands.run", "krl.commands.bench", "rich")),
        (["check", "one.src", "--jobs", "1"], ("interp", "numpy", "rich", "lark", "pydantic")),
        (
            ["run", "one.src", "--robot", "none"],
            ("numpy", "interp.robot.planning.planned_arm", "rich", "lark", "pydantic"),
        ),
    ],
)
def test_a_command_loads_what_it_does(
    words: list[str], unwanted: tuple[str, ...], tmp_path: Path
) -> None:
    """A program without a motion runs without the planner of motions, for instance."""
    (tmp_path / "one.src").write_text("DEF one()\nINT n\nn = 1\nn = n + 1\nEND\n")
    program = (
        f"import sys; from krl.cli import main; main({words!r});"
        f"print([one for one in {unwanted!r} if one in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert "[]" == done.stderr.splitlines()[-1]
