# SPDX-License-Identifier: GPL-3.0-or-later
"""Where views must stand to see the surfaces that light the picture. Arrays and a function that casts rays; no Blender.

Paths leave points of the picture as light bounces off them backwards, and go on from what they hit. That is what
should be seen, weighed by the light that reaches the picture by way of it. Places on the paths are free and connected
by construction. Of all such places and 26 directions the one that newly sees most is taken, until nothing much is new;
then each is taken back, and what is best beside all others put in its stead. Other paths than those the places were
chosen by say how much of the light is seen: the views fit their own better than the truth.

`cast(origins, directions, limits, nearest=True)` stands for the scene: arrays of (N, 3), (N, 3) and (N,), directions
of length 1, to (distance, normal, thing): (N,), infinite where nothing lies within the limit; (N, 3), either side;
(N,) int. Without `nearest` any hit within the limit will do, and only whether there is one matters.
"""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

SCORING_PATHS = 1500  # that tell how much of the light is seen
PLACEMENT_PATHS = 4000  # that places are chosen by. Light may come by few of them, through a door,
PLACEMENT_POINTS = 2000  # so these are taken from what they hit, as often as there is light
MAX_BOUNCES = 4  # bounces of a path at most
CANDIDATE_POSITIONS = 100  # on them, that a view may have
MAX_EXCHANGE_ROUNDS = 3  # of taking views back, at most
MIN_GAIN = 0.005  # of all weight, that a further view must newly see
VIEW_CLEARANCE = 0.01  # of the scene's size, between a view and any surface
MIN_VIEW_COSINE = 0.1  # between a surface and a view that sees it: at less, a pixel is too much of the surface
DARK_WEIGHT = 0.03  # of the mean light, that surfaces in the dark count for: the paths end too early for them
MAX_COVERAGE_LOSS = 0.03  # of all weight: views that see less than when they were placed, by more than that, move

DIRECTIONS = np.array([each for each in product((-1, 0, 1), repeat=3) if any(each)], float)
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]


@dataclass(frozen=True, eq=False)
class LightPaths:
    """What lights the picture. starts, places, normals: (N, 3), of each ray. toward: (N,) int, index of the point that
    starts it, by which light goes on to the picture; -1 for the picture itself. sent: (N,), the light that reaches the
    picture after it was first reflected, or emitted, here; its sum is 1. weights: (N,), all light that passes here on
    its way, a share. size: of the scene as far as the paths reach, metres."""

    starts: np.ndarray
    positions: np.ndarray
    normals: np.ndarray
    parents: np.ndarray
    contributions: np.ndarray
    weights: np.ndarray
    size: float

    def resampled(self, seen, count, rng):
        """(Bounces, seen) of `count` draws from all, each as often as its weight. They don't know what they are
        toward."""
        ends = np.cumsum(self.weights)
        at = (np.arange(count) + rng.random(count)) / count * ends[-1]
        which, times = np.unique(np.minimum(np.searchsorted(ends, at), len(ends) - 1), return_counts=True)
        return replace(
            self,
            starts=self.starts[which],
            positions=self.positions[which],
            normals=self.normals[which],
            parents=None,
            contributions=None,
            weights=times / count,
        ), seen[which]

    def subset(self, which):
        """These points alone. They don't know what they are toward. which: (N,) bool."""
        return replace(
            self,
            starts=self.starts[which],
            positions=self.positions[which],
            normals=self.normals[which],
            parents=None,
            contributions=None,
            weights=self.weights[which],
        )

    def arriving_share(self, seen):
        """The share of light that reaches the picture where only what is seen reflects it. seen: (N,) bool."""
        whole = seen.copy()
        for _ in range(MAX_BOUNCES - 1):
            whole = seen & np.where(self.parents < 0, True, whole[self.parents])
        return float(self.contributions @ whole)


@dataclass(frozen=True, eq=False)
class Placement:
    """poses: 4 x 4 matrices, view to world. coverage: what covered() says of them. clearance: from each pose to the
    next surface, at least, metres."""

    poses: list
    coverage: list
    clearance: float


