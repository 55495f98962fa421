"""The channel to one server, and how long a broken link is tried again."""

from __future__ import annotations

import dataclasses
import os
import random
import re
import socket
import time
from typing import Optional, Sequence, Tuple, Union

import grpc

from .errors import HomingError, is_correctable, is_reset, is_retriable

_MAX_MESSAGE = 256 << 20
_MAX_CORRECTIONS = 3


@dataclasses.dataclass(frozen=True)
class Server:
    # HOST:PORT; "HOST:PORT,HOST:PORT,..." or "dns:///NAME:PORT" for several servers on one database.
    address: str = "127.0.0.1:50551"
    # PEM files. Any of them turns TLS on; without tls_ca the system's authorities are trusted.
    tls_ca: Optional[str] = None
    tls_cert: Optional[str] = None
    tls_key: Optional[str] = None
    # File with a bearer token, instead of a certificate. It is sent over TLS only.
    token_file: Optional[str] = None
    # How long a broken link is tried again since it last worked, seconds. Time in which nothing was
    # sent, or the program did not take answers, does not count.
    retry_for: float = 60.0
    # Longest time without an answer, while one is awaited, until a stream counts as broken, seconds.
    answer_time: float = 60.0
    # W3C traceparent of whoever started this program; None: the environment's TRACEPARENT, without
    # it a new trace. Each call names the trace, and its own span.
    traceparent: Optional[str] = None


def _read(path: Optional[str]) -> Optional[bytes]:
    if path is None:
        return None
    with open(path, "rb") as file:
        return file.read()


def target(server: Server) -> str:
    """The name of the channel. Those of a list are resolved here: gRPC takes only their addresses."""
    if "," not in server.address:
        return server.address
    numeric = []
    for one in server.address.split(","):
        host, _, port = one.rpartition(":")
        try:
            numeric.append(f"{socket.gethostbyname(host)}:{port}")
        except OSError as error:
            raise HomingError("UNAVAILABLE", f"address: {one}: {error}") from None
    return "ipv4:" + ",".join(numeric)


def options(server: Server) -> Sequence[Tuple[str, Union[int, str]]]:
    common = [("grpc.max_receive_message_length", _MAX_MESSAGE),
              ("grpc.max_send_message_length", _MAX_MESSAGE),
              ("grpc.max_reconnect_backoff_ms", 1000),
              ("grpc.initial_reconnect_backoff_ms", 100)]
    if "," not in server.address and not server.address.startswith("dns:///"):
        # Notices within half a minute that the server, or the way to it, has fallen silent.
        return common + [("grpc.keepalive_time_ms", 20000), ("grpc.keepalive_timeout_ms", 10000)]
    # Calls are spread over the servers; one that falls silent is left within three seconds. The
    # first one's name is that of the certificates.
    name = server.address.split("dns:///")[-1].split(",")[0]
    return common + [("grpc.lb_policy_name", "round_robin"), ("grpc.keepalive_time_ms", 1000),
                     ("grpc.keepalive_timeout_ms", 2000),
                     ("grpc.http2.max_pings_without_data", 0), ("grpc.default_authority", name)]


def credentials(server: Server) -> Optional[grpc.ChannelCredentials]:
    """None: plain text."""
    tls = server.tls_ca or server.tls_cert or server.tls_key
    if not tls:
        if server.token_file:
            raise HomingError("INVALID_ARGUMENT", "a token is sent over TLS only: give tls_ca")
        return None
    if bool(server.tls_cert) != bool(server.tls_key):
        raise HomingError("INVALID_ARGUMENT", "tls_cert and tls_key belong together")
    channel = grpc.ssl_channel_credentials(_read(server.tls_ca), _read(server.tls_key),
                                           _read(server.tls_cert))
    token = _read(server.token_file)
    if token is None:
        return channel
    return grpc.composite_channel_credentials(
        channel, grpc.access_token_call_credentials(token.decode().strip()))


class Trace:
    """The trace to which all calls of one client belong."""

    def __init__(self, server: Server):
        text = os.environ.get("TRACEPARENT", "") if server.traceparent is None else server.traceparent
        found = re.fullmatch("00-([0-9a-f]{32})-([0-9a-f]{16})-([0-9a-f]{2})", text)
        is_valid = found is not None and int(found[1], 16) > 0 and int(found[2], 16) > 0
        self._trace_id = found[1] if found and is_valid else os.urandom(16).hex()
        self._flags = found[3] if found and is_valid else "00"

    def metadata(self) -> Tuple[Tuple[str, str], ...]:
        """The metadata of one call: the shared trace and a new span."""
        return (("traceparent", f"00-{self._trace_id}-{os.urandom(8).hex()}-{self._flags}"),)


class Retry:
    """Decides after each error whether to try again, and how long to wait before."""

    def __init__(self, server: Server):
        self._retry_for = server.retry_for
        # The last link was reset: a proxy may close a stream after so many bytes, and drop what the
        # server did not answer yet.
        self.one_at_a_time = False
        self.progress()

    def progress(self) -> None:
        """The link works."""
        self._last = time.monotonic()
        self._wait = 0.1
        self._corrections = 0

    def wait_after(self, error: Optional[grpc.RpcError], quiet: float = 0.0) -> Optional[float]:
        """Seconds to wait; None: give up. The error of a stream that ended early is None. `quiet`:
        seconds since the last answer in which the link was not used."""
        self._last = min(self._last + quiet, time.monotonic())
        self.one_at_a_time = error is not None and is_reset(error)
        if error is not None and is_correctable(error):
            self._corrections += 1
            if self._corrections > _MAX_CORRECTIONS:
                return None
        elif error is not None and not is_retriable(error):
            return None
        if time.monotonic() - self._last >= self._retry_for:
            return None
        wait = self._wait * random.uniform(0.7, 1.0)
        self._wait = min(0.7, self._wait * 1.7)
        return wait
