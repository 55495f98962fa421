"""The client for programs with threads."""

from __future__ import annotations

import threading
import time
from typing import Any, Callable, Iterable, Iterator, List, Optional, Union

import grpc

from . import convert
from .answer_limit import AnswerLimit
from .connection import Retry, Server, Trace, credentials, options, target
from .errors import from_rpc
from .outbox import Outbox
from .types import Answer, Camera, Journey, Match, Observation, Recorded, Travel, View
from .v1 import (homing_service_pb2, homing_service_pb2_grpc, journey_service_pb2,
                 journey_service_pb2_grpc)

Seen = Union[Observation, View]


class _Link:
    """The requests of one stream: gRPC reads them on its own thread."""

    def __init__(self, sender: "_Sender", config: Any, wrap: Callable[[Any], Any], window: int,
                 limit: AnswerLimit):
        self._limit = limit
        self._sender = sender
        self._config = config
        self._wrap = wrap
        self._room = threading.Semaphore(window)
        self._may_begin = threading.Event()
        self._over = False

    def begin(self) -> None:
        self._may_begin.set()

    def has_begun(self) -> bool:
        return self._may_begin.is_set()

    def answered(self) -> None:
        self._room.release()

    def close(self) -> None:
        self._over = True
        self._may_begin.set()
        self._room.release()

    def requests(self) -> Iterator[Any]:
        yield self._config
        self._may_begin.wait()
        while True:
            self._room.acquire()
            if self._over:
                return
            observation = self._sender.take(lambda: self._over)
            self._limit.sent()
            if observation is None:
                return
            yield self._wrap(observation)


class _Sender:
    """The outbox and the source that fills it. The streams of an old and a new link may both read it."""

    def __init__(self, source: Iterable[Seen], outbox: Outbox):
        self._source = iter(source)
        self._outbox = outbox
        self._lock = threading.Lock()
        self._pull = threading.Lock()
        self._ended = False
        self.error: Optional[BaseException] = None

    def begin(self, durable: int, reference: int) -> None:
        with self._lock:
            self._outbox.begin(durable, reference)

    def acknowledge(self, durable: int, reference: int) -> None:
        with self._lock:
            self._outbox.acknowledge(durable, reference)

    def is_done(self) -> bool:
        with self._lock:
            return self._ended and self._outbox.is_done()

    def take(self, over: Callable[[], bool]) -> Optional[Any]:
        with self._pull:
            while not over():
                with self._lock:
                    kept = self._outbox.next_kept()
                if kept is not None or self._ended:
                    return kept
                try:
                    message = convert.observation(next(self._source))
                except StopIteration:
                    self._ended = True
                    continue
                except BaseException as error:  # The caller's own: given back by the reading side.
                    self.error = error
                    self._ended = True
                    continue
                with self._lock:
                    self._outbox.add(message)
        return None


def _wait(retry: Retry, error: Optional[grpc.RpcError], quiet: float = 0.0) -> None:
    wait = retry.wait_after(error, quiet)
    if wait is None:
        raise from_rpc(error) from None
    time.sleep(wait)


