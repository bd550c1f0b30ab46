from glob import glob

from setuptools import setup

NAME = "multibot_example"

setup(
    name=NAME,
    version="0.1.0",
    description="Any number of robots in Gazebo, from one fleet file",
    license="Apache-2.0",
    packages=[],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        *((f"share/{NAME}/{it}", sorted(glob(f"{it}/*"))) for it in ("config", "launch", "urdf")),
    ],
)
