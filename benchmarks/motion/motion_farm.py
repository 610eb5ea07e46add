# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a shot may be rendered in parts: its second half as a job of its own beside the same frames of the whole job.

Used by `python -m benchmarks.motion --farm`. As docs/blender/views.md has it, one frame is rendered and the file saved
before it goes to the farm, so that all jobs begin with the same views. What is left between the jobs is told in the
noise of one frame: the difference of two seeds without history."""

import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..accuracy import candidates
from . import motion

HEAD = "| shot | way | first frame of the part | mean of its others | largest of them |\n|---|---|---:|---:|---:|"


@dataclass
class Parts:
    """What was found of one shot. found: by way, (frames,) differences in the noise of one frame. failures: by way,
    why not."""

    name: str
    found: dict = field(default_factory=dict)
    failures: dict = field(default_factory=dict)

    def rows(self):
        """Markdown, a row a way."""
        return [
            f"| {self.name} | {way} | {each[0]:.3f} | {each[1:].mean():.3f} | {each[1:].max():.3f} |"
            for way, each in self.found.items()
        ] + [f"| {self.name} | {way} | failed: {reason} | | |" for way, reason in self.failures.items()]


def measure(path, options, afterlight):
    """Parts, for each of Afterlight's ways."""
    shot = Parts(path.stem)
    for name in options.ways:
        if name in motion.ALONE:
            continue
        way, plain = motion.ways_of([name, name.partition("+")[0]], afterlight, options.accumulate)
        try:
            with tempfile.TemporaryDirectory(prefix="afterlight-farm-") as folder:
                file = sent(path, way, Path(folder), options, afterlight)
                apart = difference(part(file, half=False), part(file, half=True))
                seeds = (part(sent(path, plain, Path(folder), options, afterlight, seed), half=True) for seed in (0, 1))
                shot.found[way.name] = apart / difference(*seeds)
        except candidates.Unmeasurable as reason:
            shot.failures[way.name] = str(reason)
    return shot


def sent(path, way, folder, options, afterlight, seed=0):
    """The file as it goes to the farm: ticked, one frame rendered."""
    import bpy

    scene = motion.opened(path, options, afterlight)
    file = folder / f"seed_{seed}.blend"
    with way.mode(scene):
        scene.afterlight.seed = seed
        scene.frame_set(scene.frame_start)
        bpy.ops.render.render(scene=scene.name)
        bpy.ops.wm.save_as_mainfile(filepath=str(file), copy=True)
    return file


def part(file, half):
    """(frames, H, W, 3): the second half of the file's shot. half: that alone; otherwise cut out of the whole job."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(file), load_ui=False, use_scripts=False)
    scene = bpy.context.scene
    first, count = scene.frame_start, scene.frame_end - scene.frame_start + 1
    if half:
        scene.frame_start = first + count // 2
    _, frames = motion.job(scene)
    return np.array([frame["Combined"] for frame in frames[-(count - count // 2) :]])


def difference(one, other):
    """(frames,): root mean square difference of two shots."""
    return np.sqrt(np.square(one - other, dtype=np.float64).mean((1, 2, 3)))


def page(options, rows):
    """The page in Markdown. rows: [Parts.rows()]."""
    width, height = options.size
    return "\n".join(
        [
            f"`{options.command}`",
            "",
            f"{width} x {height}, EEVEE with {options.samples} samples. The second half of each shot as a job of "
            "its own beside the same frames "
            "of the whole job: root mean square difference, over that of two seeds without history in the same frame.",
            "",
            HEAD,
            *(row for shot in rows for row in shot),
            "",
        ]
    )
