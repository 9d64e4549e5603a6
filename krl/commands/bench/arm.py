"""`krl bench arm`: how fast the arm is planned and simulated."""

from collections.abc import Mapping
from typing import Annotated, Any

import typer
from rich.console import Console

from krl.errors import FINE
from krl.extras import ARM, expected_extras
from krl.terminal.options import JsonOption
from krl.terminal.output_files import check_files, write_json
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import figures


def arm(
    json_file: JsonOption = None,
    motions: Annotated[int, typer.Option(min=1, max=100000)] = 200,
) -> int:
    """Measure the arm: simulated seconds per second on each robot, and planning time per motion.

    The program is a list of motions, with blends and without KRL. Seconds are processor time.

    Options:
        motions: Number of motions in the program.
    """
    check_files(json_file)
    with expected_extras(*ARM):
        from interp.bench.arm import STEPS, measure
    with progress_bar("measuring", STEPS) as advance:
        record = {"bench": "arm", **measure(motions, advance)}
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
    robots = figures(("robot", "simulated", "took", "times real time", "aim"))
    for robot in record["robots"]:
        aim = "" if robot["aim"] is None else f"{robot['aim']:g}"
        if "absent" in robot:
            robots.add_row(robot["robot"], robot["absent"], "", "", aim)
            continue
        times = (f"{robot['simulated_s']:.1f} s", f"{robot['seconds']:.2f} s")
        robots.add_row(robot["robot"], *times, f"{robot['times_real_time']:.0f}", aim)
    console.print(robots)
    batch, ahead = record["simulated_s_batch"], record["simulated_s_lookahead"]
    summary = figures(("figure", ""))
    summary.add_row("planning a motion", f"{record['planning_ms_per_motion']:.2f} ms")
    summary.add_row("inverse kinematics", f"{record['inverse_per_s']:,.0f} poses/s, all ways")
    summary.add_row("the program with look-ahead", f"{ahead:.3f} s simulated")
    summary.add_row("the program in batches", f"{batch:.3f} s simulated, {batch - ahead:+.3f} s")
    console.print(summary)
