"""How many participants run here, by their ports."""

from __future__ import annotations

from multibot_rewrite.producers.ros.participants import participants_at, ports_in

TABLE = """\
   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode
 7225: 0100007F:1CF2 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 274152
 9183: 00000000:1CF3 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 274145
 9184: 00000000:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 274150
"""


def test_ports_of_a_table() -> None:
    assert ports_in(TABLE) == [7410, 7411, 7400]
    assert ports_in("") == []


def test_a_participant_has_an_even_port_behind_those_of_its_domain() -> None:
    # Two in domain 0: 7400 is for messages to all, odd ones are for data.
    assert participants_at([7400, 7410, 7411, 7412, 7413, 7412], 0) == 2
    # Two of domain 1, and one of domain 2.
    assert participants_at([7650, 7660, 7662, 7910], 1) == 2
    assert participants_at([7660, 32769], 0) == 0
