"""Case files are pytest items, each with its setup; verdicts become outcomes."""

from pathlib import Path

import pytest

pytest_plugins = ["pytester"]

HEAD = ";@ rule: {rule}\n;@ title: about {name}\n;@ phase: {phase}\nDEF {name}()\n"
RUN = HEAD + "  $FLAG[1] = TRUE ;> runs {runs}\nEND\n"
CONFTEST = "from conformance.pytest_plugin import pytest_collect_file\n"


def test_verdicts_become_outcomes(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pass and fail are as always, unconfirmed is expected to fail, the rest is skipped."""
    monkeypatch.setenv("KRL_CONFORM_SETUPS", "tree/none vm/none")
    root = Path(pytester.path, "control")
    root.mkdir()
    (root / "conftest.py").write_text(CONFTEST, encoding="utf-8")
    for name, rule, runs in (
        ("good", "CTL-01", "1"),
        ("bad", "CTL-01", "2"),
        ("open", "CTL-02", "2"),
    ):
        text = RUN.format(rule=rule, name=name, phase="run", runs=runs)
        (root / f"{name}.src").write_text(text, encoding="utf-8")
    path = RUN.format(rule="CTL-01", name="path", phase="run", runs="1").replace("runs 1", "smooth")
    (root / "path.src").write_text(path, encoding="utf-8")
    (root / "helper.src").write_text("DEF helper()\nEND\n", encoding="utf-8")
    result = pytester.runpytest_inprocess("-q", "-p", "no:cacheprovider", str(root))
    result.assert_outcomes(passed=2, failed=2, xfailed=2, skipped=2)
    result.stdout.fnmatch_lines(
        ["*bad?tree-none?: about bad*", "*expected: runs 2*", "*seen: *1 times*"]
    )
    assert "Traceback" not in result.stdout.str()
