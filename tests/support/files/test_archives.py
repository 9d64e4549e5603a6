"""Archives are read without trusting names, sizes or content, and without writing a file."""

import io
import os
import random
import stat
import struct
import warnings
import zipfile
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_all_start_methods, get_context
from pathlib import Path

import pytest

from support.files import archives
from support.files.archives import close_archives
from support.files.discovery import FoundFile, IngestError, Skipped, discover, read

A = b"DEF A()\nEND\n"
B = b"DEF B()\nEND\n"


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    """Leave no archive open behind a test: Windows could not remove it."""
    yield
    close_archives()


def packed(*members: tuple[str | zipfile.ZipInfo, bytes]) -> bytes:
    """Pack `members`, in their order and with their names as they are."""
    stream = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        warnings.simplefilter("ignore")  # double names are what some tests are about
        for name, data in members:
            archive.writestr(name, data)
    return stream.getvalue()


def info(name: str, **attributes: int) -> zipfile.ZipInfo:
    """Describe a member; the name is set late, so that nothing corrects it."""
    made = zipfile.ZipInfo("x")
    made.filename = name
    made.compress_type = zipfile.ZIP_DEFLATED
    for attribute, value in attributes.items():
        setattr(made, attribute, value)
    return made


def survey(root: Path) -> dict[str, bytes | str]:
    """Map each path below `root` to what it holds or to why it was skipped."""
    result: dict[str, bytes | str] = {}
    for item in discover([root]):
        outcome = read(item) if isinstance(item, FoundFile) else item
        assert item.path not in result
        result[item.path] = outcome.reason if isinstance(outcome, Skipped) else outcome
    return {path.removeprefix(f"{root.as_posix()}/"): what for path, what in result.items()}


def archive_at(tmp_path: Path, *members: tuple[str | zipfile.ZipInfo, bytes]) -> Path:
    file = tmp_path / "backup.zip"
    file.write_bytes(packed(*members))
    return file


def error_of(root: Path) -> str:
    with pytest.raises(IngestError) as caught:
        list(discover([root]))
    return str(caught.value)


# -- members ---------------------------------------------------------------------------------------


def test_members_are_found_with_path_size_and_origin(tmp_path: Path) -> None:
    """A member's path goes on from the archive's; its origin is the archive."""
    file = archive_at(tmp_path, ("KRC/R1/Program/a.SRC", A), ("am.ini", b"x"), ("KRC/R1/", b""))
    path = f"{file.as_posix()}/KRC/R1/Program/a.SRC"
    expected = [FoundFile(path, "backup", len(A), file.resolve(), "0")]
    assert expected == list(discover([file]))


def test_members_come_sorted(tmp_path: Path) -> None:
    """The order is that of the paths, whatever the order in the archive."""
    file = archive_at(tmp_path, ("b.src", A), ("C.dat", A), ("A.sub", A))
    assert ["A.sub", "b.src", "C.dat"] == list(survey(file))


def test_double_names_are_two_members(tmp_path: Path) -> None:
    """Of two members with one name both are read, each its own content, under two paths."""
    file = archive_at(tmp_path, ("a.src", A), ("a.src", B), ("x/../a.src", B))
    expected = {"a.src": A, "a.src (2)": B, "x/a.src": B}
    assert expected == survey(file)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("KRC\\R1\\x.src", "KRC/R1/x.src"),
        ("../../x.src", "x.src"),
        ("..\\..\\x.src", "x.src"),
        ("a/../../x.src", "a/x.src"),
        ("/etc/x.src", "etc/x.src"),
        ("//host/share/x.src", "host/share/x.src"),
        ("C:\\KRC\\x.src", "KRC/x.src"),
        ("C:x.src", "x.src"),
        ("./x.src", "x.src"),
        ("a\x1b[31m\n.src", "a\\x1b[31m\\x0a.src"),
        ("a\u202e.src", "a\\u202e.src"),
        ("Größe.src", "Größe.src"),
        ("x.src\0.jpg", "x.src"),
    ],
)
def test_names_are_cleaned(tmp_path: Path, name: str, expected: str) -> None:
    """Names of members are for showing: they lead nowhere and hold nothing a terminal obeys."""
    assert {expected: A} == survey(archive_at(tmp_path, (info(name), A)))