def sample_pixels(is_surface, count, rng):
    """Indices of `count` pixels, spread evenly over those that show a surface; of all pixels, flat."""
    found = np.flatnonzero(is_surface)
    if not len(found):
        return found
    return found[np.minimum(((np.arange(count) + rng.random(count)) / count * len(found)).astype(int), len(found) - 1)]


def trace(places, normals, albedo, cast, radiance, rng, most=MAX_BOUNCES):
    """Bounces of a picture, or None where its light comes from nothing. places, normals: (N, 3), of pixels(). albedo:
    (N,). most: bounces that count; at most DEPTH are followed.

    radiance(places, normals, things): (direct light on a white surface, albedo, emission) of what is hit, (N,) each."""
    length = np.linalg.norm(normals, axis=1)
    usable = length > 0.5  # materials of pure emission have no normal
    places, normals, share = places[usable], normals[usable] / length[usable, None], albedo[usable]
    toward = np.full(len(places), -1)
    levels, count = [], 0
    for _ in range(min(most, MAX_BOUNCES)):
        directions = _cosine_directions(normals, rng)
        distance, normal, thing = cast(places, directions, np.full(len(places), np.inf))
        hit = np.isfinite(distance)
        if not hit.any():
            break
        starts, directions, toward, share = places[hit], directions[hit], toward[hit], share[hit]
        places = starts + directions * distance[hit, None]
        normals = np.where(np.sum(normal[hit] * directions, 1)[:, None] > 0, -normal[hit], normal[hit])
        direct, reflects, emission = radiance(places, normals, thing[hit])
        levels.append(
            (starts, places, normals, toward, share * (reflects * (direct + DARK_WEIGHT * direct.mean()) + emission))
        )
        toward, share = count + np.arange(len(places)), share * reflects
        count += len(places)
        places = places + 1e-4 * distance[hit, None] * normals  # off the surface
    if not levels:
        return None
    starts, places, normals, toward, sent = map(np.concatenate, zip(*levels, strict=True))
    if not sent.sum() > 0:  # nothing is lit, or its light is not known
        sent = np.ones(len(places))
    sent = sent / sent.sum()
    weights = sent.copy()
    for index in range(count - 1, -1, -1):  # light from far passes all that is nearer to the picture
        if toward[index] >= 0:
            weights[toward[index]] += weights[index]
    low, high = np.percentile(places, (5, 95), axis=0)
    return LightPaths(
        starts, places, normals, toward, sent, weights / weights.sum(), float(max(np.linalg.norm(high - low), 1e-6))
    )


def place(light, seen, cast, half, most, rng, kept=()):
    """Poses of at most `most` views. seen: (N,) bool, what the main view sees of `light`. half: tangents of half the
    views' fields. kept: poses that stay before others are chosen where they see as much."""
    light, seen = light.resampled(seen, PLACEMENT_POINTS, rng)
    unseen = light.subset(~seen)
    saw = [in_frame(pose, half, unseen, visible(pose[:3, 3], unseen, cast))[None] for pose in kept]
    free = _free_positions(light, cast, rng)
    for position in free:
        way = (unseen.positions - position).astype(np.float32)
        saw.append(visible(position, unseen, cast) & _directions_in_frame(WORLD_TO_VIEW, way, half))
    if not saw:
        return []
    saw = np.concatenate(saw)
    saw_as_number, favour = saw.astype(np.float32), np.where(np.arange(len(saw)) < len(kept), 1.1, 1.0)

    def best_beside(chosen):
        """(option, what it newly sees) beside those chosen."""
        gain = saw_as_number @ np.where(saw[chosen].any(0), 0, unseen.weights).astype(np.float32)
        best = int(np.argmax(gain * favour))
        return best, gain[best]

    chosen = []
    while len(chosen) < most:
        best, gain = best_beside(chosen)
        if gain < MIN_GAIN:
            break
        chosen.append(best)
    for _ in range(MAX_EXCHANGE_ROUNDS):
        before = list(chosen)
        for option in before:
            chosen.remove(option)
            best, gain = best_beside(chosen)
            if gain >= MIN_GAIN:
                chosen.append(best)
        if set(chosen) == set(before):
            break
    stands = [divmod(option - len(kept), len(DIRECTIONS)) for option in chosen]
    return [
        kept[option] if option < len(kept) else pose_looking(free[place], DIRECTIONS[way])
        for option, (place, way) in zip(chosen, stands)
    ]


