# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist reads and sees while our part goes on."""

import steps


def listen():
    """Note the words and the share that the engine has Blender show in `told`."""
    from bl_ext.user_default.afterlight.addon.render.engine import AfterlightEngine as engine

    told, tell = names["told"], names["tell"] = [], engine._tell

    def tell_us_too(self, text, fraction):
        told.append((text, fraction))
        tell(self, text, fraction)

    engine._tell = tell_us_too


def listen_no_more():
    from bl_ext.user_default.afterlight.addon.render.engine import AfterlightEngine as engine

    engine._tell = names["tell"]
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
    texts = [text.split(",")[0] for text, _ in told]
    assert [text for text, before in zip(texts, [""] + texts) if text != before] == [
        "Saving passes",
        "Upload",
        "Pyramid",
        "Gather",
        "Upsample",
    ]
    shares = [share for _, share in told]
    assert shares == sorted(shares) and shares[-1] == 1 and len(set(shares)) > 5
