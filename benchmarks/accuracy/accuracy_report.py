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

import matplotlib
import numpy as np

matplotlib.use("Agg")

import matplotlib.pyplot as plt

from .. import figures
from . import metrics

PICTURES = {"indirect": "Indirect light", "final": "Final image"}
PLOT, STUDY = "error_against_cost.webp", "eevee_study.json"
CURVES = {"EEVEE": "s", "EEVEE ray tracing": "D", "Afterlight": "o", "Cycles": "^", "Cycles, denoised": "v"}
COLORS = dict(zip(CURVES, ("0.35", "tab:blue", "tab:orange", "tab:green", "tab:purple"), strict=True))
SHEET_GROUPS = {"EEVEE", "EEVEE ray tracing", "Afterlight", "Cycles, denoised"}
LIFT = 2.0  # stops, by which the contact sheets look into the shadows


def write(path, page):
    """The page `page`, a page a scene and the plot from an accuracy.json, whose folder holds the pictures."""
    found, folder = json.loads(path.read_text()), path.parent
    if measured(found):
        plot(found, folder / PLOT)
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
        f"The error of EEVEE, its ray tracing and Afterlight against Cycles with {found['bounces']} diffuse "
        "bounces, at "
        f"{found['size'][0]} x {found['size'][1]} and {found['samples']} EEVEE samples. Measured at commit "
        f"{found.get('commit', 'before 0.4.0, see the page in the history')} on {found['machine']} by",
        f"    {found['command']}",
        "- *Indirect light*: bounced diffuse light, albedo included, and the direct light of meshes and world. "
        "Afterlight's is what it adds to the picture, plus the world's light in EEVEE's.\n"
        "- *Energy*: mean over the reference's. *Relative L1*: mean difference over the reference's mean. "
        "*relMSE*: mean "
        f"of squared difference over squared reference + {metrics.EPSILON}. *99.9 %*: ratio of those percentiles. "
        "*HDR-FLIP*: the error as an eye sees it. *Cost*: seconds of a frame over plain EEVEE's beside it.\n"
        "- The reference is two independent halves, whose difference is its noise. Errors under "
        f'{found["clearly"]} times the noise are refused; "a, < b" is an estimate and an upper bound.',
    ]
    if measured(found):
        parts += [f"![Error against cost]({folder}/{PLOT})", *means(found), *by_scene(found, folder)]
    if missing := [scene for scene in found["scenes"] if "tables" not in scene]:
        parts += ["\n".join(f"- {scene['name']}: {not_measured(scene)}" for scene in missing)]
    if study:
        parts += study_parts(study)
    return "\n\n".join(parts) + "\n"


def by_scene(found, folder):
    """A row a scene: relative L1 of the indirect light by each way, and the way to the scene's own page."""
    rows = []
    for scene in measured(found):
        (one,) = [one for one in scene["tables"] if one["surface"] == "diffuse"][:1] or [None]
        errors = {row["name"]: cells(row, "indirect")[2] for row in one["rows"]} if one else {}
        rows.append((f"[{scene['name']}]({folder}/{scene['name']}.md)", errors))
    names = [name for name in dict.fromkeys(name for _, errors in rows for name in errors) if "Cycles, " not in name]
    return [
        "## Scenes",
        "Relative L1 of the indirect light on diffuse surfaces. Each scene has a page with all numbers, a "
        "contact sheet "
        "and the causes of the error of the preset Paper.",
        grid(["scene", *names], [[link, *(errors.get(name, "–") for name in names)] for link, errors in rows]),
    ]


