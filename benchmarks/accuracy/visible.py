# SPDX-License-Identifier: GPL-3.0-or-later
"""The errors that the eye sees first: blotches, dots, and the difference of two displayed pictures.

Pictures are (H, W, 3) linear radiance unless a function says otherwise, masks (H, W) bool. No Blender is needed, but
for displayed().
"""

import numpy as np

REACHABLE, NOISE = "EEVEE with Cycles' indirect light", "Cycles' own noise"  # beside the ways that are compared
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
FINEST, COARSEST = 4, 32  # pixels across: the band that blotches() looks at; finer is grain, coarser a shift of light
DARKEST = 0.05  # of the mean light: by less no error is divided
STANDS_OUT = 0.25  # of the local brightness, above which a pixel is a dot


def blotches(light, reference, mask, picture=None, halves=None):
    """Root mean square of the relative error of `light` in the band of FINEST to COARSEST pixels, over the mask.

    The error is that of luminance, averaged over FINEST pixels, over that of the picture likewise averaged, and what
    lies outside the mask counts neither as error nor as light around. picture: that the light is a part of, the true
    one; `reference` itself without. halves: two independent references of which `reference` is the mean: what their own
    noise comes to is taken off. None for an empty mask or a black picture."""
    truth = reference @ LUMINANCE
    shown = truth if picture is None else picture @ LUMINANCE
    mean = shown[mask].mean() if mask.any() else 0
    if not mean > 0:
        return None
    around = np.maximum(_smooth(shown, mask, FINEST), DARKEST * mean)

    def strength(error):
        relative = np.where(mask, _smooth(error, mask, FINEST) / around, 0)
        band = relative - _smooth(relative, mask, COARSEST)
        return (band[mask] ** 2).mean()

    found = strength(light @ LUMINANCE - truth)
    if halves is not None:
        found -= strength((halves[0] - halves[1]) @ LUMINANCE / 2)  # the noise of their mean
    return float(np.sqrt(max(found, 0.0)))


def dots(light, reference, mask, picture=None, halves=None):
    """Pixels of the mask, per million, whose error differs from the median error of their eight neighbours by more than
    STANDS_OUT of the picture's mean luminance over 3 x 3 pixels. Neighbours outside the mask do not count; a pixel
    with fewer than three is left out. picture, halves: as blotches() has them; as many dots as their noise has are
    taken off. None for an empty mask or a black picture."""
    truth = reference @ LUMINANCE
    shown = truth if picture is None else picture @ LUMINANCE
    mean = shown[mask].mean() if mask.any() else 0
    if not mean > 0:
        return None
    around = _neighbours(np.where(mask, shown, np.nan))
    enough = np.isfinite(around).sum(0) >= 3
    counted = mask & enough
    brightness = np.nanmean(np.concatenate([around, shown[None]]), axis=0)
    least = STANDS_OUT * np.maximum(brightness, DARKEST * mean)

    def count(error):
        nearby = _neighbours(np.where(mask, error, np.nan))
        median = np.nanmedian(np.where(enough, nearby, 0.0), axis=0)
        return np.count_nonzero((np.abs(error - median) > least) & counted)

    found = count(light @ LUMINANCE - truth)
    if halves is not None:
        found = max(found - count((halves[0] - halves[1]) @ LUMINANCE / 2), 0)
    return float(1e6 * found / max(np.count_nonzero(counted), 1))


def ldr_flip(picture, reference):
    """Mean LDR-FLIP error of two displayed pictures: see flip_map()."""
    return float(flip_map(picture, reference).mean(dtype=np.float64))


def flip_of_noise(halves):
    """Mean LDR-FLIP that the noise of a reference has in a comparison with it. halves: two displayed pictures of
    independent noise, whose mean is the reference: each differs from that by as much as that from the truth."""
    return ldr_flip(halves[0], (halves[0] + halves[1]) / 2)


def flip_map(picture, reference):
    """(H, W): LDR-FLIP error of two displayed pictures, (H, W, 3) in 0..1, encoded as the screen has them (sRGB), at
    the viewing distance that FLIP assumes."""
    import flip_evaluator

    reference = np.ascontiguousarray(reference, np.float32).clip(0, 1)
    picture = np.ascontiguousarray(picture, np.float32).clip(0, 1)
    error, _, _ = flip_evaluator.evaluate(
        reference, picture, "LDR", inputsRGB=True, applyMagma=False, computeMeanError=False
    )
    return error[..., 0]


def displayed(scene, picture, stops=0.0):
    """A picture as the scene's view transform shows it, (H, W, 3) float32 in 0..1, encoded for the screen. stops: by
    which it is brightened first, to look into the shadows."""
    import tempfile
    from pathlib import Path

    import bpy

    height, width = picture.shape[:2]
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = picture[::-1] * 2.0**stops
    settings = scene.render.image_settings
    before = settings.file_format, settings.color_mode, settings.color_depth
    image = bpy.data.images.new("displayed", width, height, float_buffer=True)
    try:
        image.pixels.foreach_set(pixels.ravel())
        settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGB", "16"
        with tempfile.TemporaryDirectory(prefix="afterlight-displayed-") as folder:
            path = str(Path(folder) / "picture.png")
            image.save_render(path, scene=scene)
            shown = bpy.data.images.load(path)
            shown.colorspace_settings.name = "Non-Color"
            shown.pixels.foreach_get(pixels.ravel())
            bpy.data.images.remove(shown)
    finally:
        settings.file_format, settings.color_mode, settings.color_depth = before
        bpy.data.images.remove(image)
    return pixels[::-1, :, :3].copy()


def reachable(plain, plain_indirect, indirect):
    """EEVEE's own picture with Cycles' indirect light in place of EEVEE's: the best that an addition of indirect light
    can reach, since reflections, shadows and direct light are EEVEE's. plain: EEVEE's picture. plain_indirect: what of
    it is indirect light. indirect: Cycles'."""
    return plain - plain_indirect + indirect


def _smooth(values, mask, width):
    """Mean around each pixel by a Gaussian whose full width at half maximum is `width` pixels, of the mask alone."""
    kernel = _gaussian(width)
    weights = mask.astype(float)

    def blurred(plane):
        return _along(_along(plane, kernel, 0), kernel, 1)

    return blurred(np.where(mask, values, 0.0)) / np.maximum(blurred(weights), 1e-9)


def _along(plane, kernel, axis):
    """Convolution along an axis, with zeros outside."""
    reach = len(kernel) // 2
    padded = np.pad(plane, [(reach, reach) if each == axis else (0, 0) for each in (0, 1)])
    size = plane.shape[axis]
    found = np.zeros_like(plane, dtype=float)
    for offset, weight in enumerate(kernel):
        found += weight * np.take(padded, np.arange(offset, offset + size), axis)
    return found


def _gaussian(width):
    deviation = width / (2 * np.sqrt(2 * np.log(2)))
    reach = int(np.ceil(3 * deviation))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / deviation) ** 2)
    return kernel / kernel.sum()


def _neighbours(plane):
    """(8, H, W): the neighbours of each pixel, NaN outside."""
    padded = np.pad(plane, 1, constant_values=np.nan)
    height, width = plane.shape
    return np.stack([padded[y : y + height, x : x + width] for y in range(3) for x in range(3) if (y, x) != (1, 1)])
