# SPDX-License-Identifier: GPL-3.0-or-later
"""The accuracy benchmark's plot of error against cost, and its contact sheets. No Blender is needed."""

import matplotlib
import numpy as np

matplotlib.use("Agg")

import matplotlib.pyplot as plt

from .. import figures

CURVES = {"EEVEE": "s", "EEVEE ray tracing": "D", "Afterlight": "o", "Cycles, denoised": "v"}
COLORS = dict(zip(CURVES, ("0.35", "tab:blue", "tab:orange", "tab:purple"), strict=True))
LIFT = 2.0  # stops, by which the contact sheets look into the shadows


def plot(scenes, path):
    """The whole picture's LDR-FLIP and the indirect light's relative L1, each against the cost of a frame: each scene
    thin, their mean thick. scenes: those of accuracy.json that were measured."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 5), dpi=110, layout="constrained")
    curves(left, [(flips(scene), groups(scene)) for scene in scenes])
    left.set_ylabel("LDR-FLIP of the whole picture, against Cycles")
    curves(right, [(errors(scene), groups(scene)) for scene in scenes])
    right.set_ylabel("relative L1 of the indirect light, against Cycles")
    for axes in (left, right):
        axes.set_xlabel("seconds a frame over plain EEVEE's")
        axes.grid(True, which="both", alpha=0.2)
        axes.legend()
    figures.save(figure, path, exact=True)


def rows_of(scene):
    return scene["tables"][0]["rows"]


def groups(scene):
    """{way: its curve}."""
    return {row["name"]: row["group"] for row in rows_of(scene) if row["group"] in CURVES}


def flips(scene):
    """{way: (cost, LDR-FLIP)}."""
    return {
        row["name"]: (row["cost"], scene["whole"][row["name"]]["cycles"])
        for row in rows_of(scene)
        if "cost" in row and row["name"] in scene.get("whole", {})
    }


def errors(scene):
    """{way: (cost, relative L1)}; an estimate where the reference is too noisy for more."""
    found = {}
    for row in rows_of(scene):
        light = row.get("indirect", {})
        error = light.get("l1") or light.get("about")
        if "cost" in row and error:
            found[row["name"]] = row["cost"], error
    return found


def curves(axes, scenes):
    """scenes: [({way: (x, y)}, {way: curve})]."""
    for group, marker in CURVES.items():
        names = list(dict.fromkeys(name for _, own in scenes for name, each in own.items() if each == group))
        lines = [np.array([points[name] for name in names if name in points]) for points, _ in scenes]
        color = COLORS[group]
        for line in lines:
            if len(line):
                axes.loglog(*line.T, "-", marker=marker, color=color, alpha=0.25, linewidth=0.7, markersize=3)
        # Only where every scene has the number: a mean over other scenes would be another mean.
        everywhere = [name for name in names if all(name in points for points, _ in scenes)]
        places = np.array([np.mean([points[name] for points, _ in scenes], 0) for name in everywhere])
        if not len(places):
            continue
        axes.loglog(*places.T, "-", marker=marker, color=color, linewidth=2, markersize=8, label=group)
        for name, place in zip(everywhere, places, strict=True):
            word = name.removeprefix("Cycles, ").removesuffix(", denoised").rpartition(", ")[2]
            axes.annotate(word, place, xytext=(6, 5), textcoords="offset points", fontsize=8)


def sheet(rendered, indirect, final, surface, path):
    """A contact sheet: a row for the reference and each candidate; final image, the same with shadows lifted, indirect
    light, signed error of it. Where a way has no indirect light by itself, its whole error is the light's."""
    shown = [each for each in rendered if each.final is not None and each.group in CURVES]
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
