# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender with Afterlight enabled, for the scripts beside this file.

Import this before `bpy`: Blender reads where its preferences lie when it is first imported."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import extension


def enable_afterlight():
    """Return Afterlight's package module, enabled.

    Inside Blender that is the extension the user has enabled. With Blender's Python module the working tree is
    packaged and installed as a user would, into preferences that are gone when Python ends. SystemExit says what
    to do where neither can be had."""
    if extension.MODULE in sys.modules:
        return sys.modules[extension.MODULE]
    if "bpy" in sys.modules:
        sys.exit(
            "Afterlight is not enabled in this Blender: install dist/afterlight-<version>.zip, which 'make package' "
            "writes, under Edit > Preferences > Get Extensions > Install from Disk."
        )
    if not (ROOT / "__init__.py").exists():
        sys.exit(f"{ROOT} holds no extension: its __init__.py is missing.")
    return extension.start()


def tick(scene):
    """Switch Afterlight on for `scene`, as its checkbox does. SystemExit where the extension is not enabled."""
    if not hasattr(scene, "afterlight"):
        sys.exit(f"Afterlight cannot be ticked in '{scene.name}': the extension is not enabled in this Blender.")
    scene.afterlight.enabled = True


def arguments():
    """The script's own arguments, under plain Python and after the -- of Blender's command line alike."""
    if "--" in sys.argv:
        return sys.argv[sys.argv.index("--") + 1 :]
    return sys.argv[1:] if Path(sys.argv[0]).suffix == ".py" else []
