"""Between numpy or dataclasses and messages."""

from __future__ import annotations

import datetime
from typing import Any, Optional, Union

import numpy as np

from .errors import HomingError
from .types import (Answer, Camera, Direction, Flow, Image, Journey, Match, Motion, Observation,
                    Outcome, Recorded, Side, Travel, View)
from .v1 import homing_service_pb2, journey_service_pb2, types_pb2

_ENCODINGS = {
    "gray8": (types_pb2.FRAME_ENCODING_GRAY8, 2),
    "rgb8": (types_pb2.FRAME_ENCODING_RGB8, 3),
    "bgr8": (types_pb2.FRAME_ENCODING_BGR8, 3),
}


def _wrong(message: str) -> HomingError:
    return HomingError("INVALID_ARGUMENT", message)


def _image(pixels: np.ndarray, encoding: str) -> types_pb2.Frame:
    if encoding not in _ENCODINGS:
        raise _wrong(f"encoding: {encoding} must be gray8, rgb8 or bgr8")
    code, dimensions = _ENCODINGS[encoding]
    if pixels.dtype != np.uint8 or pixels.ndim != dimensions or (dimensions == 3 and
                                                                 pixels.shape[2] != 3):
        raise _wrong(f"image: {pixels.dtype} of shape {pixels.shape} must be uint8, "
                     "height x width or height x width x 3")
    return types_pb2.Frame(encoding=code, width=pixels.shape[1], height=pixels.shape[0],
                           data=np.ascontiguousarray(pixels).tobytes())


def _file(data: bytes) -> types_pb2.Frame:
    if data.startswith(b"\x89PNG"):
        return types_pb2.Frame(encoding=types_pb2.FRAME_ENCODING_PNG, data=data)
    if data.startswith(b"\xff\xd8"):
        return types_pb2.Frame(encoding=types_pb2.FRAME_ENCODING_JPEG, data=data)
    raise _wrong("image: the bytes must be a JPEG or PNG file")


def _flow(flow: Flow) -> types_pb2.FlowVectors:
    vectors = np.asarray(flow.vectors, dtype=np.float32)
    if vectors.ndim != 2 or vectors.shape[1] != 4:
        raise _wrong(f"flow: shape {vectors.shape} must be n x 4")
    return types_pb2.FlowVectors(width=flow.width, height=flow.height, start_x=vectors[:, 0],
                                 start_y=vectors[:, 1], end_x=vectors[:, 2], end_y=vectors[:, 3])


def _view(view: View) -> types_pb2.CameraView:
    if isinstance(view, Flow):
        return types_pb2.CameraView(flow_vectors=_flow(view))
    if isinstance(view, Image):
        return types_pb2.CameraView(frame=_image(view.pixels, view.encoding))
    if isinstance(view, (bytes, bytearray, memoryview)):
        return types_pb2.CameraView(frame=_file(bytes(view)))
    if isinstance(view, np.ndarray):
        return types_pb2.CameraView(frame=_image(view, "gray8" if view.ndim == 2 else "rgb8"))
    raise _wrong(f"a view must be an array, bytes, an Image or a Flow, not {type(view).__name__}")


def observation(seen: Union[Observation, View]) -> types_pb2.Observation:
    """A bare view is that of the left camera."""
    if not isinstance(seen, Observation):
        seen = Observation(left=seen)
    message = types_pb2.Observation(break_before=seen.break_before)
    if seen.left is not None:
        message.left.CopyFrom(_view(seen.left))
    if seen.right is not None:
        message.right.CopyFrom(_view(seen.right))
    if isinstance(seen.time, datetime.datetime):
        message.capture_time.FromDatetime(seen.time.astimezone(datetime.timezone.utc))
    elif seen.time is not None:
        message.capture_time.FromNanoseconds(round(seen.time * 1e9))
    return message


def camera(known: Camera) -> types_pb2.Camera:
    return types_pb2.Camera(focal_x=known.focal_x, focal_y=known.focal_y, center_x=known.center_x,
                            center_y=known.center_y, distortion=list(known.distortion),
                            yaw_rad=known.yaw_rad, fisheye=known.fisheye)


