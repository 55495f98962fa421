"""The client for asyncio; the methods are those of Client."""

from __future__ import annotations

import asyncio
from typing import (Any, AsyncIterable, AsyncIterator, Awaitable, Callable, Iterable, List, Optional,
                    Union)

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
Source = Union[Iterable[Seen], AsyncIterable[Seen]]


async def _each(source: Source) -> AsyncIterator[Seen]:
    if hasattr(source, "__aiter__"):
        async for seen in source:  # type: ignore[union-attr]
            yield seen
    else:
        for seen in source:  # type: ignore[union-attr]
            yield seen
            await asyncio.sleep(0)


class _Sender:
    """The outbox and the task that fills it: a broken link does not interrupt the source."""

    def __init__(self, source: Source, outbox: Outbox, room: int):
        self._outbox = outbox
        # At most so many observations were taken from the source and are not answered.
        self._room = asyncio.Semaphore(room)
        self._changed = asyncio.Event()
        self._ended = False
        self.error: Optional[BaseException] = None
        self._task = asyncio.ensure_future(self._fill(source))

    async def _fill(self, source: Source) -> None:
        try:
            async for seen in _each(source):
                message = convert.observation(seen)
                await self._room.acquire()
                self._outbox.add(message)
                self._changed.set()
        except (Exception, asyncio.CancelledError) as error:
            # The caller's own, as of a task that the source awaits: given back by the reading side.
            self.error = error
        self._ended = True
        self._changed.set()

    def begin(self, durable: int, reference: int) -> None:
        self._outbox.begin(durable, reference)

    def acknowledge(self, durable: int, reference: int) -> None:
        self._outbox.acknowledge(durable, reference)

    def answered(self) -> None:
        self._room.release()

    def is_done(self) -> bool:
        return self._ended and self._outbox.is_done()

    async def take(self) -> Optional[Any]:
        while True:
            kept = self._outbox.next_kept()
            if kept is not None or self._ended:
                return kept
            self._changed.clear()
            await self._changed.wait()

    async def close(self) -> None:
        self._task.cancel()
        await asyncio.gather(self._task, return_exceptions=True)


async def _write(call: Any, sender: _Sender, wrap: Callable[[Any], Any], limit: AnswerLimit,
                 room: asyncio.Semaphore) -> None:
    """`room`: so many more may be sent before the next answer."""
    try:
        while True:
            await room.acquire()
            observation = await sender.take()
            limit.sent()
            if observation is None:
                await call.done_writing()
                return
            await call.write(wrap(observation))
    except (grpc.RpcError, asyncio.InvalidStateError):
        pass  # The reading side gets the same error.


