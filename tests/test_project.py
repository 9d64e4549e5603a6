"""The layout is as designed, and the documents name what there is."""

import ast
import importlib
import json
import re
import shutil
import subprocess
import tomllib
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import pytest
import typer
from packaging.requirements import Requirement

from krl.commands.app import app

ROOT = Path(__file__).parents[1]
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES = ["krl", "grammar", "recovery", "interp", "conformance", "reports", "support"]

TOP_LEVEL = {
    *(".ci", ".editorconfig", ".gitattributes", ".github", ".gitignore"),
    *(".pre-commit-hooks.yaml", "action.yml", "editors", "examples"),
    *(
        "CHANGELOG.md",
        "CITATION.cff",
        "CMakeLists.txt",
        "CONTRIBUTING.md",
        "LICENSE",
        "Makefile",
        "README.md",
        "mkdocs.yml",
    ),
    *("pyproject.toml", "requirements-dev.txt", "corpus", "docs", "tests"),
    *PACKAGES,
}
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
MAKE_TARGETS = set("setup recover conformance nightly fuzz test check grammar bench".split())

needs_git = pytest.mark.skipif(
    shutil.which("git") is None or not (ROOT / ".git").exists(), reason="not a git checkout"
)


def _documents() -> list[Path]:
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]


def _git(*arguments: str) -> str:
    done = subprocess.run(
        ["git", *arguments], cwd=ROOT, capture_output=True, text=True, encoding="utf-8", check=True
    )
    return done.stdout


def _make_targets() -> set[str]:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    rules = re.findall(r"^([a-z][a-z -]*):(?!=)", makefile, re.MULTILINE)
    return {target for rule in rules for target in rule.split()}


@needs_git
def test_top_level_is_as_designed() -> None:
    """Nothing lies at the top level but what the layout has a place for."""
    files = _git("ls-files", "--cached", "--others", "--exclude-standard").splitlines()
    found = {name.strip('"').partition("/")[0] for name in files}
    assert set() == found - TOP_LEVEL
    assert set() == TOP_LEVEL - found


