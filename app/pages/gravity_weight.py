"""The known weight of the gravity page: mass, a reading without it, a reading with it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtWidgets import QLineEdit, QWidget

from contactbench.app.pages.known_check import KnownCheckPanel
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.verification.known_check import WEIGHT
from contactbench.pipeline.workbench.known_checks import StillReading
from contactbench.widgets.controls import accent, form, named, push_button, sentence_label
from contactbench.widgets.numbers import NumberBox

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contactbench.app.bench import Bench

_HUNG_S, _OFF_S = 30.0, 0.01  # on the virtual bench


class WeightPanel(KnownCheckPanel):
    """Hang a known weight on the tool: mass, a reading without it, a reading with it."""

    kind = WEIGHT

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, "", parent)
        self.setTitle(self.tr("Known weight"))
        self.unloaded = ""
        intro = sentence_label(
            self.tr(
                "Hang a known mass on the tool. This reveals wrong sensor units, signs or scale, which"
                " poses alone cannot show."
            )
        )
        self.mass = NumberBox(decimals=3, minimum=0.001, maximum=500.0, value=1.0, suffix=" kg")
        self.sigma = NumberBox(decimals=2, minimum=0.0, maximum=10_000.0, value=0.5, suffix=" g")
        self.certificate = QLineEdit(maxLength=200)
        self.certificate.setPlaceholderText(self.tr("Number (optional)"))
        rows = form()
        for text, field, tip in (
            (self.tr("Mass"), self.mass, ""),
            (self.tr("Uncertainty (1 sigma)"), self.sigma, ""),
            (self.tr("Certificate"), self.certificate, self.certificate.placeholderText()),
        ):
            rows.addRow(text, named(field, text, tip=tip))
        self.first = push_button(self.tr("1. Read without weight"), self._read_unloaded, "play")
        self.second = push_button(self.tr("2. Read with weight"), self._read_loaded, "play")
        self.lay_out(intro, rows, self.first, self.second)

    def _read_unloaded(self) -> None:
        self.unloaded = ""
        self.hint.setText(self.tr("Remove everything from the tool and hold it still."))

        def read(name: str) -> None:
            self.unloaded = name
            self.hint.setText(
                self.tr("Done. Hang the weight on the tool, wait until it is at rest, then press 2.")
            )

        self.take(StillReading(), read)

    def _read_loaded(self) -> None:
        bench, reading = self.bench.live.bench, self.bench.live.reading()
        if bench is not None and reading is not None and np.isfinite(reading.R_WS).all():
            down = (
                STANDARD_GRAVITY * self.mass.value() * (reading.R_WS.T @ [0.0, 0.0, -1.0])
            )  # the virtual bench is upright
            bench.bump(down.tolist(), _HUNG_S)
        self.hint.setText(self.tr("Wait until the weight is at rest."))
        given = {
            "mass": self.mass.value(),
            "mass_sigma": self.sigma.value() / 1000,
            "certificate": self.certificate.text().strip(),
        }

        def read(name: str) -> None:
            unloaded, self.unloaded = self.unloaded, ""
            if bench is not None:
                bench.bump([0.0, 0.0, 0.0], _OFF_S)
            self.hint.setText("")
            self.judge({"unloaded": unloaded, "loaded": name}, given)

        self.take(StillReading(), read)

    def show_parameters(self, parameters: Mapping[str, Any]) -> None:
        """Show mass and certificate of the check that there is."""
        if self.unloaded or self.busy:  # another weight is just being typed in
            return
        self.mass.setValue(float(parameters.get("mass", self.mass.value())))
        self.sigma.setValue(1000 * float(parameters.get("mass_sigma", 0.0)))
        self.certificate.setText(str(parameters.get("certificate", "")))

    def allow(self) -> None:
        """Say which buttons do something now."""
        super().allow()
        free = not self.busy
        self.first.setEnabled(free)
        self.second.setEnabled(free and bool(self.unloaded))
        for field in (self.mass, self.sigma, self.certificate):
            field.setEnabled(free)
        accent(self.second, free and bool(self.unloaded), "play")
