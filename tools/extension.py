# SPDX-License-Identifier: GPL-3.0-or-later
"""Package the extension with Blender's own tool, and install that package as a user would.

    python tools/extension.py package        write dist/afterlight-<version>.zip, validated
    python tools/extension.py wheels         only download the wheels that go into it

Scripts outside the add-on (tests, samples, benchmarks) take the working extension from here:

    import extension
    afterlight = extension.start()           # the package module, installed from the zip and enabled

No Blender installation is needed: `bpy` is the Python module, and Blender's packaging tool comes with it.
"""

import atexit
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MODULE = "bl_ext.user_default.afterlight"


def manifest():
    """The manifest as a dictionary. It is the one place for the version and for the list of wheels."""
    return tomllib.loads((ROOT / "blender_manifest.toml").read_text())


def blender_ext(*arguments):
    """Run Blender's command line tool for extensions; CalledProcessError with its output where it fails."""
    (bpy_folder,) = importlib.util.find_spec("bpy").submodule_search_locations
    (tool,) = Path(bpy_folder).glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    command = [sys.executable, str(tool), *map(str, arguments)]
    run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if run.returncode:
        print(run.stdout, file=sys.stderr)
        run.check_returncode()
    return run.stdout


def download_wheels():
    """Fetch the wheels that the manifest lists and `wheels/` lacks; pip checks their hashes."""
    folder = ROOT / "wheels"
    for name in (Path(path).name for path in manifest()["wheels"]):
        if (folder / name).exists():
            continue
        folder.mkdir(exist_ok=True)
        python, abi, platform = name.removesuffix(".whl").split("-")[-3:]
        # Through a folder of its own, so that an interrupted download is never taken for a wheel.
        with tempfile.TemporaryDirectory(dir=folder, prefix=".download-") as partial:
            subprocess.run(
                [
                    sys.executable,
                    "-m",
                    "pip",
                    "download",
                    "--quiet",
                    "--disable-pip-version-check",
                    "--no-deps",
                    "--only-binary=:all:",
                    "--require-hashes",
                    "-r",
                    ROOT / "requirements-wheels.txt",
                    "--dest",
                    partial,
                    "--implementation",
                    "cp",
                    "--python-version",
                    python.removeprefix("cp"),
                    "--abi",
                    abi,
                    "--platform",
                    platform,
                ],
                check=True,
            )
            (Path(partial) / name).replace(folder / name)


def package(folder=ROOT / "dist"):
    """Build and validate the zip; return its path."""
    download_wheels()
    fields = manifest()
    path = Path(folder) / f"{fields['id']}-{fields['version']}.zip"
    path.parent.mkdir(parents=True, exist_ok=True)
    blender_ext("validate", ROOT)
    blender_ext("build", "--source-dir", ROOT, "--output-filepath", path)
    blender_ext("validate", path)
    return path


def use_temporary_preferences():
    """Point Blender at an empty folder for preferences and extensions, gone when Python ends.

    Must run before the first `import bpy`, which reads the variable. Returns the folder."""
    if "bpy" in sys.modules:
        raise RuntimeError("bpy is imported already: it would install the extension into your own preferences")
    folder = tempfile.mkdtemp(prefix="afterlight-user-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    # A more specific variable would win over this one.
    for name in [name for name in os.environ if name.startswith("BLENDER_USER_")]:
        del os.environ[name]
    os.environ["BLENDER_USER_RESOURCES"] = folder
    return Path(folder)


def install(path):
    """Install a zip by Blender's operator, enable it, and return the package's module."""
    import bpy

    bpy.ops.extensions.package_install_files(filepath=str(path), repo="user_default", enable_on_install=True)
    if MODULE not in bpy.context.preferences.addons:
        raise RuntimeError(f"Blender could not enable {path}; its output above says why")
    return sys.modules[MODULE]


def start():
    """Package the working tree, install that, and return the module. For scripts with a Blender of their own."""
    folder = use_temporary_preferences()
    return install(package(folder / "package"))


def main():
    command = sys.argv[1:]
    if command == ["package"]:
        path = package()
        print(f"{path.relative_to(ROOT)}: {path.stat().st_size / 1e6:.1f} MB")
    elif command == ["wheels"]:
        download_wheels()
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
