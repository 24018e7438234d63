"""What the Verify page shows in the scene: markers, the contact, where it was touched, and how far that was off."""

import time
from typing import Any

import numpy as np

from contactbench.app.bench import Bench
from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.heatmap.heatmap import default_bandwidth, heatmap
from contactbench.pipeline.heatmap.subdivide import drawing_of
from contactbench.pipeline.kernel import Contact, Reason
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import Region
from contactbench.pipeline.verification.figures import Verification
from contactbench.pipeline.workbench.live import LiveReading
from contactbench.pipeline.workbench.markers import Markers
from contactbench.pipeline.workbench.verify import VerifyOutcome
from contactbench.pipeline.workbench.verify_touches import TouchView
from contactbench.widgets.numbers import filled
from contactbench.widgets.scene import TouchErrors

_EVERY_S = 0.5
_MOST_CONTACTS = 4_000
_LEAST_N = 1.0
_SHOWN = {"skipped": "open"}  # the scene knows open, done and failed


def firm_contact(reading: LiveReading | None) -> Contact | None:
    """Return the contact of a press that is firm enough to be shown; None: there is none."""
    # A hand that lets go: the ellipse of so little force is larger than the probe, and says nothing.
    light = reading is None or not float(np.linalg.norm(reading.compensated[:3])) >= _LEAST_N
    return None if reading is None or light else reading.contact


def millimetres_within(contact: Contact) -> float:
    """Return how far the 95 % ellipse of a contact reaches, mm, at least a tenth."""
    return max(1e3 * contact.within, 0.1)


class VerifyScene:
    """Draws for one page; nothing while that is not shown."""

    def __init__(self, bench: Bench) -> None:
        self._bench, self._scene = bench, bench.scene
        self.probe: Probe | None = None
        self.heat = False
        self.outcome: VerifyOutcome | None = None
        self.regions: tuple[Region, ...] = ()
        self._shown: Any = None
        self._points: list[np.ndarray[Any, Any]] = []
        self._sigmas: list[float] = []
        self._counted, self._drawn_at, self._busy = 0, 0.0, False
        self._contact: Any = None

    def begin(self, title: str) -> None:
        """Show all of it anew; `title` is what the job of drawing heat is called."""
        self._title, self._shown, self._contact = title, None, None
        if self.probe is not None:
            self._scene.show_probe(self.probe, regions=self.regions)
        self._scene.set_tool("turn")

    def end(self) -> None:
        """Take it all away."""
        none = np.zeros((0, 3))
        self._scene.show_markers(none)
        self._scene.show_errors(None)
        self._scene.show_contact(None)
        self._scene.show_force(None)
        self._scene.show_field(None)
        self._scene.set_tool("turn")

    # ---- markers -----------------------------------------------------------------------------

    def show_markers(self, markers: Markers, view: TouchView | None) -> None:
        """Show markers, and how far they are, or what the last verification found; only if something changed."""
        outcome = self.outcome if view is None else None
        content = (markers, None if view is None else (view.rows, view.next_one, view.accepted), outcome)
        if content == self._shown:
            return
        self._shown = content
        points = np.array([each.point_S for each in markers.all]).reshape(-1, 3)
        if view is not None:
            states = tuple(_SHOWN.get(row.state, row.state) for row in view.rows)
            self._scene.show_markers(points, markers.names, states, view.next_one)
            self._scene.show_errors(_live(view))
        elif outcome is None or outcome.stale:
            self._scene.show_markers(points, markers.names, ("open",) * len(markers))
            self._scene.show_errors(None)
        else:
            self._show_found(outcome.found, markers, points)

    def _show_found(self, found: Verification, markers: Markers, points: np.ndarray[Any, Any]) -> None:
        """Show where touches were located, and markers in the colour of their largest error."""
        touches = located(found)
        self._scene.show_errors(touches)
        judged = {each.name: each for each in found.per_marker}
        worst = _worst(found)
        names, states, tints = [], [], []
        scale = ColourScale(0.0 if touches is None else 1e3 * touches.top)
        for name in markers.names:
            each = judged.get(name)
            names.append(name if each is None else filled("{}  {:.2f} mm", name, each.max_mm))
            states.append(
                "open" if each is None else "failed" if each.max_mm > 1e3 * found.limits.max_m else "done"
            )
            shade = scale.colours(np.array([0.0 if each is None else each.max_mm]))[0]
            tints.append("" if each is None else "#" + bytes(np.rint(255 * shade).astype(np.uint8)).hex())
        place = markers.names.index(worst) if worst in markers.names else None
        self._scene.show_markers(points, names, states, None, tints, place)

    def show_worst(self) -> None:
        """Turn the view so that the marker with the largest error is seen."""
        outcome = self.outcome
        worst = None if outcome is None else _worst(outcome.found)
        if outcome is None or worst is None:
            return
        touch = max(
            (each for each in outcome.found.touches if each.accepted and each.marker == worst),
            key=lambda each: each.distance_mm or 0.0,
        )
        if touch.point_mm is not None and touch.error_mm is not None:
            self._scene.bring_into_view(1e-3 * (np.array(touch.point_mm) - touch.error_mm))

    # ---- the contact -------------------------------------------------------------------------

    def show_reading(self, reading: LiveReading | None, captions: tuple[str, str] = ("", "")) -> None:
        """
        Show the contact and the force now.

        Parameters
        ----------
        reading : LiveReading or None
        captions : (str, str)
            What is written beside the second place, if there is one: in sight, and behind the probe.
        """
        contact = firm_contact(reading)
        if contact is None or contact.point is None or reading is None:
            if self._contact is not None:
                self._contact = None
                self._scene.show_contact(None)
                self._scene.show_force(None)
            return
        self._contact = contact
        two = contact.reason is Reason.TWO_TOUCHES  # the force is that of both: it acts at neither
        covariance = None if two else contact.covariance
        sure = "" if two else filled("≤ {:.1f} mm", millimetres_within(contact))
        if contact.reason is Reason.AMBIGUOUS:
            sure = filled("{:.0f} %", 100 * contact.confidence)
        self._scene.show_contact(contact.point, covariance, contact.normal, _others(contact), captions, sure)
        self._scene.show_force(None if two else reading.compensated[:3], contact.point)
        if contact.accepted and len(self._points) < _MOST_CONTACTS:
            self._points.append(np.asarray(contact.point))
            self._sigmas.append(float(contact.sigma_max))

    # ---- heat --------------------------------------------------------------------------------

    def forget_contacts(self) -> None:
        """Begin anew with where it was touched."""
        self._points, self._sigmas, self._counted = [], [], 0
        self._scene.show_field(None)

    def show_heat(self, wanted: bool) -> None:
        """Colour the probe by contacts, or not."""
        self.heat, self._counted = wanted, 0
        if not wanted:
            self._scene.show_field(None)

    def tick(self) -> None:
        """Bring the heat up to date, twice a second at most, in a worker."""
        probe, count = self.probe, len(self._points)
        if not self.heat or self._busy or probe is None or count == self._counted or not count:
            return
        if time.monotonic() < self._drawn_at + _EVERY_S:
            return
        self._busy, self._counted, self._drawn_at = True, count, time.monotonic()
        points, width = np.array(self._points), default_bandwidth(self._sigmas)

        def work(_progress: object, _cancelled: object) -> Any:
            try:
                return heatmap(drawing_of(probe), points, bandwidth=width, counted="samples")
            except InputError:  # a bandwidth that does not suit a tiny probe: no colours then
                return None

        self._bench.jobs.start(self._title, work, self._drawn, self._not_drawn)

    def _drawn(self, found: Any) -> None:
        self._busy = False
        if found is not None and self.heat:
            title = f"{found.title} [{found.unit}]"
            self._scene.show_field(found.values, title, found.scale, on=found.probe)

    def _not_drawn(self, error: BaseException) -> None:
        self._busy = self.heat = False
        self._bench.jobs.failed.emit(None, error)


