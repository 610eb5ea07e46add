# SPDX-License-Identifier: GPL-3.0-or-later
"""What the machine can do, and what a frame must do at the least: its floor.

    floor = sum over stages of max(bytes / bandwidth, fetches / fetch rate, samples / arithmetic rate)

measure() finds the three rates, work() counts. The counts are of what the method needs however it is laid out: each
number of the input is read once, each result is written once, a sample is one fetch of one record."""

import re
from contextlib import contextmanager
from dataclasses import dataclass
from statistics import median

from . import opengl

CHANNELS_IN = 13          # of the passes, float32: depth, normal, colour, direct light, emission
CHANNELS_OUT = 3          # red, green and blue of the result
CHANNELS_LEFT = 7         # of the passes that compositing reads again: depth, normal, colour
NUMBER = 4                # bytes of one of them
RECORD = 16               # bytes of what a texel of the pyramid holds, and of what it receives: one fetch
GROUP = 8                 # threads along the side of a work group, as in addon/light
FETCHES = 256             # by a thread, in the measurement of the fetch rate
REACH = 16                # of those, in texels: the default radius
REPEATS = 9


@dataclass(frozen=True)
class Work:
    """What one stage must do. samples: those that fall inside the picture."""

    stage: str
    read: int             # bytes
    written: int          # bytes
    fetches: float        # of 16 bytes
    samples: float = 0

    @property
    def bytes(self):
        return self.read + self.written

    def floor(self, rates):
        """Seconds, and which of the rates sets them. rates: as measure() returns them."""
        bounds = {"bandwidth": self.bytes / rates["bandwidth"], "fetches": self.fetches / rates["fetches"],
                  "arithmetic": self.samples / rates["arithmetic"]}
        limit = max(bounds, key=bounds.get)
        return bounds[limit], limit


