# SPDX-License-Identifier: GPL-3.0-or-later
"""Where views must stand to see the surfaces that light the image. Arrays and a function that casts rays; no Blender.

Paths start at points of the image and follow light backwards as it bounces. The points that they hit are what views
should see, weighted by the light that reaches the image by way of them. Positions on the paths are in free space and
connected to the image by construction, so views are chosen among them: of all such positions and 26 directions the one
that newly sees most is taken, until nothing much is gained; then each choice in turn is taken back and replaced by the
best one beside all others. How much of the light is seen is measured by other paths than those used for the choice,
since the views fit their own paths better than the truth.

`cast(origins, directions, limits, nearest=True)` stands for the scene: it takes arrays (N, 3), (N, 3) and (N,), with
directions of length 1, and returns (distance, normal, material): (N,), infinite if nothing lies within the limit; (N,
3), facing either side; (N,) int. Without `nearest` any hit within the limit may be returned, and only whether there is
one matters.
"""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

SCORING_PATHS = 1500  # paths that measure how much of the light is seen
PLACEMENT_PATHS = 4000  # paths that views are chosen by. Few of them may find the light, through a door,
PLACEMENT_POINTS = 2000  # so this many of their points are resampled, by weight
MAX_BOUNCES = 4  # bounces of a path
CANDIDATE_POSITIONS = 100  # positions on the paths that are tried for a view
MAX_EXCHANGE_ROUNDS = 3  # rounds of replacing each chosen view
MIN_GAIN = 0.005  # share of the weight that one more view must newly see
VIEW_CLEARANCE = 0.01  # distance between a view and any surface, as a share of the scene's size
MIN_VIEW_COSINE = 0.1  # between a surface's normal and a view that sees it: at less a pixel covers too much of it
DARK_WEIGHT = 0.03  # of the mean direct light, added everywhere: paths are too short to find the light of dark surfaces
MAX_COVERAGE_LOSS = 0.03  # share of the light; if the views see that much less than when placed, they are placed anew

# Tolerances, all chosen by eye.
HIT_OFFSET = 1e-4  # offset of the next ray off the surface, as a share of the ray's length
ALONG_PATH = 0.15, 0.85  # share of a path segment within which a view may stand: not at either surface
KEEP_BONUS = 1.1  # factor on the gain of views that stand already, so that they don't move for little
MIN_DISTANCE = 1e-4  # between a view and a point that it sees, as a share of the scene's size
VISIBILITY_GAP = 3e-3  # share of the distance by which a visibility ray ends before its point

DIRECTIONS = np.array([each for each in product((-1, 0, 1), repeat=3) if any(each)], float)
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]


@dataclass(frozen=True, eq=False)
class LightPaths:
    """The points by way of which light reaches the image, one for each traced ray. starts, positions, normals: (N, 3),
    where the ray starts and what it hits. parents: (N,) int, index of the point that the ray starts at, which is the
    next on the light's way to the image; -1 for the image itself. contributions: (N,), the light that reaches the image
    after being emitted or first reflected here, a share of all. weights: (N,), all light that passes here on its way,
    normalised. size: extent of the scene as far as the paths reach, metres."""

    starts: np.ndarray
    positions: np.ndarray
    normals: np.ndarray
    parents: np.ndarray
    contributions: np.ndarray
    weights: np.ndarray
    size: float

    def resampled(self, seen, count, rng):
        """(LightPaths, seen) of `count` samples, with probabilities proportional to the weights. The result has no
        parents."""
        cumulative = np.cumsum(self.weights)
        targets = (np.arange(count) + rng.random(count)) / count * cumulative[-1]
        indices, counts = np.unique(
            np.minimum(np.searchsorted(cumulative, targets), len(cumulative) - 1), return_counts=True
        )
        return replace(
            self,
            starts=self.starts[indices],
            positions=self.positions[indices],
            normals=self.normals[indices],
            parents=None,
            contributions=None,
            weights=counts / count,
        ), seen[indices]

    def subset(self, mask):
        """LightPaths of the points in `mask`, (N,) bool, alone. The result has no parents."""
        return replace(
            self,
            starts=self.starts[mask],
            positions=self.positions[mask],
            normals=self.normals[mask],
            parents=None,
            contributions=None,
            weights=self.weights[mask],
        )

    def arriving_share(self, seen):
        """The share of the light that reaches the image if only the points in `seen`, (N,) bool, send any on."""
        arrives = seen.copy()
        for _ in range(MAX_BOUNCES - 1):
            arrives = seen & np.where(self.parents < 0, True, arrives[self.parents])
        return float(self.contributions @ arrives)


