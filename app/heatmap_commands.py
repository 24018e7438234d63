"""``contactbench heatmap view``, beside what :mod:`contactbench.pipeline.commands.heatmap` has."""

from pathlib import Path

import typer

from contactbench.app.commands import check_screen
from contactbench.pipeline.commands.heatmap import heatmap_app

__all__ = ["heatmap_app"]


@heatmap_app.command(example="heatmap view my-session", as_json=False)
def view(files: list[Path] | None = None, /) -> None:
    """Look at heatmaps in a window: play back, compare, read values, save pictures and films.

    Parameters
    ----------
    files : [FILES]...
        Recordings, contacts or sessions.
    """
    check_screen()
    from contactbench.app.application import prepared

    application = prepared()
    from contactbench.app.heatmap_viewer import run
    from contactbench.app.settings import WindowSettings
    from contactbench.app.translation import load
    from contactbench.widgets.theme import use_theme

    remembered = WindowSettings().now
    load(application, remembered.language)
    use_theme(remembered.theme)
    raise typer.Exit(run(list(files or ())))
