"""What the reading does, so large that it can be read from a metre away."""

from PySide6.QtCore import QRect, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from contactbench.pipeline.calibration.stillness import StillState
from contactbench.widgets.messages import filled
from contactbench.widgets.theme import colours, draw_fitted, icon, is_dark, sized, smooth_painter

CAPTURED, ASKED = "captured", "asked"
_RING, _PEN, _ICON = 76, 8, 44  # px
# State -> icon, colour of the theme.
_LOOKS = {
    "idle": ("play", "muted"), "moving": ("moving", "muted"), "settling": ("settling", "accent"),
    "still": ("record", "accent"), ASKED: ("record", "accent"), CAPTURED: ("check", "good"),
    "bumped": ("warning", "warning"), "touched": ("touched", "warning"), "stale": ("cross", "stale"),
}  # fmt: skip


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
