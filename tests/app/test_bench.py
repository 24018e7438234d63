import pytest
from waiting import until

from contactbench.app.bench import Bench, Weight
from contactbench.pipeline.session import Session
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.desk import Desk


@pytest.fixture
def bench(qapp, tmp_path):  # noqa: ARG001 - for what it does
    made = Bench(Desk(Session.create(tmp_path / "s")), None)
    yield made
    made.close()


def test_what_is_done_with_the_session_is_told(qtbot, bench):
    with qtbot.waitSignal(bench.changed, timeout=10_000):
        bench.do("Writing", lambda session: session.set_parameter("devices.serial", "7"))
    assert bench.desk.state.settings["devices.serial"].value == "7"


def test_order_is_kept(qtbot, bench):
    done = []
    for number in range(20):
        bench.do(
            "Writing", lambda session, number=number: session.note(str(number)), lambda _: done.append(1)
        )
    qtbot.waitUntil(lambda: len(done) == 20, timeout=15_000)
    assert [note.text for note in bench.desk.state.notes] == [str(number) for number in range(20)]


def test_running_and_failed_steps(qtbot, bench):
    with qtbot.waitSignal(bench.changed):
        bench.set_running(Step.GRAVITY, going_on=True)
    with qtbot.assertNotEmitted(bench.changed):
        bench.set_running(Step.GRAVITY, going_on=True)
    with qtbot.waitSignal(bench.changed):
        bench.set_failed(Step.PROBE, "The mesh is open.")
    assert bench.failed == {Step.PROBE: "The mesh is open."}
    with qtbot.waitSignal(bench.over) as over:
        bench.set_running(Step.PROBE, going_on=True)
    assert (bench.failed, over.args) == ({}, ["The mesh is open."])


def test_messages(qtbot, bench):
    with qtbot.waitSignal(bench.told) as told:
        bench.tell(Weight.GOOD, "Done.", "details")
    assert (told.args[0].weight, told.args[0].text) == ("good", "Done.")


def test_a_finding_whose_rate_changes_stands_until_it_ends(bench):
    told, over = [], []
    bench.told.connect(lambda notice: told.append(notice.text))
    bench.over.connect(over.append)
    said = ()
    for now in (("The sensor sends 180 Hz.",), ("The sensor sends 179 Hz.",)):
        said = bench.tell_findings(said, now)
    assert (told, over) == (["The sensor sends 180 Hz."], [])
    bench.tell_findings(said, ())
    assert over == ["The sensor sends 180 Hz."], "as it was told, so that the status bar knows it"


def test_closing_stops_work_and_frees_the_session(bench, tmp_path):
    job = bench.jobs.start("Work", lambda _p, cancelled: until(cancelled))
    bench.close()
    assert job.cancelled()
    with Session.open(tmp_path / "s"):
        pass
