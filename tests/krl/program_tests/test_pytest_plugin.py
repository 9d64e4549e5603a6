"""The plug-in gives tests of robot programs to pytest, and `krl test` runs it."""

import json
import re
import shutil
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from krl.cli import main

pytest_plugins = ["pytester"]

CELL = Path(__file__).parents[3] / "examples" / "cell-tests"
OPTIONS = ("-q", "-p", "krl.program_tests.pytest_plugin", "-p", "no:cacheprovider")


@pytest.fixture
def no_other_plugins(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the package is installed pytest would load the plug-in a second time."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")


@pytest.mark.usefixtures("no_other_plugins")
def test_the_cell_of_the_tutorial_passes_as_documented(pytester: pytest.Pytester) -> None:
    """All its tests pass; page and lcov show what ran, and what the tests leave out."""
    shutil.copytree(CELL, pytester.path / "cell")
    options = (*OPTIONS, "--junitxml=j.xml", "--krl-cov-html=cov", "--krl-lcov=cov.info")
    result = pytester.runpytest_subprocess(*options, "cell/tests")
    result.assert_outcomes(passed=6)
    cases = ElementTree.parse(pytester.path / "j.xml").findall(".//testcase")
    assert "two parts lie on the tray" in [case.get("name") for case in cases]
    assert {"cell.tests.test_pick_place.toml", "cell.tests.test_gripper.src"} == {
        case.get("classname") for case in cases
    }
    lcov = (pytester.path / "cov.info").read_text(encoding="utf-8")
    assert "SF:cell/KRC/R1/Program/pick_place.src" in lcov
    assert "DA:23,0" in lcov  # HALT behind a gripper that does not open
    assert "DA:51," not in lcov  # ENDFCT of a function
    assert "test_gripper.src" not in lcov
    page = (pytester.path / "cov" / "index.html").read_text(encoding="utf-8")
    assert "never executed" in page


@pytest.mark.usefixtures("no_other_plugins")
def test_without_the_packages_of_the_arm_one_line_names_the_extra(
    pytester: pytest.Pytester,
) -> None:
    """The plug-in comes with every installation, and not all have the arm."""
    Path("test_work.toml").write_text("[[test]]\nname = 'x'\n", encoding="utf-8")
    pytester.makeconftest("import krl.extras\nkrl.extras.find_spec = lambda name: None\n")
    result = pytester.runpytest_subprocess(*OPTIONS)
    result.assert_outcomes(errors=1)
    result.stdout.re_match_lines([r"this needs scipy, which is not installed: .*\[arm\]"])
    assert "ModuleNotFoundError" not in result.stdout.str()


@pytest.mark.usefixtures("no_other_plugins")
def test_failures_and_errors_have_no_traceback(pytester: pytest.Pytester) -> None:
    """A failure says what was expected and seen, a file that cannot be used its one line."""
    Path("work.src").write_text("DEF work()\n$OUT[1]=TRUE\nEND\n", encoding="utf-8")
    text = "[[test]]\nname = 'x'\nexpect = ['out 1 never']\n"
    Path("test_work.toml").write_text(text, encoding="utf-8")
    Path("test_bad.toml").write_text("[[test]]\nnaem = 'x'\n", encoding="utf-8")
    result = pytester.runpytest_subprocess(*OPTIONS, "--continue-on-collection-errors")
    result.assert_outcomes(failed=1, errors=1)
    result.stdout.fnmatch_lines(
        ["*test_bad.toml:2: naem is not a key*", "*expected: out 1 never", "*seen: *work.src:2*"]
    )
    assert "Traceback" not in result.stdout.str()


@pytest.mark.skipif(sys.platform == "win32", reason="no such names of files")
@pytest.mark.usefixtures("no_other_plugins")
def test_names_of_files_and_tests_steer_nothing(pytester: pytest.Pytester) -> None:
    """Not the terminal, JUnit, lcov or the page: what would is spelt out."""
    strange = "x\x1b[31m\n::error::\u202e<script>alert(1)\udcff"
    folder = Path(strange.replace("/", ""))
    folder.mkdir()
    (folder / "work.src").write_text("DEF work()\n$OUT[1]=TRUE\nEND\n", encoding="utf-8")
    text = f"program = 'work.src'\n[[test]]\nname = {json.dumps(strange[:-1])}\n"
    (folder / f"test_{folder}.toml").write_text(f"{text}expect = ['out 1 never']", encoding="utf-8")
    options = (*OPTIONS, "--junitxml=j.xml", "--krl-cov-html=cov", "--krl-lcov=cov.info")
    result = pytester.runpytest_subprocess(*options)
    result.assert_outcomes(failed=1)
    (case,) = ElementTree.parse(pytester.path / "j.xml").findall(".//testcase")
    told = [
        *(result.stdout.str(), result.stderr.str(), *case.attrib.values()),
        *(Path(name).read_text(encoding="utf-8") for name in ("cov.info", "cov/index.html")),
    ]
    assert [] == [text for text in told if re.search(r"[\x00-\x08\x0b-\x1f\u202e]", text)]
    assert [] == [line for line in "\n".join(told).splitlines() if line.startswith("::error")]
    assert "<script>alert" not in told[-1]


def test_krl_test_has_the_exit_status_of_all_commands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """0 where all pass, 1 where one fails, 2 without tests or for a path that is not there."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTEST_ADDOPTS", "-p no:cacheprovider")
    Path("work.src").write_text("DEF work()\n$OUT[1]=TRUE\nEND\n", encoding="utf-8")
    assert 2 == main(["test"])
    assert 2 == main(["test", "gone"])
    assert 2 == main(["test", "work.src"])
    text = "[[test]]\nname = '{}'\nexpect = ['out 1 {}']\n"
    Path("test_work.toml").write_text(
        text.format("good", "TRUE") + text.format("bad", "never"), encoding="utf-8"
    )
    Path("test_python.py").write_text("assert False\n", encoding="utf-8")
    assert 1 == main(["test", "--junit", "j.xml"])
    names = [one.get("name") for one in ElementTree.parse("j.xml").iterfind(".//testcase")]
    assert ["bad", "good"] == names  # whichever of them ends first
    assert 0 == main(["test", ".", "-k", "good", "--junit", "j.xml", "--", "-q"])
    assert 'testsuite name="krl"' in Path("j.xml").read_text(encoding="utf-8")
    out, err = capfd.readouterr()
    assert "gone: no such file or folder" in err
    assert "work.src: no test of a robot program" in err
    assert "\ntest_work.toml:6: bad\n" in out  # as seen from here