def test_names_in_the_old_code_page(tmp_path: Path) -> None:
    """A name that is not marked as UTF-8 is read in code page 437."""
    data = packed(("Gr__e.src", A)).replace(b"Gr__e", b"Gr\x94\xe1e")
    (tmp_path / "backup.zip").write_bytes(data)
    assert {"Größe.src": A} == survey(tmp_path / "backup.zip")


@pytest.mark.parametrize("name", ["x.src/", "x.src\\", ".git/x.src", "__MACOSX/x.src", ".."])
def test_folders_and_hidden_folders_are_no_candidates(tmp_path: Path, name: str) -> None:
    """Folder entries, and members in folders that a walk would ignore, yield nothing."""
    file = archive_at(tmp_path, (info(name), b""), ("a.src", A))
    assert {"a.src": A} == survey(file)


def test_nothing_is_written(tmp_path: Path) -> None:
    """Reading a hostile archive leaves the folder around it as it was."""
    inner = packed(("../../evil.src", A))
    file = archive_at(tmp_path, ("../evil.src", A), ("n.zip", inner), ("/evil.dat", A))
    survey(file)
    assert [file] == list(tmp_path.rglob("*"))
    assert not (tmp_path.parent / "evil.src").exists()


# -- archives in archives --------------------------------------------------------------------------


def test_an_archive_in_an_archive_is_opened(tmp_path: Path) -> None:
    """One level of nesting is read, the next is skipped with its reason."""
    deepest = packed(("c.src", A))
    inner = packed(("b.src", B), ("deep.zip", deepest))
    file = archive_at(tmp_path, ("a.src", A), ("Intern.ZIP", inner))
    reason = "an archive in an archive in an archive is not opened"
    expected = {"a.src": A, "Intern.ZIP/b.src": B, "Intern.ZIP/deep.zip": reason}
    assert expected == survey(file)


def test_a_nested_archive_belongs_to_the_backup_around_it(tmp_path: Path) -> None:
    """Beside programs, a nested archive is part of the same origin."""
    file = archive_at(tmp_path, ("a.src", A), ("Intern.zip", packed(("b.src", B))))
    assert ["backup", "backup"] == [item.origin for item in discover([file])]


def test_an_archive_of_archives_is_a_collection(tmp_path: Path) -> None:
    """An archive that holds only archives is like a folder of them: each is an origin."""
    inner = packed(("a.src", A))
    file = archive_at(tmp_path, ("line/cell1.zip", inner), ("cell2.zip", inner))
    expected = ["backup/cell2", "backup/line/cell1"]
    assert expected == [item.origin for item in discover([file])]


def test_a_damaged_nested_archive_is_skipped_alone(tmp_path: Path) -> None:
    """What stands beside a damaged nested archive is read all the same."""
    inner = packed(("b.src", B))[:-10]
    file = archive_at(tmp_path, ("n.zip", inner), ("a.src", A), ("o.zip", b"hello"))
    expected = {
        "a.src": A,
        "n.zip": "truncated or damaged archive",
        "o.zip": "not a zip archive",
    }
    assert expected == survey(file)


# -- refused members -------------------------------------------------------------------------------


def test_encrypted_members_are_skipped(tmp_path: Path) -> None:
    """The flag of encryption in the directory is enough; no password is asked for."""
    data = bytearray(packed(("a.src", A), ("b.src", B)))
    data[data.index(b"PK\1\2") + 8] |= 1
    (tmp_path / "backup.zip").write_bytes(data)
    assert {"a.src": "encrypted", "b.src": B} == survey(tmp_path / "backup.zip")


@pytest.mark.parametrize(
    ("method", "name"), [(zipfile.ZIP_BZIP2, "bzip2"), (zipfile.ZIP_LZMA, "LZMA")]
)
def test_other_compression_is_skipped(tmp_path: Path, method: int, name: str) -> None:
    """Methods that cannot be unpacked in bounded steps are refused by name."""
    file = archive_at(tmp_path, (info("a.src", compress_type=method), A), ("b.src", B))
    expected = {"a.src": f"compression method {name} is not supported", "b.src": B}
    assert expected == survey(file)


