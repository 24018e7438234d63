"""The files that a desktop, udev and a release read say what is true, in the form that they are read in."""

import importlib.util
import json
import re
import shutil
import subprocess
import tomllib
import xml.etree.ElementTree as ET
import zipfile
from configparser import ConfigParser
from pathlib import Path

import pytest
import yaml

from contactbench import __version__
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.archive import export_archive

ROOT = Path(__file__).parents[2]
PACKAGING = ROOT / "packaging"
INSTALLERS = PACKAGING / "installers"
TYPE = "application/vnd.contactbench.session+zip"
MIME = "{http://www.freedesktop.org/standards/shared-mime-info}"


def make():
    """Return the module that makes installers: it is a script, and not in the package."""
    spec = importlib.util.spec_from_file_location("make_installers", INSTALLERS / "make.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


# ---- the desktop ---------------------------------------------------------------------------------


def entry():
    reader = ConfigParser(interpolation=None)
    reader.optionxform = str
    reader.read(PACKAGING / "contactbench.desktop", "utf-8")
    return reader["Desktop Entry"]


def test_the_menu_entry_is_valid():
    command = ["desktop-file-validate", PACKAGING / "contactbench.desktop"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "")
    found = entry()
    assert found["Exec"] == "contactbench gui %f"
    assert found["MimeType"] == f"{TYPE};"
    for key in ("GenericName", "Comment", "Keywords"):
        assert found[f"{key}[de]"] not in ("", found[key])


def test_a_session_archive_is_known_by_its_first_bytes_and_its_name(tmp_path):
    root = ET.parse(INSTALLERS / "contactbench.xml").getroot()  # noqa: S314 - our own file
    kind = root.find(f"{MIME}mime-type")
    assert kind.get("type") == TYPE
    outer = kind.find(f"{MIME}magic/{MIME}match")
    inner = outer.find(f"{MIME}match")
    Session.create(tmp_path / "session").close()
    archive = tmp_path / f"session{kind.find(f'{MIME}glob').get('pattern').removeprefix('*')}"
    export_archive(tmp_path / "session", archive)
    data = archive.read_bytes()
    for match in (outer, inner):
        value = match.get("value").encode().decode("unicode_escape").encode("latin-1")
        assert data[int(match.get("offset")) :].startswith(value)
    with zipfile.ZipFile(tmp_path / "other.zip", "w") as other:
        other.writestr("a.txt", "journal")
    assert not (tmp_path / "other.zip").read_bytes()[30:].startswith(b"journal")


def test_the_software_catalogue_names_the_same_program():
    root = ET.parse(INSTALLERS / "contactbench.metainfo.xml").getroot()  # noqa: S314 - our own file
    assert root.findtext("launchable") == "contactbench.desktop"
    assert root.findtext("provides/mediatype") == TYPE
    assert root.findtext("provides/binary") == "contactbench"
    assert root.findtext("summary") == entry()["Comment"]
    assert root.findtext("project_license") == "Apache-2.0"


# ---- udev ----------------------------------------------------------------------------------------

KEY = re.compile(
    r'(ACTION|SUBSYSTEM|DRIVER|LABEL|GOTO|TAG|SYMLINK|ATTR\{[a-z_]+\}|ENV\{[A-Z_]+\})(==|!=|\+=|=)"([^"]*)"'
)


def rules():
    """Yield the rules, each a list of (key, operator, value)."""
    for line in (INSTALLERS / "70-contactbench.rules").read_text("utf-8").splitlines():
        if line and not line.startswith("#"):
            parts = line.split(", ")
            found = [KEY.fullmatch(part) for part in parts]
            assert all(found), line
            yield [each.groups() for each in found]


def applied(device):
    """Return what the rules do to a device, by udev's order: (names of links, tags, attributes written)."""
    links, tags, attributes, skip = [], [], {}, ""
    for rule in rules():
        wanted = [each for each in rule if each[1] in ("==", "!=")]
        rest = [each for each in rule if each not in wanted]
        if skip:
            if ("LABEL", "=", skip) in rest:
                skip = ""
            continue
        if all(_matches(device.get(key, ""), value) == (op == "==") for key, op, value in wanted):
            for key, _, value in rest:
                value = re.sub(r"\$env\{(\w+)\}", lambda m: device.get(f"ENV{{{m[1]}}}", ""), value)
                if key == "GOTO":
                    skip = value
                elif key == "SYMLINK":
                    links.append(value)
                elif key == "TAG":
                    tags.append(value)
                elif key.startswith("ATTR"):
                    attributes[key] = value
    assert not skip, f"there is no label {skip}"
    return links, tags, attributes


def _matches(text, pattern):
    alternatives = [re.escape(each).replace(r"\?", ".").replace(r"\*", ".*") for each in pattern.split("|")]
    return any(re.fullmatch(each, text) for each in alternatives)


FTDI = {
    "ACTION": "add", "SUBSYSTEM": "tty", "ENV{ID_BUS}": "usb", "ENV{ID_VENDOR_ID}": "0403",
    "ENV{ID_SERIAL_SHORT}": "FT4ABC", "ENV{ID_USB_INTERFACE_NUM}": "00",
}  # fmt: skip


def test_an_adapter_gets_a_name_by_its_serial_number_and_can_be_used():
    assert applied(FTDI) == (["contactbench/FT4ABC"], ["uaccess"], {})
    assert applied(FTDI | {"ENV{ID_USB_INTERFACE_NUM}": "01"})[0] == ["contactbench/FT4ABC-01"]


def test_an_adapter_without_a_serial_number_gets_no_name():
    assert applied(FTDI | {"ENV{ID_VENDOR_ID}": "1a86", "ENV{ID_SERIAL_SHORT}": ""}) == ([], ["uaccess"], {})


@pytest.mark.parametrize(
    "other",
    [{"ENV{ID_BUS}": "pci"}, {"ENV{ID_VENDOR_ID}": "2341"}, {"SUBSYSTEM": "block"}, {"ACTION": "remove"}],
)
def test_other_devices_are_left_alone(other):
    assert applied(FTDI | other) == ([], [], {})


def test_an_ftdi_chip_sends_at_once():
    port = {"ACTION": "add", "SUBSYSTEM": "usb-serial", "DRIVER": "ftdi_sio"}
    assert applied(port) == ([], [], {"ATTR{latency_timer}": "1"})
    assert applied(port | {"DRIVER": "cp210x"}) == ([], [], {})


def test_the_rules_are_read_before_the_seats():
    """uaccess is looked at by 73-seat-late.rules; the serial number is known from 60-serial.rules on."""
    (file,) = INSTALLERS.glob("*.rules")
    assert "60-serial.rules" < file.name < "73-seat-late.rules"


# ---- wheel, sdist, parts list --------------------------------------------------------------------


def zipped(file, *names):
    with zipfile.ZipFile(file, "w") as packed:
        for name in names:
            packed.writestr(name, "")
    return file


WHOLE = (
    "contactbench/pipeline/kernel/__init__.py",
    "contactbench/pipeline/kernel/build.json",
    "contactbench/app/translations/contactbench_de.qm",
    "contactbench/app/help/start.md",
    "contactbench-1.dist-info/licenses/LICENSE",
)


def test_a_wheel_with_what_nobody_needs_is_refused(tmp_path):
    module = make()
    module.check_content(zipped(tmp_path / "a.whl", *WHOLE))
    for stranger in ("tests/test_cli.py", "contactbench/docs/a.md", "contactbench/assets/readme-demo.png"):
        with pytest.raises(module.InstallerError, match=re.escape(stranger)):
            module.check_content(zipped(tmp_path / "b.whl", *WHOLE, stranger))


@pytest.mark.parametrize("missing", WHOLE)
def test_a_wheel_that_lacks_something_is_refused(tmp_path, missing):
    module = make()
    with pytest.raises(module.InstallerError, match="is missing"):
        module.check_content(zipped(tmp_path / "a.whl", *(name for name in WHOLE if name != missing)))


def test_an_appimage_without_its_runtime_is_refused(tmp_path, monkeypatch):
    module = make()
    monkeypatch.delenv("CONTACTBENCH_APPIMAGE_RUNTIME", raising=False)
    with pytest.raises(module.InstallerError, match="CONTACTBENCH_APPIMAGE_RUNTIME"):
        module.make_appimage(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_the_parts_list_has_every_constraint_and_no_registry(tmp_path):
    program = Path(shutil.which("cyclonedx-py") or "")
    module = make()
    module.sbom(program, tmp_path / "a.json")
    module.sbom(program, tmp_path / "b.json")
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    found = json.loads((tmp_path / "a.json").read_text("utf-8"))
    there = {part["name"].lower().replace("_", "-"): part["version"] for part in found["components"]}
    lines = (ROOT / "constraints.txt").read_text("utf-8").splitlines()
    wanted = dict(line.lower().replace("_", "-").split("==") for line in lines if not line.startswith("#"))
    assert there == wanted
    assert found["metadata"]["component"]["name"] == "contactbench"
    assert found["metadata"]["component"]["version"] == __version__
    assert "://" in found.pop("$schema")
    del found["metadata"]["component"]["externalReferences"]  # the paper
    assert "://" not in json.dumps(found)


# ---- one version, forms ----------------------------------------------------------------------------


def test_the_version_stands_in_one_place():
    """In pyproject.toml; a citation and ROS packages have to repeat it, and the example of a command may."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
    assert version == __version__
    texts = [file for kind in ("py", "spec", "iss", "xml", "cmake") for file in PACKAGING.rglob(f"*.{kind}")]
    texts += [
        file for room in ("app", "pipeline", "widgets", "assets") for file in (ROOT / room).rglob("*.py")
    ]
    repeated = [
        str(file.relative_to(ROOT))
        for file in texts
        if file.name != "package.xml" and re.search(rf"(?<![\d.]){re.escape(version)}(?![\d.])", _code(file))
    ]
    assert repeated == []


def _code(file):
    text = file.read_text("utf-8")
    return re.sub(r"^;.*$", "", text, flags=re.MULTILINE) if file.suffix == ".iss" else text


@pytest.mark.parametrize("file", sorted((ROOT / ".github").rglob("*.yml")), ids=lambda file: file.name)
def test_forms_and_workflows_can_be_read(file):
    found = yaml.safe_load(file.read_text("utf-8"))
    if file.parent.name == "ISSUE_TEMPLATE" and file.name != "config.yml":
        assert {"name", "description", "body"} <= set(found)
        ids = [each["id"] for each in found["body"] if "id" in each]
        assert len(ids) == len(set(ids))
        assert all(each["type"] == "markdown" or each["attributes"]["label"] for each in found["body"])
