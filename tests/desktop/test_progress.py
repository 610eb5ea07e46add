# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist reads and sees while our part goes on."""

import steps


def listen():
    """Note what the engine has Blender show in `told`, as (seconds, text) and (seconds, share)."""
    from bl_ext.user_default.afterlight.addon.pipeline.engine import AfterlightEngine as engine
    names["told"] = told = []
    show, move = bpy.types.RenderEngine.update_stats, bpy.types.RenderEngine.update_progress
    engine.update_stats = lambda self, *texts: (told.append((time.perf_counter(), ", ".join(texts))), show(self, *texts))
    engine.update_progress = lambda self, share: (told.append((time.perf_counter(), share)), move(self, share))


def listen_no_more():
    from bl_ext.user_default.afterlight.addon.pipeline.engine import AfterlightEngine as engine
    del engine.update_stats, engine.update_progress
    return names["told"]


def test_blender_shows_our_stages_by_name(window, afterlight):
    """Each stage is named, in order, and the bar moves on several times a second while the gather goes on."""
    steps.new_box(window)
    steps.tick(window)
    window.run(steps.long_gather)
    window.run(listen)
    try:
        steps.into_the_gather(window)
        window.picture("gathering")
        window.wait("not rendering()", 120)
    finally:
        told = window.run(listen_no_more)
    texts = [text.removeprefix("Afterlight, ").split(",")[0] for _, text in told if isinstance(text, str)]
    assert [text for text, before in zip(texts, [""] + texts) if text != before] == [
        "Saving passes", "Upload", "Pyramid", "Gather", "Upsample"]
    shares = [share for _, share in told if not isinstance(share, str)]
    assert shares == sorted(shares) and shares[-1] == 1 and len(set(shares)) > 5