@dataclass(frozen=True, eq=False)
class Placement:
    """poses: [(4, 4) view-to-world matrix]. coverage: shares of the light, as coverage() returns them. clearance:
    minimum distance from each pose to a surface, metres."""

    poses: list
    coverage: list
    clearance: float


def sample_pixels(is_surface, count, rng):
    """Flat indices of `count` pixels, spread evenly over those that show a surface. is_surface: (H, W) bool."""
    surface_pixels = np.flatnonzero(is_surface)
    if not len(surface_pixels):
        return surface_pixels
    chosen = ((np.arange(count) + rng.random(count)) / count * len(surface_pixels)).astype(int)
    return surface_pixels[np.minimum(chosen, len(surface_pixels) - 1)]


def trace(positions, normals, albedo, cast, radiance, rng, max_bounces=MAX_BOUNCES):
    """LightPaths of an image, or None if no surface sends it light. positions, normals: (N, 3), albedo: (N,), of pixels
    of the image. max_bounces: bounces that count; at most MAX_BOUNCES are traced.

    radiance(positions, normals, materials) returns (direct light on a white surface, albedo, emission) of what was hit,
    (N,) each."""
    length = np.linalg.norm(normals, axis=1)
    usable = length > 0.5  # purely emissive materials have no normal
    positions, normals, throughput = positions[usable], normals[usable] / length[usable, None], albedo[usable]
    parents = np.full(len(positions), -1)
    levels, count = [], 0
    for _ in range(min(max_bounces, MAX_BOUNCES)):
        directions = _cosine_directions(normals, rng)
        distance, hit_normal, material = cast(positions, directions, np.full(len(positions), np.inf))
        hit = np.isfinite(distance)
        if not hit.any():
            break
        starts, directions, parents, throughput = positions[hit], directions[hit], parents[hit], throughput[hit]
        positions = starts + directions * distance[hit, None]
        normals = np.where(np.sum(hit_normal[hit] * directions, 1)[:, None] > 0, -hit_normal[hit], hit_normal[hit])
        direct, reflectance, emission = radiance(positions, normals, material[hit])
        sent = throughput * (reflectance * (direct + DARK_WEIGHT * direct.mean()) + emission)
        levels.append((starts, positions, normals, parents, sent))
        parents, throughput = count + np.arange(len(positions)), throughput * reflectance
        count += len(positions)
        positions = positions + HIT_OFFSET * distance[hit, None] * normals  # off the surface
    if not levels:
        return None
    starts, positions, normals, parents, contributions = map(np.concatenate, zip(*levels, strict=True))
    if not contributions.sum() > 0:  # nothing is lit, or its light is unknown
        contributions = np.ones(len(positions))
    contributions = contributions / contributions.sum()
    weights = contributions.copy()
    for index in range(count - 1, -1, -1):  # from the far end: light passes all points nearer to the image
        if parents[index] >= 0:
            weights[parents[index]] += weights[index]
    low, high = np.percentile(positions, (5, 95), axis=0)
    return LightPaths(
        starts,
        positions,
        normals,
        parents,
        contributions,
        weights / weights.sum(),
        float(max(np.linalg.norm(high - low), 1e-6)),
    )


def place(paths, seen, cast, half_field, max_views, rng, kept=()):
    """Poses of at most `max_views` views. seen: (N,) bool, which points the main view sees. half_field: tangents of
    half the views' fields of view. kept: poses that stand already, which stay unless others see more."""
    paths, seen = paths.resampled(seen, PLACEMENT_POINTS, rng)
    unseen = paths.subset(~seen)
    sees_point = [in_frame(pose, half_field, unseen, visible(pose[:3, 3], unseen, cast))[None] for pose in kept]
    positions = _free_positions(paths, cast, rng)
    for position in positions:
        offset = (unseen.positions - position).astype(np.float32)
        sees_point.append(visible(position, unseen, cast) & _directions_in_frame(WORLD_TO_VIEW, offset, half_field))
    if not sees_point:
        return []
    sees_point = np.concatenate(sees_point)
    sees_number = sees_point.astype(np.float32)
    bonus = np.where(np.arange(len(sees_point)) < len(kept), KEEP_BONUS, 1.0)

    def best_beside(chosen):
        """(option, weight that it newly sees): the best one beside the chosen options."""
        gain = sees_number @ np.where(sees_point[chosen].any(0), 0, unseen.weights).astype(np.float32)
        best = int(np.argmax(gain * bonus))
        return best, gain[best]

    chosen = []
    while len(chosen) < max_views:
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
    candidates = [divmod(option - len(kept), len(DIRECTIONS)) for option in chosen]
    return [
        kept[option] if option < len(kept) else pose_looking(positions[position_index], DIRECTIONS[direction_index])
        for option, (position_index, direction_index) in zip(chosen, candidates)
    ]