@pytest.mark.parametrize(
    ("mode", "reason"),
    [(stat.S_IFLNK, "symbolic link"), (stat.S_IFIFO, "not a regular file")],
)
def test_links_and_devices_are_skipped(tmp_path: Path, mode: int, reason: str) -> None:
    """A member that is a link or a device, says its Unix mode, is not read."""
    odd = info("a.src", external_attr=(mode | 0o644) << 16, create_system=3)
    assert {"a.src": reason, "b.src": B} == survey(archive_at(tmp_path, (odd, A), ("b.src", B)))


def test_attributes_of_other_systems_are_no_mode(tmp_path: Path) -> None:
    """The upper attribute bits mean a Unix mode only where a Unix tool wrote them."""
    odd = info("a.src", external_attr=stat.S_IFLNK << 16, create_system=0)
    assert {"a.src": A} == survey(archive_at(tmp_path, (odd, A)))


def test_a_wrong_checksum_is_found(tmp_path: Path) -> None:
    """A member whose content does not match its checksum is skipped, the others are read."""
    file = archive_at(tmp_path, (info("a.src", compress_type=zipfile.ZIP_STORED), A), ("b.src", B))
    file.write_bytes(file.read_bytes().replace(A, A.lower()))
    assert {"a.src": "damaged: wrong checksum", "b.src": B} == survey(file)


def with_claimed_size(size: int) -> bytes:
    data = bytearray(packed(("a.src", A)))
    struct.pack_into("<I", data, data.index(b"PK\1\2") + 24, size)
    return bytes(data)


def test_members_that_share_their_bytes_are_read_once(tmp_path: Path) -> None:
    """A directory that names the same bytes many times makes a small archive no bomb."""
    data = packed(("a.src", b"DEF A()\nEND\n"), ("b.src", b"DEF B()\nEND\n"))
    listed, end = data.index(b"PK\x01\x02"), data.rindex(b"PK\x05\x06")
    entry, others = data[listed : listed + 51], data[listed + 51 : end]
    assert others.startswith(b"PK\x01\x02")
    tail = bytearray(data[end:])
    tail[8:12] = struct.pack("<HH", 401, 401)
    tail[12:16] = struct.pack("<I", len(entry) * 400 + len(others))
    file = tmp_path / "bomb.zip"
    file.write_bytes(data[:listed] + entry * 400 + others + tail)
    found = survey(file)
    reasons = [what for what in found.values() if isinstance(what, str)]
    assert ["its bytes are those of another member too"] * 399 == reasons
    assert 2 == len(found) - len(reasons)


def test_a_size_claimed_too_small_is_found(tmp_path: Path) -> None:
    """A member is never read beyond the size the directory claims; its checksum then tells."""
    (tmp_path / "backup.zip").write_bytes(with_claimed_size(5))
    assert {"a.src": "damaged: wrong checksum"} == survey_folder(tmp_path)


def test_a_size_claimed_too_large_does_no_harm(tmp_path: Path) -> None:
    """What is there is read; the claim only shows in `FoundFile.size`."""
    (tmp_path / "backup.zip").write_bytes(with_claimed_size(5000))
    assert {"a.src": A} == survey_folder(tmp_path)


def survey_folder(folder: Path) -> dict[str, bytes | str]:
    return {path.partition("/")[2]: what for path, what in survey(folder).items()}


# -- limits ----------------------------------------------------------------------------------------


def test_a_member_beyond_the_limit_is_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A member that claims to be larger than the limit is skipped unread."""
    monkeypatch.setattr(archives, "MAX_FILE_BYTES", archives.MB)
    file = archive_at(tmp_path, ("a.src", A), ("bomb.src", bytes(archives.MB + 1)))
    (_, bomb) = discover([file])
    expected = Skipped(f"{file.as_posix()}/bomb.src", "larger than 1 MB", "backup")
    assert expected == bomb


def test_reading_counts_what_it_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reading stops beyond the limit, whatever was claimed, and well before the end."""
    monkeypatch.setattr(archives, "MAX_FILE_BYTES", 3 * archives.MB)
    stream = io.BytesIO(bytes(20 * archives.MB))
    with pytest.raises(archives.ArchiveError, match="larger than 3 MB"):
        archives.read_whole(stream)
    assert stream.tell() <= 5 * archives.MB