class Client:
    """Thread-safe, but for one iterator at a time of each stream."""

    def __init__(self, server: Union[Server, str] = Server()):
        self._server = Server(address=server) if isinstance(server, str) else server
        self._trace = Trace(self._server)
        secret = credentials(self._server)
        where, how = target(self._server), options(self._server)
        self._channel = (grpc.insecure_channel(where, how) if secret is None
                         else grpc.secure_channel(where, secret, how))
        self._journeys = journey_service_pb2_grpc.JourneyServiceStub(self._channel)
        self._homing = homing_service_pb2_grpc.HomingServiceStub(self._channel)

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, *unused: Any) -> None:
        self.close()

    def close(self) -> None:
        self._channel.close()

    def _call(self, method: Callable[..., Any], request: Any) -> Any:
        retry = Retry(self._server)
        while True:
            try:
                return method(request, timeout=60, metadata=self._trace.metadata())
            except grpc.RpcError as error:
                _wait(retry, error)

    def record(self, journey: str, observations: Iterable[Seen], *, writer: str = "python",
               live: bool = False, left_camera: Optional[Camera] = None,
               right_camera: Optional[Camera] = None, model: str = "", window: int = 32,
               finish: bool = True) -> Iterator[Recorded]:
        """Records a journey; gives an answer for each observation once it is durable. Observations that
        became durable just before the link broke have no answer.

        A broken link is restored. When the program runs again with the same writer, it continues where
        it stopped: the observations that the server has are left out, or, with `live`, new ones
        follow behind a break. Give each drive a name of its own: under that of an unfinished journey,
        another drive counts as the rest of it. `finish` closes the journey at the end.
        """
        self._call(self._journeys.CreateJourney,
                   convert.create_request(journey, writer, left_camera, right_camera, model))
        sender = _Sender(observations, Outbox(live))
        config = journey_service_pb2.RecordJourneyRequest()
        config.config.journey = journey
        config.config.writer_id = writer
        retry = Retry(self._server)
        reported = -1
        while True:
            error: Optional[grpc.RpcError] = None
            limit = AnswerLimit(self._server.answer_time)
            link = _Link(sender, config,
                         lambda seen: journey_service_pb2.RecordJourneyRequest(observation=seen),
                         1 if retry.one_at_a_time else window, limit)
            limit.sent()  # The first answer says where to begin.
            stream = self._journeys.RecordJourney(link.requests(),
                                                   metadata=self._trace.metadata())
            try:
                for response in limit.answers(stream):
                    durable = response.next_sequence
                    has_reference = response.HasField("resend_from")
                    reference = response.resend_from if has_reference else durable
                    if not link.has_begun():
                        sender.begin(durable, min(reference, durable))
                        if durable > reported + 1:
                            retry.progress()
                        reported = max(reported, durable - 1)
                        link.begin()
                        continue
                    sender.acknowledge(durable, reference)
                    link.answered()
                    if reported < response.sequence < durable:
                        reported = response.sequence
                        retry.progress()
                        yield convert.recorded(response)
                if sender.is_done():
                    break
            except grpc.RpcError as caught:
                error = None if limit.expired else caught
            finally:
                link.close()
                stream.cancel()
            _wait(retry, error, limit.quiet())
        if sender.error is not None:
            raise sender.error
        if finish:
            self.finish(journey, writer=writer)

    def localize(self, journey: str, observations: Iterable[Seen], *,
                 travel: Travel = Travel.RETURN, left_camera: Optional[Camera] = None,
                 right_camera: Optional[Camera] = None, tolerance_steps: int = 10,
                 max_matches: int = 10, threshold: float = 0.2,
                 window: int = 32) -> Iterator[Answer]:
        """Gives an answer for each observation. A broken link is restored, with the belief."""
        config = convert.localize_config(journey, travel, left_camera, right_camera,
                                         tolerance_steps, max_matches, threshold)
        sender = _Sender(observations, Outbox())
        sender.begin(0, 0)
        retry = Retry(self._server)
        reported = -1
        while True:
            error: Optional[grpc.RpcError] = None
            limit = AnswerLimit(self._server.answer_time)
            link = _Link(sender, homing_service_pb2.LocalizeRequest(config=config),
                         lambda seen: homing_service_pb2.LocalizeRequest(observation=seen),
                         1 if retry.one_at_a_time else window, limit)
            link.begin()
            stream = self._homing.Localize(link.requests(), metadata=self._trace.metadata())
            try:
                for response in limit.answers(stream):
                    link.answered()
                    if response.sequence <= reported:
                        continue
                    sender.acknowledge(response.sequence + 1, response.sequence)
                    reported = response.sequence
                    retry.progress()
                    last = convert.prior(response)
                    if last is not None:
                        config.prior.CopyFrom(last)
                    yield convert.answer(response)
                if sender.is_done():
                    break
            except grpc.RpcError as caught:
                error = None if limit.expired else caught
            finally:
                link.close()
                stream.cancel()
            _wait(retry, error, limit.quiet())
            # The last one answered is sent again: flow continues from it.
            sender.begin(reported + 1, max(reported, 0))
        if sender.error is not None:
            raise sender.error

    def match(self, journey: str, first: View, second: View, *, side: str = "left",
              travel: Travel = Travel.RETURN, max_matches: int = 10,
              threshold: float = 0.2) -> List[Match]:
        """The stored landmarks that resemble two consecutive frames of one camera, best first."""
        request = convert.match_request(journey, first, second, side, travel, max_matches, threshold)
        found = self._call(self._homing.MatchLandmarks, request)
        return [convert.match(one) for one in found.matches]

    def journeys(self, parent: str = "robots/-") -> Iterator[Journey]:
        """All journeys, or those of one robot, in order of name."""
        request = journey_service_pb2.ListJourneysRequest(parent=parent, page_size=1000)
        while True:
            page = self._call(self._journeys.ListJourneys, request)
            for found in page.journeys:
                yield convert.journey(found)
            request.page_token = page.next_page_token
            if not request.page_token:
                return

    def get(self, journey: str) -> Journey:
        return convert.journey(self._call(self._journeys.GetJourney,
                                          journey_service_pb2.GetJourneyRequest(name=journey)))

    def finish(self, journey: str, *, writer: str = "") -> Journey:
        request = journey_service_pb2.FinishJourneyRequest(name=journey, writer_id=writer)
        return convert.journey(self._call(self._journeys.FinishJourney, request).journey)

    def delete(self, journey: str) -> None:
        self._call(self._journeys.DeleteJourney,
                   journey_service_pb2.DeleteJourneyRequest(name=journey))
