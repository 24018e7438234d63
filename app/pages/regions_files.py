"""Regions from and to files of their own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QCoreApplication

from contactbench.app.bench import Weight
from contactbench.pipeline.mesh.regions import RegionSet, load_regions, save_regions

if TYPE_CHECKING:
    from contactbench.app.pages.regions import RegionsPage


def read_regions(page: RegionsPage, file: Path) -> None:
    """Replace all regions by those of a file, as one step; names and colours stay where the file has none."""
    work = page.work
    if work is None:
        return

    def done(found: RegionSet) -> None:
        if work is not page.work:
            return
        regions = found
        if file.suffix.lower() == ".csv":
            regions = RegionSet.from_labels(found.labels, work.model.regions)
        page.edit(lambda model: model.replace_all(regions), 1)

    page.doing.begin(
        QCoreApplication.translate("RegionsPage", "Reading regions"),
        lambda *_: load_regions(file, work.probe),
        done,
    )


def write_regions(page: RegionsPage, file: Path) -> None:
    """Write all regions to a file."""
    work = page.work
    if work is None:
        return
    regions = work.model.snapshot()

    def done(_: object) -> None:
        page.bench.tell(
            Weight.GOOD,
            QCoreApplication.translate("RegionsPage", "The regions are written to {0}.").format(file),
        )

    page.doing.begin(
        QCoreApplication.translate("RegionsPage", "Writing regions"),
        lambda *_: save_regions(regions, work.probe, file),
        done,
    )
