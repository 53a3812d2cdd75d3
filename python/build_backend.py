"""The PEP 517 back-end of `pip install .`: CMake builds and installs, this packs the wheel.

The environment variable SIGNORINI_CMAKE_ARGS adds CMake options, for example
-DSIGNORINI_WITH_GMP=OFF. SIGNORINI_WHEEL_BUILD names a build folder that has the module already, built
for this Python: it is packed as it is. The standard library alone.
"""

import base64
import hashlib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "wheel"


def _version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    found = re.search(r"project\(signorini VERSION ([0-9.]+)", text)
    if found is None:
        raise RuntimeError("CMakeLists.txt: no project(signorini VERSION ...)")
    return found.group(1)


def _metadata():
    return (
        "Metadata-Version: 2.1\n"
        "Name: signorini\n"
        f"Version: {_version()}\n"
        "Summary: Complementarity and contact problems, solved and certified\n"
        "License: MIT\n"
        "Requires-Python: >=3.9\n"
        "Requires-Dist: numpy\n"
    )


def _tag():
    abi = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{abi}-{abi}-{platform}"


def _install(build, staged):
    command = ["cmake", "--install", str(build), "--prefix", str(staged), "--component", "python"]
    subprocess.run(command, check=True)


def _build():
    """Configures, builds and installs. Returns the folder that holds the package."""
    staged = BUILD / "stage"
    built = os.environ.get("SIGNORINI_WHEEL_BUILD")
    if built:
        _install(ROOT / built, staged)
        return staged
    options = [
        "-DCMAKE_BUILD_TYPE=Release",
        "-DBUILD_SHARED_LIBS=OFF",
        f"-DSIGNORINI_PYTHON={sys.executable}",
        "-DSIGNORINI_BUILD_PYTHON=ON",
    ]
    for part in ("BUILD_TESTS", "BUILD_BENCH", "BUILD_VALIDATION", "BUILD_COLLISION", "WITH_BULLET", "WITH_DART"):
        options.append(f"-DSIGNORINI_{part}=OFF")
    options += shlex.split(os.environ.get("SIGNORINI_CMAKE_ARGS", ""))
    jobs = os.environ.get("SIGNORINI_JOBS", str(os.cpu_count() or 1))
    commands = (
        ["cmake", "-S", str(ROOT), "-B", str(BUILD), "-G", "Ninja", *options],
        ["cmake", "--build", str(BUILD), "--target", "signorini_python", "-j", jobs],
    )
    for command in commands:
        subprocess.run(command, check=True)
    _install(BUILD, staged)
    return staged


def _record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    staged = _build()
    info = f"signorini-{_version()}.dist-info"
    files = {
        path.relative_to(staged).as_posix(): path.read_bytes()
        for path in sorted(staged.rglob("*"))
        if path.is_file()
    }
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: signorini\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
    ).encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    record = "".join(_record_line(name, content) for name, content in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    name = f"signorini-{_version()}-{_tag()}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in files.items():
            wheel.writestr(path, content)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """The files that git knows."""
    base = f"signorini-{_version()}"
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    info = BUILD / "PKG-INFO"
    info.parent.mkdir(parents=True, exist_ok=True)
    info.write_text(_metadata(), encoding="utf-8")
    name = f"{base}.tar.gz"
    with tarfile.open(pathlib.Path(sdist_directory) / name, "w:gz") as archive:
        for path in filter(None, listed.split("\0")):
            archive.add(ROOT / path, f"{base}/{path}")
        archive.add(info, f"{base}/PKG-INFO")
    return name