def located(found: Verification) -> TouchErrors | None:
    """Return the accepted touches of a verification, and where the rejected ones could be as well; None: no touch."""
    used = [each for each in found.touches if each.accepted and each.point_mm and each.error_mm]
    if not used:
        return None
    points = 1e-3 * np.array([each.point_mm for each in used])
    upper = np.array([each.covariance_mm2 or (np.nan,) * 6 for each in used])
    covariances = 1e-6 * upper[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    rivals = [place for each in found.touches for place in each.rivals_mm]
    return TouchErrors(
        points - 1e-3 * np.array([each.error_mm for each in used]),
        points,
        covariances,
        1e-3 * np.array(rivals).reshape(-1, 3),
    )


def _live(view: TouchView) -> TouchErrors | None:
    return TouchErrors(*map(np.array, zip(*view.contacts, strict=True))) if view.contacts else None


def _worst(found: Verification) -> str | None:
    """Return the name of the marker with the largest error; None: no touch was accepted."""
    return max(found.per_marker, key=lambda each: each.max_mm).name if found.per_marker else None


def _others(contact: Contact) -> np.ndarray[Any, Any] | None:
    """Return where it could be as well, the likeliest first, or where the second touch is; (k, 3), S, m."""
    if contact.reason is Reason.TWO_TOUCHES and contact.second is not None:
        return np.asarray(contact.second).reshape(1, 3)
    if contact.reason not in (Reason.AMBIGUOUS, Reason.BY_REGION) or not contact.candidates:
        return None
    return np.array([each.point for each in contact.candidates])
