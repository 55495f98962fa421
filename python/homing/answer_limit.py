"""Cancels the stream of a server that is connected and does not answer."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from typing import Any, AsyncIterator, Callable, Iterator, Optional

import grpc


class AnswerLimit:
    """Thread-safe. Time that the reader takes for an answer is not the server's."""

    def __init__(self, seconds: float):
        self._seconds = seconds
        self._changed = threading.Condition()
        self._awaited = 0
        self._is_reading = False
        self._since = 0.0
        self._over = False
        self._noted = time.monotonic()
        self._quiet = 0.0
        self.expired = False

    def quiet(self) -> float:
        """Time since the last answer in which none was awaited, or its reader was busy, seconds."""
        with self._changed:
            self._note()
            return self._quiet

    def _note(self) -> None:
        """Before each change of what is awaited."""
        now = time.monotonic()
        if self._awaited == 0 or not self._is_reading:
            self._quiet += now - self._noted
        self._noted = now

    def sent(self) -> None:
        """One more answer, or the end of the stream, is awaited."""
        with self._changed:
            self._note()
            if self._awaited == 0:
                self._since = time.monotonic()
                self._changed.notify()
            self._awaited += 1

    def answered(self) -> None:
        with self._changed:
            self._note()
            self._quiet = 0.0
            # A server may answer twice.
            self._awaited = max(0, self._awaited - 1)
            self._is_reading = False

    def read_on(self) -> None:
        with self._changed:
            self._note()
            self._is_reading = True
            self._since = time.monotonic()
            self._changed.notify()

    @contextlib.contextmanager
    def watch(self, cancel: Callable[[], Any]) -> Iterator[None]:
        """Calls `cancel` on another thread once the time has passed."""
        self.read_on()
        threading.Thread(target=self._watch, args=(cancel,), daemon=True).start()
        try:
            yield
        finally:
            with self._changed:
                self._over = True
                self._changed.notify()

    def answers(self, stream: Any) -> Iterator[Any]:
        with self.watch(stream.cancel):
            for response in stream:
                self.answered()
                yield response
                self.read_on()

    async def answers_async(self, call: Any) -> AsyncIterator[Any]:
        """Ends like a stream that ended early, if the time has passed."""
        loop = asyncio.get_running_loop()
        with self.watch(lambda: loop.call_soon_threadsafe(call.cancel)):
            while True:
                try:
                    response = await _read(call)
                except asyncio.CancelledError:
                    if not self.expired:
                        raise
                    return
                if response is None:
                    return
                self.answered()
                yield response
                self.read_on()

    def _watch(self, cancel: Callable[[], Any]) -> None:
        with self._changed:
            while not self._over and not self.expired:
                if self._awaited == 0 or not self._is_reading:
                    self._changed.wait()
                    continue
                left = self._since + self._seconds - time.monotonic()
                self.expired = left <= 0
                self._changed.wait(max(0.0, left))
        if self.expired:
            cancel()


async def _read(call: Any) -> Optional[Any]:
    """None: the stream ended without an error."""
    response = await call.read()
    if response is not grpc.aio.EOF:
        return response
    code = await call.code()
    if code is grpc.StatusCode.OK:
        return None
    raise grpc.aio.AioRpcError(code, await call.initial_metadata(), await call.trailing_metadata(),
                               await call.details())
