"""Builds the wheel of `pip install ./demos/python`: CMake compiles and installs the component `python`, and this packs it.

A build backend by PEP 517 that takes no more than Python's own library. It builds in build/wheel-*, so that a second
wheel takes seconds; no option of an earlier call is kept. Further options of CMake's, such as the place of another Bullet:
CMAKE_ARGS in the environment, or `pip install --config-settings NAME=VALUE`, which become -DNAME=VALUE.
"""

import base64
import hashlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
VERSION = re.search(r"BulletAmbient VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
TAG = "-".join(["cp%d%d" % sys.version_info[:2]] * 2 + [re.sub("[-.]", "_", sysconfig.get_platform())])
NAME = f"bullet_ambient-{VERSION}"
METADATA = f"""Metadata-Version: 2.1
Name: bullet_ambient
Version: {VERSION}
Summary: Rigid bodies of Bullet in air or water: added mass, pressure with separation, friction, buoyancy
License: Zlib
License-File: LICENSE
Requires-Python: >=3.10
Requires-Dist: numpy
"""
WHEEL = f"Wheel-Version: 1.0\nGenerator: wheel_backend\nRoot-Is-Purelib: false\nTag: {TAG}\n"
OPTIONS = {"CMAKE_BUILD_TYPE": "Release", "CMAKE_UNITY_BUILD": "ON", "CMAKE_UNITY_BUILD_BATCH_SIZE": "0",
           "BULLET_AMBIENT_FLOAT32": "OFF", "BULLET_AMBIENT_TESTS": "OFF", "BULLET_AMBIENT_PYTHON": "ON",
           "BULLET_AMBIENT_PYBULLET": "ON", "BULLET_AMBIENT_PYTHON_DIR": ".",
           "Python3_EXECUTABLE": os.path.realpath(sys.executable)}
TARGETS = ["ambient_python", "ambient_mesh_reader", "ambient_pybullet"]


def run(*command):
    try:
        subprocess.run(command, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise SystemExit(f"{error}\nWhat the wheel is built with is installed by: .ci/install_packages wheel") from None


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = Path(metadata_directory) / f"{NAME}.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text(METADATA)
    (folder / "WHEEL").write_text(WHEEL)
    shutil.copy(ROOT / "LICENSE", folder)
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    build = str(ROOT / "build" / f"wheel-{sys.implementation.cache_tag}")
    options = [f"-D{name}={value}" for name, value in OPTIONS.items()] + shlex.split(os.environ.get("CMAKE_ARGS", ""))
    options += [f"-D{name}={value}" for name, value in (config_settings or {}).items()]
    run("cmake", "--fresh", "-G", "Ninja", "-S", str(ROOT), "-B", build, *options)
    run("cmake", "--build", build, "--target", *TARGETS)
    with tempfile.TemporaryDirectory() as stage:
        run("cmake", "--install", build, "--component", "python", "--prefix", stage)
        prepare_metadata_for_build_wheel(stage)
        return pack(Path(stage), Path(wheel_directory) / f"{NAME}-{TAG}.whl").name


def pack(stage, wheel):
    """Writes all files below a folder into a wheel, with the list of them and their hashes. Returns its path."""
    files = {str(path.relative_to(stage)): path for path in sorted(stage.rglob("*")) if path.is_file()}
    hashes = {name: base64.urlsafe_b64encode(hashlib.sha256(path.read_bytes()).digest()).rstrip(b"=").decode()
              for name, path in files.items()}
    record = f"{NAME}.dist-info/RECORD"
    lines = [f"{name},sha256={hashes[name]},{path.stat().st_size}" for name, path in files.items()] + [f"{record},,"]
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, strict_timestamps=False) as archive:
        for name, path in files.items():
            archive.write(path, name)
        archive.writestr(record, "\n".join(lines) + "\n")
    return wheel
