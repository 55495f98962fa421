"""The clients against a server that answers what is not true, and one that falls silent."""

import asyncio
import queue
import threading
import time
import unittest
from concurrent import futures

import grpc
import numpy as np

import homing
import homing.aio
from homing.connection import options
from homing.types import Motion, Outcome
from homing.v1 import (homing_service_pb2, homing_service_pb2_grpc, journey_service_pb2,
                       journey_service_pb2_grpc)

JOURNEY = "robots/r/journeys/a"
FRAMES = [np.full((16, 16), number, np.uint8) for number in range(8)]
COUNT = len(FRAMES)


def queued(requests):
    """A queue of them as they arrive; None: the end."""
    come = queue.Queue()

    def read():
        try:
            for request in requests:
                come.put(request)
        except grpc.RpcError:
            pass
        come.put(None)

    threading.Thread(target=read, daemon=True).start()
    return come


def impatient(requests, seconds):
    """Ends once nothing has come for so long."""
    come = queued(requests)
    while True:
        try:
            request = come.get(timeout=seconds)
        except queue.Empty:
            return
        if request is None:
            return
        yield request


def through_a_proxy(requests, context):
    """One that resets the stream if two observations arrive before the first one is computed."""
    come = queued(requests)
    while True:
        request = come.get()
        if request is None:
            return
        time.sleep(0 if request.HasField("config") else 0.05)
        if not come.empty() and come.queue[0] is not None:
            context.abort(grpc.StatusCode.INTERNAL, "Received RST_STREAM with error code 2")
        yield request


class LyingServer(journey_service_pb2_grpc.JourneyServiceServicer,
                  homing_service_pb2_grpc.HomingServiceServicer):
    """Ends a stream without an error after `ends_after` observations; `lie` changes each answer;
    `silent` streams are accepted and never answer; a stream without requests for `patience` s ends;
    of each method the first `cancelled` calls are cancelled; `proxy` sits in front of it."""

    def __init__(self, ends_after=None, lie=lambda answer: None, silent=0, answer_time=60,
                 retry_for=0.5, patience=60, cancelled=0, proxy=False):
        self.proxy = proxy
        self.cancelled = {name: cancelled for name in ("create", "finish", "record", "localize")}
        self.patience = patience
        self.silent = silent
        self.ends_after = ends_after
        self.lie = lie
        self.stored = 0
        self.finished = False
        self.server = grpc.server(futures.ThreadPoolExecutor(4))
        journey_service_pb2_grpc.add_JourneyServiceServicer_to_server(self, self.server)
        homing_service_pb2_grpc.add_HomingServiceServicer_to_server(self, self.server)
        port = self.server.add_insecure_port("127.0.0.1:0")
        self.address = homing.Server(address=f"127.0.0.1:{port}", retry_for=retry_for,
                                     answer_time=answer_time)

    def __enter__(self):
        self.server.start()
        return self

    def __exit__(self, *unused):
        self.server.stop(0)

    def cancel_first(self, method, context):
        self.cancelled[method] -= 1
        if self.cancelled[method] >= 0:
            context.abort(grpc.StatusCode.CANCELLED, "CANCELLED")

    def CreateJourney(self, request, context):
        self.cancel_first("create", context)
        return journey_service_pb2.Journey(name=JOURNEY)

    def FinishJourney(self, request, context):
        self.cancel_first("finish", context)
        self.finished = True
        return journey_service_pb2.FinishJourneyResponse()

    def fall_silent(self, context):
        self.silent -= 1
        while self.silent >= 0 and context.is_active():
            time.sleep(0.01)

    def arriving(self, requests, context):
        if self.proxy:
            return through_a_proxy(requests, context)
        return impatient(requests, self.patience)

    def RecordJourney(self, requests, context):
        self.cancel_first("record", context)
        self.fall_silent(context)
        requests = self.arriving(requests, context)
        next(requests)
        answer = journey_service_pb2.RecordJourneyResponse
        yield answer(next_sequence=self.stored, resend_from=self.stored)
        for count, request in enumerate(requests, 1):
            if count == self.ends_after:
                return
            sequence = request.observation.sequence
            truth = answer(sequence=sequence, next_sequence=max(self.stored, sequence + 1))
            self.lie(truth)
            self.stored = truth.next_sequence
            yield truth

    def Localize(self, requests, context):
        self.cancel_first("localize", context)
        self.fall_silent(context)
        requests = self.arriving(requests, context)
        next(requests)
        for count, request in enumerate(requests, 1):
            if count == self.ends_after:
                return
            truth = homing_service_pb2.LocalizeResponse(sequence=request.observation.sequence)
            self.lie(truth)
            yield truth


