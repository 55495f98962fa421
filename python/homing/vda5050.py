"""Prints the answers of `homing localize --json` as fragments of VDA 5050 state messages.

    homing --json localize --journey robots/r1/journeys/out --left /dev/video0 | homing-vda5050

A fragment has the fields of `state` (VDA 5050, version 2.1) that Homing knows; a fleet adapter merges
it into the robot's state. docs/fleet.md has the table. A place is a step of the outbound journey;
--poses FILE.csv (step,x,y,theta) gives the pose of steps on the fleet's map, and enables agvPosition.
"""

from __future__ import annotations

import argparse
import bisect
import csv
import json
import math
import sys
from typing import Any, Dict, Iterable, Iterator, List, NamedTuple, Optional, TextIO


class Pose(NamedTuple):
    step: float
    x: float
    y: float
    theta: float


def read_poses(lines: Iterable[str]) -> List[Pose]:
    """Rows step,x,y,theta with a heading line: metres and radians. ValueError names the row."""
    poses = []
    for number, row in enumerate(csv.DictReader(lines), start=2):
        try:
            poses.append(Pose(*(float(row[name]) for name in Pose._fields)))
        except (KeyError, TypeError, ValueError):
            raise ValueError(f"line {number}: must have numbers step,x,y,theta") from None
    return sorted(poses)


def _wrapped(angle: float) -> float:
    return math.atan2(math.sin(angle), math.cos(angle))


def pose_at(poses: List[Pose], step: float) -> Optional[Pose]:
    """Between two poses, linearly; None beyond the first and the last."""
    if not poses or not poses[0].step <= step <= poses[-1].step:
        return None
    after = bisect.bisect_left([pose.step for pose in poses], step)
    second = poses[after]
    if second.step == step:
        return second
    first = poses[after - 1]
    share = (step - first.step) / (second.step - first.step)
    turn = _wrapped(second.theta - first.theta)
    return Pose(step, first.x + share * (second.x - first.x),
                first.y + share * (second.y - first.y), _wrapped(first.theta + share * turn))


def _information(answer: Dict[str, Any]) -> Dict[str, Any]:
    fields = ("outcome", "journey", "step", "probability", "progress_home", "direction",
              "path_offset")
    references = [{"referenceKey": field, "referenceValue": str(answer[field])}
                  for field in fields if answer.get(field) is not None]
    return {"infoType": "homing.localization", "infoLevel": "INFO",
            "infoReferences": references}


def _error(answer: Dict[str, Any]) -> Dict[str, Any]:
    return {"errorType": "homing.unknownPlace", "errorLevel": "WARNING",
            "errorDescription": "The robot is probably off the recorded route",
            "errorReferences": [{"referenceKey": "on_route",
                                 "referenceValue": str(answer.get("on_route"))}]}


def fragment(answer: Dict[str, Any], poses: List[Pose], map_id: str = "",
             map_version: str = "") -> Dict[str, Any]:
    """The part of `state` that one answer gives."""
    localized = answer["outcome"] == "MATCH"
    journey = answer.get("journey")
    state: Dict[str, Any] = {"information": [_information(answer)], "errors": []}
    if answer["outcome"] == "UNKNOWN_PLACE":
        state["errors"].append(_error(answer))
    known_map = map_id or (journey or "").replace("/", ".")
    if known_map:
        state["maps"] = [{"mapId": known_map, "mapVersion": map_version or "1",
                          "mapStatus": "ENABLED"}]
    pose = pose_at(poses, answer["step"]) if answer.get("step") is not None else None
    if pose is not None and known_map:
        heading = pose.theta
        if answer.get("direction") == "HOMEWARD":
            heading = _wrapped(heading + math.pi)
        state["agvPosition"] = {"x": pose.x, "y": pose.y, "theta": heading, "mapId": known_map,
                                "positionInitialized": localized,
                                "localizationScore": answer["probability"]}
    return state


def fragments(lines: Iterable[str], poses: List[Pose], map_id: str = "",
              map_version: str = "") -> Iterator[Dict[str, Any]]:
    for line in lines:
        if line.strip():
            yield fragment(json.loads(line), poses, map_id, map_version)


def make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="homing-vda5050", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--poses", metavar="FILE.csv", help="poses of steps: step,x,y,theta")
    parser.add_argument("--map-id", default="", help="mapId [the journey's name with dots]")
    parser.add_argument("--map-version", default="1", help="mapVersion [1]")
    return parser


def main(arguments: Optional[List[str]] = None, source: TextIO = sys.stdin,
         target: TextIO = sys.stdout) -> int:
    flags = make_parser().parse_args(arguments)
    poses: List[Pose] = []
    try:
        if flags.poses:
            with open(flags.poses, newline="", encoding="utf-8") as file:
                poses = read_poses(file)
        for state in fragments(source, poses, flags.map_id, flags.map_version):
            print(json.dumps(state), file=target, flush=True)
    except (OSError, ValueError, KeyError) as error:
        print(f"homing-vda5050: error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