def test_an_archive_has_a_limit_for_all_members(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Members beyond the archive's limit are skipped, nested ones too; small ones still fit."""
    monkeypatch.setattr(archives, "MAX_ARCHIVE_BYTES", 2 * archives.MB)
    large = bytes(archives.MB)
    inner = packed(("b.src", large))
    file = archive_at(tmp_path, ("a.src", large), ("m.zip", inner), ("z.src", A))
    reason = "the archive holds more than 2 MB"
    assert {"a.src": large, "m.zip/b.src": reason, "z.src": A} == survey(file)


def test_an_archive_has_a_limit_for_the_number_of_members(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Too many members, those of nested archives included, and the archive is not opened."""
    monkeypatch.setattr(archives, "MAX_MEMBERS", 4)
    few = packed(("a.src", A), ("b.src", B))
    file = archive_at(tmp_path, ("m.zip", few), ("n.zip", few), ("o.zip", few))
    listed = survey(archive_at(tmp_path, ("m.zip", few)))
    assert {"m.zip/a.src": A, "m.zip/b.src": B} == listed
    file = archive_at(tmp_path, ("k.src", A), ("m.zip", few), ("n.zip", few), ("o.zip", few))
    reason = "more than 100,000 members"
    assert {"k.src": A, "m.zip": reason, "n.zip": reason, "o.zip": reason} == survey(file)
    assert error_of(archive_at(tmp_path, *[(f"{i}.src", A) for i in range(5)])).endswith(reason)


def test_a_huge_directory_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An archive's directory is refused by its size before anything is made of it."""
    monkeypatch.setattr(archives, "MAX_DIRECTORY_BYTES", archives.MB)
    file = archive_at(tmp_path, *[(f"{i:0>60000}.src", b"") for i in range(20)])
    assert error_of(file) == f"{file.as_posix()}: its directory is larger than 1 MB"


# -- damaged archives ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "empty file"),
        (b"DEF A()\nEND\n", "not a zip archive"),
        (packed(("a.src", A))[:40], "truncated or damaged archive"),
        (packed(("a.src", A))[:-1], "truncated or damaged archive"),
        (packed(("a.txt", A)), "no .src, .dat or .sub file in it"),
    ],
    ids=["empty", "text", "cut", "one byte short", "no KRL"],  # the bytes hold the time of day
)
def test_a_lone_archive_with_nothing_to_read_is_an_error(
    tmp_path: Path, data: bytes, reason: str
) -> None:
    """An archive that is the only root and gives nothing ends in one clear line."""
    file = tmp_path / "backup.zip"
    file.write_bytes(data)
    assert f"{file.as_posix()}: {reason}" == error_of(file)


def test_a_damaged_archive_among_others_is_skipped(tmp_path: Path) -> None:
    """Beside other files a damaged archive is one skipped entry."""
    (tmp_path / "bad.zip").write_bytes(packed(("a.src", A))[:-1])
    (tmp_path / "good.zip").write_bytes(packed(("a.src", A)))
    expected = {"bad.zip": "truncated or damaged archive", "good.zip/a.src": A}
    assert expected == survey(tmp_path)


def test_damage_never_raises(tmp_path: Path) -> None:
    """Whatever bytes of an archive are changed, cut or added, every member has an outcome."""
    rng = random.Random(1)
    inner = packed(("i.src", A))
    seed = packed(("KRC/a.src", A * 20), (info("b\\c.dat"), B), ("n.zip", inner), ("a.src", A))
    (tmp_path / "whole.src").write_bytes(A)
    for _ in range(400):
        data = bytearray(seed)
        for _ in range(rng.randint(1, 4)):
            place = rng.randrange(len(data))
            edit = rng.choice(EDITS)
            edit(data, place, rng)
        (tmp_path / "x.zip").write_bytes(data)
        outcomes = survey(tmp_path)
        assert outcomes["whole.src"] == A
        assert all(isinstance(what, bytes) or what.isprintable() for what in outcomes.values())
        close_archives()


def _change(data: bytearray, place: int, rng: random.Random) -> None:
    data[place] = rng.choice([0, 0xFF, rng.randrange(256)])


def _cut(data: bytearray, place: int, rng: random.Random) -> None:
    del data[place : place + rng.randint(0, 8)]


def _add(data: bytearray, place: int, rng: random.Random) -> None:
    data[place:place] = rng.randbytes(rng.randint(1, 8))


