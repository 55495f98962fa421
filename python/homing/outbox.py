"""Numbers observations and keeps those that may have to be sent again. Knows no network."""

from __future__ import annotations

import collections
from typing import Deque, Optional

from .errors import HomingError
from .v1 import types_pb2


class Outbox:
    """With `live`, observations after a restart are new; else the source begins with number 0
    again, and the observations that the server has are left out. Not thread-safe."""

    def __init__(self, live: bool = False):
        self._live = live
        self._begun = False
        self._kept: Deque[types_pb2.Observation] = collections.deque()
        self._next_number = 0
        # The number after the last one sent, or that the server had before.
        self._sent = 0
        self._cursor = 0
        self._break_at = -1
        # Of a source that begins again: the server has all before, and asks for one of them.
        self._durable = 0
        self._reference = -1

    def begin(self, durable: int, reference: int) -> None:
        """A new link: the server has all before `durable`, and flow continues from `reference`."""
        self._sent = max(self._sent, durable)
        self._believe(durable)
        if not self._begun:
            self._begun = True
            self._durable = durable
            if self._live:
                self._next_number = durable
                self._cursor = durable
                self._break_at = durable if durable > 0 else -1
            else:
                self._reference = reference
                self._cursor = min(reference, durable)
            return
        self.acknowledge(durable, reference)
        has_reference = any(kept.sequence == reference for kept in self._kept)
        self._cursor = reference if has_reference else durable
        if not has_reference and reference < durable:
            self._break_at = durable

    def _believe(self, durable: int) -> None:
        if not 0 <= durable <= self._sent:
            raise HomingError("DATA_LOSS", f"the server answers observation {durable - 1}, but the "
                              f"last one sent is {self._sent - 1}")

    def is_done(self) -> bool:
        """The server has everything that was added."""
        return all(kept.sequence < self._durable for kept in self._kept)

    def acknowledge(self, durable: int, reference: int) -> None:
        self._believe(durable)
        self._durable = max(self._durable, durable)
        self._kept = collections.deque(
            kept for kept in self._kept if kept.sequence >= durable or kept.sequence == reference)

    def next_kept(self) -> Optional[types_pb2.Observation]:
        """The next one to send; None: all kept ones were sent."""
        for kept in self._kept:
            if kept.sequence >= self._cursor:
                self._cursor = kept.sequence + 1
                self._sent = max(self._sent, self._cursor)
                if kept.sequence == self._break_at:
                    kept.break_before = True
                return kept
        return None

    def add(self, observation: types_pb2.Observation) -> None:
        """Numbers and keeps it, unless the server has it and does not ask for it."""
        observation.sequence = self._next_number
        self._next_number += 1
        if observation.sequence >= self._durable or observation.sequence == self._reference:
            self._kept.append(observation)
