# SPDX-License-Identifier: GPL-3.0-or-later
"""Render moving shots by EEVEE alone and with Afterlight, and put the two beside each other in one animated picture.

    .venv/bin/python sample_blends/clip.py [SHOT ...] [--frames 1-24] [--size 480x270] [--samples 16]
        [--preset production] [--folder build/clip]

Writes <shot>.webp, EEVEE alone on the left; lossy enough to have less than 3 MB."""

import argparse
import io
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))  # Blender's -P does not do it

import session
from demo import GAP, picture_size

SHOTS = HERE / "moving"
CLIPS = HERE.parent / "build" / "clip"
LARGEST = 3_000_000  # bytes; the README shows them
QUALITIES = 90, 80, 70, 60, 45, 30


def rendered(scene, enabled, folder):
    """[PIL.Image]: the scene's frames, rendered in one job with Afterlight on or off."""
    import bpy
    from PIL import Image

    scene.afterlight.enabled = enabled
    scene.render.filepath = str(folder / f"{'lit' if enabled else 'plain'}_####.png")
    scene.frame_set(scene.frame_end)  # an animation that begins at the current frame passes for F12 in its first
    bpy.ops.render.render(animation=True, scene=scene.name)
    if enabled and scene.afterlight.report:
        sys.exit(scene.afterlight.report)
    return [Image.open(path).convert("RGB") for path in sorted(folder.glob(f"{'lit' if enabled else 'plain'}_*.png"))]


def side_by_side(left, right):
    """Two pictures of one size in one, white between them."""
    from PIL import Image

    both = Image.new("RGB", (left.width + GAP + right.width, left.height), "white")
    both.paste(left, (0, 0))
    both.paste(right, (left.width + GAP, 0))
    return both


def write(frames, path, rate):
    """An endless WebP of the best quality that is small enough; `rate` frames a second."""
    for quality in QUALITIES:
        file = io.BytesIO()
        frames[0].save(
            file,
            "WEBP",
            save_all=True,
            append_images=frames[1:],
            duration=round(1000 / rate),
            loop=0,
            quality=quality,
            method=6,
        )
        if file.tell() < LARGEST:
            path.write_bytes(file.getvalue())
            return quality
    sys.exit(
        f"{path.name} would have {file.tell()} bytes at the least quality; {LARGEST} are wanted. Make it smaller "
        "by --size."
    )


def show(name, options):
    """Write the clip of one shot."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(SHOTS / f"{name}.blend"), load_ui=False)
    scene = bpy.data.scenes[name]
    scene.render.resolution_x, scene.render.resolution_y = options.size
    scene.render.resolution_percentage = 100
    scene.render.compositor_device = "CPU"  # the GPU compositor crashes in long processes (docs/blender/rendering.md)
    scene.eevee.taa_render_samples = options.samples
    image = scene.render.image_settings
    image.media_type, image.file_format, image.color_mode = "IMAGE", "PNG", "RGB"
    if options.frames:
        scene.frame_start, scene.frame_end = options.frames
    module = sys.modules[session.extension.MODULE]
    bpy.ops.afterlight.preset(filepath=str(module.addon.ui.operators.PRESETS / f"{options.preset}.py"))
    scene.afterlight.use_animated_seed = True
    start = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="afterlight-clip-") as folder:
        plain, lit = (rendered(scene, enabled, Path(folder)) for enabled in (False, True))
    path = options.folder / f"{name}.webp"
    quality = write([side_by_side(*pair) for pair in zip(plain, lit, strict=True)], path, options.rate)
    print(
        f"{path}: {len(plain)} frames, {path.stat().st_size / 1000:.0f} kB at quality {quality}, "
        f"{time.perf_counter() - start:.0f} s"
    )


def frame_range(text):
    first, last = (int(number) for number in text.split("-"))
    return first, last


def main():
    shots = sorted(path.stem for path in SHOTS.glob("*.blend"))
    parser = argparse.ArgumentParser(description="Clips of moving shots, before and after, side by side.")
    parser.add_argument("names", nargs="*", metavar="SHOT", help=f"of {', '.join(shots)}; all without")
    parser.add_argument("--frames", type=frame_range, metavar="FIRST-LAST", help="the shot's without")
    parser.add_argument("--size", type=picture_size, default=(480, 270), metavar="WxH", help="of each half; 480x270")
    parser.add_argument("--samples", type=int, default=16, help="EEVEE's samples a pixel; 16")
    parser.add_argument("--preset", default="production", help="Afterlight's; production")
    parser.add_argument("--rate", type=int, default=12, help="frames a second; 12, half as fast as life")
    parser.add_argument("--folder", type=Path, default=CLIPS, help="where the clips go; build/clip without")
    options = parser.parse_args(session.arguments())
    if missing := [name for name in options.names if name not in shots]:
        parser.error(f"there is no {missing[0]}.blend in {SHOTS}; 'make samples' writes the shots")
    session.enable_afterlight()
    options.folder = options.folder.resolve()
    options.folder.mkdir(parents=True, exist_ok=True)
    for name in options.names or shots:
        show(name, options)


if __name__ == "__main__":
    main()