def _directory(data: bytearray, _place: int, rng: random.Random) -> None:
    start = data.find(b"PK\1\2")
    if 0 <= start < len(data) - 46:
        data[start + rng.randrange(4, 46)] = rng.randrange(256)


EDITS: list[Callable[[bytearray, int, random.Random], None]] = [_change, _cut, _add, _directory]


# -- reading again and elsewhere -------------------------------------------------------------------


def test_archives_stay_open_between_reads(tmp_path: Path) -> None:
    """Reading many members opens their archive once, and only a few archives stay open."""
    for number in range(8):
        (tmp_path / f"{number}.zip").write_bytes(packed(("a.src", A), ("b.src", B)))
    found = [item for item in discover([tmp_path]) if isinstance(item, FoundFile)]
    for item in found:
        read(item)
        assert archives._opened.cache_info().currsize <= archives.OPEN_ARCHIVES
    assert 8 == archives._opened.cache_info().misses
    assert 16 == len(found)


def test_a_changed_archive_is_noticed(tmp_path: Path) -> None:
    """When the archive changes after it was listed, what is read is new or refused, never mixed."""
    file = archive_at(tmp_path, ("a.src", A), ("b.src", B))
    found = [item for item in discover([file]) if isinstance(item, FoundFile)]
    assert [read(item) for item in found] == [A, B]
    file.write_bytes(packed(("a.src", A + B)))
    reasons = [what.reason for what in map(read, found) if isinstance(what, Skipped)]
    assert ["the archive changed while it was being read"] * 2 == reasons


def test_a_vanished_archive_is_skipped(tmp_path: Path) -> None:
    """When the archive is gone, its members are skipped with the reason."""
    file = archive_at(tmp_path, ("a.src", A))
    (found,) = discover([file])
    file.unlink()
    assert isinstance(found, FoundFile)
    outcome = read(found)
    assert isinstance(outcome, Skipped)
    assert outcome.reason.startswith("cannot be read: ")
    assert (found.path, found.origin) == (outcome.path, outcome.origin)


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")  # forking is what we test
@pytest.mark.parametrize("method", sorted({"spawn", "fork"} & {*get_all_start_methods()}))
def test_members_are_read_in_other_processes(tmp_path: Path, method: str) -> None:
    """A file that was found is read in another process, also when its archive is open here."""
    contents = [b"DEF A()\n;%d\nEND\n" % number * 50 for number in range(40)]
    file = archive_at(tmp_path, *[(f"{i:02}.src", data) for i, data in enumerate(contents)])
    found = [item for item in discover([file]) if isinstance(item, FoundFile)]
    assert contents[0] == read(found[0])
    with ProcessPoolExecutor(2, get_context(method)) as pool:
        assert contents == list(pool.map(read, found))


def opened_by(found: FoundFile) -> tuple[int, int]:
    """Read, and say in which process, and how many archives were opened in it and before it."""
    read(found)
    return os.getpid(), archives._opened.cache_info().misses


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")  # forking is what we test
@pytest.mark.skipif("fork" not in get_all_start_methods(), reason="this system has no fork")
def test_a_forked_process_opens_archives_itself(tmp_path: Path) -> None:
    """What is open at a fork is not used by the child: both would move one file position."""
    (found,) = discover([archive_at(tmp_path, ("a.src", A))])
    assert isinstance(found, FoundFile)
    parent, opened = opened_by(found)
    assert 1 == opened
    with get_context("fork").Pool(1) as pool:
        child, opened = pool.apply(opened_by, (found,))
    assert child != parent
    assert 2 == opened


def test_members_are_read_by_many_threads(tmp_path: Path) -> None:
    """Threads of one process share the open archives without disturbing one another."""
    contents = [b"DEF A()\n;%d\nEND\n" % number * 50 for number in range(60)]
    for name in "abcdef":
        members = [(f"{i:02}.src", data) for i, data in enumerate(contents)]
        (tmp_path / f"{name}.zip").write_bytes(packed(*members))
    found = [item for item in discover([tmp_path]) if isinstance(item, FoundFile)]
    shuffled = sorted(found, key=lambda item: (item.member, item.path))
    with ThreadPoolExecutor(4) as pool:
        outcomes = dict(zip(shuffled, pool.map(read, shuffled), strict=True))
    assert contents * 6 == [outcomes[item] for item in found]