def create_request(name: str, writer: str, left: Optional[Camera], right: Optional[Camera],
                   model: str) -> journey_service_pb2.CreateJourneyRequest:
    parts = name.split("/")
    if len(parts) != 4 or parts[0] != "robots" or parts[2] != "journeys":
        raise _wrong(f"journey: {name} must be robots/ROBOT/journeys/JOURNEY")
    request = journey_service_pb2.CreateJourneyRequest(parent="/".join(parts[:2]),
                                                       journey_id=parts[3], writer_id=writer)
    settings = request.journey.settings
    settings.deviation_model = model
    if left is not None:
        settings.left_camera.CopyFrom(camera(left))
    if right is not None:
        settings.right_camera.CopyFrom(camera(right))
    return request


def localize_config(journey: str, travel: Travel, left: Optional[Camera], right: Optional[Camera],
                    tolerance_steps: int, max_matches: int,
                    threshold: float) -> homing_service_pb2.LocalizeConfig:
    config = homing_service_pb2.LocalizeConfig(journey=journey, travel=travel.value,
                                               tolerance_steps=tolerance_steps,
                                               max_matches=max_matches, threshold=threshold)
    if left is not None:
        config.left_camera.CopyFrom(camera(left))
    if right is not None:
        config.right_camera.CopyFrom(camera(right))
    return config


def match_request(journey: str, first: View, second: View, side: str, travel: Travel,
                  max_matches: int, threshold: float) -> homing_service_pb2.MatchLandmarksRequest:
    if side not in ("left", "right"):
        raise _wrong(f"side: {side} must be left or right")
    request = homing_service_pb2.MatchLandmarksRequest(journey=journey, travel=travel.value,
                                                       max_matches=max_matches,
                                                       threshold=threshold)
    frames = getattr(request, side).frames
    frames.first.CopyFrom(_view(first).frame)
    frames.second.CopyFrom(_view(second).frame)
    return request


def prior(answer: homing_service_pb2.LocalizeResponse) -> Optional[Any]:
    """Where the filter starts after a broken link."""
    if not answer.journey or not answer.HasField("step"):
        return None
    message = homing_service_pb2.LocalizePrior(journey=answer.journey, step=answer.step,
                                               direction=answer.direction,
                                               probability=answer.probability)
    if answer.HasField("path_offset"):
        message.path_offset = answer.path_offset
    return message


def _enum(kind: Any, number: int) -> Any:
    """A newer server may have values that this package does not know."""
    try:
        return kind(number)
    except ValueError:
        return Outcome.UNKNOWN_PLACE if kind is Outcome else kind.UNKNOWN


def _optional(message: Any, field: str) -> Any:
    return getattr(message, field) if message.HasField(field) else None


def recorded(message: journey_service_pb2.RecordJourneyResponse) -> Recorded:
    return Recorded(sequence=message.sequence, step=_optional(message, "step"),
                    motion=_enum(Motion, message.motion), landmarks=len(message.landmarks))


def match(message: types_pb2.Match) -> Match:
    return Match(journey=message.journey, landmark=message.landmark, step=message.step,
                 side=_enum(Side, message.side), delta=message.delta, p=message.p, p_t=message.p_t)


def answer(message: homing_service_pb2.LocalizeResponse) -> Answer:
    interval = None
    if message.HasField("interval"):
        interval = (message.interval.first, message.interval.last)
    return Answer(sequence=message.sequence, outcome=_enum(Outcome, message.outcome),
                  motion=_enum(Motion, message.motion), journey=message.journey or None,
                  step=_optional(message, "step"), probability=message.probability,
                  interval=interval, progress_home=_optional(message, "progress_home"),
                  direction=_enum(Direction, message.direction),
                  speed_ratio=_optional(message, "speed_ratio"), turn=_optional(message, "turn"),
                  path_offset=_optional(message, "path_offset"), on_route=message.on_route,
                  landmark=_optional(message, "landmark"),
                  similarity=_optional(message, "similarity"),
                  matches=[match(found) for found in message.matches])


def journey(message: journey_service_pb2.Journey) -> Journey:
    finished = message.state == journey_service_pb2.Journey.STATE_FINISHED
    return Journey(name=message.name, finished=finished, steps=message.step_count,
                   landmarks=message.landmark_count, fingerprints=message.fingerprint_count,
                   next_sequence=message.next_sequence, readers=list(message.readers))
