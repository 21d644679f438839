# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape of a jam of floating logs at a rack whose axes stand at x = 0 across a channel; x downstream, y = 0 in the middle, z upward."""
from dataclasses import dataclass

import numpy as np

OUTSIDE = 0.02              # share of the wood that lies upstream of the jam's end, and as much downstream of its front
ALONG, AROUND = 33, 24      # points along a log and around it


@dataclass
class Logs:
    diameter: float
    length: float
    density: float

    @property
    def volume(self):
        return np.pi / 4 * self.diameter**2 * self.length


def buoyancyToDrag(logs, speed, drag=1.2, water=1000, g=9.81):
    """Of a log across the stream: (1 - rho_log/rho) g pi/4 D^2 L over drag/2 U^2 D L."""
    return np.pi / 2 * (1 - logs.density / water) * g * logs.diameter / (drag * speed**2)


def points(logs, centres, directions):
    """Points of the axes, n x ALONG x 3, and of the surfaces, n x ALONG x AROUND x 3; directions: unit vectors along the axes."""
    along = logs.length * ((np.arange(ALONG) + 0.5) / ALONG - 0.5)
    axes = centres[:, None] + along[:, None] * directions[:, None]
    across = np.eye(3)[np.abs(directions).argmin(1)]
    across -= directions * (across * directions).sum(1)[:, None]
    across /= np.linalg.norm(across, axis=1)[:, None]
    angle = 2 * np.pi * np.arange(AROUND)[:, None] / AROUND
    ring = 0.5 * logs.diameter * (np.cos(angle) * across[:, None] + np.sin(angle) * np.cross(directions, across)[:, None])
    return axes, axes[:, :, None] + ring[:, None]


@dataclass
class Jam:
    begin: float            # downstream and upstream ends [m]
    end: float
    thickness: np.ndarray   # of slices from begin upstream [m]: from the lowest to the highest point, mean over the columns across that have logs
    outline: np.ndarray     # the same, of the whole slice: as seen from the side
    slice: float            # length of a slice [m]
    width: float
    solid: float            # volume of the wood between the ends [m^3]

    @property
    def length(self):
        """From the rack's axes upstream."""
        return -self.end

    def bulk(self, thickness):
        """Bulk factor: volume within an envelope over the volume of wood."""
        return self.width * self.slice * thickness.sum() / self.solid

    def atRack(self, length):
        """Mean thickness over a length upstream of the rack's axes."""
        middle = self.begin - self.slice * (np.arange(len(self.thickness)) + 0.5)
        return self.thickness[(middle < 0) & (middle > -length)].mean()


def shape(logs, centres, directions, width):
    """The Jam of logs, in columns about as wide and long as a log is thick."""
    axes, surfaces = points(logs, centres, directions)
    x = axes[..., 0].ravel()
    end, begin = np.quantile(x, (OUTSIDE, 1 - OUTSIDE))
    nSlices, nAcross = (max(1, round(reach / logs.diameter)) for reach in (begin - end, width))
    low, high = _extent(surfaces.reshape(-1, 3), (begin, end), width, (nSlices, nAcross))
    isThere = high > low
    thickness = np.where(isThere, high - low, 0).sum(1) / np.maximum(isThere.sum(1), 1)
    outline = np.where(isThere.any(1), high.max(1) - low.min(1), 0)
    return Jam(begin, end, thickness, outline, (begin - end) / nSlices, width, logs.volume * len(centres) * ((x > end) & (x < begin)).mean())


def _extent(cloud, ends, width, size):
    """Lowest and highest points in columns, slices x columns across; infinite where there are none."""
    begin, end = ends
    i = np.floor((begin - cloud[:, 0]) / (begin - end) * size[0]).astype(int)
    j = np.clip(np.floor((cloud[:, 1] / width + 0.5) * size[1]).astype(int), 0, size[1] - 1)
    inside = (i >= 0) & (i < size[0])
    low, high = np.full(size, np.inf), np.full(size, -np.inf)
    np.minimum.at(low, (i[inside], j[inside]), cloud[inside, 2])
    np.maximum.at(high, (i[inside], j[inside]), cloud[inside, 2])
    return low, high