def record(liar, pause=0):
    with homing.Client(liar.address) as client:
        return list(client.record(JOURNEY, camera(pause)))


def localize(liar, pause=0):
    with homing.Client(liar.address) as client:
        return list(client.localize(JOURNEY, camera(pause)))


def camera(pause):
    for number, frame in enumerate(FRAMES):
        if number == COUNT // 2:
            time.sleep(pause)
        yield frame


def of_aio(method):
    async def live_camera(pause):
        for number, frame in enumerate(FRAMES):
            if number == COUNT // 2:
                await asyncio.sleep(pause)
            yield frame

    async def run(liar, pause=0):
        async with homing.aio.AsyncClient(liar.address) as client:
            record_or_localize = getattr(client, method)
            return [answer async for answer in record_or_localize(JOURNEY, live_camera(pause))]
    return lambda *arguments: asyncio.run(run(*arguments))


RECORDING = (record, of_aio("record"))
LOCALISING = (localize, of_aio("localize"))


class LyingServerTest(unittest.TestCase):

    def test_a_stream_that_ends_early_without_an_error_is_a_lost_link(self):
        for run in RECORDING + LOCALISING:
            with LyingServer(ends_after=4) as liar:
                self.assertEqual([answer.sequence for answer in run(liar)], list(range(COUNT)))

    def test_a_proxy_that_resets_the_stream_gets_one_at_a_time(self):
        for run in RECORDING + LOCALISING:
            with LyingServer(proxy=True, retry_for=30) as liar:
                self.assertEqual([answer.sequence for answer in run(liar)], list(range(COUNT)))

    def test_what_is_not_acknowledged_is_not_finished(self):
        for run in RECORDING:
            with LyingServer(lie=lambda answer: setattr(answer, "next_sequence", 0)) as liar:
                with self.assertRaisesRegex(homing.HomingError, "ended the stream early"):
                    run(liar)
                self.assertFalse(liar.finished)

    def test_no_answer_to_what_was_not_sent_is_believed(self):
        for runs, field in ((RECORDING, "next_sequence"), (LOCALISING, "sequence")):
            for run in runs:
                for number in (100, 2**63 - 1):
                    with LyingServer(lie=lambda answer: setattr(answer, field, number)) as liar:
                        with self.assertRaisesRegex(homing.HomingError, "DATA_LOSS"):
                            run(liar)
                        self.assertFalse(liar.finished)

    def test_values_of_a_newer_server_are_unknown(self):
        for run in RECORDING + LOCALISING:
            with LyingServer(lie=lambda answer: setattr(answer, "motion", 77)) as liar:
                self.assertEqual({answer.motion for answer in run(liar)}, {Motion.UNKNOWN})
        for run in LOCALISING:
            with LyingServer(lie=lambda answer: setattr(answer, "outcome", 77)) as liar:
                self.assertEqual({answer.outcome for answer in run(liar)}, {Outcome.UNKNOWN_PLACE})

    def test_a_server_that_never_answers_is_a_lost_link(self):
        for run in RECORDING + LOCALISING:
            with LyingServer(silent=1, answer_time=0.5, retry_for=30) as liar:
                self.assertEqual([answer.sequence for answer in run(liar)], list(range(COUNT)))
            with LyingServer(silent=1000, answer_time=0.2) as liar:
                with self.assertRaisesRegex(homing.HomingError, "did not answer"):
                    run(liar)

    def test_a_quiet_source_does_not_use_up_the_time_to_try_again(self):
        for run in RECORDING + LOCALISING:
            with LyingServer(patience=0.8, retry_for=1) as liar:
                answers = run(liar, 2.5)
            self.assertEqual([answer.sequence for answer in answers], list(range(COUNT)))

    def test_calls_that_a_stopping_server_cancels_are_tried_again(self):
        for run in RECORDING + LOCALISING:
            with LyingServer(cancelled=2, retry_for=30) as liar:
                self.assertEqual([answer.sequence for answer in run(liar)], list(range(COUNT)))

    def test_a_client_that_is_closed_meanwhile_does_not_try_again(self):
        with LyingServer(silent=1000, retry_for=30) as liar:
            client = homing.Client(liar.address)
            threading.Timer(0.3, client.close).start()
            with self.assertRaisesRegex(homing.HomingError, "CANCELLED"):
                list(client.record(JOURNEY, iter(FRAMES)))

    def test_a_silent_server_is_noticed(self):
        for address in ("127.0.0.1:1", "127.0.0.1:1,127.0.0.1:2"):
            self.assertIn("grpc.keepalive_time_ms",
                          dict(options(homing.Server(address=address))))


if __name__ == "__main__":
    unittest.main()
