"""Fragments of VDA 5050 state messages."""

import io
import json
import math
import os
import tempfile
import unittest

from homing import vda5050

ANSWER = {"sequence": 4, "outcome": "MATCH", "journey": "robots/r1/journeys/out", "step": 5,
          "probability": 0.93, "progress_home": 0.5, "direction": "HOMEWARD", "on_route": 0.98}
LOST = {"sequence": 5, "outcome": "UNKNOWN_PLACE", "journey": None, "step": None,
        "probability": 0.1, "progress_home": None, "direction": "UNKNOWN", "on_route": 0.2}
POSES = "step,x,y,theta\n0,0,0,0\n10,10,0,0\n20,10,10,1.5707963\n"


class Vda5050Test(unittest.TestCase):

    def setUp(self):
        self.poses = vda5050.read_poses(POSES.splitlines())

    def test_a_match_has_a_position_on_the_map(self):
        state = vda5050.fragment(ANSWER, self.poses, "hall", "3")
        position = state["agvPosition"]
        self.assertEqual((position["x"], position["y"]), (5, 0))
        # On the way home the robot heads the other way.
        self.assertAlmostEqual(abs(position["theta"]), math.pi)
        self.assertTrue(position["positionInitialized"])
        self.assertEqual(position["localizationScore"], 0.93)
        self.assertEqual(position["mapId"], "hall")
        self.assertEqual(state["maps"], [{"mapId": "hall", "mapVersion": "3",
                                          "mapStatus": "ENABLED"}])
        self.assertEqual(state["errors"], [])

    def test_fields_that_the_standard_requires(self):
        state = vda5050.fragment(ANSWER, self.poses)
        for field in ("x", "y", "theta", "mapId", "positionInitialized"):
            self.assertIn(field, state["agvPosition"])
        for info in state["information"]:
            self.assertIn("infoType", info)
            self.assertIn(info["infoLevel"], ("INFO", "DEBUG"))
            for reference in info["infoReferences"]:
                self.assertIsInstance(reference["referenceValue"], str)

    def test_a_lost_robot_has_an_error_and_no_position(self):
        state = vda5050.fragment(LOST, self.poses)
        self.assertNotIn("agvPosition", state)
        self.assertNotIn("maps", state)
        self.assertEqual(state["errors"][0]["errorLevel"], "WARNING")
        self.assertTrue(vda5050.fragment(dict(ANSWER, outcome="AMBIGUOUS"), self.poses)
                        ["agvPosition"]["positionInitialized"] is False)

    def test_headings_turn_the_short_way(self):
        poses = [vda5050.Pose(0, 0, 0, 3.0), vda5050.Pose(2, 0, 0, -3.0)]
        self.assertAlmostEqual(abs(vda5050.pose_at(poses, 1).theta), math.pi)
        self.assertIsNone(vda5050.pose_at(poses, 3))
        self.assertIsNone(vda5050.pose_at([], 0))

    def test_the_command(self):
        output = io.StringIO()
        lines = io.StringIO("\n".join(json.dumps(one) for one in (ANSWER, LOST)) + "\n")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "poses.csv")
            with open(path, "w", encoding="utf-8") as file:
                file.write(POSES)
            self.assertEqual(vda5050.main(["--poses", path], lines, output), 0)
        states = [json.loads(line) for line in output.getvalue().splitlines()]
        self.assertEqual([("agvPosition" in state) for state in states], [True, False])

    def test_a_bad_row_is_named(self):
        with self.assertRaisesRegex(ValueError, "line 3"):
            vda5050.read_poses(["step,x,y,theta", "0,0,0,0", "1,a,0,0"])


if __name__ == "__main__":
    unittest.main()
