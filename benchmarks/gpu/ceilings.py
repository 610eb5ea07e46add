# SPDX-License-Identifier: GPL-3.0-or-later
"""What the machine can do, and what a frame must do at the least: its floor.

    floor = sum over stages of max(bytes / bandwidth, fetches / fetch rate, samples / arithmetic rate)

measure() finds the three rates, work() counts. The counts are of what the method needs however it is laid out: each
number of the input is read once, each result is written once, a sample is one fetch of one record."""

from dataclasses import dataclass
from statistics import median

from . import opengl
from .fetchless import gather_passes, without_fetches

CHANNELS_IN = 13  # of the passes, float32: depth, normal, colour, direct light, emission
CHANNELS_OUT = 3  # red, green and blue of the result
CHANNELS_LEFT = 7  # of the passes that compositing reads again: depth, normal, colour
NUMBER = 4  # bytes of one of them
RECORD = 16  # bytes of what a texel of the pyramid holds, and of what it receives: one fetch
GROUP = 8  # threads along the side of a work group, as in addon/gather
FETCHES = 256  # by a thread, in the measurement of the fetch rate
REACH = 16  # of those, in texels: the default radius
ROUNDS = 9


@dataclass(frozen=True)
class Work:
    """What one stage must do. samples: those that fall inside the picture."""

    stage: str
    read: int  # bytes
    written: int  # bytes
    fetches: float  # of 16 bytes
    samples: float = 0

    @property
    def bytes(self):
        return self.read + self.written

    def floor(self, rates):
        """Seconds, and which of the rates sets them. rates: as measure() returns them."""
        bounds = {
            "bandwidth": self.bytes / rates["bandwidth"],
            "fetches": self.fetches / rates["fetches"],
            "arithmetic": self.samples / rates["arithmetic"],
        }
        limit = max(bounds, key=bounds.get)
        return bounds[limit], limit


