# SPDX-License-Identifier: Apache-2.0
"""Frames in serialized tf: bytes laid out by hand as CDR has them."""

from __future__ import annotations

import struct
import tracemalloc

import pytest
from hypothesis import given, strategies as st
from zenoh_robots import tf_message

from multibot_rewrite.producers.ros.assemble import numbers_of
from multibot_rewrite.producers.zenoh.cdr import read_header_frame, read_tf, read_transform

# One transform, odom -> base: count, stamp, "odom" with its zero, "base" with its zero, then
# seven doubles at a multiple of 8 (36 bytes are before them, so 4 are empty).
ONE = (
    b"\x00\x01\x00\x00"
    b"\x01\x00\x00\x00"
    b"\x07\x00\x00\x00\x08\x00\x00\x00"
    b"\x05\x00\x00\x00odom\x00\x00\x00\x00"
    b"\x05\x00\x00\x00base\x00"
    b"\x00\x00\x00" + b"\x00" * 4 + struct.pack("<7d", 1, 2, 3, 0, 0, 0, 1)
)


def edges(data: bytes) -> list[tuple[str, str]] | None:
    message = read_tf(data)
    found = message.transforms if message else ()
    return None if message is None else [(it.header.frame_id, it.child_frame_id) for it in found]


def test_one_transform() -> None:
    assert edges(ONE) == [("odom", "base")]


def test_a_single_transform_has_no_count() -> None:
    # Without the count what is behind it moves by 4 bytes, which the seven doubles take up.
    single = ONE[:4] + ONE[8:40] + struct.pack("<7d", 1, 2, 3, 0, 0, 0, 1)
    assert read_transform(single) == read_tf(ONE)
    assert read_transform(single[:-1]) is None


@pytest.mark.parametrize("mark", ["<", ">"])
def test_where_frames_are(mark: str) -> None:
    message = read_tf(tf_message(("odom", "base"), ("base", "scan"), mark=mark))
    assert message
    assert [numbers_of(it.transform) for it in message.transforms] == [(1, 2, 3, 0, 0, 0, 1)] * 2


@pytest.mark.parametrize("mark", ["<", ">"])
def test_names_of_any_length_stay_aligned(mark: str) -> None:
    wanted = [("o" * size, "ä" * (12 - size)) for size in range(12)]
    assert edges(tf_message(*wanted, mark=mark)) == wanted


def test_no_transform_is_a_message() -> None:
    assert edges(b"\x00\x01\x00\x00\x00\x00\x00\x00") == []


@pytest.mark.parametrize("end", [*range(4), 7, 8, 20, 30, 60, len(ONE) - 1])
def test_a_message_that_is_cut_short_is_none(end: int) -> None:
    assert read_tf(ONE[:end]) is None


def test_an_image_is_not_copied_for_its_header() -> None:
    image = ONE[:4] + ONE[8:16] + b"\x04\x00\x00\x00cam\x00" + b"\x80" * 1_000_000
    tracemalloc.start()
    assert read_header_frame(image) == "cam"
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 100_000


def test_another_encapsulation_is_none() -> None:
    assert read_tf(b"\x00\x07" + ONE[2:]) is None


@pytest.mark.slow
@given(st.binary(max_size=200))
def test_no_bytes_break_the_reader(data: bytes) -> None:
    read_tf(data)
    read_tf(ONE[:8] + data)
