# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a picture is from a reference, in five numbers that do not depend on the scale of the light.

    compare(picture, reference, mask)       used by `python -m benchmarks.accuracy`

Pictures are (H, W, 3) linear radiance, rows top first; masks (H, W) bool.
"""

import numpy as np

NAMES = {"energy": "energy", "l1": "relative L1", "relmse": "relMSE", "p999": "99.9 %", "flip": "HDR-FLIP"}
EPSILON = 0.01  # relMSE's, for references of mean 1: black pixels must not decide it
PERCENTILE = 99.9  # the highlights; the very largest value would be one firefly's
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
MOST_STOPS = 10  # between HDR-FLIP's exposures, where most of the reference is nearly black


def compare(picture, reference, mask, flip=True):
    """{"energy", "l1", "relmse", "p999", "flip"} over the pixels of the mask.

    energy: mean over the reference's mean. l1: mean |difference| over the reference's mean. relmse: mean of squared
    difference / (squared reference + EPSILON), both over the reference's mean. p999: ratio of the 99.9th percentiles.
    flip: mean HDR-FLIP, or None where not asked for. All are None where the reference is black or the mask empty.
    Raises ValueError for pictures of different shapes, and for NaN or infinity within the mask.
    """
    if not picture.shape == reference.shape == (*mask.shape, 3):
        raise ValueError(f"pictures and mask differ in shape: {picture.shape}, {reference.shape}, {mask.shape}")
    a, b = picture[mask].astype(np.float64), reference[mask].astype(np.float64)
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise ValueError("the picture or its reference holds NaN or infinity")
    mean = b.mean() if b.size else 0
    if not mean > 0:
        return dict.fromkeys(NAMES)
    a, b = a / mean, b / mean
    highlight = np.percentile(b, PERCENTILE)
    return {
        "energy": float(a.mean()),
        "l1": float(np.abs(a - b).mean()),
        "relmse": float(((a - b) ** 2 / (b**2 + EPSILON)).mean()),
        "p999": float(np.percentile(a, PERCENTILE) / highlight) if highlight > 0 else None,
        "flip": hdr_flip(picture / mean, reference / mean, mask) if flip else None,
    }


def noise(first, second, mask):
    """Relative L1 error of the mean of two pictures that are equally noisy and independent; None for black ones."""
    a, b = first[mask].astype(np.float64), second[mask].astype(np.float64)
    mean = (a + b).mean() / 2 if a.size else 0
    return float(np.abs(a - b).mean() / 2 / mean) if mean > 0 else None


def l1_without_noise(picture, first, second, mask):
    """Relative L1 error of a picture against what two equally noisy, independent references would come to: an estimate.

    For errors and noise that are normally distributed the square of the mean of |error + noise| is linear in the
    noise's variance, which the mean of both references halves: extrapolated to no noise, 2 l1(mean)^2 - l1(each)^2.
    For other distributions (Laplace's, uniform, mixtures of two scales) that is within a tenth where the noise is as
    large as the error, and too large rather than too small. None for black references."""
    both = compare(picture, (first + second) / 2, mask, flip=False)["l1"]
    if both is None:
        return None
    mean = (first[mask].mean(dtype=float) + second[mask].mean(dtype=float)) / 2
    each = np.mean([np.abs(picture[mask].astype(float) - half[mask]).mean() for half in (first, second)]) / mean
    return float(np.sqrt(max(2 * both**2 - each**2, 0.0)))


def hdr_flip(picture, reference, mask):
    """Mean HDR-FLIP error over the mask; what lies outside it counts as equal."""
    import flip_evaluator  # here: the arithmetic above serves where only numpy is installed

    reference = np.where(np.isfinite(reference), reference, 0).clip(min=0).astype(np.float32)
    picture = np.where(mask[..., None], picture, reference).clip(min=0).astype(np.float32)
    start, stop = exposures(reference[mask])
    error, _, _ = flip_evaluator.evaluate(
        reference,
        picture,
        "HDR",
        applyMagma=False,
        computeMeanError=False,
        parameters={"startExposure": start, "stopExposure": stop},
    )
    return float(error[..., 0][mask].mean(dtype=np.float64))


def exposures(colors):
    """(first, last) exposure of HDR-FLIP for colours (n, 3), as Andersson et al. 2021 choose them: the brightest and
    the median luminance come out at 0.85 of ACES' tone curve.

    Chosen here because flip_evaluator would count what lies outside a mask, and ends the process where the two are one.
    """
    luminance = colors @ LUMINANCE
    brightest, median = luminance.max(), np.median(luminance)
    rise, slope, fall, bend, end = 0.6**2 * 2.51, 0.6 * 0.03, 0.6**2 * 2.43, 0.6 * 0.59, 0.14
    a, b, c = rise - 0.85 * fall, slope - 0.85 * bend, -0.85 * end
    white = (-b + np.sqrt(b * b - 4 * a * c)) / (2 * a)
    first = np.log2(white / brightest)
    stops = np.log2(brightest / max(median, brightest * 2.0**-MOST_STOPS))
    return float(first), float(first + max(stops, 0.01))
