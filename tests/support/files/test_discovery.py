"""Files are found below folders, each once, with the origin they came from."""

import os
import pickle
import sys
import tempfile
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.files import archives, discovery
from support.files.discovery import FoundFile, IngestError, Skipped, discover, read

PROGRAM = b"DEF A()\nEND\n"

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such files")


def lay(root: Path, *names: str) -> Path:
    """Make `root` hold the files `names`; a name that ends in `/` is a folder."""
    for name in names:
        file = root / name
        if name.endswith("/"):
            file.mkdir(parents=True, exist_ok=True)
            continue
        file.parent.mkdir(parents=True, exist_ok=True)
        if name.lower().endswith(".zip"):
            with zipfile.ZipFile(file, "w") as archive:
                archive.writestr("KRC/R1/z.src", PROGRAM)
        else:
            file.write_bytes(PROGRAM)
    return root


def shown(*roots: Path) -> list[str]:
    """Return the paths found below `roots`; none may be skipped."""
    found = list(discover(roots))
    assert all(isinstance(item, FoundFile) for item in found), found
    return [item.path for item in found]


def below(root: Path, *roots: Path) -> list[str]:
    return [path.removeprefix(f"{root.as_posix()}/") for path in shown(*roots or (root,))]


def origins(*roots: Path) -> dict[str, str]:
    """Map each file name to its origin."""
    return {item.path.rpartition("/")[2]: item.origin for item in discover(roots)}


def skipped(*roots: Path) -> dict[str, str]:
    """Map the name of what was skipped to its reason."""
    items = list(discover(roots))
    return {i.path.rpartition("/")[2]: i.reason for i in items if isinstance(i, Skipped)}


def error_of(*roots: Path) -> str:
    with pytest.raises(IngestError) as caught:
        list(discover(roots))
    assert str(caught.value).isprintable()
    return str(caught.value)


# -- the walk --------------------------------------------------------------------------------------


def test_candidates_are_known_by_their_suffix(tmp_path: Path) -> None:
    """`.src`, `.dat` and `.sub` count in any case of letters, and nothing else."""
    lay(tmp_path, "a.src", "b.DAT", "c.Sub", "d.txt", "e.src.bak", "src", "f.srcx")
    assert ["a.src", "b.DAT", "c.Sub"] == below(tmp_path)


def test_what_is_found_is_complete(tmp_path: Path) -> None:
    """A file has path, origin, size in bytes and its file, absolute whatever the root was."""
    lay(tmp_path, "cell/a.src")
    file = tmp_path / "cell" / "a.src"
    expected = FoundFile(file.as_posix(), "cell", len(PROGRAM), file.resolve(), None)
    assert [expected] == list(discover([tmp_path]))
    assert expected == pickle.loads(pickle.dumps(expected))
    assert PROGRAM == read(expected)