def work(region, width, height, settings):
    """[Work] of a frame of width x height pixels, stage by stage. region: the module light.pyramid."""
    sizes = region.level_sizes(-(-width // settings.start), -(-height // settings.start), settings.radius)
    pixels, base, texels = width * height, sizes[0][0] * sizes[0][1], sum(w * h for w, h in sizes)
    samples = sum(_samples(region, index, size, settings) for index, size in enumerate(sizes))

    def streams(stage, read, written):
        return Work(stage, read, written, read / RECORD)

    gathered = streams("gather", texels * RECORD, texels * RECORD)
    return [
        streams("pack", pixels * CHANNELS_IN * NUMBER, base * RECORD),
        streams("pyramid", base * RECORD, (texels - base) * RECORD),
        Work("gather", gathered.read, gathered.written, gathered.fetches + samples, samples),
        streams("upsample", texels * 2 * RECORD, base * RECORD),
        streams("composite", pixels * CHANNELS_LEFT * NUMBER + base * 2 * RECORD, pixels * CHANNELS_OUT * NUMBER),
    ]


def _samples(region, index, size, settings):
    """How many samples of a level fall inside the picture: each texel of the region is drawn as often as any other."""
    table = abs(region.offsets(settings.radius, finest=index == 0))
    inside = ((size[0] - table[:, 0]).clip(0) * (size[1] - table[:, 1]).clip(0)).sum()
    return float(inside) * region.samples_at(index, settings.samples, len(table)) / len(table)


def measure(light, passes, camera, settings):
    """The rates of this machine and the frame they are to be held against, measured in turn, medians of ROUNDS:

    "bandwidth" (bytes a second), "fetches" and "arithmetic" (samples a second); "copies" and "fetch_formats", which the
    first two are the fastest of; "frame" and "gather", the seconds of all passes and of those that gather."""
    width, height = passes.size
    base = -(-width // settings.start), -(-height // settings.start)
    probes = {("fetch_formats", format): fetches(format, base) for format in ("RGBA32F", "RGBA32UI")}
    probes |= {
        ("copies", f"{format} {size[0]}x{size[1]}"): copy(format, size)
        for format in ("R32F", "RGBA32F")
        for size in (base, (width, height), (2048, 2048))
    }
    seconds = {}

    def note(name, measured):
        seconds.setdefault(name, []).append(measured)

    def frame():
        with opengl.timed(light) as dispatches:
            light.gather_indirect(passes, camera, settings)
        by_pass = {name: sum(parts) for name, parts in dispatches.items()}
        return sum(by_pass.values()), sum(by_pass[name] for name in gather_passes(light))

    for _ in range(1 + ROUNDS):  # the first compiles
        for name, (_, run) in probes.items():
            note(name, run())
        whole, gather = frame()
        note("frame", whole)
        note("gather", gather)
        with without_fetches(light):
            note("arithmetic", frame()[1])
    found = {name: median(measured[1:]) for name, measured in seconds.items()}
    rates = {
        kind: {name[1]: amount / found[name] for name, (amount, _) in probes.items() if name[0] == kind}
        for kind in ("copies", "fetch_formats")
    }
    return rates | {
        "bandwidth": max(rates["copies"].values()),
        "fetches": max(rates["fetch_formats"].values()),
        "arithmetic": _all_samples(light.pyramid, passes.size, settings) / found["arithmetic"],
        "frame": found["frame"],
        "gather": found["gather"],
    }


def _all_samples(region, size, settings):
    """Samples of a frame, whether they fall inside the picture or not."""
    sizes = region.level_sizes(*(-(-extent // settings.start) for extent in size), settings.radius)
    return sum(
        width
        * height
        * region.samples_at(index, settings.samples, len(region.offsets(settings.radius, finest=index == 0)))
        for index, (width, height) in enumerate(sizes)
    )


def copy(format, size):
    """A copy from texture to texture: (bytes read and written, function that runs it and returns seconds)."""
    components, kind = opengl.FORMATS[format]
    return 2 * size[0] * size[1] * components * int(kind[1]), probe(
        format,
        size,
        f"""void main() {{
        ivec2 p = ivec2(gl_GlobalInvocationID.xy);
        if (p.x < {size[0]} && p.y < {size[1]}) {{ imageStore(target, p, texelFetch(source, p, 0)); }}
    }}""",
    )


def fetches(format, size):
    """Neighbouring threads read neighbouring texels, all at the same offset from their own: (fetches, function)."""
    vector = "uvec4" if format.endswith("UI") else "vec4"
    threads = [-(-extent // GROUP) * GROUP for extent in size]
    return threads[0] * threads[1] * FETCHES, probe(
        format,
        size,
        f"""void main() {{
        ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2({size[0] - 1}, {size[1] - 1});
        {vector} sum = {vector}(0);
        for (uint k = 0u; k < {FETCHES}u; k++) {{
          uint random = k * 2654435769u;
          ivec2 offset = ivec2(random >> 27u, (random >> 22u) & 31u) - {REACH};
          sum += texelFetch(source, clamp(p + offset, ivec2(0), last), 0);
        }}
        if (p.x <= last.x && p.y <= last.y) {{ imageStore(target, p, sum); }}
    }}""",
    )


def probe(format, size, main):
    """A function that runs a shader with a thread for each texel of its textures, and returns seconds."""
    info = opengl.CreateInfo()
    info.sampler(0, "UINT_2D" if format.endswith("UI") else "FLOAT_2D", "source")
    info.image(0, format, "UINT_2D" if format.endswith("UI") else "FLOAT_2D", "target", {"WRITE"})
    info.local_group_size(GROUP, GROUP)
    info.compute_source(main)
    shader, source, target = opengl.Shader(info), opengl.Texture(size, format), opengl.Texture(size, format)

    def run():
        shader.uniform_sampler("source", source)
        shader.image("target", target)
        with opengl._timer() as timer:
            opengl.dispatch(shader, *(-(-extent // GROUP) for extent in size), 1)
        return timer.elapsed * 1e-9

    return run
