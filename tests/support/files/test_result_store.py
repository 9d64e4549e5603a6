"""Results kept from one run to the next."""

from pathlib import Path

from support.files.result_store import ResultStore


def test_values_come_back_by_key_and_digest(tmp_path: Path) -> None:
    """What is kept is what was put last; another digest, or another key, has none."""
    record = {"clusters": [{"title": "FOR … STEP"}], "files": 3}
    with ResultStore(tmp_path, "key") as store:
        store.put([("a", {"files": 2}), ("b", "no KRL")])
        store.put([("a", record)])
    with ResultStore(tmp_path, "key") as store:
        assert (record, "no KRL", None) == (store.get("a"), store.get("b"), store.get("c"))
        assert (record, None) == (store.get_record("a"), store.get_record("b"))
    with ResultStore(tmp_path, "other") as store:
        assert store.get("a") is None


def test_damage_that_sqlite_quotes_is_put_aside_too(tmp_path: Path) -> None:
    """Its message holds the damaged bytes, which are no text."""
    with ResultStore(tmp_path, "key"):
        pass
    base = tmp_path / "results.sqlite"
    damaged = base.read_bytes().replace(b"PRIMARY KEY", b"PRIMARY K\xb5Y")
    assert damaged != base.read_bytes()
    base.write_bytes(damaged)
    with ResultStore(tmp_path, "key") as store:
        store.put([("a", 3)])
    with ResultStore(tmp_path, "key") as store:
        assert 3 == store.get("a")
    assert damaged == (tmp_path / "results.damaged").read_bytes()
