"""Modules of ours are started the right way, as a package and as the application."""

import io
import subprocess
import sys
from pathlib import Path

import pytest

from contactbench.pipeline import installation
from contactbench.pipeline.installation import (
    MODULES,
    component_folders,
    module_command,
    remedy,
    run_asked_module,
)
from contactbench.pipeline.mesh.engines import child, worker

SOURCES = [*Path(installation.__file__).resolve().parent.rglob("*.py")]
SOURCES += [*Path(installation.__file__).resolve().parents[1].joinpath("app").rglob("*.py")]


@pytest.fixture
def application(monkeypatch, tmp_path):
    """Be the application, in a folder."""
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    monkeypatch.setattr(sys, "executable", str(tmp_path / "contactbench"))
    return tmp_path


@pytest.mark.parametrize("module", MODULES)
def test_a_package_asks_its_interpreter(module):
    command = module_command(module, "a", "b")
    assert command == [sys.executable, "-P", "-m", module, "a", "b"]


def test_the_application_asks_itself(application):
    command = module_command("contactbench.pipeline.cli", "--version")
    assert command[0] == str(application / "contactbench")
    assert "-m" not in command


@pytest.mark.usefixtures("application")
def test_the_application_runs_what_it_was_asked_for(monkeypatch, capsys):
    words = module_command("contactbench.pipeline.cli", "--version")
    monkeypatch.setattr(sys, "argv", words)
    monkeypatch.delitem(sys.modules, "contactbench.pipeline.cli", raising=False)  # else runpy warns
    with pytest.raises(SystemExit) as ended:
        run_asked_module(words)
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith("contactbench ")
    assert sys.argv[1:] == ["--version"]


@pytest.mark.parametrize(
    "words", [["contactbench"], ["contactbench", "gui"], ["contactbench", "--run-module", "os"]]
)
def test_what_is_no_module_of_ours_is_a_command(words):
    assert not run_asked_module(words)


def test_a_module_that_the_application_could_not_run_is_refused():
    with pytest.raises(ValueError, match="MODULES"):
        module_command("contactbench.app.translation")


@pytest.mark.parametrize("module", MODULES)
def test_every_such_module_can_be_run(module):
    code = f"import importlib.util; assert importlib.util.find_spec({module!r})"
    subprocess.run([sys.executable, "-c", code], check=True)
    text = Path(
        next(s for s in SOURCES if s.as_posix().endswith(module[13:].replace(".", "/") + ".py"))
    ).read_text()
    assert 'if __name__ == "__main__":' in text


def test_nothing_else_starts_an_interpreter():
    """In the application `sys.executable -m` would open a second window."""
    found = {each.name for each in SOURCES if '"-m"' in each.read_text("utf-8")}
    assert found == {"installation.py"}


@pytest.mark.usefixtures("application")
def test_a_package_is_told_pip_and_the_application_a_component(monkeypatch):
    assert "contactbench-meshlab" in remedy("meshlab")
    assert "pip" not in remedy("meshlab")
    assert "Python package" in remedy("study")
    monkeypatch.delattr(sys, "frozen")
    assert remedy("meshlab") == "pip install 'contactbench[meshlab]'"


def test_a_component_is_looked_for_beside_the_application(application, monkeypatch):
    assert application / "components" / "meshlab" in component_folders("meshlab")
    monkeypatch.delattr(sys, "frozen")
    assert component_folders("meshlab") == []


def test_the_engines_child_finds_a_component(application, monkeypatch):
    """What is in the component's folder is imported in the child, and only there."""
    folder = application / "components" / "meshlab"
    folder.mkdir(parents=True)
    (folder / "pymeshlab_of_the_component.py").write_text("", "utf-8")
    monkeypatch.setattr(worker, "_MODULES", dict.fromkeys(worker.Library, "pymeshlab_of_the_component"))
    monkeypatch.setattr(sys, "path", [*sys.path])
    said = []
    monkeypatch.setattr(worker, "_private_pipes", lambda: (io.BytesIO(), None))
    monkeypatch.setattr(worker, "_limit_resources", lambda _most: None)
    monkeypatch.setattr(worker.signal, "signal", lambda *_: None)
    monkeypatch.setattr(worker, "write_message", lambda _to, message: said.append(message.kind))
    assert worker.main("meshlab") == 0
    assert said == ["ready"]
    assert installation.module_command(child._WORKER, "meshlab")[0] == str(application / "contactbench")
