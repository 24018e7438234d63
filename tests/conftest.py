"""What tests of windows need: a screen of their own, so that no other test's window takes the focus."""

import gc
import os
import pickle
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from native import locked

_screen = None
# As the command line does. Set before anything loads numpy.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Tests do the work that they look at, and leave nothing in the user's folder.
os.environ["CONTACTBENCH_CACHE"] = "off"
# Every worker and every program that tests start loads what an earlier one compiled; else each compiles all anew.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
# Benchmarks start processes of their own modules.
os.environ["PYTHONPATH"] = os.pathsep.join(
    (str(Path(__file__).parent), os.environ.get("PYTHONPATH", ""))
).rstrip(os.pathsep)


def pytest_configure(config):  # noqa: ARG001 - the hook's name
    """Start a screen for this process, where it has none or would share one with another worker."""
    global _screen
    # Whoever starts us in the background may have had Ctrl-C ignored, which the processes of tests would inherit.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    shared = "PYTEST_XDIST_WORKER" in os.environ
    if shutil.which("Xvfb") is None or (os.environ.get("DISPLAY") and not shared):
        return
    read, write = os.pipe()
    # The processor draws every pixel: a worker's windows are no larger than they usually are. Those of `packaging/run
    # windows`, which has no workers, are looked at in twice the scale, too.
    size = "1280x800x24" if shared else "2560x1440x24"
    _screen = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", size, "-nolisten", "tcp"],
        pass_fds=[write],
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    with os.fdopen(read) as numbers:
        number = numbers.readline().strip()
    if number:
        os.environ["DISPLAY"] = f":{number}"
        os.environ["QT_QPA_PLATFORM"] = "xcb"


def pytest_collection_modifyitems(items):
    """Begin with the files that take longest: what comes last is not shared among workers."""
    items.sort(key=lambda item: item.path.name not in {"test_docs.py", "test_shell.py", "test_verify.py"})


@pytest.fixture(autouse=True, scope="module")
def _frozen():
    """Take what is there before a file's tests for what stays: every later collection would walk through it."""
    gc.collect()
    gc.freeze()


def pytest_unconfigure(config):  # noqa: ARG001 - the hook's name
    """Take it down again, and let the interpreter's last collection come to what was frozen: the kernel counts it."""
    gc.unfreeze()
    if _screen is not None:
        _screen.terminate()
        _screen.wait(10)


@pytest.fixture(autouse=True)
def _as_it_was():
    """Give every test of windows an application without a theme or language that another one chose."""
    yield
    widgets = sys.modules.get("PySide6.QtWidgets")
    application = widgets and widgets.QApplication.instance()
    if not application:
        return
    from PySide6.QtCore import QCoreApplication, QEvent, QTranslator
    from PySide6.QtGui import QPalette

    for translator in application.findChildren(QTranslator):
        application.removeTranslator(translator)
    application.setProperty("sheet", None)
    application.setPalette(QPalette())
    # What is to be deleted later is deleted by the next event loop: after the last test there is none.
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


@pytest.fixture(scope="session")
def once(tmp_path_factory):
    """Have a folder filled once for all workers of a run, by whoever asks first; return it, and what that gave."""
    base = tmp_path_factory.getbasetemp()
    base = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "once"

    def made(name, make):
        folder, told = base / name, base / f"{name}.pickle"
        folder.mkdir(parents=True, exist_ok=True)
        with locked(base / f"{name}.lock"):
            if not told.exists():
                told.write_bytes(pickle.dumps(make(folder)))
        return folder, pickle.loads(told.read_bytes())  # noqa: S301 - our own

    return made


@pytest.fixture(scope="session")
def prepare_once(once):
    """Prepare a bundled probe as the demo does, but only once: it gives the same every time."""
    from contactbench.pipeline.demo import housing

    prepare = housing.prepare_probe

    def copy(folder, name):
        made, result = once(f"{name}-{housing._CAD_FACETS}", lambda made: prepare(made, name))
        shutil.copytree(made, folder, dirs_exist_ok=True)
        return result

    return copy


@pytest.fixture(scope="session")
def tutorial(once):
    """The tutorial's sample data, of seed 2; not to be changed."""
    pytest.importorskip("mujoco", reason="the virtual bench needs MuJoCo (extra sim)")
    from contactbench.pipeline.demo.tutorial import write_tutorial

    return once("tutorial", lambda folder: write_tutorial(folder / "sample", seed=2))[1]


@pytest.fixture(scope="session")
def calibrated(once):
    """A session with a calibration and a probe; everybody gets a copy."""
    from workbench.touch_session import make_session

    return once("calibrated", lambda folder: make_session(folder / "s", folder))[1]


@pytest.fixture(scope="session")
def sessions(once, calibrated):
    """Two sessions: one that is calibrated, one that is verified, too; to be copied like the first."""
    from workbench.touch_session import verify

    def make(folder):
        shutil.copytree(calibrated, folder / "calibrated")
        verify(shutil.copytree(calibrated, folder / "verified"))

    return once("sessions", make)[0]


@pytest.fixture(scope="session")
def to_paint(once):
    """A session with a probe to paint on; to be copied."""
    from workbench.region_sessions import make_session

    return once("regions", make_session)[1]


@pytest.fixture(scope="session")
def bundle(once):
    """A bundle that moves a robot."""
    from benchmarks.bundle_example import example_config

    folder, _ = once("bundle", lambda made: example_config(500, rate=200.0).write(made / "runtime.zip"))
    return folder / "runtime.zip"


@pytest.fixture(scope="session")
def elfin():
    """The arm of the paper."""
    pytest.importorskip("mujoco")
    from contactbench.pipeline.robot import Robot

    return Robot.named("elfin3")


@pytest.fixture
def rng():
    import numpy as np

    return np.random.default_rng(0)
