# SPDX-License-Identifier: Apache-2.0
"""The frames in a serialized ``tf2_msgs/msg/TFMessage``. Pure.

Source: the plain CDR of DDS, which rmw_zenoh serializes with (``cdr.cpp``): four bytes of
encapsulation, then each number at a multiple of its size. TFMessage is a list of TransformStamped:
stamp (int32, uint32), frame_id, child_frame_id, and seven doubles, translation and rotation.
"""

import struct
from collections.abc import Callable
from typing import NamedTuple, TypeVar

_T = TypeVar("_T")
_HEADER = 4
# CDR_BE and CDR_LE; other encapsulations have other alignment.
_ENDS = {b"\x00\x00": ">", b"\x00\x01": "<"}
_STAMP = 8
# A robot with more has the same names in the rest.
MOST_JOINTS = 200


class _Header(NamedTuple):
    frame_id: str
    stamp: float


class _Vector(NamedTuple):
    x: float
    y: float
    z: float


class _Quaternion(NamedTuple):
    x: float
    y: float
    z: float
    w: float


class Transform(NamedTuple):
    """As in geometry_msgs; a pose has the same numbers."""

    translation: _Vector
    rotation: _Quaternion


class _Stamped(NamedTuple):
    header: _Header
    child_frame_id: str
    transform: Transform


class TfMessage(NamedTuple):
    """A TFMessage; fields as in tf2_msgs, stamps in seconds."""

    transforms: tuple[_Stamped, ...]


def read_tf(data: bytes) -> TfMessage | None:
    """Return the message in these bytes, or None if it is cut short or no plain CDR."""
    return _read(data, lambda it: TfMessage(tuple(_stamped(it) for _ in range(it.number()))), None)


def read_transform(data: bytes) -> TfMessage | None:
    """Return the message with a single TransformStamped in these bytes, or None if cut short."""
    return _read(data, lambda it: TfMessage((_stamped(it),)), None)


def read_header_frame(data: bytes) -> str | None:
    """Return the ``header.frame_id`` of a message that begins with a header, or None if cut short."""
    return _read(data, lambda it: _texts(it, 1)[0], None)


def read_text(data: bytes) -> str | None:
    """Return the text of a ``std_msgs/msg/String``, or None if cut short."""
    return _read(data, lambda it: it.text(), None)


def read_child_frame(data: bytes) -> str | None:
    """Return the ``child_frame_id`` of an Odometry, after its header, or None if cut short."""
    return _read(data, lambda it: _texts(it, 2)[1], None)


def read_pose(data: bytes, texts: int) -> Transform | None:
    """Return the pose after a stamp and ``texts`` strings, or None for other data."""
    return _read(data, lambda it: _transform(it) if _texts(it, texts) else None, None)


def read_joint_names(data: bytes) -> tuple[str, ...]:
    """Return the names in a JointState or JointTrajectory, after its header; empty if cut short."""

    def names(reader: _Reader) -> tuple[str, ...]:
        _texts(reader, 1)
        return tuple(reader.text() for _ in range(min(reader.number(), MOST_JOINTS)))

    return _read(data, names, ())


def _read(data: bytes, read: "Callable[[_Reader], _T]", without: _T) -> _T:
    """Return what ``read`` finds in CDR data, or ``without``."""
    mark = _ENDS.get(data[:2])
    if mark is None:
        return without
    try:
        return read(_Reader(memoryview(data)[_HEADER:], mark))
    except (struct.error, UnicodeDecodeError, IndexError):
        return without


def _texts(reader: "_Reader", many: int) -> list[str]:
    """Return the first ``many`` texts behind the stamp."""
    reader.skip(_STAMP)
    return [reader.text() for _ in range(many)]


def read_stamp(data: bytes) -> float | None:
    """Return the ``header.stamp`` of such a message in seconds, or None if cut short."""
    mark = _ENDS.get(data[:2])
    if mark is None or len(data) < _HEADER + _STAMP:
        return None
    seconds, parts = struct.unpack(f"{mark}iI", data[_HEADER : _HEADER + _STAMP])
    return float(seconds + parts / 1e9)


def _stamped(reader: "_Reader") -> _Stamped:
    stamp = reader.number() + reader.number() / 1e9
    parent, child = reader.text(), reader.text()
    return _Stamped(_Header(parent, stamp), child, _transform(reader))


def _transform(reader: "_Reader") -> Transform:
    reader.align(8)
    return Transform(_Vector(*reader.doubles(3)), _Quaternion(*reader.doubles(4)))


class _Reader:
    """A place in the bytes behind the encapsulation."""

    def __init__(self, data: memoryview, mark: str) -> None:
        self._data = data
        self._mark, self._number = mark, struct.Struct(f"{mark}I")
        self._at = 0

    def align(self, size: int) -> None:
        self._at += -self._at % size

    def skip(self, size: int) -> None:
        """Skip so many bytes; raises IndexError behind the end."""
        self._at += size
        if self._at > len(self._data):
            raise IndexError

    def doubles(self, many: int) -> tuple[float, ...]:
        """Return so many doubles; raises struct.error behind the end."""
        values = struct.unpack_from(f"{self._mark}{many}d", self._data, self._at)
        self._at += 8 * many
        return values

    def number(self) -> int:
        """Return the next uint32; raises struct.error behind the end."""
        self.align(4)
        (value,) = self._number.unpack_from(self._data, self._at)
        self._at += 4
        return int(value)

    def text(self) -> str:
        """Return the next string; its length counts the zero at its end."""
        length, start = self.number(), self._at
        self.skip(length)
        return bytes(self._data[start : self._at]).removesuffix(b"\x00").decode()
