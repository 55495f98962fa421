"""numpy in, typed answers out."""

import datetime
import unittest

import homing
import numpy as np
from homing import convert
from homing.v1 import homing_service_pb2, types_pb2


class ConvertTest(unittest.TestCase):

    def test_arrays(self):
        gray = np.arange(6, dtype=np.uint8).reshape(2, 3)
        frame = convert.observation(gray).left.frame
        self.assertEqual((frame.encoding, frame.width, frame.height, frame.data),
                         (types_pb2.FRAME_ENCODING_GRAY8, 3, 2, bytes(range(6))))
        color = np.zeros((2, 3, 3), np.uint8)
        self.assertEqual(convert.observation(color).left.frame.encoding,
                         types_pb2.FRAME_ENCODING_RGB8)
        self.assertEqual(convert.observation(homing.Image(color)).left.frame.encoding,
                         types_pb2.FRAME_ENCODING_BGR8)
        # Not contiguous.
        self.assertEqual(convert.observation(gray[:, ::2]).left.frame.data, bytes([0, 2, 3, 5]))

    def test_files_and_flow(self):
        self.assertEqual(convert.observation(b"\x89PNG...").left.frame.encoding,
                         types_pb2.FRAME_ENCODING_PNG)
        flow = homing.Flow(640, 480, np.array([[1, 2, 3, 4], [5, 6, 7, 8]]))
        vectors = convert.observation(homing.Observation(right=flow)).right.flow_vectors
        self.assertEqual(list(vectors.start_y), [2, 6])
        self.assertEqual(list(vectors.end_x), [3, 7])

    def test_wrong_input_is_named(self):
        for wrong, words in ((np.zeros((2, 2)), "float64"), (b"text", "JPEG"), ("text", "str"),
                             (np.zeros((2, 2, 4), np.uint8), "(2, 2, 4)")):
            with self.assertRaises(homing.HomingError) as caught:
                convert.observation(wrong)
            self.assertEqual(caught.exception.code, "INVALID_ARGUMENT")
            self.assertIn(words, caught.exception.message)

    def test_times(self):
        moment = datetime.datetime(2026, 1, 2, tzinfo=datetime.timezone.utc)
        for time in (moment, moment.timestamp()):
            seen = convert.observation(homing.Observation(left=b"\xff\xd8", time=time))
            self.assertEqual(seen.capture_time.ToDatetime(), moment.replace(tzinfo=None))

    def test_absent_values_are_none(self):
        answer = convert.answer(
            homing_service_pb2.LocalizeResponse(outcome=3, motion=1, on_route=0.25))
        self.assertIs(answer.outcome, homing.Outcome.UNKNOWN_PLACE)
        self.assertEqual((answer.journey, answer.step, answer.interval, answer.turn),
                         (None, None, None, None))
        self.assertEqual(answer.on_route, 0.25)
        self.assertIsNone(convert.prior(homing_service_pb2.LocalizeResponse()))

    def test_a_place_is_step_0_too(self):
        message = homing_service_pb2.LocalizeResponse(outcome=1, journey="robots/r/journeys/j",
                                                      step=0, path_offset=0.5)
        self.assertEqual(convert.answer(message).step, 0)
        self.assertEqual(convert.prior(message).path_offset, 0.5)


if __name__ == "__main__":
    unittest.main()
