# SPDX-License-Identifier: GPL-3.0-or-later
"""What benchmarks.accuracy found, as a page of Markdown, a plot, and a contact sheet a scene. No Blender is needed.

    .venv/bin/python -m benchmarks.accuracy.accuracy_report docs/measured/accuracy/accuracy.json [--page
    docs/measured/accuracy.md]

draws page and plot again from the numbers alone; contact sheets are drawn while the pictures are at hand."""

import argparse
import json
import os
from pathlib import Path
from statistics import mean

from . import accuracy_plots, metrics
from .visible import NOISE, REACHABLE

PICTURES = {"indirect": "Indirect light", "final": "Final image"}
PLOT, STUDY = "error_against_cost.webp", "eevee_study.json"


def write(path, page):
    """The page `page`, a page a scene and the plot from an accuracy.json, whose folder holds the pictures."""
    found, folder = json.loads(path.read_text()), path.parent
    if measured(found):
        accuracy_plots.plot(measured(found), folder / PLOT)
    for scene in found["scenes"]:
        text = "\n\n".join(
            [
                f"# {scene['name']}",
                f"A scene of [Accuracy]({os.path.relpath(page, folder)}), which explains the terms.",
                *scene_parts(scene, found),
            ]
        )
        (folder / f"{scene['name']}.md").write_text(text + "\n")
    study = json.loads((folder / STUDY).read_text()) if (folder / STUDY).exists() else None
    page.write_text(markdown(found, os.path.relpath(folder, page.parent), study))


def measured(found):
    return [scene for scene in found["scenes"] if "tables" in scene]


def markdown(found, folder, study=None):
    """The page. folder: of the pictures and of the scenes' pages, seen from the page."""
    parts = [
        "# Accuracy",
        "How near EEVEE, its ray tracing, Afterlight and Cycles with few samples and its denoiser come to Cycles with "
        f"many samples and {found['bounces']} diffuse bounces, at {found['size'][0]} x {found['size'][1]} and "
        f"{found['samples']} EEVEE samples. Measured at commit "
        f"{found.get('commit', 'before 0.4.0, see the page in the history')} on {found['machine']} by",
        f"    {found['command']}",
    ]
    if measured(found):
        parts += [*seen(found, folder), *light(found, folder)]
    if missing := [scene for scene in found["scenes"] if "tables" not in scene]:
        parts += ["\n".join(f"- {scene['name']}: {not_measured(scene)}" for scene in missing)]
    if study:
        parts += study_parts(study)
    return "\n\n".join(parts) + "\n"


def seen(found, folder):
    """The whole pictures and their cost: means over the scenes, the plot, and a row a scene."""
    scenes = measured(found)
    names = [name for name in ways(scenes) if any("cost" in row for row in rows_called(scenes, name))]
    rows = []
    for name in [*names, REACHABLE, NOISE]:
        own = rows_called(scenes, name)
        pictures = [scene["whole"].get(name, {}) for scene in scenes]
        marks = [row.get("visible", {}) for row in own]
        rows.append(
            [
                name,
                *(number(average([each.get(key) for each in pictures])) for key in ("cycles", "reachable")),
                number(average([each.get("blotches") for each in marks] or [None])),
                number(average([each.get("dots") for each in marks] or [None]), 0),
                *costs(own),
            ]
        )
    by_scene = [
        [
            f"[{scene['name']}]({folder}/{scene['name']}.md)",
            *(number(scene["whole"].get(name, {}).get("cycles")) for name in [*names, REACHABLE, NOISE]),
            "–" if scene.get("caustics") is None else f"{scene['caustics']:.0%}",
        ]
        for scene in scenes
    ]
    return [
        "## The whole picture, and its cost",
        f"Means over {len(scenes)} scenes; a dash where a scene has no number.",
        grid(
            [
                "",
                "LDR-FLIP against Cycles",
                "against the reachable picture",
                "blotches",
                "dots per million",
                "cost",
                "graphics card",
                "host",
            ],
            rows,
        ),
        "- *LDR-FLIP*: the error as an eye sees it, of the whole picture through the scene's view transform.\n"
        f"- The *reachable picture* is {REACHABLE} in place of its own: its reflections, refractions, shadows and "
        "direct light are not Afterlight's to change. Its row is the error that is EEVEE's own.\n"
        "- *Blotches*: root mean square of the error of the light between 4 and 32 pixels across, over the brightness "
        "there, on diffuse surfaces. *Dots*: pixels whose error stands out from their neighbours' by a quarter of that "
        "brightness. The light is the indirect light; of denoised ways, which have none by itself, all of it. The "
        "reference's noise is taken off the first; dots are counted against the denoised reference.\n"
        "- *Cost*: seconds of a frame over plain EEVEE's beside it. Of that, *graphics card*: EEVEE's drawing and "
        "Afterlight's shaders; *host*: evaluation, files, placing of views, which take the same on any machine with "
        "such a processor. **Here the graphics card is software, on the same processor as Cycles: that flatters "
        "Cycles.** On a graphics card the first share nearly vanishes.\n"
        "- LDR-FLIP compares with the reference as Blender's denoiser leaves its many samples. "
        f"*{NOISE}*: the part that what is left of its noise may have in each number.",
        f"![Error against cost]({folder}/{PLOT})",
        "LDR-FLIP against Cycles, scene by scene. Each has a page with all numbers and a contact sheet. *Caustics*: "
        "share of the indirect light on diffuse surfaces that comes by way of gloss and glass, which EEVEE has not.",
        grid(["scene", *names, REACHABLE, NOISE, "caustics"], by_scene),
    ]


