"""What takes long on the Regions page: finding the facets of a tool, and computing the probe again."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from contactbench.app.bench import Weight
from contactbench.app.undo import SessionCommand
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh.engines import Cancelled
from contactbench.pipeline.workbench.regions import Clear
from contactbench.pipeline.workbench.regions_session import apply
from contactbench.pipeline.workbench.steps import Step

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.jobs import Job
    from contactbench.app.pages.regions import RegionsPage
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.session.actions import Record
    from contactbench.pipeline.workbench.regions import Found, RegionsWork, Tool

    Progress = Callable[[float], None]
    Stop = Callable[[], bool]


class Doing(QObject):
    """
    One thing at a time, in a worker; meanwhile nothing is painted.

    Attributes
    ----------
    job : Job or None
        What is being done.
    """

    def __init__(self, page: RegionsPage) -> None:
        super().__init__(page)
        self._page = page
        self.job: Job | None = None
        self._planned: Tool | None = None

    def show_plan(self, tool: Tool | None) -> None:
        """Show what a box or plane would take, in words and half painted."""
        page = self._page
        work, before, self._planned = page.work, self._planned, tool
        if work is None or not page.shown or not (rank := page.panel.regions.rank):
            return
        if tool is None:
            if before is not None:
                page.bench.scene.paint(None, work.colours)
            return
        found = work.finder(tool, rank)()
        text = self.tr("Facets: {0:,}; area: {1:.2f} cm²").format(
            int(found.mask.sum()), 1e4 * work.area(found.mask)
        )
        page.panel.tools.show_plan(text)
        page.bench.scene.paint(None, work.planned(found))

    def use(self, tool: Tool, erase: bool = False) -> None:
        """Use a tool on the chosen region: look for its facets in a worker, then make it one step."""
        page = self._page
        work = page.work
        if work is None or self.job is not None:
            return
        work.abort()
        try:
            finder = work.finder(tool, page.panel.regions.rank)
        except InputError as error:
            page.bench.tell(Weight.WARNING, str(error))
            return
        if isinstance(tool, Clear):
            self._found(work, finder(), erase)
            return
        self.begin(
            self.tr("Finding the facets"),
            lambda *_: finder(),
            lambda found: self._found(work, found, erase),
        )

    def _found(self, work: RegionsWork, found: Found, erase: bool) -> None:
        page = self._page
        if work is not page.work:
            return
        if self._planned is not None:
            page.bench.scene.paint(None, work.colours)
        protect = page.panel.tools.protect.isChecked()
        try:
            text = work.give(found, protect=protect, erase=erase)
        except InputError as error:
            page.bench.tell(Weight.WARNING, str(error))
            return
        if found.sentence:
            page.bench.tell(Weight.INFO, found.sentence)
        page.push(text)
        if text is None:
            page.bench.tell(Weight.INFO, self.tr("Nothing changed: the region is like that already."))

    def apply(self) -> None:
        """Compute the probe again with these regions."""
        bench, desk = self._page.bench, self._page.bench.desk
        if self.job is not None:
            return
        self._page.keeper.keep_now()
        text = self.tr("give the probe its regions")

        def work(progress: Progress, cancelled: Stop) -> Callable[[Session], Record]:
            desk.do(lambda _session: None).result()  # what was just painted is in the session now
            return apply(desk, progress, cancelled)

        def recorded(_: object) -> None:
            bench.set_failed(Step.REGIONS, "")
            bench.tell(Weight.GOOD, self.tr("The probe has its regions now."))

        def wrong(error: BaseException) -> None:
            bench.set_failed(Step.REGIONS, str(error))
            bench.tell(Weight.ERROR, str(error))

        def computed(record: Callable[[Session], Record]) -> None:
            bench.undo.push(SessionCommand(bench, text, record, recorded, wrong))

        bench.set_running(Step.REGIONS, True)
        self.begin(self.tr("Giving the probe its regions"), work, computed, wrong)

    def begin(
        self,
        title: str,
        work: Callable[[Progress, Stop], object],
        done: Callable[..., None],
        wrong: Callable[[BaseException], None] | None = None,
    ) -> None:
        """Do something in a worker, during which nothing is painted; without `wrong`, an error is told."""
        page = self._page
        if self.job is not None:
            return

        def over() -> None:
            self.job = None
            page.bench.set_running(Step.REGIONS, False)
            page.use_tool()
            page.show_all()

        def finished(result: object) -> None:
            over()
            done(result)

        def failed(error: BaseException) -> None:
            over()
            if isinstance(error, Cancelled):
                return
            if wrong is not None:
                wrong(error)
            else:
                page.bench.tell(Weight.ERROR, str(error))

        page.stop_tool()
        self.job = page.bench.jobs.start(title, work, finished, failed)
        self.job.progressed.connect(page.panel.show_share)
        page.show_all()
