"""Which ways gravity has pulled, as poses on the sphere of directions in the sensor, and what the reading does."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QBrush, QColor, QHelpEvent, QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from contactbench.pipeline.calibration.stillness import StillState
from contactbench.pipeline.workbench.gravity_fit import PoseRow, PoseState
from contactbench.widgets.messages import filled, translated
from contactbench.widgets.theme import Colours, colours, draw_fitted, icon, is_dark, sized, smooth_painter

CAPTURED, ASKED = "captured", "asked"
_RING, _PEN, _ICON = 76, 8, 44  # px
# State -> icon, colour of the theme.
_LOOKS = {
    "idle": ("play", "muted"), "moving": ("moving", "muted"), "settling": ("settling", "accent"),
    "still": ("record", "accent"), ASKED: ("record", "accent"), CAPTURED: ("check", "good"),
    "bumped": ("warning", "warning"), "touched": ("touched", "warning"), "stale": ("cross", "stale"),
}  # fmt: skip
_DOT = 6.0  # px
_NEAR_PX = 12.0  # px
_PULSE = 30  # ticks of the window: a second


class Place(NamedTuple):
    """A direction on the discs: which of them, and where, in radii from its middle."""

    front: bool
    x: float
    y: float


def place(down_S: NDArray[np.float64]) -> Place:
    """
    Return where a direction is drawn: Lambert's azimuthal equal-area projection of each half of the sphere.

    Equal areas on the discs are equal shares of all directions, so that a gap is as large as it looks.

    Parameters
    ----------
    down_S : (3,)
        Where gravity pulls to, S; of length 1. +z is the middle of the front disc, -z that of the back.
    """
    x, y, z = map(float, down_S)
    front = z >= 0
    stretch = np.sqrt(1 / (1 + abs(z)))
    return Place(front, x * stretch, y * stretch)


@dataclass(frozen=True)
class _Disc:
    middle: QPointF
    radius: float

    def at(self, spot: Place) -> QPointF:
        return QPointF(self.middle.x() + self.radius * spot.x, self.middle.y() - self.radius * spot.y)


class Coverage(QWidget):
    """
    Two discs: gravity towards the sensor's +z side (the tool's), and towards its -z side.

    Taken poses are filled, those left out hollow, rejected ones crosses, the next one a pulsing ring, the present
    direction a dot with a line to the middle; what cannot be reached is hatched.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(self.tr("Coverage of gravity directions"))
        self._rows: tuple[PoseRow, ...] = ()
        self._next: NDArray[np.float64] | None = None
        self._now: NDArray[np.float64] | None = None
        self._tilt = 180.0
        self._down_W = np.array([0.0, 0.0, -1.0])
        self._beat = 0

    def sizeHint(self) -> QSize:
        """Return a size that fits the panel."""
        return QSize(330, 186)

    def minimumSizeHint(self) -> QSize:
        """Return the least that can be read."""
        return QSize(260, 170)

    # ---- what it shows -----------------------------------------------------------------------------

    def show_poses(
        self,
        rows: tuple[PoseRow, ...],
        suggested: NDArray[np.float64] | None,
        max_tilt: float = 180.0,
        down_W: tuple[float, float, float] = (0.0, 0.0, -1.0),
    ) -> None:
        """Show poses, the orientation R_WS (3, 3) to take next, and the largest tilt that can be reached, degrees.

        `down_W` is where gravity points in W.
        """
        self._down_W = np.array(down_W) / max(float(np.linalg.norm(down_W)), 1e-12)
        self._rows = tuple(row for row in rows if row.R_WS is not None)
        self._next, self._tilt = suggested, max_tilt
        counts = {state: sum(row.state is state for row in self._rows) for state in PoseState}
        self.setAccessibleDescription(
            self.tr("Poses: {taken} captured, {left} left out, {rejected} rejected").format(
                taken=counts[PoseState.TAKEN],
                left=counts[PoseState.LEFT_OUT],
                rejected=counts[PoseState.REJECTED],
            )
        )
        self.update()

    def show_now(self, R_WS: NDArray[np.float64] | None) -> None:
        """Show how the sensor stands, and let the ring pulse; called at each tick."""
        self._beat = (self._beat + 1) % _PULSE
        if R_WS is None and self._now is None and self._next is None:
            return
        moved = R_WS is None or self._now is None or np.abs(R_WS - self._now).max() > 1e-3
        if moved or (self._next is not None and self._beat % 3 == 0):
            self._now = R_WS
            self.update()

    def spot_of(self, row: PoseRow) -> QPointF:
        """Return where a pose is drawn, px."""
        assert row.R_WS is not None  # noqa: S101 - those without are not shown
        spot = place(self._down_W @ row.R_WS)
        return self._disc(front=spot.front).at(spot)

    # ---- drawing -----------------------------------------------------------------------------------

    def _disc(self, *, front: bool) -> _Disc:
        radius = min(self.width() / 4 - 12, (self.height() - 40) / 2)
        x = self.width() * (0.25 if front else 0.75)
        return _Disc(QPointF(x, 6 + radius), radius)

    def paintEvent(self, _: QPaintEvent) -> None:
        """Draw it."""
        c = colours(is_dark())
        painter = smooth_painter(self)
        for front in (True, False):
            self._draw_disc(painter, self._disc(front=front), c, front=front)
        for row in self._rows:
            self._draw_pose(painter, self.spot_of(row), row.state, c)
        if self._next is not None:
            spot = place(self._down_W @ self._next)
            swell = 2.0 + 3.0 * abs(self._beat / _PULSE * 2 - 1)
            painter.setPen(QPen(QColor(c.accent), 3))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(self._disc(front=spot.front).at(spot), _DOT + swell, _DOT + swell)
        if self._now is not None:
            self._draw_now(painter, self._now, c)
        painter.end()

    def _draw_disc(self, painter: QPainter, disc: _Disc, c: Colours, *, front: bool) -> None:
        rim = QRectF(
            disc.middle.x() - disc.radius, disc.middle.y() - disc.radius, 2 * disc.radius, 2 * disc.radius
        )
        painter.setPen(QPen(QColor(c.line), 1.5))
        painter.setBrush(QColor(c.panel))
        painter.drawEllipse(rim)
        self._hatch(painter, disc, rim, c, front=front)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(c.line), 1, Qt.PenStyle.DotLine))
        for degrees in (30.0, 60.0):
            reach = disc.radius * np.sqrt(1 - np.cos(np.radians(degrees)))
            painter.drawEllipse(disc.middle, reach, reach)
        painter.setFont(sized(self.font(), 10))
        painter.setPen(QColor(c.muted))
        name = self.tr("gravity towards the tool (+z)") if front else self.tr("away from the tool (-z)")
        below = QRectF(disc.middle.x() - self.width() / 4, rim.bottom() + 4, self.width() / 2, 24)
        painter.drawText(below, Qt.AlignmentFlag.AlignHCenter, name)

    def _hatch(self, painter: QPainter, disc: _Disc, rim: QRectF, c: Colours, *, front: bool) -> None:
        """Hatch what the largest tilt keeps away: directions too far from the sensor's z axis."""
        if self._tilt >= 180:
            return
        part = self._tilt if front else 180 - self._tilt
        edge = disc.radius * float(np.sqrt(1 - np.cos(np.radians(min(part, 90.0)))))
        circle, path = QPainterPath(), QPainterPath()
        circle.addEllipse(disc.middle, edge, edge)
        path.addEllipse(rim)
        if front:
            path = path.subtracted(circle) if self._tilt < 90 else QPainterPath()
        elif self._tilt > 90:
            path = circle
        painter.fillPath(path, QBrush(QColor(c.stale), Qt.BrushStyle.BDiagPattern))

    def _draw_pose(self, painter: QPainter, at: QPointF, state: PoseState, c: Colours) -> None:
        if state is PoseState.REJECTED:
            painter.setPen(QPen(QColor(c.bad), 3))
            d = _DOT - 1
            painter.drawLine(at - QPointF(d, d), at + QPointF(d, d))
            painter.drawLine(at - QPointF(d, -d), at + QPointF(d, -d))
            return
        taken = state is PoseState.TAKEN
        painter.setPen(QPen(QColor(c.good if taken else c.muted), 2))
        painter.setBrush(QColor(c.good) if taken else QBrush(Qt.BrushStyle.NoBrush))
        painter.drawEllipse(at, _DOT, _DOT)

    def _draw_now(self, painter: QPainter, R_WS: NDArray[np.float64], c: Colours) -> None:
        spot = place(self._down_W @ R_WS)
        disc = self._disc(front=spot.front)
        painter.setPen(QPen(QColor(c.text), 1))
        painter.drawLine(disc.middle, disc.at(spot))
        painter.setPen(QPen(QColor(c.panel), 1.5))
        painter.setBrush(QColor(c.text))
        painter.drawEllipse(disc.at(spot), 4.5, 4.5)

    def event(self, event: QEvent) -> bool:
        """Say in a tool tip which pose is under the mouse."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            text = self._under(QPointF(event.pos()))
            QToolTip.showText(event.globalPos(), text, self)
            return True
        return super().event(event)

    def _under(self, at: QPointF) -> str:
        for row in self._rows:
            away = self.spot_of(row) - at
            if away.x() ** 2 + away.y() ** 2 < _NEAR_PX**2:
                return f"{translated(row.name)}: {translated(row.words)}. {translated(row.reason)}".strip()
        return self.tr(
            "Gravity directions in the sensor frame. Filled: captured; hollow: left out; cross: rejected;"
            " ring: next pose; dark dot: now. Well-spread poses give the best calibration."
        )


class CaptureState(QWidget):
    """
    An icon in a ring, a word, and a line below it; the ring fills while a pose is averaged.

    It never takes the meaning from the colour alone: each state has its own shape and word.

    Attributes
    ----------
    word, line : str
        What it says, and says below.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMinimumHeight(_RING + 24)
        self._shape, self.word, self.line, self._share = "idle", "", "", 0.0
        self.show_idle()

    def show_idle(self) -> None:
        """Show that nothing is going on."""
        self._show("idle", self.tr("not started"), "", 0.0)

    def show_state(
        self,
        state: StillState,
        *,
        seconds: float | None = None,
        share: float = 0.0,
        captured: bool = False,
        by_key: bool = False,
        wanted: bool = False,
    ) -> None:
        """
        Show what the reading does.

        Parameters
        ----------
        state : StillState
        seconds : float, optional
            Until it is still.
        share : float
            Of the averaging that is done, 0 to 1.
        captured : bool
            The pose has been captured.
        by_key, wanted : bool
            Captures are asked for by a key, and this one was.
        """
        if captured and state is StillState.STILL:
            self._show(CAPTURED, self.tr("captured"), self.tr("Turn the tool to the next pose."), 1.0)
            return
        if state is StillState.STILL and by_key and not wanted:
            self._show(
                ASKED, self.tr("still: press SPACE"), self.tr("Press SPACE to capture this pose."), share
            )
            return
        words = {
            StillState.MOVING: (self.tr("moving"), self.tr("Hold the tool still.")),
            StillState.SETTLING: (self.tr("settling"), self.tr("Keep still.")),
            StillState.STILL: (self.tr("still"), self.tr("Keep still: averaging.")),
            StillState.BUMPED: (self.tr("bumped"), self.tr("Keep still: capture restarts automatically.")),
            StillState.TOUCHED: (self.tr("touched"), self.tr("Remove whatever is touching the tool.")),
            StillState.STALE: (self.tr("no samples"), self.tr("The devices are not sending data.")),
        }
        word, line = words[state]
        if state is StillState.SETTLING and seconds is not None:
            word = filled(self.tr("settling {seconds:.1f} s"), seconds=seconds)
        self._show(state.value, word, line, share if state is StillState.STILL else 0.0)

    def _show(self, shape: str, word: str, line: str, share: float) -> None:
        if (shape, word, line, share) == (self._shape, self.word, self.line, self._share):
            return
        if word != self.word:
            self.setAccessibleName(word)
            self.setAccessibleDescription(line)
        self._shape, self.word, self.line, self._share = shape, word, line, share
        self.update()

    @property
    def role(self) -> str:
        """Name of the theme's colour for the state."""
        return _LOOKS[self._shape][1]

    @property
    def share(self) -> float:
        """How much of the averaging is done, 0 to 1."""
        return self._share

    def sizeHint(self) -> QSize:
        """Return a size that fits the panel."""
        return QSize(320, _RING + 24)

    # ---- drawing -----------------------------------------------------------------------------------

    def paintEvent(self, _: QPaintEvent) -> None:
        """Draw it."""
        c = colours(is_dark())
        tint = QColor(getattr(c, self.role))
        painter = smooth_painter(self)
        ring = QRectF(_PEN, (self.height() - _RING) / 2, _RING, _RING)
        painter.setPen(QPen(QColor(c.line), _PEN))
        painter.drawEllipse(ring)
        painter.setPen(QPen(tint, _PEN, c=Qt.PenCapStyle.FlatCap))
        painter.drawArc(ring, 90 * 16, -int(360 * 16 * self._share))
        inside = QRect(0, 0, _ICON, _ICON)
        inside.moveCenter(ring.center().toPoint())
        icon(*_LOOKS[self._shape]).paint(painter, inside)
        left = ring.right() + 20
        self._words(painter, QRectF(left, 0, self.width() - left, self.height()), tint, QColor(c.text))
        painter.end()

    def _words(self, painter: QPainter, room: QRectF, tint: QColor, text: QColor) -> None:
        painter.setPen(tint)
        half = room.height() / 2
        top = QRectF(room.left(), 0, room.width(), half + 6)
        draw_fitted(painter, top, self.word, 24, 8, Qt.AlignmentFlag.AlignBottom, bold=True)
        painter.setFont(sized(self.font(), 10.5))
        painter.setPen(text)
        below = QRectF(room.left(), half + 10, room.width(), half - 10)
        painter.drawText(below, Qt.TextFlag.TextWordWrap, self.line)