def ways(scenes):
    """Names of all ways to render, in their order."""
    return list(dict.fromkeys(row["name"] for scene in scenes for row in accuracy_plots.rows_of(scene)))


def rows_called(scenes, name):
    """A way's rows of the tables of diffuse surfaces; {} where a scene has none."""
    if name in (REACHABLE, NOISE):
        return []
    return [
        next((row for row in accuracy_plots.rows_of(scene) if row["name"] == name), {"name": name}) for scene in scenes
    ]


def costs(rows):
    """[cost, graphics card's share of it, host's]."""
    cost, host = (average([row.get(key) for row in rows] or [None]) for key in ("cost", "host"))
    if rows and rows[0].get("group", "").startswith("Cycles"):
        return [number(cost, 2), number(None), number(None)]
    return [number(cost, 2), number(None if None in (cost, host) else cost - host, 2), number(host, 2)]


def light(found, folder):
    """The light alone, on diffuse surfaces: means over the scenes, and a row a scene."""
    scenes = measured(found)
    averaged = []
    for name in ways(scenes):
        rows = rows_called(scenes, name)
        averaged.append(
            {"name": name}
            | {picture: mean_of([row.get(picture, {}) for row in rows]) for picture in PICTURES}
            | {"cost": average([row.get("cost") for row in rows])}
        )
    names = [row["name"] for row in averaged if row["indirect"]["l1"] is not None or "at_most" in row["indirect"]]
    by_scene = []
    for scene in scenes:
        errors = {row["name"]: cells(row, "indirect")[2] for row in accuracy_plots.rows_of(scene)}
        by_scene.append([f"[{scene['name']}]({folder}/{scene['name']}.md)", *(errors.get(name, "–") for name in names)])
    return [
        "## The light alone",
        "- *Indirect light*: bounced diffuse light, albedo included, and the direct light of meshes and world. "
        "Afterlight's is what it adds to the picture, plus the world's light in EEVEE's. Cycles' denoiser works on the "
        "whole picture: with it there is no indirect light by itself.\n"
        "- *Energy*: mean over the reference's. *Relative L1*: mean difference over the reference's mean. *relMSE*: "
        f"mean of squared difference over squared reference + {metrics.EPSILON}. *99.9 %*: ratio of those percentiles. "
        "*HDR-FLIP*: FLIP at all exposures.\n"
        "- The reference is two independent halves, whose difference is its noise. Errors under "
        f'{found["clearly"]} times the noise are refused; "a, < b" is an estimate, the noise taken off, and an upper '
        "bound.",
        f"Means over the diffuse surfaces of {len(scenes)} scenes:",
        *picture_tables(averaged),
        "Relative L1 of the indirect light, scene by scene:",
        grid(["scene", *names], by_scene),
    ]


def mean_of(scenes):
    """Of the numbers of several scenes; the mean of bounds is a bound."""
    found = {key: average([each.get(key) for each in scenes]) for key in metrics.NAMES}
    if any("at_most" in each for each in scenes):
        for key in ("at_most", "about"):
            found[key] = average([each.get(key, each.get("l1")) for each in scenes])
    return found


def average(values):
    return None if None in values else mean(values)


def not_measured(scene):
    return f"Not measured: {scene.get('skipped') or scene.get('failed')}."