def coverage(light, seen, cast, half, poses):
    """Bounces.arrives() of what the main view sees, and with each pose."""
    seen, shares = seen.copy(), [light.arriving_share(seen)]
    for pose in poses:
        new = ~seen & in_frame(pose, half, light, True)
        seen[new] = visible(pose[:3, 3], light.subset(new), cast)
        shares.append(light.arriving_share(seen))
    return shares


def pose_looking(position, direction):
    """The pose at `position` that looks along `direction`, upright."""
    back = -direction / np.linalg.norm(direction)
    up = np.array([0.0, 1, 0]) if abs(back[2]) > 0.999 else np.array([0.0, 0, 1])
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = right, np.cross(back, right), back, position
    return pose


def visible(position, light, cast):
    """(N,) bool: what can be seen well from a place, in any direction. position: (3,), or (N, 3), one for each."""
    to = light.positions - position
    far = np.linalg.norm(to, axis=1)
    far = np.where(far > 0, far, 1.0)
    found = (np.sum(to * light.normals, 1) < -MIN_VIEW_COSINE * far) & (far > 1e-4 * light.size)
    to, limit = to[found] / far[found, None], far[found] * (1 - 3e-3) - 1e-4 * light.size
    distance, _, _ = cast(np.broadcast_to(position, light.positions.shape)[found], to, limit, nearest=False)
    found[found] = ~np.isfinite(distance)
    return found


def in_frame(pose, half, light, reached):
    """(N,) bool: what of `reached` lies in the frame."""
    return reached & _directions_in_frame(pose[:3, :3].T, light.positions - pose[:3, 3], half)


def _directions_in_frame(to_view, way, half):
    """(..., N) bool: what lies that way, (N, 3), from a view is in its frame. to_view: (..., 3, 3), of each view."""
    x, y, z = np.moveaxis(to_view @ way.T, -2, 0)
    return (np.abs(x) < -z * half[0]) & (np.abs(y) < -z * half[1])


def _free_positions(light, cast, rng):
    chosen = rng.integers(len(light.positions), size=CANDIDATE_POSITIONS)
    along = rng.uniform(0.15, 0.85, CANDIDATE_POSITIONS)[:, None]
    found = light.starts[chosen] * (1 - along) + light.positions[chosen] * along
    origins, directions = np.repeat(found, len(DIRECTIONS), 0), np.tile(DIRECTIONS, (len(found), 1))
    distance, _, _ = cast(origins, directions, np.full(len(origins), VIEW_CLEARANCE * light.size), nearest=False)
    return found[~np.isfinite(distance).reshape(len(found), -1).any(1)]


def _cosine_directions(normals, rng):
    """A direction about each normal, as often as light leaves a matt surface that way."""
    radius, angle = np.sqrt(rng.random(len(normals))), 2 * np.pi * rng.random(len(normals))
    axis = np.where(np.abs(normals[:, :1]) > 0.9, (0.0, 1, 0), (1.0, 0, 0))
    side = np.cross(normals, axis)
    side /= np.linalg.norm(side, axis=1)[:, None]
    found = (
        side * (radius * np.cos(angle))[:, None]
        + np.cross(normals, side) * (radius * np.sin(angle))[:, None]
        + normals * np.sqrt(1 - radius**2)[:, None]
    )
    return found / np.linalg.norm(found, axis=1)[:, None]


WORLD_TO_VIEW = np.array(
    [pose_looking(np.zeros(3), direction)[:3, :3].T for direction in DIRECTIONS], np.float32
)  # turns, to each of them