def test_paths_stay_relative(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Paths are shown as the root was given; `.` does not show."""
    lay(tmp_path, "cells/one/a.src")
    monkeypatch.chdir(tmp_path)
    assert shown(Path("cells")) == ["cells/one/a.src"]
    assert shown(Path()) == ["cells/one/a.src"]
    assert shown(Path("./cells/one/a.src")) == ["cells/one/a.src"]
    monkeypatch.chdir(tmp_path / "cells" / "one")
    assert shown(Path("../..")) == ["../../cells/one/a.src"]


def test_the_order_is_that_of_names(tmp_path: Path) -> None:
    """Files and folders are sorted together, without regard to case first, then exactly."""
    lay(tmp_path, "B/b.src", "a/a.src", "a.src", "C.src", "b.src", "a/B.src", "c/x.dat")
    expected = ["a/a.src", "a/B.src", "a.src", "B/b.src", "b.src", "c/x.dat", "C.src"]
    assert expected == below(tmp_path)


def test_hidden_folders_are_ignored(tmp_path: Path) -> None:
    """`.git`, other hidden folders and installed packages are not looked into, unless named."""
    lay(tmp_path, ".git/a.src", ".venv/x/a.src", "node_modules/a.src", "__MACOSX/a.src", "b.src")
    assert ["b.src"] == below(tmp_path)
    assert ["a.src"] == below(tmp_path / ".venv" / "x")


def test_archives_below_a_folder_are_opened(tmp_path: Path) -> None:
    """A `.zip` is looked into in its place in the order."""
    lay(tmp_path, "a.src", "b.ZIP/", "c.zip", "d.src")
    lay(tmp_path, "b.ZIP/x.src")
    assert ["a.src", "b.ZIP/x.src", "c.zip/KRC/R1/z.src", "d.src"] == below(tmp_path)


def test_deep_folders(tmp_path: Path) -> None:
    """Folders may be nested deeper than Python calls may."""
    depth = 400 if sys.platform == "linux" else 20
    lay(tmp_path, "x/" * depth + "a.src")
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(250)
    try:
        assert len(shown(tmp_path)) == 1
    finally:
        sys.setrecursionlimit(limit)


def test_memory_stays_flat(tmp_path: Path) -> None:
    """What was found is not kept: 36 times the files, twice as deep, take twice the memory."""

    def peak(root: Path) -> int:
        tracemalloc.start()
        for _ in discover([root]):
            pass
        size = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return size

    six = [f"{name}/" for name in "abcdef"]
    few = [a + b for a in six for b in six]
    lay(tmp_path / "few", *(f"{name[:-1]}.src" for name in few))
    lay(tmp_path / "many", *(f"{a}{b[:-1]}.src" for a in few for b in few))
    peak(tmp_path / "few")  # what is made once and kept is no matter of size
    assert peak(tmp_path / "many") < 3 * peak(tmp_path / "few")


# -- roots -----------------------------------------------------------------------------------------


def test_a_file_below_two_roots_is_found_once(tmp_path: Path) -> None:
    """A file reached through several roots belongs to the nearest one."""
    lay(tmp_path, "all/one/a.src", "all/one/b.src", "all/two/c.src", "all/d.zip")
    top = tmp_path / "all"
    roots = [
        top,
        top / "one",
        top / "one" / "a.src",
        top,
        top / "d.zip",
        top / "two" / ".." / "two",
    ]
    assert sorted(shown(top)) == sorted(path.replace("two/../", "") for path in shown(*roots))


def test_a_hidden_folder_below_a_root_can_be_named_too(tmp_path: Path) -> None:
    """Naming a folder that the walk would ignore adds it."""
    lay(tmp_path, "a.src", ".old/b.src")
    assert ["a.src", ".old/b.src"] == below(tmp_path, tmp_path, tmp_path / ".old")


TREE = ["a/b/x.src", "a/b/y.dat", "a/c.zip", "a/z.SUB", "d/e/f/g.src", "d/.git/h.src", "i.txt"]
PLACES = ["", "a", "a/b", "a/b/x.src", "a/c.zip", "d", "d/e", "d/e/f/g.src", "a/../d"]


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return lay(tmp_path_factory.mktemp("tree"), *TREE)


@given(order=st.lists(st.sampled_from(PLACES), min_size=1).flatmap(
    lambda places: st.tuples(st.just(places), st.permutations(places))
))  # fmt: skip
def test_the_order_of_roots_does_not_matter(tree: Path, order: tuple[list[str], list[str]]) -> None:
    """The same places named in any order give the same, and each file once."""
    first, second = (list(discover([tree / place for place in places])) for places in order)
    assert first == second
    files = [(item.file, item.member) for item in first if isinstance(item, FoundFile)]
    assert len(set(files)) == len(files) == len(first)


NAMES = st.text("ab.üX$ -", min_size=1, max_size=6).filter(lambda name: name.strip(" .") == name)


@given(st.sets(st.tuples(NAMES, NAMES, st.sampled_from([".src", ".DAT", ".sub", ".txt"]))))
def test_every_candidate_is_found_exactly_once(names: set[tuple[str, str, str]]) -> None:
    """Whatever the names, each candidate is found once and no other file is."""
    wanted = {f"{folder}/{stem}{suffix}".casefold() for folder, stem, suffix in names}
    with tempfile.TemporaryDirectory() as made:
        root = lay(Path(made) / "root", "keep.src", *(f"{a}/{b}{c}" for a, b, c in sorted(names)))
        found = [path.casefold() for path in below(root)]
    expected = {"keep.src"} | {name for name in wanted if not name.endswith(".txt")}
    assert expected == set(found)
    assert len(set(found)) == len(found)


# -- origins ---------------------------------------------------------------------------------------


def test_folders_below_a_root_are_origins(tmp_path: Path) -> None:
    """The first folder below a root is the origin."""
    lay(tmp_path / "cells", "one/KRC/a.src", "two/deep/er/b.src")
    assert {"a.src": "one", "b.src": "two"} == origins(tmp_path / "cells")


def test_folders_beside_programs_belong_to_them(tmp_path: Path) -> None:
    """Where files lie in the root itself only a backup below it is an origin of its own."""
    lay(tmp_path / "cells", "one/KRC/a.src", "two/deep/er/b.src", "c.src")
    expected = {"a.src": "one", "b.src": "cells", "c.src": "cells"}
    assert expected == origins(tmp_path / "cells")


@pytest.mark.parametrize("sign", [".git/", "KRC/", "krc/", "R1/", "STEU/", "C/KRC/", ".git"])
def test_a_backup_or_repository_is_one_origin(tmp_path: Path, sign: str) -> None:
    """A root that is a repository or a controller backup is an origin as a whole."""
    lay(tmp_path / "cell7", sign, "R1x/a.src", "b/c/d.src")
    assert {"a.src": "cell7", "d.src": "cell7"} == origins(tmp_path / "cell7")


def test_the_origin_of_a_lone_file_is_its_folder(tmp_path: Path) -> None:
    """A root that is a file comes from the folder around it."""
    lay(tmp_path, "cell7/a.src")
    assert {"a.src": "cell7"} == origins(tmp_path / "cell7" / "a.src")


def test_the_current_folder_has_a_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Files in `.` come from the folder that `.` is."""
    monkeypatch.chdir(lay(tmp_path / "cell7", "a.src"))
    assert {"a.src": "cell7"} == origins(Path())


def test_repositories_are_named_by_owner(tmp_path: Path) -> None:
    """A folder OWNER__NAME stands for the repository OWNER/NAME."""
    lay(tmp_path, "o-1__my__robot/a.src", "__x/b.src", "y__/c.src")
    expected = {"a.src": "o-1/my__robot", "b.src": "__x", "c.src": "y__"}
    assert expected == origins(tmp_path)
    assert {"a.src": "o-1/my__robot"} == origins(tmp_path / "o-1__my__robot")


def test_a_corpus_names_its_origins_one_level_deeper(tmp_path: Path) -> None:
    """Below a corpus, each folder in `programs` and `open` is an origin; nothing else is read."""
    corpus = lay(
        tmp_path / "corpus",
        "sources.toml",
        "programs/palletiser/KRC/a.src",
        "programs/b.src",
        "open/own__er/R1/c.src",
        "negatives/d.src",
        "other/e.src",
    )
    expected = {"a.src": "palletiser", "b.src": "programs", "c.src": "own/er"}
    assert expected == origins(corpus)


def test_a_corpus_is_known_below_a_repository(tmp_path: Path) -> None:
    """Surveying the whole checkout leaves the negatives of its corpus out as well."""
    lay(tmp_path / "work", ".git/", "x/a.src", "corpus/sources.toml", "corpus/negatives/n.src")
    lay(tmp_path / "work", "corpus/programs/glue/b.src")
    assert {"a.src": "work", "b.src": "glue"} == origins(tmp_path / "work")


def test_a_list_of_sources_alone_is_no_corpus(tmp_path: Path) -> None:
    """Without `programs` or `open` beside it, `sources.toml` means nothing to us."""
    lay(tmp_path, "sources.toml", "cell/a.src")
    assert {"a.src": "cell"} == origins(tmp_path)


def test_negatives_can_be_named(tmp_path: Path) -> None:
    """What a corpus leaves out is read when it is named itself."""
    corpus = lay(tmp_path / "corpus", "sources.toml", "programs/p/a.src", "negatives/d.src")
    expected = {"a.src": "p", "d.src": "negatives"}
    assert expected == origins(corpus, corpus / "negatives")


def test_archives_are_origins(tmp_path: Path) -> None:
    """An archive is an origin of its own, named after its file, wherever it lies."""
    lay(tmp_path, "cell/KR210.2019.ZIP", "cell/a.src")
    assert {"a.src": "cell", "z.src": "KR210.2019"} == origins(tmp_path)


def test_archives_of_one_name_are_distinguished(tmp_path: Path) -> None:
    """Archives that share a name are named with as many folders as tell them apart."""
    lay(tmp_path, "a/x/backup.zip", "b/x/backup.zip", "b/y/backup.zip", "b/y/other.zip")
    expected = ["a/x/backup", "b/x/backup", "y/backup", "other"]
    assert expected == [item.origin for item in discover([tmp_path])]
    assert ["backup"] == [item.origin for item in discover([tmp_path / "a"])]


# -- what is skipped -------------------------------------------------------------------------------


def link(at: Path, to: Path) -> None:
    try:
        at.symlink_to(to, target_is_directory=to.is_dir())
    except OSError:
        pytest.skip("links cannot be made here")


def test_links_are_not_followed(tmp_path: Path) -> None:
    """Links to files and folders are skipped with their reason, so no circle is endless."""
    root = lay(tmp_path / "root", "one/a.src")
    lay(tmp_path / "else", "b.src")
    link(root / "one" / "up", root)
    link(root / "linked.src", tmp_path / "else" / "b.src")
    link(root / "broken.dat", tmp_path / "nowhere")
    link(root / "broken.txt", tmp_path / "nowhere")
    reason = "symbolic link, not followed"
    assert {"up": reason, "linked.src": reason, "broken.dat": reason} == skipped(root)
    assert ["a.src"] == [i.path[-5:] for i in discover([root]) if isinstance(i, FoundFile)]


def test_a_root_may_be_a_link(tmp_path: Path) -> None:
    """A link that is named itself is followed; what it leads to is still found only once."""
    real = lay(tmp_path / "real", "one/a.src")
    link(tmp_path / "link", real)
    assert [f"{(tmp_path / 'link').as_posix()}/one/a.src"] == shown(tmp_path / "link")
    assert len(shown(tmp_path / "link", real)) == 1


def test_a_folder_with_the_name_of_a_file(tmp_path: Path) -> None:
    """A folder named like a program is reported, and what it holds is found."""
    lay(tmp_path, "x.src/y.src")
    assert {"x.src": "a folder, not a file"} == skipped(tmp_path)
    assert [f.path[-11:] for f in discover([tmp_path]) if isinstance(f, FoundFile)] == [
        "x.src/y.src"
    ]


@posix_only
def test_pipes_are_not_opened(tmp_path: Path) -> None:
    """A pipe is skipped without waiting for somebody to write to it, also when read later."""
    lay(tmp_path, "a.src")
    (found,) = discover([tmp_path])
    assert isinstance(found, FoundFile)
    os.mkfifo(tmp_path / "p.src")
    os.mkfifo(tmp_path / "p.zip")
    reason = "not a regular file"
    assert {"p.src": reason, "p.zip": reason} == skipped(tmp_path)
    (tmp_path / "a.src").unlink()
    os.mkfifo(tmp_path / "a.src")
    assert Skipped(found.path, f"cannot be read: {reason}", found.origin) == read(found)
    assert error_of(tmp_path / "p.src").endswith("p.src: neither a file nor a folder")


@posix_only
@pytest.mark.skipif(hasattr(os, "geteuid") and os.geteuid() == 0, reason="root may read all")
def test_what_may_not_be_read_is_skipped(tmp_path: Path) -> None:
    """Files and folders without permission are skipped with the system's reason."""
    lay(tmp_path, "a.src", "closed/b.src")
    (tmp_path / "a.src").chmod(0)
    (tmp_path / "closed").chmod(0)
    try:
        found, closed = discover([tmp_path])
        assert isinstance(found, FoundFile)
        assert isinstance(closed, Skipped)
        assert isinstance(read(found), Skipped)
        assert closed.reason == "folder cannot be read: Permission denied"
        assert error_of(tmp_path / "closed").endswith("cannot be read: Permission denied")
    finally:
        (tmp_path / "closed").chmod(0o700)


def test_an_unreadable_folder_is_skipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder that cannot be listed is one skipped entry, and the walk goes on."""
    lay(tmp_path, "a/b.src", "c.src")
    refuse(monkeypatch, tmp_path / "a")
    (closed, found) = discover([tmp_path])
    assert isinstance(found, FoundFile)
    reason = "folder cannot be read: Permission denied"
    assert Skipped(f"{tmp_path.as_posix()}/a", reason, tmp_path.name) == closed


def test_an_unreadable_root_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A root that cannot be listed ends in one clear line, before anything is returned."""
    refuse(monkeypatch, tmp_path)
    with pytest.raises(IngestError, match=r"cannot be read: Permission denied\Z"):
        discover([tmp_path])


def refuse(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let the system refuse to list `folder`, also for a user who may list everything."""
    real: Callable[[Path], object] = os.scandir

    def scandir(path: Path) -> object:
        if Path(path) == folder.resolve():
            raise PermissionError(13, "Permission denied", str(path))
        return real(path)

    monkeypatch.setattr(os, "scandir", scandir)


def test_a_vanished_file_is_skipped(tmp_path: Path) -> None:
    """A file that is gone when it is to be read is skipped, and nothing is raised."""
    (found,) = discover([lay(tmp_path / "cell", "a.src")])
    assert isinstance(found, FoundFile)
    found.file.unlink()
    outcome = read(found)
    assert isinstance(outcome, Skipped)
    assert (outcome.path, outcome.origin) == (found.path, "cell")
    assert outcome.reason.startswith("cannot be read: ")


def test_a_huge_file_is_skipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file beyond the limit is skipped unread; one that grows beyond it later, too."""
    lay(tmp_path, "a.src", "b.src")
    monkeypatch.setattr(archives, "MAX_FILE_BYTES", archives.MB)
    (tmp_path / "b.src").write_bytes(bytes(archives.MB + 1))
    assert {"b.src": "larger than 1 MB"} == skipped(tmp_path)
    found = next(discover([tmp_path]))
    assert isinstance(found, FoundFile)
    (tmp_path / "a.src").write_bytes(bytes(archives.MB + 1))
    assert Skipped(found.path, "larger than 1 MB", found.origin) == read(found)
    (tmp_path / "a.src").write_bytes(bytes(archives.MB))
    assert bytes(archives.MB) == read(found)


@posix_only
def test_names_are_shown_without_their_power(tmp_path: Path) -> None:
    """Control characters, and bytes that are no UTF-8, are escaped in paths and origins."""
    folder = tmp_path / "a\x1b[2J\n"
    folder.mkdir()
    odd = os.fsencode(folder) + b"/\xfc.src"
    try:
        with open(odd, "wb") as stream:  # noqa: PTH123 - a name no Path can be written for
            stream.write(PROGRAM)
    except OSError:
        pytest.skip("the file system wants UTF-8")
    (found,) = discover([tmp_path])
    assert isinstance(found, FoundFile)
    assert found.path.endswith("/a\\x1b[2J\\x0a/\\xfc.src")
    assert found.origin == "a\\x1b[2J\\x0a"
    assert PROGRAM == read(pickle.loads(pickle.dumps(found)))


# -- errors ----------------------------------------------------------------------------------------


def test_a_missing_path_is_an_error_at_once(tmp_path: Path) -> None:
    """A path that does not exist ends in one clear line, before anything is returned."""
    lay(tmp_path, "a.src")
    missing = tmp_path / "missing"
    with pytest.raises(IngestError) as caught:
        discover([tmp_path, missing])
    assert f"{missing.as_posix()}: no such file or folder" == str(caught.value)


@pytest.mark.parametrize("name", ["a.src/b.src", "x" * 5000, "a\0b", "line\nfeed"])
def test_impossible_paths_are_errors(tmp_path: Path, name: str) -> None:
    """Paths that no system has end in one clear line."""
    lay(tmp_path, "a.src")
    assert error_of(tmp_path / name)


def test_nothing_named_is_an_error() -> None:
    """At least one root is needed."""
    assert error_of() == "no file or folder was named"


def test_a_folder_without_krl_is_an_error(tmp_path: Path) -> None:
    """A folder without candidates ends in one clear line."""
    lay(tmp_path / "one", "a.txt")
    lay(tmp_path / "two", "x/")
    one, two = tmp_path / "one", tmp_path / "two"
    assert f"{one.as_posix()}: no .src, .dat or .sub file in it" == error_of(one)
    assert error_of(one, two) == "2 places: no .src, .dat or .sub file in any"


def test_a_file_that_is_no_candidate(tmp_path: Path) -> None:
    """A lone file of another kind is an error; among other roots it is skipped."""
    lay(tmp_path, "a.txt", "b.src")
    reason = "not a .src, .dat, .sub or .zip file"
    file = tmp_path / "a.txt"
    assert f"{file.as_posix()}: {reason}" == error_of(file)
    assert {"a.txt": reason} == skipped(file, tmp_path / "b.src")


def test_a_folder_that_goes_away_hides_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Folders of others may be removed while the files around a program are listed."""
    (tmp_path / "gone").mkdir()
    (tmp_path / "a.src").touch()

    def gone(entry: os.DirEntry[str]) -> bool:
        raise FileNotFoundError(entry.path)

    monkeypatch.setattr(discovery, "_is_link", gone)
    assert [tmp_path / "a.src"] == [one.file for one in discovery.files_around(tmp_path, 2)]
