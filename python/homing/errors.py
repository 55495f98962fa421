"""Errors of the server and of the way to it."""

from __future__ import annotations

from typing import Optional

import grpc

_RETRY_INFO = b"google.rpc.RetryInfo"
# What gRPC says of calls that this program cancelled, or whose client it closed.
_OWN_CANCELS = ("Channel closed!", "Locally cancelled by application!")


class HomingError(Exception):
    """code says what to do ("NOT_FOUND"), message names the field, the value and the limit."""

    def __init__(self, code: str, message: str):
        super().__init__(f"{message} ({code})")
        self.code = code
        self.message = message


def from_rpc(error: Optional[grpc.RpcError]) -> HomingError:
    """None: the stream ended without an error, or fell silent, before everything was answered."""
    if error is None:
        return HomingError("UNAVAILABLE", "the server ended the stream early, or did not answer")
    return HomingError(error.code().name, error.details() or "")


def is_retriable(error: grpc.RpcError) -> bool:
    """UNAVAILABLE, RESOURCE_EXHAUSTED to which the server added when to try again, or CANCELLED by the
    server: one that shuts down ends new calls so."""
    code = error.code()
    if code == grpc.StatusCode.UNAVAILABLE:
        return True
    if code == grpc.StatusCode.CANCELLED:
        return error.details() not in _OWN_CANCELS
    if code != grpc.StatusCode.RESOURCE_EXHAUSTED:
        return False
    trailers = error.trailing_metadata() or ()
    return any(key == "grpc-status-details-bin" and _RETRY_INFO in value
               for key, value in trailers)


def is_reset(error: grpc.RpcError) -> bool:
    """Something between client and server, such as a proxy, reset the stream."""
    return (error.code() in (grpc.StatusCode.INTERNAL, grpc.StatusCode.UNKNOWN)
            and any(text in (error.details() or "")
                    for text in ("RST_STREAM", "http2 header with status: ")))


def is_correctable(error: grpc.RpcError) -> bool:
    """The server expects another observation, and the first answer of a new stream names it; or the
    stream was reset."""
    return error.code() == grpc.StatusCode.OUT_OF_RANGE or is_reset(error)
