# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's numbers as a page of Markdown, and whether they keep what is promised. No Blender is needed here."""

import platform
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import NamedTuple

GPU_STAGES = ("upload", "pyramid", "gather", "upsample", "read_back")
VIEWS_STAGES = ("views", "bounces", "gather", "upsample", "read_back")  # the same of Radiosity
WHOLE_BOUND = 1.0  # Afterlight's seconds / those that EEVEE's ray tracing adds to a frame
GPU_BOUND = 0.1  # the same for the part on the GPU
SAMPLES_BOUNDS = {"draft": 1, "production": 6}  # samples of EEVEE that the stages on the GPU may take the time of
MEMORY_BOUNDS = {"Paper": 700, "Radiosity": 1500}  # MB above EEVEE alone, by method
CONSTANT_COST = "## Constant cost"  # the page's last part, by benchmarks.cost.constant_cost


class Frame(NamedTuple):
    """One rendered frame: seconds on the clock, and seconds of all processor cores together (in a software GPU's case
    its work is in them, and they tell a slow frame from a busy machine)."""

    wall: float
    cpu: float


class Preset(NamedTuple):
    """One lit frame with a preset's settings; stages in seconds, and the whole frame's. samples: draws of Radiosity."""

    method: str
    start: str
    samples: int
    stages: dict
    frame: float


@dataclass
class Measured:
    """All that one run of the benchmark has found. Stages are dicts of seconds, in the order in which they ran."""

    title: str  # of the scene
    size: tuple  # of the timed frames, pixels
    machine: str
    command: str
    commit: str  # that was measured
    radius: int  # texels: the default, for the frames of these four
    first: dict  # stages of the first lit frame
    stages: list  # of the lit frames after it
    plain: list  # Frames of EEVEE at one sample, box unticked
    lit: list  # and ticked, each right after its plain one
    samples: int  # EEVEE's, of the two below
    untraced: list  # Frames of EEVEE alone
    traced: list  # and with its ray tracing, each right after one of EEVEE alone
    presets: dict = field(default_factory=dict)  # Preset by name
    memory: dict = field(default_factory=dict)  # peak in MB by case: "plain", "compositor" and presets
    memory_size: tuple = ()

    @property
    def sums(self):
        """Seconds of all stages, frame by frame."""
        return [sum(stages.values()) for stages in self.stages]

    @property
    def gpu(self):
        """Seconds of the stages on the GPU, transfers included, frame by frame."""
        return [sum(stages[name] for name in GPU_STAGES) for stages in self.stages]

    @property
    def whole(self):
        """Seconds that Afterlight costs a frame: its stages, or what the frame takes longer if that is more."""
        return max(median(self.sums), median(added(self.plain, self.lit)))

    @property
    def sample(self):
        """Seconds of one more sample of EEVEE."""
        first, all_of_them = (median(frame.wall for frame in frames) for frames in (self.plain, self.untraced))
        return (all_of_them - first) / (self.samples - 1)

    @property
    def ray_tracing(self):
        """Seconds that EEVEE's ray tracing adds to a frame."""
        return median(added(self.untraced, self.traced))


def added(without, having):
    """Seconds on the clock that one thing adds, pair by pair."""
    return [after.wall - before.wall for before, after in zip(without, having, strict=True)]


def processor():
    """The name of this machine's processor."""
    if (info := Path("/proc/cpuinfo")).exists():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":")[1].strip()
    return platform.processor()


def verdicts(measured):
    """[(sentence, whether the bound holds)]."""
    tracing, found = measured.ray_tracing, []
    for what, seconds, bound in (
        ("The whole add-on", measured.whole, WHOLE_BOUND),
        ("Its part on the GPU", median(measured.gpu), GPU_BOUND),
    ):
        ratio = seconds / tracing if tracing > 0 else float("inf")
        found.append(
            (
                f"{what} takes {seconds:.2f} s, {ratio:.3f} of the {tracing:.2f} s that EEVEE's ray tracing adds "
                f"to {measured.samples} samples. Promised: less than {bound:g}",
                ratio < bound,
            )
        )
    for name, preset in measured.presets.items():
        if preset.method == "Radiosity" and name in SAMPLES_BOUNDS:
            seconds, bound = sum(preset.stages[stage] for stage in VIEWS_STAGES), SAMPLES_BOUNDS[name]
            samples = seconds / measured.sample if measured.sample > 0 else float("inf")
            found.append(
                (
                    f"{name.title()}'s part on the GPU, all views and bounces, takes {seconds:.2f} s, as "
                    f"{samples:.2f} samples of "
                    f"EEVEE do. Promised: at most {bound}",
                    samples <= bound,
                )
            )
        more, bound = measured.memory[name] - measured.memory["plain"], MEMORY_BOUNDS[preset.method]
        found.append(
            (
                f"{name.title()} needs {more:.0f} MB more than EEVEE alone at {_size(measured.memory_size)}. "
                f"Promised: at most {bound}",
                more <= bound,
            )
        )
    return found


