"""Arguments and results of the clients. Lengths are pixels of the source image, angles radians."""

from __future__ import annotations

import dataclasses
import datetime
import enum
from typing import List, Optional, Sequence, Tuple, Union

import numpy as np


class Side(enum.Enum):
    """A side of the route as the outbound robot met it, not of the robot."""
    UNKNOWN = 0
    LEFT = 1
    RIGHT = 2


class Motion(enum.Enum):
    UNKNOWN = 0
    MOVING = 1
    STANDING = 2
    TURNING = 3


class Outcome(enum.Enum):
    MATCH = 1
    AMBIGUOUS = 2
    UNKNOWN_PLACE = 3


class Direction(enum.Enum):
    UNKNOWN = 0
    HOMEWARD = 1
    OUTWARD = 2


class Travel(enum.Enum):
    """RETURN: the robot heads the other way, so its cameras have changed sides of the route."""
    RETURN = 1
    SAME = 2


@dataclasses.dataclass(frozen=True)
class Image:
    """Pixels, uint8: height x width for "gray8", height x width x 3 for "rgb8" and "bgr8"."""
    pixels: np.ndarray
    encoding: str = "bgr8"


@dataclasses.dataclass(frozen=True)
class Flow:
    """Optical flow from the observation before: rows of start x, start y, end x, end y."""
    width: int
    height: int
    vectors: np.ndarray


View = Union[np.ndarray, bytes, Image, Flow]


@dataclasses.dataclass(frozen=True)
class Observation:
    """One instant, with the left camera, the right one or both."""
    left: Optional[View] = None
    right: Optional[View] = None
    # When it was captured: an aware datetime, or seconds since 1970.
    time: Union[datetime.datetime, float, None] = None
    # Observations before this one are missing: no step spans this point.
    break_before: bool = False


@dataclasses.dataclass(frozen=True)
class Camera:
    """Pinhole or fisheye camera, as OpenCV has them."""
    focal_x: float
    focal_y: float
    center_x: float
    center_y: float
    distortion: Sequence[float] = ()
    # Rotation away from square to the direction of travel, clockwise seen from above.
    yaw_rad: float = 0.0
    fisheye: bool = False


@dataclasses.dataclass(frozen=True)
class Recorded:
    """The answer to one observation, which is durable now."""
    sequence: int
    # None: it made no step.
    step: Optional[int]
    motion: Motion
    landmarks: int


@dataclasses.dataclass(frozen=True)
class Match:
    """A stored landmark that is similar to one seen now."""
    journey: str
    landmark: int
    step: int
    side: Side
    delta: float
    p: float
    p_t: float


@dataclasses.dataclass(frozen=True)
class Answer:
    """Where the robot is. None stands where there is no value; docs/api.md explains each."""
    sequence: int
    outcome: Outcome
    motion: Motion
    journey: Optional[str]
    step: Optional[int]
    # Of the steps of the interval, inclusive.
    probability: float
    interval: Optional[Tuple[int, int]]
    progress_home: Optional[float]
    direction: Direction
    speed_ratio: Optional[float]
    turn: Optional[float]
    path_offset: Optional[float]
    on_route: float
    landmark: Optional[int]
    similarity: Optional[float]
    matches: List[Match]


@dataclasses.dataclass(frozen=True)
class Journey:
    name: str
    finished: bool
    steps: int
    landmarks: int
    fingerprints: int
    next_sequence: int
    readers: List[str]