def work(region, width, height, settings):
    """[Work] of a frame of width x height pixels, stage by stage. region: the module light.region."""
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
    """The rates of this machine, in units a second: "bandwidth" (bytes), "fetches" and "arithmetic" (samples); and what
    the first two are the fastest of, "copies" and "fetch_formats". All at the given frame and settings."""
    width, height = passes.size
    base = -(-width // settings.start), -(-height // settings.start)
    fetched = {format: _fetch_rate(format, base) for format in ("RGBA32F", "RGBA32UI")}
    copies = {f"{format} {size[0]}x{size[1]}": _copy_rate(format, size)
              for format in ("R32F", "RGBA32F") for size in (base, (width, height), (2048, 2048))}
    return {"bandwidth": max(copies.values()), "fetches": max(fetched.values()),
            "arithmetic": _arithmetic_rate(light, passes, camera, settings), "copies": copies, "fetch_formats": fetched}


def _copy_rate(format, size):
    """Bytes a second, read and written, of a copy from texture to texture."""
    shader = _shader(format, f"""void main() {{
        ivec2 p = ivec2(gl_GlobalInvocationID.xy);
        if (p.x < {size[0]} && p.y < {size[1]}) {{ imageStore(target, p, texelFetch(source, p, 0)); }}
    }}""")
    components, kind = opengl.FORMATS[format]
    moved = 2 * size[0] * size[1] * components * int(kind[1])
    return moved / _seconds(shader, format, size)


def _fetch_rate(format, size):
    """Fetches a second where neighbouring threads read neighbouring texels, all at the same offset from their own."""
    shader = _shader(format, f"""void main() {{
        ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = ivec2({size[0] - 1}, {size[1] - 1});
        {_vector(format)} sum = {_vector(format)}(0);
        for (uint k = 0u; k < {FETCHES}u; k++) {{
          uint random = k * 2654435769u;
          ivec2 offset = ivec2(random >> 27u, (random >> 22u) & 31u) - {REACH};
          sum += texelFetch(source, clamp(p + offset, ivec2(0), last), 0);
        }}
        if (p.x <= last.x && p.y <= last.y) {{ imageStore(target, p, sum); }}
    }}""")
    threads = [-(-extent // GROUP) * GROUP for extent in size]
    return threads[0] * threads[1] * FETCHES / _seconds(shader, format, size)


def _vector(format):
    return "uvec4" if format.endswith("UI") else "vec4"


def _shader(format, main):
    info = opengl.CreateInfo()
    kind = "UINT_2D" if format.endswith("UI") else "FLOAT_2D"
    info.sampler(0, kind, "source")
    info.image(0, format, kind, "target", {"WRITE"})
    info.local_group_size(GROUP, GROUP)
    info.compute_source(main)
    return opengl.Shader(info)


def _seconds(shader, format, size):
    """Median seconds of one dispatch over textures of `size`."""
    source, target = (opengl.Texture(size, format) for _ in range(2))
    shader.uniform_sampler("source", source)
    shader.image("target", target)
    groups = [-(-extent // GROUP) for extent in size]
    timers = []
    for _ in range(1 + REPEATS):
        with opengl._timer() as timer:
            opengl.dispatch(shader, *groups, 1)
        timers.append(timer)
    return median(timer.elapsed for timer in timers[1:]) * 1e-9


def _arithmetic_rate(light, passes, camera, settings):
    """Samples a second of the gather's own shader, with records made up in registers instead of fetched."""
    region = light.region
    sizes = region.level_sizes(*(-(-extent // settings.start) for extent in passes.size), settings.radius)
    samples = sum(width * height * region.samples_at(index, settings.samples,
                                                     len(region.offsets(settings.radius, finest=index == 0)))
                  for index, (width, height) in enumerate(sizes))
    seconds = []
    with without_fetches(light):
        for _ in range(1 + REPEATS):
            with opengl.timed(light) as dispatches:
                light.gather_indirect(passes, camera, settings)
            seconds.append(sum(sum(dispatches[name]) for name in gather_passes(light)))
    return samples / median(seconds[1:])


def gather_passes(light):
    """Names of the passes that gather."""
    return [name for name, made_of in light.device.PASSES.items() if "gather" in made_of.files]


@contextmanager
def without_fetches(light):
    """Within the block the passes that gather fetch no records and no offsets; what light they find means nothing."""
    gather = (light.device.SHADERS / "gather.glsl").read_text()

    class CreateInfo(opengl.CreateInfo):
        def __init__(self):
            super().__init__()
            self.vectors = {}

        def sampler(self, slot, kind, name):
            super().sampler(slot, kind, name)
            self.vectors[name] = "uvec4" if kind.startswith("UINT") else "vec4"

        def compute_source(self, text):
            super().compute_source(_fetchless(text, self.vectors) if gather in text else text)

    gpu_types = light.device.gpu.types
    light.release()
    gpu_types.GPUShaderCreateInfo = CreateInfo
    try:
        yield
    finally:
        gpu_types.GPUShaderCreateInfo = opengl.CreateInfo
        light.release()


def _fetchless(text, vectors):
    """A shader's text with its fetches made up. A thread reads one record, real numbers, when it starts; each fetch
    then returns that with its lowest bits flipped by the place asked for, so that the compiler keeps all arithmetic.
    Offsets are 0 or 1: every sample falls inside the picture."""
    made_up, start = "", ""
    for name, vector in vectors.items():
        bits = {"uvec4": "kept_{0} ^ uvec4(p.x & 1)",
                "vec4": "uintBitsToFloat(floatBitsToUint(kept_{0}) ^ uvec4(p.x & 1))"}[vector].format(name)
        if name == "offsets":
            bits = "vec4(p.x & 1, (p.x >> 1) & 1, 0, 0)"
        made_up += f"{vector} kept_{name};\n"
        made_up += f"{vector} made_up_{name}(ivec2 p, int level) {{ return {vector}({bits}); }}\n"
        start += f"  kept_{name} = texelFetch({name}, ivec2(gl_GlobalInvocationID.xy) % textureSize({name}, 0), 0);\n"
    text = re.sub(r"\btexelFetch\(\s*(\w+)\s*,", r"made_up_\1(", text)
    text = text.replace("void main()", "void fetchless()")
    return f"{made_up}{text}\nvoid main()\n{{\n{start}  fetchless();\n}}\n"