def page(measured):
    """The whole report."""
    return (
        "\n\n".join(
            [
                "# Speed and memory",
                f"`{measured.title}` at {_size(measured.size)}, measured at commit {measured.commit} by",
                f"    {measured.command}",
                f"on {measured.machine}.",
                "Seconds are on the clock, unless the column says otherwise: processor seconds are those of all cores "
                "together. On a software GPU they contain the GPU's work, and a frame whose two columns do not "
                "move together "
                "was disturbed by something else on the machine.",
                "## Promised, and measured",
                "\n".join(f"- {'Kept' if kept else 'MISSED'}: {text}." for text, kept in verdicts(measured)),
                "## Afterlight's own time, stage by stage",
                f"Method Paper, start Quarter, 64 samples, radius {measured.radius}; {len(measured.stages)} "
                "frames in one "
                "process. The GPU is waited for after each stage. The first frame compiles the shaders and "
                "stands apart. "
                "Nothing here depends on EEVEE's samples.",
                _stage_table(measured),
                "As a cross-check, whole frames of one EEVEE sample with the box unticked and ticked in turn: "
                "ticking adds "
                f"{_spread(added(measured.plain, measured.lit))} s. What that holds beyond the stages is "
                "Blender's: the helper "
                "scene and the compositor. The larger of the two counts above.",
                "## EEVEE's time for the same frame",
                "The same passes are on; ray tracing is EEVEE's own, at the file's settings. Frames with and "
                "without it take "
                "turns.",
                _frame_table(measured),
                *_presets(measured),
                *_memory(measured),
            ]
        )
        + "\n"
    )


def write(path, page=None, constant_cost=None):
    """Write one of the two parts of a file: the page as page() gives it, or its last part from the heading
    CONSTANT_COST on. The other part stays as it is."""
    before, heading, after = path.read_text().partition(CONSTANT_COST) if path.exists() else ("", "", "")
    parts = before if page is None else page, heading + after if constant_cost is None else constant_cost
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(part.strip("\n") + "\n" for part in parts if part))


def _stage_table(measured):
    rows = [
        (name.replace("_", " "), f"{measured.first[name]:.3f}", *_cells([stages[name] for stages in measured.stages]))
        for name in measured.first
    ]
    first_gpu = sum(measured.first[name] for name in GPU_STAGES)
    rows.append(("**on the GPU**, upload to read back", f"{first_gpu:.3f}", *_cells(measured.gpu)))
    rows.append(("**all stages**", f"{sum(measured.first.values()):.3f}", *_cells(measured.sums)))
    return table(("stage", "first frame, s", "median, s", "smallest to largest"), rows)


def _frame_table(measured):
    count = f"{measured.samples} samples"
    rows = [
        (name, *_cells([frame.wall for frame in frames], 2), f"{median(frame.cpu for frame in frames):.2f}")
        for name, frames in (
            (f"EEVEE, {count}", measured.untraced),
            (f"EEVEE with ray tracing, {count}", measured.traced),
            ("EEVEE, 1 sample", measured.plain),
            ("EEVEE, 1 sample, and Afterlight", measured.lit),
        )
    ]
    tracing = [after.cpu - before.cpu for before, after in zip(measured.untraced, measured.traced, strict=True)]
    rows.insert(
        2,
        (
            "**what ray tracing adds**, pair by pair",
            *_cells(added(measured.untraced, measured.traced), 2),
            f"{median(tracing):.2f}",
        ),
    )
    return table(("frame", "median, s", "smallest to largest", "processor, median, s"), rows)


def _presets(measured):
    if not measured.presets:
        return []
    rows = [
        (
            name.title(),
            preset.method,
            preset.start,
            preset.samples,
            f"{preset.stages['gather']:.2f}",
            f"{sum(preset.stages.values()):.2f}",
            f"{preset.frame:.2f}",
        )
        for name, preset in measured.presets.items()
    ]
    return [
        "## Presets",
        "One frame of one EEVEE sample each, its shaders compiled and its views placed by one before. "
        "Radiosity's frames "
        "hold a sample of EEVEE for every view as well.",
        table(("preset", "method", "start", "samples or draws", "gather, s", "all stages, s", "frame, s"), rows),
    ]


def _memory(measured):
    if not measured.memory:
        return []
    names = {"plain": "EEVEE alone, the same passes on", "compositor": "EEVEE and a compositor that changes nothing"}
    rows = [
        (
            names.get(case, f"EEVEE and Afterlight, {case.title()}"),
            f"{peak:.0f}",
            f"{peak - measured.memory['plain']:+.0f}",
        )
        for case, peak in measured.memory.items()
    ]
    return [
        "## Memory",
        f"Peak resident memory of a process that renders three frames at {_size(measured.memory_size)}, one "
        "process a case; Radiosity with seven further views. On a software GPU, textures are part of it. Blender "
        "itself grows up to the third frame.",
        table(("case", "peak, MB", "above EEVEE alone, MB"), rows),
    ]


def _size(size):
    return "x".join(map(str, size))


def _cells(seconds, digits=3):
    return f"{median(seconds):.{digits}f}", f"{min(seconds):.{digits}f} to {max(seconds):.{digits}f}"


def _spread(seconds):
    middle, ends = _cells(seconds, 2)
    return f"{middle} ({ends})"


def table(heading, rows, text=1):
    """A Markdown table: the first column, or as many as `text` says, text; the others numbers."""
    lines = [heading, ["---"] * text + ["---:"] * (len(heading) - text), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)