def test_hooks_run_for_names_in_capitals() -> None:
    """Controllers write CELL.SRC, and a commit of it alone is checked."""
    hooks = (ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8")
    patterns = re.findall(r"^  files: (.+)$", hooks, re.MULTILINE)
    assert patterns
    for pattern in patterns:
        found = [bool(re.search(pattern, name)) for name in ("a.src", "R1/CELL.SRC", "a.txt")]
        assert [True, True, False] == found


@pytest.mark.parametrize("name", PACKAGES)
def test_package_says_what_it_is(name: str) -> None:
    """Every package says what it is, and re-exports nothing; only `krl` is a library for others."""
    package = importlib.import_module(name)
    tree = ast.parse(Path(str(package.__file__)).read_text(encoding="utf-8"))
    assert ast.get_docstring(tree)
    assert name == "krl" or 1 == len(tree.body)


def test_packages_are_named_alike_everywhere() -> None:
    """What is packed, what is typed and what has layers are the same packages."""
    tools = PROJECT["tool"]
    packed = tools["scikit-build"]["wheel"]["packages"]
    assert sorted(PACKAGES) == sorted(name for name in packed if "/" not in name)
    assert PACKAGES == tools["importlinter"]["root_packages"]
    assert [*PACKAGES, "tests"] == tools["mypy"]["files"]


def test_no_module_has_a_name_that_says_nothing() -> None:
    """There are no utils, helpers or managers."""
    modules = {path.stem for package in PACKAGES for path in (ROOT / package).rglob("*.py")}
    assert set() == modules & {"util", "utils", "helper", "helpers", "manager", "managers"}


def test_tests_are_folders_without_init() -> None:
    """Test folders are not packages; each is named after what it tests, but for the long runs."""
    folders = {path.name for path in (ROOT / "tests").iterdir() if path.is_dir()}
    assert set() == folders - {*PACKAGES, "soak", "__pycache__"}
    assert [] == list((ROOT / "tests").rglob("__init__.py"))


def test_version_stands_in_one_place() -> None:
    """The version of pyproject.toml is the installed one, and no module repeats it."""
    version = PROJECT["project"]["version"]
    assert version == metadata.version("krl-workbench")
    modules = (path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
    repeated = [path for path in modules if f'"{version}"' in path.read_text(encoding="utf-8")]
    assert [] == repeated


@pytest.mark.skipif(shutil.which("make") is None, reason="no make here")
def test_a_release_has_one_version(tmp_path: Path) -> None:
    """`make release` sets it in package, citation and extension, and begins a chapter."""
    named = ["pyproject.toml", "CITATION.cff", "CHANGELOG.md", "Makefile"]
    named += ["editors/vscode/package.json", "editors/vscode/package-lock.json"]
    for name in named:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    before, _ = _versions(tmp_path)
    assert {PROJECT["project"]["version"]} == before
    make = ["make", "-C", str(tmp_path), "release"]
    assert 0 != subprocess.run([*make, "VERSION=7.8"], check=False, capture_output=True).returncode
    subprocess.run([*make, "VERSION=7.8.9"], check=True, capture_output=True)
    after, changelog = _versions(tmp_path)
    assert {"7.8.9"} == after
    assert re.search(r"^## \[Unreleased\]\n\n## \[7\.8\.9\] - \d{4}-\d\d-\d\d\n", changelog, re.M)
    assert set(named) == {
        path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()
    }


def _versions(root: Path) -> tuple[set[str], str]:
    """All versions that the files of a release have, and the text of the changelog."""
    citation = re.search(r"^version: (.*)$", (root / "CITATION.cff").read_text("utf-8"), re.M)
    extension, lock = (
        json.loads((root / "editors/vscode" / name).read_text(encoding="utf-8"))
        for name in ("package.json", "package-lock.json")
    )
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert citation is not None
    versions = {citation[1], extension["version"], lock["version"], project["version"]}
    changelog = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    return versions | {lock["packages"][""]["version"]}, changelog


def test_python_version_is_the_same_everywhere() -> None:
    """Package, ruff, mypy, Makefile and README ask for the same Python."""
    assert ">=3.11" == PROJECT["project"]["requires-python"]
    assert "py311" == PROJECT["tool"]["ruff"]["target-version"]
    assert "3.11" == PROJECT["tool"]["mypy"]["python_version"]
    assert "sys.version_info < (3, 11)" in (ROOT / "Makefile").read_text(encoding="utf-8")
    assert "Python 3.11 or later" in (ROOT / "README.md").read_text(encoding="utf-8")


def test_make_has_the_agreed_targets() -> None:
    """The Makefile has every agreed target, and `make help` names them all."""
    targets = _make_targets()
    assert set() == MAKE_TARGETS - targets
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert set() == {target for target in targets - {"help"} if f"make {target}" not in makefile}


@pytest.mark.parametrize("document", _documents(), ids=lambda path: str(path.name))
def test_documents_name_what_there_is(document: Path) -> None:
    """Targets, commands, modules, names in modules and linked files that a document names exist."""
    text = document.read_text(encoding="utf-8")
    code = "\n".join(
        re.findall(r"```.*?\n(.*?)```", text, re.DOTALL) + re.findall(r"`(.+?)`", text)
    )
    assert set() == set(re.findall(r"^make ([a-z]+)", code, re.MULTILINE)) - _make_targets()
    commands = set(typer.main.get_command(app()).commands)  # type: ignore[attr-defined]
    assert set() == set(re.findall(r"^(?:\S+\\)?krl ([a-z]+)", code, re.MULTILINE)) - commands
    named = re.findall(r"`([a-z0-9_/]+\.py)`", text)
    modules = [
        path.as_posix() for top in (*PACKAGES, "tests") for path in (ROOT / top).rglob("*.py")
    ]
    assert set() == {one for one in named if not any(path.endswith(f"/{one}") for path in modules)}
    for name, file in re.findall(r"`(\w+)` in `([a-z0-9_/]+\.py)`", text):
        found = [ROOT / path for path in modules if path.endswith(f"/{file}")]
        assert any(re.search(rf"\b{name}\b", path.read_text(encoding="utf-8")) for path in found)
    for name in re.findall(rf"`((?:{'|'.join(PACKAGES)})(?:\.\w+){{2,}})`", text):
        resolve_name(name)
    places = re.findall(
        rf"`((?:{'|'.join([*PACKAGES, 'corpus', 'docs', 'tests'])})/[\w./-]+)`", text
    )
    written = re.compile(
        r"reports/(out|history)|corpus/open|.*[A-Z]{4}"
    )  # by commands; stands for any
    assert set() == {one for one in places if not ((ROOT / one).exists() or written.match(one))}
    links = set(re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text))
    assert set() == {link for link in links if not (document.parent / link).exists()}


@needs_git
@pytest.mark.parametrize("name", ["main.src", "MAIN.SRC", "$config.dat", "sps.sub", "cell.zip"])
def test_git_leaves_krl_alone(name: str) -> None:
    """Git changes no line end of KRL files and archives, on any system."""
    (line,) = _git("check-attr", "text", "--", f"corpus/programs/cell/{name}").splitlines()
    assert line.endswith(": text: unset")


@needs_git
def test_every_system_can_check_the_project_out() -> None:
    """No two names differ in letter case alone, and Windows has each name."""
    paths = _git("ls-files", "-z").rstrip("\0").split("\0")
    assert len(paths) == len({path.casefold() for path in paths})
    parts = {part for path in paths for part in path.split("/")}
    reserved = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?|.*[ .]|.*[<>:\"|?*\\].*", re.I)
    assert set() == {part for part in parts if reserved.fullmatch(part)}
    assert max(map(len, paths)) < 150  # below a folder of the longest path that Windows opens


@needs_git
@pytest.mark.parametrize("name", ["corpus/open/a__b/main.src", "reports/out/recover/index.html"])
def test_git_ignores_what_is_not_ours(name: str) -> None:
    """Fetched files and written pages cannot be committed by accident."""
    assert name == _git("check-ignore", "--", name).strip()


def _asked_for(extra: str) -> Iterator[Requirement]:
    """What the project needs with an extra, extras of its own followed."""
    project = PROJECT["project"]
    for line in [*project["dependencies"], *project["optional-dependencies"][extra]]:
        asked = Requirement(line)
        if asked.name == project["name"]:
            for one in asked.extras:
                yield from _asked_for(one)
        else:
            yield asked


def test_locked_versions_are_those_asked_for() -> None:
    """`make lock` was run since pyproject.toml asked for something else; all of it has hashes."""
    locked = (ROOT / "requirements-dev.txt").read_text(encoding="utf-8")
    pins = re.findall(r"^([a-z0-9-]+)==(\S+)(.*(?:\n .*)*)", locked, re.MULTILINE)
    assert [] == [name for name, _, hashes in pins if "--hash=sha256:" not in hashes]
    assert len(re.findall(r"^[a-z0-9]", locked, re.MULTILINE)) == len(pins)
    versions = {name: version for name, version, _ in pins}
    unmet = [
        str(asked)
        for asked in _asked_for("dev")
        if not asked.specifier.contains(versions.get(asked.name, "0"))
    ]
    assert [] == unmet


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.stem)
def test_actions_are_pinned_and_may_do_little(workflow: Path) -> None:
    """Each action of others is named by digest, and no workflow may write as a whole."""
    text = workflow.read_text(encoding="utf-8")
    used = re.findall(r"uses: (\S+)", text)
    assert [] == [name for name in used if not re.fullmatch(r"[^@]+@[0-9a-f]{40}", name)]
    (permissions,) = re.findall(r"^permissions: (.*)$", text, re.MULTILINE)
    assert permissions in ("{}", "{ contents: read }")


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.stem)
def test_workflows_run_what_there_is(workflow: Path) -> None:
    """What a workflow names exists: targets, commands of `krl`, scripts of npm, extras, folders."""
    text = workflow.read_text(encoding="utf-8")
    commands = set(typer.main.get_command(app()).commands)  # type: ignore[attr-defined]
    assert set() == set(re.findall(r"\bmake ([a-z-]+)", text)) - _make_targets()
    assert set() == set(re.findall(r"(?:run: |&& )krl ([a-z]+)", text)) - commands
    for job in re.split(r"^  (?=\S+:$)", text, flags=re.MULTILINE):
        folders = [ROOT / name for name in re.findall(r"working-directory: ([^\s}]+)", job)]
        folders += [ROOT / name for name in re.findall(r"^ +cd (\S+)$", job, re.MULTILINE)]
        assert [] == [folder for folder in folders if not folder.is_dir()]
        scripts = set(re.findall(r"npm run ([a-z]+)", job))
        scripts |= {"test"} if "npm test" in job else set()
        for package in [folder / "package.json" for folder in folders] if scripts else ():
            known = json.loads(package.read_text(encoding="utf-8"))["scripts"]
            assert set() == scripts - set(known)
    extras = {name for found in re.findall(r"'\.\[(.*?)\]'", text) for name in found.split(",")}
    assert set() == extras - set(PROJECT["project"]["optional-dependencies"])


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash here")
def test_ci_script_is_well_formed() -> None:
    """The script of continuous integration parses and stops at the first error."""
    script = ROOT / ".ci" / "run"
    subprocess.run(["bash", "-n", script.as_posix()], check=True)
    assert "\nset -euo pipefail\n" in script.read_text(encoding="utf-8")
