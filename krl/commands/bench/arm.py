"""`krl bench arm`: how fast the arm is planned and simulated."""

from typing import Annotated

import typer

from krl.commands.bench.bench_command import Record, bench
from krl.errors import say
from krl.extras import ARM, expected_extras
from krl.terminal.options import JsonOption
from krl.terminal.progress import progress_bar
from krl.terminal.text_table import print_figures


def _print(record: Record) -> None:
    say(
        f"{record['motions']:,} motions, a cycle of {record['cycle_us'] / 1000:g} ms; "
        f"Python {record['python']}"
    )
    robots = []
    for robot in record["robots"]:
        cells = (robot.get("absent"), "", "")
        if "absent" not in robot:
            ratio = f"{robot['times_real_time']:.0f}"
            cells = (f"{robot['simulated_s']:.1f} s", f"{robot['seconds']:.2f} s", ratio)
        robots.append((robot["robot"], *cells, "" if robot["aim"] is None else f"{robot['aim']:g}"))
    print_figures(("robot", "simulated", "took", "times real time", "aim"), robots)
    batch, ahead = record["simulated_s_batch"], record["simulated_s_lookahead"]
    summary = {
        "planning a motion": f"{record['planning_ms_per_motion']:.2f} ms",
        "inverse kinematics": f"{record['inverse_per_s']:,.0f} poses/s, all ways",
        "the program with look-ahead": f"{ahead:.3f} s simulated",
        "the program in batches": f"{batch:.3f} s simulated, {batch - ahead:+.3f} s",
    }
    print_figures(("figure", ""), summary.items())


@bench(_print)
def arm(
    _json_file: JsonOption = None,
    motions: Annotated[int, typer.Option(min=1, max=100000)] = 200,
) -> Record:
    """Measure the arm: simulated seconds per second on each robot, and planning time per motion.

    The program is a list of motions, with blends and without KRL. Seconds are processor time.

    Options:
        motions: Number of motions in the program.
    """
    with expected_extras(*ARM):
        from interp.bench.arm import STEPS, measure
    with progress_bar("measuring", STEPS) as advance:
        return measure(motions, advance)