def scene_parts(scene, found):
    """The paragraphs of a scene's own page, which lies beside its contact sheet."""
    if "tables" not in scene:
        return [not_measured(scene)]
    parts = [f"![Contact sheet]({scene['name']}.webp)"]
    for one in scene["tables"]:
        what = (
            "Diffuse surfaces"
            if one["surface"] == "diffuse"
            else (
                f"Surfaces that are not diffuse (gloss and glass are over {found['not_diffuse']:.0%} of their colour)"
            )
        )
        noise = ", ".join(f"{PICTURES[name].lower()} {number(value, 4)}" for name, value in one["noise"].items())
        world = (
            f" The world's direct light is {one['world']:.0%} of the indirect light."
            if one.get("world", 0) > 0.001
            else ""
        )
        parts += [
            f"{what}, {one['share']:.1%} of the frame. The reference has "
            f"{scene['samples'][str(found['bounces'])]} samples; its noise, as relative L1: {noise}.{world}",
            *picture_tables(one["rows"]),
            *visible_parts(one["rows"]),
        ]
    if "whole" in scene:
        parts += whole_parts(scene)
    return parts + cause_parts(scene.get("causes"))


def picture_tables(rows):
    """One table for the indirect light and one for the final image."""
    return [
        grid([title, *metrics.NAMES.values(), "cost"], [cells(row, picture) for row in rows])
        for picture, title in PICTURES.items()
    ]


def visible_parts(rows):
    """Blotches and dots of the light; nothing for numbers that were measured without them."""
    seen = [row for row in rows if "visible" in row]
    if not seen:
        return []
    head = ["light", "blotches", "dots per million"]
    return [
        grid(
            head, [[row["name"], number(row["visible"]["blotches"]), number(row["visible"]["dots"], 0)] for row in seen]
        )
    ]


def whole_parts(scene):
    """LDR-FLIP of the whole picture as it is displayed."""
    kinds = [one["surface"] for one in scene["tables"]]
    keys = ["cycles", *(f"cycles, {kind}" for kind in kinds), "reachable"]
    rows = [[name, *(number(found.get(key)) for key in keys)] for name, found in scene["whole"].items()]
    caustics = scene.get("caustics")
    return [
        "The whole picture through the scene's view transform. The *reachable* picture is EEVEE's own with Cycles' "
        "indirect light in place of its own; its row is the error that is EEVEE's own."
        + ("" if caustics is None else f" Caustics are {caustics:.1%} of the indirect light on diffuse surfaces."),
        grid(
            ["LDR-FLIP", "against Cycles", *(f"on {kind} surfaces" for kind in kinds), "against the reachable picture"],
            rows,
        ),
    ]


def cells(row, picture):
    found = row.get(picture, {})
    if "failed" in row:
        return [row["name"], f"failed: {row['failed']}", *[""] * len(metrics.NAMES)]
    missing = "refused" if "refused" in found else number(None)
    numbers = {key: missing if found.get(key) is None else number(found[key]) for key in metrics.NAMES}
    if "at_most" in found:
        about = f"{number(found['about'])}, " if found.get("about") is not None else ""
        numbers["l1"] = f"{about}< {number(found['at_most'])}"
    return [row["name"], *numbers.values(), number(row.get("cost"), 2)]


def cause_parts(causes):
    if not causes:
        return []
    rows = [
        [
            row["name"],
            row["explanation"],
            number(row.get("share")),
            number(row.get("gain")),
            *(number(row.get(key)) for key in metrics.NAMES),
        ]
        for row in causes
    ]
    return [
        "Where the error of the preset Paper comes from, each cause against the next better picture. *Share* is the "
        "mean difference, *gain* the energy that the cause adds, both over the reference's mean; gains add up.",
        grid(["cause", "", "share", "gain", *metrics.NAMES.values()], rows),
    ]


def study_parts(study):
    rows = [
        [
            row["name"],
            *(number(row["l1"].get(name)) for name in study["scenes"]),
            number(row["mean"]),
            number(row["cost"], 2),
        ]
        for row in study["rows"]
    ]
    return [
        "## EEVEE's ray tracing at its best",
        f"What *best* above means: the settings with the least mean relative L1 "
        f"of the indirect light, at {study['size'][0]} x {study['size'][1]} and {study['samples']} samples (its "
        "light grows with "
        "the samples, so its errors here are above those of the tables), measured at commit "
        f"{study.get('commit', 'unknown')} by",
        f"    {study['command']}",
        "Settings whose numbers equal the default's do not touch diffuse surfaces.",
        grid(["settings (others at their defaults)", *study["scenes"], "mean", "cost"], rows),
    ]


def grid(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def number(value, digits=3):
    return "–" if value is None else f"{value:.{digits}f}"


def main():
    parser = argparse.ArgumentParser(description="The page and the plot of an accuracy.json again.")
    parser.add_argument("numbers", type=Path, metavar="accuracy.json")
    parser.add_argument("--page", type=Path, help="accuracy.md beside it")
    options = parser.parse_args()
    if not options.numbers.is_file():
        parser.error(f"there is no {options.numbers}; 'make accuracy' writes docs/measured/accuracy/accuracy.json")
    write(options.numbers, options.page or options.numbers.parent / "accuracy.md")


if __name__ == "__main__":
    main()
