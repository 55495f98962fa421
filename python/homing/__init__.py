"""Homing: a robot records its way out and finds its way home by optical flow.

    import homing
    with homing.Client("127.0.0.1:50551") as client:
        for recorded in client.record("robots/r1/journeys/out", frames):
            print(recorded.sequence, recorded.step)
        for answer in client.localize("robots/r1/journeys/out", frames_home):
            print(answer.outcome, answer.step, answer.probability)

A frame is a numpy array (height x width of uint8, or height x width x 3 in RGB), the bytes of a JPEG
or PNG file, or an Image; optical flow is a Flow. With two cameras, give Observation objects.
AsyncClient is the same for asyncio.
"""

from .aio import AsyncClient
from .client import Client
from .connection import Server
from .errors import HomingError
from .types import (Answer, Camera, Direction, Flow, Image, Journey, Match, Motion, Observation,
                    Outcome, Recorded, Side, Travel)

__all__ = [
    "Answer", "AsyncClient", "Camera", "Client", "Direction", "Flow", "HomingError", "Image",
    "Journey", "Match", "Motion", "Observation", "Outcome", "Recorded", "Server", "Side", "Travel",
]
