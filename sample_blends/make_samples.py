# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the sample scenes, each from the module of its name in this folder, with Afterlight switched on.

.venv/bin/python sample_blends/make_samples.py [NAME ...] [--plain] [--folder FOLDER]
blender -b -P sample_blends/make_samples.py -- [NAME ...]
"""

import argparse
import importlib
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))  # Blender's -P does not do it

import session

SAMPLES = (
    "cornell_box",
    "sunlit_room",
    "many_lights",
    "emissive_sign",
    "sculpture",
    "apartment",
    "street",
    "desk",
    "corridor",
    "metal_bin",
    "polished_floor",
    "plastics",
)
GLOSSY = SAMPLES[-3:]  # those that Glossy Light is on in
DIFFUSE = SAMPLES[:-3]  # those whose light accuracy measures
MOVING = (
    "pillars",
    "walking_shadow",
    "lamp_switched",
    "creature",
)  # shots; apart, as the others are measured by the folder
ARTISTS = (
    "loft",
    "sky_room",
    "courtyard",
    "product",
    "bust",
    "night_lamp",
    "fog",
    "bazaar",
    "heavy_room",
)  # what artists build, with textures, glass, leaves, hair, fog; apart for the same reason
LARGEST = 2_000_000  # bytes; the samples are kept in the repository
LARGEST_OF_ARTISTS = 3_000_000  # with their textures


def make(name, folder, plain):
    """Build one sample and save it compressed; return the file's path."""
    import bpy

    import parts

    scene = parts.empty_scene(name)
    importlib.import_module(name).build(scene)
    scene.render.filepath = f"//{name}_"
    if not plain:
        session.tick(scene)
        scene.afterlight.use_glossy = name in GLOSSY
    path = folder / f"{name}.blend"
    path.unlink(missing_ok=True)  # or Blender keeps it as a .blend1
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False, compress=True)
    largest = LARGEST_OF_ARTISTS if name in ARTISTS else LARGEST
    if path.stat().st_size > largest:
        sys.exit(f"{path} has {path.stat().st_size} bytes; at most {largest} are wanted.")
    return path


def main():
    every = SAMPLES + MOVING + ARTISTS
    parser = argparse.ArgumentParser(description="Write Afterlight's sample scenes.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"some of: {', '.join(every)}; all without")
    parser.add_argument("--plain", action="store_true", help="without Afterlight, for a look at the bare scenes")
    parser.add_argument(
        "--folder",
        type=Path,
        default=HERE,
        help="where to write; beside this script without, and there in moving/ and artists/ what belongs in them",
    )
    options = parser.parse_args(session.arguments())
    if unknown := set(options.names) - set(every):
        parser.error(f"no sample is called {', '.join(sorted(unknown))}; there are {', '.join(every)}")
    if not options.plain:
        session.enable_afterlight()
    folder = options.folder.resolve()
    for name in options.names or every:
        into = folder / ("moving" if name in MOVING else "artists" if name in ARTISTS else "")
        into.mkdir(parents=True, exist_ok=True)
        path = make(name, into, options.plain)
        print(f"{path}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
