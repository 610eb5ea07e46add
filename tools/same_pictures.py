# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the working tree renders the pictures of an earlier commit, to the bit: for changes that must change none.

    .venv/bin/python tools/same_pictures.py REVISION [NAME ...]

Renders three samples with both, by F12 and as an animation whose frames are averaged, and with the method Paper. Exit
code 1 where a picture differs. The commit is checked out into a temporary folder."""

import hashlib
import json
import subprocess
import sys
import tempfile
from pathlib import Path

if sys.argv[1:2] == ["--render"]:  # the tools of the tree that is named, not those beside this file
    sys.path[0] = str(Path(sys.argv[2]) / "tools")

import extension

SIZE, SAMPLES = (256, 144), 4
SHOTS = {
    "cornell_box": {},
    "cornell_box, Paper": {"method": "PAPER"},
    "metal_bin": {"use_glossy": True, "denoise": "NODE", "accumulate": 2},
    "moving/walking_shadow": {"frames": (7, 9)},
}


def render(root, folder, names):
    """{shot: [hash of a frame's pixels]} by the extension in the tree that this process was started for."""
    extension.start()  # before the first `import bpy`

    import bpy
    import numpy as np
    import OpenEXR

    found = {}
    for name in names:
        changes = dict(SHOTS[name])
        bpy.ops.wm.open_mainfile(filepath=str(root / "sample_blends" / f"{name.split(',')[0]}.blend"), load_ui=False)
        scene = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = SIZE
        scene.render.resolution_percentage, scene.eevee.taa_render_samples = 100, SAMPLES
        scene.render.compositor_device = "CPU"
        image = scene.render.image_settings
        image.media_type, image.file_format, image.color_depth, image.exr_codec = "IMAGE", "OPEN_EXR", "32", "NONE"
        first, last = changes.pop("frames", (1, 1))
        for setting, value in changes.items():
            setattr(scene.afterlight, setting, value)
        scene.afterlight.enabled = True
        scene.frame_start, scene.frame_end = first, last
        scene.frame_set(last if last > first else first)
        scene.render.filepath = str(folder / f"{name.replace('/', '_')}_####.exr")
        if last > first:
            bpy.ops.render.render(animation=True)
        else:
            bpy.ops.render.render(write_still=True)
        if scene.afterlight.report:
            sys.exit(f"{name}: {scene.afterlight.report}")
        found[name] = []
        for path in sorted(folder.glob(f"{name.replace('/', '_')}_*.exr")):
            part = OpenEXR.File(str(path), separate_channels=True).parts[0]
            pixels = np.stack([part.channels[axis].pixels for axis in "RGB"])
            found[name].append(f"{hashlib.sha256(pixels.tobytes()).hexdigest()[:16]} (mean {pixels.mean():.6f})")
            path.unlink()
    return found


def rendered_by(root, names):
    """As render(), in a process of its own."""
    with tempfile.TemporaryDirectory(prefix="afterlight-same-") as folder:
        out = Path(folder) / "found.json"
        subprocess.run(
            [sys.executable, __file__, "--render", str(root), str(out), *names],
            check=True,
            text=True,
            stdout=subprocess.DEVNULL,
        )
        return json.loads(out.read_text())


def main():
    if sys.argv[1:2] == ["--render"]:
        root, out, *names = sys.argv[2:]
        Path(out).write_text(json.dumps(render(Path(root), Path(out).parent, names)))
        return
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    revision, names = sys.argv[1], sys.argv[2:] or list(SHOTS)
    with tempfile.TemporaryDirectory(prefix="afterlight-before-") as before:
        archive = subprocess.run(
            ["git", "-C", str(extension.ROOT), "archive", revision], check=True, stdout=subprocess.PIPE
        )
        subprocess.run(["tar", "-x", "-C", before], input=archive.stdout, check=True)
        if (extension.ROOT / "wheels").exists():  # they have been downloaded once
            (Path(before) / "wheels").symlink_to(extension.ROOT / "wheels")
        one, other = rendered_by(Path(before), names), rendered_by(extension.ROOT, names)
    for name in names:
        print(f"{name}: {'the same' if one[name] == other[name] else 'DIFFERS'}\n  {one[name]}\n  {other[name]}")
    sys.exit(int(one != other))


if __name__ == "__main__":
    main()