def means(found):
    """A table of means over the scenes."""
    tables = [one for scene in measured(found) for one in scene["tables"] if one["surface"] == "diffuse"]
    names = list(dict.fromkeys(row["name"] for one in tables for row in one["rows"]))
    averaged = []
    for name in names:
        rows = [row for one in tables for row in one["rows"] if row["name"] == name]
        averaged.append(
            {"name": name}
            | {picture: mean_of([row.get(picture, {}) for row in rows]) for picture in PICTURES}
            | {"cost": average([row.get("cost") for row in rows])}
        )
    return [
        "## Mean over the scenes",
        f"Diffuse surfaces of {len(tables)} scenes; a dash where a scene has no number.",
        *picture_tables(averaged),
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
        parts += whole_parts(scene["whole"])
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


def whole_parts(whole):
    """LDR-FLIP of the whole picture as it is displayed."""
    rows = [[name, number(found["cycles"]), number(found["reachable"])] for name, found in whole.items()]
    return [
        "The whole picture through the scene's view transform. The *reachable* picture is EEVEE's own with Cycles' "
        "indirect light in place of its own.",
        grid(["LDR-FLIP", "against Cycles", "against the reachable picture"], rows),
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


def plot(found, path):
    """Relative L1 of the indirect light against the cost of a frame: each scene thin, their mean thick."""
    figure, axes = plt.subplots(figsize=(8, 5), dpi=110, layout="constrained")
    tables = [one for scene in measured(found) for one in scene["tables"] if one["surface"] == "diffuse"]
    for group, marker in CURVES.items():
        lines = [
            [
                (row["cost"], row.get("indirect", {}).get("l1"), row["name"])
                for row in one["rows"]
                if row["group"] == group and "cost" in row
            ]
            for one in tables
        ]
        for line in lines:
            drawn = [point for point in line if point[1]]
            axes.loglog(
                [x for x, *_ in drawn],
                [y for _, y, _ in drawn],
                "-",
                marker=marker,
                color=COLORS[group],
                alpha=0.25,
                linewidth=0.7,
                markersize=3,
            )
        names = list(dict.fromkeys(name for line in lines for *_, name in line))
        points = [[(x, y) for line in lines for x, y, own in line if own == name and y] for name in names]
        # Only where every scene has the number: a mean over other scenes would be another mean.
        thick = [(name, np.mean(each, 0)) for name, each in zip(names, points, strict=True) if len(each) == len(tables)]
        if thick:
            places = np.array([place for _, place in thick])
            axes.loglog(*places.T, "-", marker=marker, color=COLORS[group], linewidth=2, markersize=8, label=group)
            for name, place in thick:
                axes.annotate(name.rpartition(", ")[2], place, xytext=(6, 5), textcoords="offset points", fontsize=8)
    axes.set_xlabel("seconds a frame over plain EEVEE's")
    axes.set_ylabel(f"relative L1 of the indirect light, against Cycles with {found['bounces']} bounces")
    axes.grid(True, which="both", alpha=0.2)
    axes.legend()
    figures.save(figure, path, exact=True)


def sheet(rendered, indirect, final, surface, path):
    """A contact sheet: a row for the reference and each candidate; final image, the same with shadows lifted, indirect
    light, signed error of it. Where a way has no indirect light by itself, its whole error is the light's."""
    shown = [each for each in rendered if each.final is not None and each.group in SHEET_GROUPS]
    rows = [("Cycles", final, indirect)]
    for each in shown:
        light = each.indirect if each.indirect is not None else each.final - final + indirect
        rows.append((each.name, each.final, light))
    height, width = surface.shape
    figure, axes = plt.subplots(
        len(rows), 4, figsize=(13.3, len(rows) * 3.35 * height / width), dpi=80, squeeze=False, layout="constrained"
    )
    white, scale = exposure(final[surface]), indirect[surface].mean()
    for (name, image, light), line in zip(rows, axes, strict=True):
        line[0].imshow(tone(image / white), interpolation="nearest")
        line[1].imshow(tone(image * 2**LIFT / white), interpolation="nearest")
        line[2].imshow(tone(light / max(exposure(indirect[surface]), 1e-30)), interpolation="nearest")
        error = np.where(surface, (light - indirect).mean(-1) / max(scale, 1e-30), 0)
        drawn = line[3].imshow(error, cmap="RdBu_r", vmin=-2, vmax=2, interpolation="nearest")
        line[0].set_ylabel(name, fontsize=8)
        for each in line:
            each.set_xticks([])
            each.set_yticks([])
    for each, title in zip(
        axes[0],
        ("final image", f"final image, {LIFT:+.0f} stops", "indirect light", "error of it, over the reference's mean"),
        strict=True,
    ):
        each.set_title(title, fontsize=9)
    figure.colorbar(drawn, ax=axes[:, 3], shrink=0.4, extend="both")
    figures.save(figure, path)


def exposure(colors):
    """The radiance that is shown as white."""
    return max(float(np.percentile(colors, 99)), 1e-30) if colors.size else 1.0


def tone(image):
    """Linear light as sRGB shows it."""
    image = np.nan_to_num(image).clip(0, 1)
    return np.where(image <= 0.0031308, 12.92 * image, 1.055 * image ** (1 / 2.4) - 0.055)


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