def coverage(paths, seen, cast, half_field, poses):
    """Shares of the light that arrives (LightPaths.arriving_share()): of what the main view sees, then with each pose
    added."""
    seen, shares = seen.copy(), [paths.arriving_share(seen)]
    for pose in poses:
        new = ~seen & in_frame(pose, half_field, paths, True)
        seen[new] = visible(pose[:3, 3], paths.subset(new), cast)
        shares.append(paths.arriving_share(seen))
    return shares


def pose_looking(position, direction):
    """The 4 x 4 pose at `position` that looks along `direction`, upright."""
    back = -direction / np.linalg.norm(direction)
    up = np.array([0.0, 1, 0]) if abs(back[2]) > 0.999 else np.array([0.0, 0, 1])
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = right, np.cross(back, right), back, position
    return pose


def visible(position, paths, cast):
    """(N,) bool: which points can be seen well from a position, in any direction. position: (3,), or (N, 3), one for
    each."""
    to_point = paths.positions - position
    length = np.linalg.norm(to_point, axis=1)
    length = np.where(length > 0, length, 1.0)
    is_visible = (np.sum(to_point * paths.normals, 1) < -MIN_VIEW_COSINE * length) & (
        length > MIN_DISTANCE * paths.size
    )
    to_point = to_point[is_visible] / length[is_visible, None]
    limits = length[is_visible] * (1 - VISIBILITY_GAP) - MIN_DISTANCE * paths.size
    distance, _, _ = cast(np.broadcast_to(position, paths.positions.shape)[is_visible], to_point, limits, nearest=False)
    is_visible[is_visible] = ~np.isfinite(distance)
    return is_visible


def in_frame(pose, half_field, paths, candidates):
    """(N,) bool: which of the points in `candidates`, (N,) bool or True, lie in the frame of a pose."""
    return candidates & _directions_in_frame(pose[:3, :3].T, paths.positions - pose[:3, 3], half_field)


def _directions_in_frame(to_view, directions, half_field):
    """(..., N) bool: whether directions, (N, 3), from a view lie in its frame. to_view: (..., 3, 3), rotation of each
    view."""
    x, y, z = np.moveaxis(to_view @ directions.T, -2, 0)
    return (np.abs(x) < -z * half_field[0]) & (np.abs(y) < -z * half_field[1])


def _free_positions(paths, cast, rng):
    chosen = rng.integers(len(paths.positions), size=CANDIDATE_POSITIONS)
    along = rng.uniform(*ALONG_PATH, CANDIDATE_POSITIONS)[:, None]
    positions = paths.starts[chosen] * (1 - along) + paths.positions[chosen] * along
    origins, directions = np.repeat(positions, len(DIRECTIONS), 0), np.tile(DIRECTIONS, (len(positions), 1))
    distance, _, _ = cast(origins, directions, np.full(len(origins), VIEW_CLEARANCE * paths.size), nearest=False)
    return positions[~np.isfinite(distance).reshape(len(positions), -1).any(1)]


def _cosine_directions(normals, rng):
    """A random direction about each normal, with cosine-weighted probability."""
    radius, angle = np.sqrt(rng.random(len(normals))), 2 * np.pi * rng.random(len(normals))
    axis = np.where(np.abs(normals[:, :1]) > 0.9, (0.0, 1, 0), (1.0, 0, 0))
    side = np.cross(normals, axis)
    side /= np.linalg.norm(side, axis=1)[:, None]
    directions = (
        side * (radius * np.cos(angle))[:, None]
        + np.cross(normals, side) * (radius * np.sin(angle))[:, None]
        + normals * np.sqrt(1 - radius**2)[:, None]
    )
    return directions / np.linalg.norm(directions, axis=1)[:, None]


# The rotation from world to view, for each of DIRECTIONS.
WORLD_TO_VIEW = np.array([pose_looking(np.zeros(3), direction)[:3, :3].T for direction in DIRECTIONS], np.float32)
