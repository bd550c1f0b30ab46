"""Numbers of simulated sensors with which they see nothing.

Sources: gz-sensors CameraSensor.cc and GpuLidarSensor.cc (a picture of no pixels, no samples: 'is not
created'), sdformat lidar.sdf and camera.sdf (metres), Sensor.cc (a rate of 0 is each step).
"""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.sensors import CAMERAS, LIDARS, number_at
from multibot_rewrite.rules.subject import Subject

_LIDAR = ("lidar", "ray")
# No lidar sees as far, in metres, and none is blind for as long.
FAR, BLIND = 2000.0, 20.0
_ABOVE_0 = {
    "camera": ("image/width", "image/height", "clip/near", "horizontal_fov"),
    "lidar": ("scan/horizontal/samples", "range/max"),
}


def sees_nothing(subject: Subject) -> Iterator[Problem]:
    """Pictures without a pixel, scans without a ray, negative rates, ranges in millimetres."""
    for sensor in subject.elements.every("sensor"):
        type_ = sensor.get("type", "")
        rate = number_at(sensor, "update_rate")
        if rate is not None and rate < 0:
            yield _problem(sensor, "update_rate", "is below 0")
        for inner in sensor.iterchildren("camera") if type_ in CAMERAS else ():
            yield from _none_of(inner, _ABOVE_0["camera"])
        for inner in sensor.iterchildren(*_LIDAR) if type_ in LIDARS else ():
            yield from _none_of(inner, _ABOVE_0["lidar"])
            yield from _in_millimetres(inner)


def _none_of(inner: _Element, paths: tuple[str, ...]) -> Iterator[Problem]:
    for path in paths:
        value = number_at(inner, path)
        if value is not None and value <= 0:
            yield _problem(inner, path, "has to be above 0")


def _in_millimetres(lidar: _Element) -> Iterator[Problem]:
    near, far = number_at(lidar, "range/min"), number_at(lidar, "range/max")
    if near is not None and far is not None and near >= BLIND and far >= FAR:
        yield _problem(
            lidar, "range/max", "is a length in metres", "divide by 1000: are these millimetres?"
        )


def _problem(above: _Element, path: str, words: str, hint: str = "") -> Problem:
    element = above.find(path)
    assert element is not None
    message = f"{element.tag} is {(element.text or '').strip()}, which {words}"
    return Problem(element, message, "", hint, level=WARNING)
