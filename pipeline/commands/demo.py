"""``contactbench demo`` and ``tutorial``: the main job on bundled probes, and sample data to do it with by hand."""

from pathlib import Path

from contactbench.pipeline.console import Noun, answer, as_json, say

demo_app = Noun()
tutorial_app = Noun()


@demo_app.command(example="demo --out my-demo")
def demo(
    out: Path = Path("contactbench-demo"), probe: str = "all", touches: int = 1_000, seed: int = 0
) -> None:
    """Calibrate, prepare, press markers on a virtual bench, locate, and check against the known truth.

    Needs no hardware and no files. Writes recordings, meshes, contacts, reports, a runtime bundle, a
    table of errors and a picture. Exit code 1: the errors are larger than noise explains, a verification
    failed, or a bundle was refused.

    Parameters
    ----------
    out : DIR
        Folder to write.
    probe : linear|convex|t-shape|all
        Probe to use.
    touches
        Random touches per probe, at least 10.
    seed
        Seed: the same seed gives the same CSV files.
    """
    from rich.console import Console

    from contactbench.pipeline.demo import PROBE_NAMES, run

    names = PROBE_NAMES if probe == "all" else (probe,)
    report = run(out, names, touches, seed, say)
    Console(stderr=as_json()).print(report.table())
    for sentence in report.sentences():
        say(sentence, "red" if "FAILED" in sentence else "")
    answer(report.to_json(), good=report.verified)


@tutorial_app.command(example="tutorial my-first-probe")
def tutorial(folder: Path, /, seed: int = 0) -> None:
    """Write sample data for the tutorials: poses, recordings, a housing, touches, markers, and the truth.

    Simulated on the virtual bench, in seconds; README.md in the folder says what each file is.

    Parameters
    ----------
    folder : DIR
        Folder to write, new or empty.
    seed
        Of chance: the same seed gives the same bytes.
    """
    from contactbench.pipeline.demo.tutorial import write_tutorial

    data = write_tutorial(folder, seed, say)
    say(
        f"{folder}: {len(data.files)} files; README.md says what they are. Go there with: cd {folder}",
        "green",
    )
    answer({"out": str(folder), "files": list(data.files), "place": data.place, "bumped": list(data.bumped)})
