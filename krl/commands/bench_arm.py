"""`krl bench arm`: how fast the arm is planned and simulated."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from krl.door import FINE, Unusable
from krl.progress import progress_bar
from krl.writing import write_json

__all__ = ["arm"]


def arm(
    json_file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write the record here.")
    ] = None,
    motions: Annotated[
        int, typer.Option(min=1, max=100_000, metavar="N", help="Motions of the program.")
    ] = 200,
) -> int:
    """Measure the arm: simulated seconds a second on each robot, and what a motion costs to plan.

    The program is a list of motions, with blends and without KRL. Seconds are processor time.
    """
    try:
        from interp.robot.benchmark import STEPS, measure
    except ImportError as error:
        raise Unusable(
            f"the arm needs what the extra arm installs, and {error.name} is missing"
        ) from error
    with progress_bar("measuring", STEPS) as advance:
        record = {"bench": "arm", **measure(motions, advance)}
    if json_file is not None:
        write_json(record, json_file, indent=1)
    _print(record)
    return FINE


def _print(record: Mapping[str, Any]) -> None:
    console = Console(highlight=False)
    console.print(
        f"{record['motions']:,} motions, a cycle of {record['cycle_us'] / 1000:g} ms; "
        f"Python {record['python']}",
        soft_wrap=True,
    )
    robots = _table("robot", "simulated", "took", "times real time", "aim")
    for robot in record["robots"]:
        aim = "" if robot["aim"] is None else f"{robot['aim']:g}"
        if "absent" in robot:
            robots.add_row(robot["robot"], robot["absent"], "", "", aim)
            continue
        times = (f"{robot['simulated_s']:.1f} s", f"{robot['seconds']:.2f} s")
        robots.add_row(robot["robot"], *times, f"{robot['times_real_time']:.0f}", aim)
    console.print(robots)
    batch, ahead = record["simulated_s_batch"], record["simulated_s_lookahead"]
    figures = _table("figure", "")
    figures.add_row("planning a motion", f"{record['planning_ms_per_motion']:.2f} ms")
    figures.add_row("inverse kinematics", f"{record['inverse_per_s']:,.0f} poses/s, all ways")
    figures.add_row("the program with look-ahead", f"{ahead:.3f} s simulated")
    figures.add_row("the program in batches", f"{batch:.3f} s simulated, {batch - ahead:+.3f} s")
    console.print(figures)


def _table(*columns: str) -> Table:
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False)
    for number, column in enumerate(columns):
        table.add_column(column, justify="left" if number == 0 else "right")
    return table
