"""A sweep's chapter of the results page, from its rows alone."""

from pathlib import Path

from contactbench.pipeline.durable import write_file
from contactbench.pipeline.study.pages import Results
from contactbench.pipeline.study.sweep.growth import is_noisy, plain, speed_table, tables, usual
from contactbench.pipeline.study.sweep.plan import SweepPlan
from contactbench.pipeline.study.sweep.run import faults_of

_SAID = {
    "speed-error.png": "Speed against error: mean of all answers against the median time from Python, for every method"
    " and mesh, touches within 45° (first and last are named). Dotted: the front; ringed: its knee.",
    "growth.png": "How time and error grow with the mesh, with the fitted exponents. Error: of the mesh alone, without"
    " noise, of sure answers on the right part of the probe.",
    "force.png": "Error against force, touches within 45°, with the bound that the sensor's noise sets. Where few"
    " answers are sure (little force), they are a selection that can lie below it.",
    "angle.png": "Error against the angle between force and normal, at a middle force, with the bound.",
    "Targets": "The bound is that of methods that know nothing of the local torque. Contactbench takes it for small (a"
    " standard deviation of 1 mm times the force) and can lie below the bound; the wrench axis takes it for zero, which"
    " with more force or torsion is the larger error. The axis' time here is that of one Embree ray,"
    " without the point, the other candidates and the reason that contactbench's includes.",
    "Steep touches, without noise": "The line of force of a steep touch often runs through another surface, too. Both"
    " then explain the wrench, and the answer is ambiguous: its point is on the surface that the force meets first. The"
    " wrench does not tell which is right.",
    "The local torque: solved for, or taken for zero": "Sure answers on the right part of the probe, up to 45 degrees,"
    " finest mesh. Below 1 a method is better than any without a bias can be: it knows something of the torque"
    " beforehand.",
}


def make(results: Results, folder: Path) -> str:
    """
    Write a sweep's pictures and return its chapter.

    Parameters
    ----------
    folder : Path
        For the pictures.

    Raises
    ------
    InputError
        The rows are not those of a sweep, or a picture cannot be written.
    """
    from contactbench.pipeline.study.sweep.plots import plots

    rows = list(results.rows)
    plan = SweepPlan.of(dict(results.about.get("plan", {})), "results")
    pictures = plots(rows)
    parts = [f"## Sweep: {plan.name}", _about(plan, len(rows))]
    for title, text in tables(rows):
        parts += [f"### {title}", text, *([_SAID[title]] if title in _SAID else [])]
    for name, data in pictures.items():
        write_file(folder / name, data)
        parts.append(f"![{name.removesuffix('.png')}]({name})\n\n{_SAID[name]}")
    noisy = [row for row in rows if is_noisy(row) and not row["failed"]]
    parts.append(
        f"<details><summary>Every method on every mesh</summary>\n\n{speed_table(usual(noisy or rows))}\n\n</details>"
    )
    for heading, items in (
        ("Left out", results.about.get("left_out", ())),
        ("Not computed", faults_of(rows)),
    ):
        parts += [f"{heading}:\n\n" + "\n".join(f"- {item}" for item in items)] if items else []
    return "\n\n".join(parts)


def _about(plan: SweepPlan, cells: int) -> str:
    def of(values: tuple[object, ...]) -> str:
        return ", ".join(f"{value:g}" if isinstance(value, float) else str(value) for value in values)

    return (
        f"{cells:,} cells of {plan.touches:,} touches each, seed {plan.seed}, spread over the whole probe above its"
        f" mount, none of it a region of priority."
        f" Methods {of(plan.methods)}; probes {of(tuple(map(plain, plan.probes)))}; facets {plan.facets[0]:,} to"
        f" {plan.facets[-1]:,}; forces {of(plan.forces)} N; angles {of(plan.angles)}°; torsion (standard deviation of"
        f" the torque about the normal over the force) {of(tuple(1e3 * x for x in plan.torsions))} mm; noise"
        f" {of(plan.noises)}; filters {of(plan.filters)}. Truth of a bundled probe is its exact surface, of a"
        " file the mesh in it."
    )
