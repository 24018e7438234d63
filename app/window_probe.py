"""The session's probe in the scene, also on pages that have no other mesh to show."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.app.bench import Bench
    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.regions.region import Region


class SessionProbe(QObject):
    """Shows the newest probe of a session from its opening on, until a page shows one itself."""

    def open(self, bench: Bench) -> None:
        """Begin with a session: the scene is emptied, and shows its probe when it is read."""
        scene, folder, state = bench.scene, bench.desk.folder, bench.desk.state
        scene.show_field(None)
        scene.show_probe(None)
        found = state.newest("probe")
        if found is None:
            return

        def read(_progress: object, _cancelled: object) -> tuple[Probe, Sequence[Region]] | None:
            from contactbench.pipeline.mesh.sidecar import load_probe_file
            from contactbench.pipeline.session.recompute import inputs_of
            from contactbench.pipeline.verification.result import load_surface

            try:
                files = inputs_of(folder, state, {"probe": found.content})
                probe = load_surface(files["probe"])
                named = probe.region.any()
                return probe, load_probe_file(files["probe"]).regions.regions if named else ()
            except (InputError, OSError, LookupError):
                return None  # the page that needs it says why

        def came(found: tuple[Probe, Sequence[Region]] | None) -> None:
            if found is not None and scene.probe_layer.probe is None:
                scene.show_probe(found[0], regions=found[1])
                scene.look("fit")

        bench.jobs.start(self.tr("Loading probe"), read, came)
