# SPDX-License-Identifier: GPL-3.0-or-later
"""Render sample scenes by EEVEE alone and with Afterlight, and put the two pictures side by side.

    .venv/bin/python sample_blends/demo.py [NAME ...] [--all] [--size 640x360] [--samples 16]
        [--folder build/demo] [--webp docs/pictures]

Writes <name>_eevee.png, <name>_afterlight.png, and <name>.png with the first on its left; the last also as a small
WebP, where a folder for that is given (it needs Pillow)."""

import argparse
import importlib.util
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))  # Blender's -P does not do it

import session

PICTURES = HERE.parent / "build" / "demo"
QUALITY = 88  # of WebP: nobody sees a difference
GAP = 8  # pixels between the two pictures


def render(scene, path, enabled):
    """Render `scene` to the PNG `path` with Afterlight on or off; return the seconds it took."""
    import bpy

    scene.afterlight.enabled = enabled
    scene.render.filepath = str(path)
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True, scene=scene.name)
    return time.perf_counter() - start


def side_by_side(left, right, path):
    """Put two PNG files of one size beside each other, white between them, into the PNG `path`."""
    import bpy
    import numpy as np

    def pixels(source):
        image = bpy.data.images.load(str(source))
        width, height = image.size
        values = np.empty((height, width, 4), np.float32)
        image.pixels.foreach_get(values.ravel())
        bpy.data.images.remove(image)
        return values

    first, second = pixels(left), pixels(right)
    height, width, _ = first.shape
    both = np.ones((height, 2 * width + GAP, 4), np.float32)
    both[:, :width], both[:, width + GAP :] = first, second
    image = bpy.data.images.new(path.stem, both.shape[1], height)
    image.pixels.foreach_set(both.ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)


def show(name, folder, size, samples):
    """Render the sample `name` both ways; return the path of the picture of both."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(HERE / f"{name}.blend"), load_ui=False)
    scene = bpy.data.scenes[name]
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.eevee.taa_render_samples = samples
    scene.render.image_settings.file_format = "PNG"
    plain, lit, both = (folder / f"{name}{tag}.png" for tag in ("_eevee", "_afterlight", ""))
    seconds = render(scene, plain, False), render(scene, lit, True)
    side_by_side(plain, lit, both)
    print(f"{name}: {seconds[0]:.1f} s by EEVEE alone, {seconds[1]:.1f} s with Afterlight")
    return both


def as_webp(path, target):
    """Write a PNG as a small WebP."""
    from PIL import Image

    target.parent.mkdir(parents=True, exist_ok=True)
    Image.open(path).convert("RGB").save(target, "WEBP", quality=QUALITY, method=6)


def picture_size(text):
    width, height = (int(number) for number in text.split("x"))
    return width, height


def main():
    samples = sorted(path.stem for path in HERE.glob("*.blend"))
    parser = argparse.ArgumentParser(description="Before and after pictures of Afterlight's sample scenes.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"some of: {', '.join(samples)}; cornell_box without")
    parser.add_argument("--all", action="store_true", help="every sample")
    parser.add_argument("--size", type=picture_size, default=(640, 360), metavar="WxH", help="640x360 without")
    parser.add_argument("--samples", type=int, default=16, help="EEVEE's samples a pixel; 16 without")
    parser.add_argument("--folder", type=Path, default=PICTURES, help="where the pictures go; build/demo without")
    parser.add_argument("--webp", type=Path, metavar="FOLDER", help="where a WebP of each goes; nowhere without")
    options = parser.parse_args(session.arguments())
    names = samples if options.all else options.names or ["cornell_box"]
    if missing := [name for name in names if name not in samples]:
        parser.error(f"there is no {missing[0]}.blend in {HERE}; 'make samples' writes the sample scenes")

    if options.webp and not importlib.util.find_spec("PIL"):
        parser.error("--webp needs Pillow, which this Python does not have")

    session.enable_afterlight()
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    pictures = [show(name, folder, options.size, options.samples) for name in names]
    if options.webp:
        for path in pictures:
            as_webp(path, options.webp / f"{path.stem}.webp")
    print("\nEEVEE alone on the left, with Afterlight on the right:")
    for path in pictures:
        print(f"  {path}")


if __name__ == "__main__":
    main()
