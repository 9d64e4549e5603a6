"""The steps of a nightly run: its commands, and their shares of the time."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

#: Programs that the fuzzer runs in a run of one hour; proportional for other durations.
_PROGRAMS = 12_000


@dataclass(frozen=True, slots=True)
class Step:
    """A command; ``share`` is the largest part of the total time that it may take.

    ``again`` are the options that run its failed cases once more.
    """

    name: str
    arguments: tuple[str, ...]
    share: float
    page: str = ""
    again: tuple[str, ...] = ()


def steps_of(paths: list[Path], folder: Path, minutes: float) -> Iterator[Step]:
    """Yield the commands of a nightly run, the most important ones first."""
    given = tuple(map(str, paths))
    seed = folder.name.replace("-", "").replace(".", "")
    seed = seed if seed.isdigit() else "1"
    programs = str(max(100, round(_PROGRAMS * minutes / 60)))
    yield Step(
        "conform", ("conform", "--html", str(folder / "conform")), 0.25, "conform/index.html"
    )
    arm = ("--executor", "native", "--robot", "mujoco")
    motions = ("motion", "blending", "program", *arm, "--html", str(folder / "conform-arm"))
    yield Step("conform-arm", ("conform", *motions), 0.15, "conform-arm/index.html", arm)
    yield Step("conform-laws", ("conform", "--metamorphic", "10"), 0.1)
    within = ("--minutes", f"{0.25 * minutes:g}")  # a slow machine runs fewer
    yield Step("fuzz", ("fuzz", "--programs", programs, *within, "--seed", seed), 0.35)
    yield Step(
        "recover", ("recover", *given, "--out", str(folder / "recover")), 0.3, "recover/index.html"
    )
    yield Step(
        "growth", ("growth", *given, "--out", str(folder / "growth")), 0.15, "growth/index.html"
    )
    limits = {
        "scale": ("--sizes", "4,8,16"),
        "conform": ("--mutants", str(max(10, round(minutes / 2))), "--seed", seed),
    }
    for bench in ("recover", "check", "scale", "vm", "arm", "conform"):
        arguments = ("bench", bench, *(given if bench in ("recover", "check", "scale") else ()))
        share = 0.25 if bench == "conform" else 0.15
        yield Step(f"bench-{bench}", (*arguments, *limits.get(bench, ())), share)
    sample = str(max(4, round(minutes / 2)))
    yield Step("bench-mutation", ("bench", "mutation", "--singles", sample, "--multiple", "4"), 0.2)
