"""The command `boreprop`: simulate a case, draw the paper's figures."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated, NoReturn

from ..case.case import SAMPLE_INTERVAL
from ..core.propagation import RELATIVE_TOLERANCE
from . import console
from .console import typer

MAX_ROWS = 10_000_000
WIDE = 110  # characters: a line a mode

app = console.new_app("Borehole propagation of a directional drilling system.")


def main() -> NoReturn:
    """Run the command `boreprop`."""
    console.run(app)


@app.callback()
def _boreprop(version: console.Version = False) -> None:
    pass


@app.command()
def simulate(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")],
    output: Annotated[Path, typer.Option(metavar="RUN.csv", help="The result file, .csv or .parquet.")],
    sample_interval: Annotated[
        float, typer.Option(parser=console.positive, metavar="M", help="Drilled length between rows, m.")
    ] = SAMPLE_INTERVAL,
    length: Annotated[
        float | None, typer.Option(parser=console.positive, metavar="M", help="Length to drill, m, if not the case's.")
    ] = None,
    engine: Annotated[
        str, typer.Option(metavar="python|native", help="The model in Python, or the same as compiled code: faster.")
    ] = "python",
    tolerance: console.Tolerance = None,
) -> None:
    """Simulate a case; rows at k times the sample interval, k = 0, 1, …

    If the run cannot go on to its end, the rows so far are written all the same; the exit status is then 3.
    """
    from ..case.file import load_case
    from ..core.checks import check_number
    from ..errors import InputError, Stopped
    from ..run.results import SUFFIXES, case_path, write_trajectory

    console.check_output(output, SUFFIXES)
    if case_path(output).resolve() == case_file.resolve():
        raise InputError(f"{output}: must have another name, as its case would replace the case file, got {case_file}")
    case = load_case(case_file)
    if length is not None:
        case = replace(case, length=length)
    check_number("--sample-interval", sample_interval, at_least=case.length / MAX_ROWS)
    from ..run.simulate import simulate

    try:
        with console.progress("drilling", case.length) as drilled:
            trajectory = simulate(
                case,
                sample_interval=sample_interval,
                relative_tolerance=tolerance or RELATIVE_TOLERANCE,
                progress=drilled,
                engine=engine,
            )
    except Stopped as stopped:
        if stopped.trajectory is not None:
            write_trajectory(stopped.trajectory, output)
        raise
    write_trajectory(trajectory, output)
    print(f"{output}: {len(trajectory)} rows over {case.length:g} m")


@app.command()
def summary(
    run_file: Annotated[Path, typer.Argument(metavar="RUN.csv", help="A result file, .csv or .parquet.")],
    case_file: Annotated[
        Path | None, typer.Option("--case", metavar="CASE.toml", help="Its case, if it does not carry one.")
    ] = None,
) -> None:
    """Print a run in a dozen numbers."""
    from rich.console import Console
    from rich.table import Table

    from ..analysis.summary import summarize
    from ..case.file import load_case
    from ..errors import InputError
    from ..report.tables.summary import rows
    from ..run.results import read_trajectory

    trajectory = read_trajectory(run_file, load_case(case_file) if case_file else None)
    if trajectory.case is None:
        raise InputError(f"{run_file}: must carry its case, or be given one with --case, got neither")
    if len(trajectory) < 2:
        raise InputError(f"{run_file}: must have at least 2 rows, got {len(trajectory)}")
    table = Table(str(run_file), "")
    for row in rows(summarize(trajectory)):
        table.add_row(*row)
    Console().print(table)


@app.command()
def steering(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")],
    output: Annotated[
        Path | None, typer.Option(metavar="STEERING.png", help="Draw build rate against force into this file.")
    ] = None,
    inclination_deg: Annotated[
        float | None,
        typer.Option(
            metavar="A", help="Inclination at which the weight acts, degrees, if not that of the end of the hole."
        ),
    ] = None,
    force_limit: Annotated[
        float | None,
        typer.Option(
            parser=console.positive,
            metavar="N",
            help="Largest force, N, if not the largest of the case's schedule, or 30 kN if that has none.",
        ),
    ] = None,
) -> None:
    """Print how fast a steady steering force turns the hole, and draw it."""
    from math import radians

    from rich.console import Console
    from rich.table import Table

    from ..case.file import load_case
    from ..core.checks import check_number
    from ..report.tables.steering import HEADINGS, piece_rows, rows, summarize

    if output is not None:
        console.check_output(output, (".png",))
    if inclination_deg is not None:
        check_number("--inclination-deg", inclination_deg)
    case = load_case(case_file)
    summary = summarize(case, None if inclination_deg is None else radians(inclination_deg), force_limit)
    table, pieces = Table(str(case_file), ""), Table(*HEADINGS)
    for row in rows(summary):
        table.add_row(*row)
    for cells in piece_rows(summary.curve):
        pieces.add_row(*cells)
    Console().print(table, pieces)
    if output is not None:
        from ..report.figures.drawing import save
        from ..report.figures.steering import draw

        save(draw(summary), output)
        print(f"{output}: build rate and bit tilt over the steering force")


@app.command()
def study(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file: what the cases share.")],
    output: Annotated[
        Path, typer.Option(metavar="STUDY.parquet", help="The file of results. If it is there, the study goes on.")
    ],
    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=START:STOP:COUNT", help="An axis of a grid, or NAME=VALUE,VALUE,…; may come again."),
    ] = None,
    uncertain: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=normal(MEAN,DEVIATION)",
            help="What a parameter is drawn from, also lognormal(MEDIAN,DEVIATION OF THE LOG), uniform(LOW,HIGH) or "
            "triangular(LOW,MODE,HIGH); may come again.",
        ),
    ] = None,
    draws: Annotated[int, typer.Option("--sample", metavar="N", help="Number of draws.")] = 200,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the draws.")] = 1,
    workers: Annotated[
        int | None, typer.Option(metavar="K", help="Number of processes, if not one for each core.")
    ] = None,
    dask: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Compute on the workers of a Dask scheduler, tcp://HOST:PORT.")
    ] = None,
    tolerance: console.Tolerance = None,
) -> None:
    """Simulate many cases on all cores: over a grid, or of uncertain parameters.

    NAME is an input or parameter of the case in SI units (stabilizer_clearance[1]), eta_pi or bit_tilt_limit_deg.
    """
    from rich.console import Console
    from rich.table import Table

    from ..analysis.study.design import grid, parse_axis, parse_distribution, parse_each, sample
    from ..case.file import load_case
    from ..core.checks import check_number
    from ..errors import InputError

    console.check_output(output, (".parquet",))
    check_number("--sample", draws, at_least=1)
    check_number("--seed", seed, at_least=0)
    if workers is not None:
        check_number("--workers", workers, at_least=1)
    if dask is not None and workers is not None:
        raise InputError(f"--workers: must not be given with --dask, whose workers compute, got {workers}")
    if bool(vary) == bool(uncertain):
        raise InputError(f"must be given either --vary or --uncertain, got {'both' if vary else 'neither'}")
    case = load_case(case_file)
    if vary:
        cases, quantiles = grid(case, parse_each(parse_axis, vary)), {"least": 0.0, "median": 0.5, "largest": 1.0}
    else:
        cases = sample(case, parse_each(parse_distribution, uncertain or []), draws, seed)
        quantiles = {"10 %": 0.1, "50 %": 0.5, "90 %": 0.9}
    from ..analysis.study.cluster import on_cluster
    from ..analysis.study.figures import key_figures
    from ..analysis.study.run import study as run
    from ..report.tables.study import lines, verdict

    figures = key_figures if tolerance is None else partial(key_figures, relative_tolerance=tolerance)
    try:
        with on_cluster(dask) as executor, console.progress("cases", len(cases)) as done:
            results = run(cases, figures, output=output, executor=executor, workers=workers, progress=done)
    except KeyboardInterrupt:
        if output.exists():
            console.warn(f"{output}: keeps the cases that are done; the same command goes on from there")
        raise
    table = Table(str(output), *quantiles)
    for line in lines(results, quantiles.values()):
        table.add_row(*line)
    Console().print(table)
    print(f"{output}: {verdict(results)}")


@app.command()
def dogleg(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")],
    output: Annotated[Path | None, typer.Option(metavar="MAP.png", help="Draw a map into this file.")] = None,
    eta_pi: Annotated[
        str | None, typer.Option(metavar="A:B:N", help="The map's ηΠ: from, to, how many; if not around the case's.")
    ] = None,
    clearance_mm: Annotated[
        str | None,
        typer.Option(metavar="A:B:N", help="Its clearances of the first stabilizer that can touch the wall, mm."),
    ] = None,
    limit_deg: Annotated[
        float, typer.Option(parser=console.positive, metavar="A", help="Largest turn that is tried, degrees.")
    ] = 10.0,
    tolerance: console.Tolerance = None,
) -> None:
    """Print the smallest dogleg in the existing hole from which a case ripples; map it over weight and clearance.

    The hole is straight and turns over half the length of the BHA before the bit.
    """
    from math import radians

    from rich.console import Console
    from rich.table import Table

    from ..analysis.study.design import parse_range
    from ..analysis.tipping import critical_dogleg_or_why, dogleg_map, usual_map
    from ..case.file import load_case
    from ..report.tables.tipping import SIDES, left_out, rows

    if output is not None:
        console.check_output(output, (".png",))
    across = parse_range("--eta-pi", eta_pi) if eta_pi else None
    up = parse_range("--clearance-mm", clearance_mm) / 1e3 if clearance_mm else None
    case, limit = load_case(case_file), radians(limit_deg)
    found = {
        side: critical_dogleg_or_why(case, side=side, limit=limit, relative_tolerance=tolerance or RELATIVE_TOLERANCE)
        for side in SIDES
    }
    table = Table(str(case_file), "")
    for row in rows(case, found, limit):
        table.add_row(*row)
    Console().print(table)
    if output is not None:
        from ..report.figures.drawing import save
        from ..report.figures.tipping import draw_map

        usual = usual_map(case)
        across, up = usual[0] if across is None else across, usual[1] if up is None else up
        with console.progress("doglegs", len(across) * len(up)) as done:
            found_map = dogleg_map(
                case, across, up, limit=limit, relative_tolerance=tolerance or RELATIVE_TOLERANCE, progress=done
            )
        save(draw_map(case, found_map, limit), output)
        print(f"{output}: the smallest dogleg that tips it over, by weight and clearance{left_out(found_map)}")


@app.command()
def hysteresis(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")],
    output: Annotated[Path, typer.Option(metavar="LOOP.png", help="The picture.")],
    eta_pi: Annotated[
        str | None, typer.Option(metavar="A:B:N", help="Change the weight: ηΠ from, to, how many.")
    ] = None,
    clearance_mm: Annotated[
        str | None,
        typer.Option(
            metavar="A:B:N", help="Change the clearance of the first stabilizer that can touch the wall instead, mm."
        ),
    ] = None,
    dogleg_deg: Annotated[
        float,
        typer.Option(
            parser=console.positive,
            metavar="A",
            help="Turn of straight holes over half the BHA before the bit, degrees.",
        ),
    ] = 0.5,
    tolerance: console.Tolerance = None,
) -> None:
    """Draw where an ongoing ripple dies out as weight or clearance goes up, and where it comes back on the way down."""
    from math import radians

    from ..analysis import hysteresis as loops
    from ..analysis.stability.contacts import first_that_touches
    from ..analysis.study.design import parse_range
    from ..case.file import load_case
    from ..errors import InputError
    from ..report.figures.drawing import save
    from ..report.figures.tipping import draw_loop
    from ..report.tables.tipping import loop

    console.check_output(output, (".png",))
    if (eta_pi is None) == (clearance_mm is None):
        raise InputError(f"must be given one of --eta-pi and --clearance-mm, got {'both' if eta_pi else 'neither'}")
    case = load_case(case_file)
    if eta_pi is not None:
        name, values = "eta_pi", parse_range("--eta-pi", eta_pi).tolist()
    else:
        name = f"stabilizer_clearance[{first_that_touches(case)}]"
        values = (parse_range("--clearance-mm", clearance_mm or "") / 1e3).tolist()
    with console.progress("values", 2 * len(values)) as done:
        found = loops.hysteresis(
            case, name, values, radians(dogleg_deg), relative_tolerance=tolerance or RELATIVE_TOLERANCE, progress=done
        )
    save(draw_loop(case, found), output)
    print(f"{output}: {loop(case, found)}")


@app.command()
def roots(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")],
    eta_pi: Annotated[
        float | None, typer.Option(parser=console.positive, metavar="X", help="ηΠ, if not the case's.")
    ] = None,
    contact: Annotated[
        str | None,
        typer.Option(metavar="1,2", help="One mode in full: the stabilizers that touch, '' for none."),
    ] = None,
    saturated: Annotated[bool, typer.Option("--saturated", help="With the bit tilt at its limit.")] = False,
    inclination_deg: Annotated[
        float | None, typer.Option(metavar="A", help="Inclination of the straight hole, if not that at the end.")
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON: one mode, without --contact that with no contact.")
    ] = False,
    every: Annotated[bool, typer.Option("--all", help="With --json: a list of all modes.")] = False,
) -> None:
    """Print what the modes of a case do: whether each is stable, drifts or oscillates, how fast, and in which waves.

    A mode is which stabilizers touch the wall, and whether the bit tilt is at its limit. With --contact or --json the
    rightmost roots of one mode.
    """
    import json
    from math import radians

    from rich.console import Console
    from rich.table import Table

    from ..analysis.stability.contacts import all_contacts, contacts_met, held
    from ..analysis.stability.roots import find_roots, parse_contact
    from ..case.file import load_case
    from ..core import system as assembly
    from ..core.checks import check_number
    from ..errors import InputError
    from ..report.tables.stability import (
        HEADINGS,
        MODE_HEADINGS,
        NOT_MET,
        as_plain,
        caption,
        mode_row,
        modes_title,
        rows,
        title,
    )

    if every and contact is not None:
        raise InputError(f"--all: must be without --contact, got --contact {contact!r}")
    touching = parse_contact(contact or "")
    if inclination_deg is not None:
        check_number("--inclination-deg", inclination_deg)
    case = load_case(case_file)
    bha, bit, forces = case.bha, case.bit, case.schedule.rss_force
    inclination = case.survey.inclination[-1] if inclination_deg is None else radians(inclination_deg)
    at = assembly.eta_pi(bha, bit, case.active_weight_on_bit) if eta_pi is None else eta_pi
    weight_on_bit = at * bha.force_scale / bit.lateral_steering_resistance
    if every or (contact is None and not as_json):
        found = [
            find_roots(case, at, contact=numbers, saturated=tilt, inclination=inclination)
            for numbers in all_contacts(bha)
            for tilt in ((True,) if saturated else (False, True))
        ]
        if as_json:
            print(json.dumps([as_plain(roots) for roots in found]))
            return
        table = Table(*MODE_HEADINGS, title=modes_title(at, weight_on_bit, inclination), caption=NOT_MET)
        here = held(bha, bit, weight_on_bit, forces[0], inclination)
        met = contacts_met(bha, bit, inclination, forces)
        for roots in found:
            table.add_row(*mode_row(roots, bha.length_scale, here, met))
        Console(width=WIDE).print(table)
        return
    one = find_roots(case, at, contact=touching, saturated=saturated, inclination=inclination)
    if as_json:
        print(json.dumps(as_plain(one)))
        return
    table = Table(*HEADINGS, title=title(one, weight_on_bit), caption=caption(one))
    for row in rows(one, bha.length_scale):
        table.add_row(*row)
    Console().print(table)


@app.command()
def stability(
    case_file: Annotated[Path, typer.Argument(metavar="CASE.toml", help="The case file.")],
    output: Annotated[Path, typer.Option(metavar="CHART.png", help="The picture.")],
    eta_pi: Annotated[str | None, typer.Option(metavar="A:B:N", help="N values of ηΠ from A to B.")] = None,
    lambda2: Annotated[
        str | None, typer.Option(metavar="A:B:N", help="N values of λ₂, stabilizer 1 to 2 over bit to 1, from A to B.")
    ] = None,
) -> None:
    """Draw the stability chart of a case over ηΠ and λ₂, for the inclination at its end, and print its limits.

    There is a panel for each mode that matters: at most four ways in which stabilizers can touch, among them the one
    the case is held in, each with the bit tilt saturated and not.
    """
    from ..analysis.stability.chart import stability_chart, usual_grid
    from ..analysis.stability.contacts import charted, held
    from ..analysis.stability.roots import critical_eta_pi
    from ..analysis.study.design import parse_range
    from ..case.file import load_case
    from ..core import system as assembly

    console.check_output(output, (".png",))
    across = parse_range("--eta-pi", eta_pi) if eta_pi else None
    up = parse_range("--lambda2", lambda2) if lambda2 else None
    case = load_case(case_file)
    bha, bit, inclination, forces = case.bha, case.bit, case.survey.inclination[-1], case.schedule.rss_force
    own = assembly.eta_pi(bha, bit, case.active_weight_on_bit)
    here, _ = held(bha, bit, case.active_weight_on_bit, forces[0], inclination)
    contacts = charted(bha, bit, inclination, forces, here)
    limits = {contact: critical_eta_pi(case, contact=contact, inclination=inclination) for contact in contacts}
    usual_across, usual_up = usual_grid(bha, own, max(limit.eta_pi if limit else 0.0 for limit in limits.values()))
    across, up = usual_across if across is None else across, usual_up if up is None else up
    from ..report.figures.drawing import save
    from ..report.figures.stability import draw
    from ..report.tables.stability import stability_limit, weight

    with console.progress("chart", 1.0) as done:
        chart = stability_chart(case, across, up, contacts=contacts, progress=done)
    save(draw(chart, case), output)
    print(
        f"{output}: {len(across)} × {len(up)} points; {stability_limit(contacts[0], limits[contacts[0]])}; "
        f"the case: ηΠ = {own:.4g} ({weight(case.active_weight_on_bit)})"
    )
    for contact in contacts[1:]:
        print(f"{output}: {stability_limit(contact, limits[contact])}")


@app.command()
def figures(output: Annotated[Path, typer.Argument(metavar="OUT/", help="The directory to put them in.")]) -> None:
    """Draw the paper's figures 6, 7 and 8 (PNG)."""
    from ..report.figures.paper import make_figures

    output.mkdir(parents=True, exist_ok=True)
    with console.progress("figures", 1.0) as done:
        make_figures(output, done)
    print(f"{output}: figures 6, 7 and 8")


if __name__ == "__main__":
    main()
