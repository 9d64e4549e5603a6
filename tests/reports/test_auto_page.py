"""The page of an automatic recovery."""

from pathlib import Path

from reports.recovery.auto_page import write_auto_page


def test_what_is_still_refused(tmp_path: Path) -> None:
    """Not what was refused before the last step that lines show, nor what was taken later."""

    def step(title: str, lines: int = 0) -> dict[str, object]:
        return {"title": title, "edits": [f"rule: or {title}"], "lines": lines, "reason": "why"}

    rounds = [
        {"taken": [], "refused": [step("before")]},
        {"taken": [step("shown", 2)], "refused": [step("alone"), step("later")]},
        {"taken": [step("later")], "refused": [step("behind")]},
        {"taken": [], "refused": []},
    ]
    text = write_auto_page({"rounds": rounds}, tmp_path).read_text(encoding="utf-8")
    _, refused = text.split("Still refused")
    titles = ("before", "shown", "alone", "later", "behind")
    assert ["alone", "behind"] == [t for t in titles if f"<summary>{t}</summary>" in refused]