class AsyncClient:
    """For one event loop."""

    def __init__(self, server: Union[Server, str] = Server()):
        self._server = Server(address=server) if isinstance(server, str) else server
        self._trace = Trace(self._server)
        secret = credentials(self._server)
        where, how = target(self._server), options(self._server)
        self._channel = (grpc.aio.insecure_channel(where, how) if secret is None
                         else grpc.aio.secure_channel(where, secret, how))
        self._journeys = journey_service_pb2_grpc.JourneyServiceStub(self._channel)
        self._homing = homing_service_pb2_grpc.HomingServiceStub(self._channel)

    async def __aenter__(self) -> "AsyncClient":
        return self

    async def __aexit__(self, *unused: Any) -> None:
        await self.close()

    async def close(self) -> None:
        await self._channel.close()

    async def _call(self, method: Callable[..., Awaitable[Any]], request: Any) -> Any:
        retry = Retry(self._server)
        while True:
            try:
                return await method(request, timeout=60, metadata=self._trace.metadata())
            except grpc.RpcError as error:
                await _wait(retry, error)

    async def record(self, journey: str, observations: Source, *, writer: str = "python",
                     live: bool = False, left_camera: Optional[Camera] = None,
                     right_camera: Optional[Camera] = None, model: str = "", window: int = 32,
                     finish: bool = True) -> AsyncIterator[Recorded]:
        """As Client.record."""
        await self._call(self._journeys.CreateJourney,
                         convert.create_request(journey, writer, left_camera, right_camera, model))
        config = journey_service_pb2.RecordJourneyRequest()
        config.config.journey = journey
        config.config.writer_id = writer
        retry = Retry(self._server)
        sender: Optional[_Sender] = None
        outbox = Outbox(live)
        reported = -1
        try:
            while True:
                limit = AnswerLimit(self._server.answer_time)
                room = asyncio.Semaphore(1 if retry.one_at_a_time else window)
                limit.sent()  # The first answer says where to begin.
                call = self._journeys.RecordJourney(metadata=self._trace.metadata())
                writing: Optional[asyncio.Future] = None
                error: Optional[grpc.RpcError] = None
                try:
                    await call.write(config)
                    async for response in limit.answers_async(call):
                        durable = response.next_sequence
                        has_reference = response.HasField("resend_from")
                        reference = response.resend_from if has_reference else durable
                        if sender is None or writing is None:
                            outbox.begin(durable, min(reference, durable))
                            if durable > reported + 1:
                                retry.progress()
                            reported = max(reported, durable - 1)
                            if sender is None:
                                # A source that begins again passes over what the server has.
                                sender = _Sender(observations, outbox,
                                                 window + (0 if live else durable))
                            writing = asyncio.ensure_future(
                                _write(call, sender, _record_request, limit, room))
                            continue
                        room.release()
                        sender.acknowledge(durable, reference)
                        if reported < response.sequence < durable:
                            reported = response.sequence
                            sender.answered()
                            retry.progress()
                            yield convert.recorded(response)
                    if sender is not None and sender.is_done():
                        break
                except grpc.RpcError as caught:
                    error = caught
                finally:
                    call.cancel()
                    await _cancel(writing)
                await _wait(retry, error, limit.quiet())
        finally:
            if sender is not None:
                await sender.close()
        if sender.error is not None:
            raise sender.error
        if finish:
            await self.finish(journey, writer=writer)

    async def localize(self, journey: str, observations: Source, *,
                       travel: Travel = Travel.RETURN, left_camera: Optional[Camera] = None,
                       right_camera: Optional[Camera] = None, tolerance_steps: int = 10,
                       max_matches: int = 10, threshold: float = 0.2,
                       window: int = 32) -> AsyncIterator[Answer]:
        """As Client.localize."""
        config = convert.localize_config(journey, travel, left_camera, right_camera,
                                         tolerance_steps, max_matches, threshold)
        outbox = Outbox()
        outbox.begin(0, 0)
        sender = _Sender(observations, outbox, window)
        retry = Retry(self._server)
        reported = -1
        try:
            while True:
                limit = AnswerLimit(self._server.answer_time)
                room = asyncio.Semaphore(1 if retry.one_at_a_time else window)
                call = self._homing.Localize(metadata=self._trace.metadata())
                writing: Optional[asyncio.Future] = None
                error: Optional[grpc.RpcError] = None
                try:
                    await call.write(homing_service_pb2.LocalizeRequest(config=config))
                    writing = asyncio.ensure_future(_write(
                        call, sender,
                        lambda seen: homing_service_pb2.LocalizeRequest(observation=seen), limit,
                        room))
                    async for response in limit.answers_async(call):
                        room.release()
                        if response.sequence <= reported:
                            continue
                        sender.acknowledge(response.sequence + 1, response.sequence)
                        reported = response.sequence
                        sender.answered()
                        retry.progress()
                        last = convert.prior(response)
                        if last is not None:
                            config.prior.CopyFrom(last)
                        yield convert.answer(response)
                    if sender.is_done():
                        break
                except grpc.RpcError as caught:
                    error = caught
                finally:
                    call.cancel()
                    await _cancel(writing)
                await _wait(retry, error, limit.quiet())
                # The last one answered is sent again: flow continues from it.
                sender.begin(reported + 1, max(reported, 0))
        finally:
            await sender.close()
        if sender.error is not None:
            raise sender.error

    async def match(self, journey: str, first: View, second: View, *, side: str = "left",
                    travel: Travel = Travel.RETURN, max_matches: int = 10,
                    threshold: float = 0.2) -> List[Match]:
        request = convert.match_request(journey, first, second, side, travel, max_matches, threshold)
        found = await self._call(self._homing.MatchLandmarks, request)
        return [convert.match(one) for one in found.matches]

    async def journeys(self, parent: str = "robots/-") -> AsyncIterator[Journey]:
        request = journey_service_pb2.ListJourneysRequest(parent=parent, page_size=1000)
        while True:
            page = await self._call(self._journeys.ListJourneys, request)
            for found in page.journeys:
                yield convert.journey(found)
            request.page_token = page.next_page_token
            if not request.page_token:
                return

    async def get(self, journey: str) -> Journey:
        request = journey_service_pb2.GetJourneyRequest(name=journey)
        return convert.journey(await self._call(self._journeys.GetJourney, request))

    async def finish(self, journey: str, *, writer: str = "") -> Journey:
        request = journey_service_pb2.FinishJourneyRequest(name=journey, writer_id=writer)
        return convert.journey((await self._call(self._journeys.FinishJourney, request)).journey)

    async def delete(self, journey: str) -> None:
        await self._call(self._journeys.DeleteJourney,
                         journey_service_pb2.DeleteJourneyRequest(name=journey))


def _record_request(seen: Any) -> Any:
    return journey_service_pb2.RecordJourneyRequest(observation=seen)


async def _wait(retry: Retry, error: Optional[grpc.RpcError], quiet: float = 0.0) -> None:
    wait = retry.wait_after(error, quiet)
    if wait is None:
        raise from_rpc(error) from None
    await asyncio.sleep(wait)


async def _cancel(task: Optional[asyncio.Future]) -> None:
    if task is not None:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
