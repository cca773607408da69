"""Version 1 of the scene language as frozen records; the string below each field documents it everywhere."""

from atomsim.scene.language.base import Declaration, Rest, Vector
from atomsim.scene.language.expectations import Expectation
from atomsim.scene.language.groups import (
    AtomsGroup,
    BallGroup,
    BlockGroup,
    Copies,
    Group,
    PlaneGroup,
    PolygonGroup,
    RingGroup,
    Rotation,
    Spin,
    StringGroup,
)
from atomsim.scene.language.rules import (
    AllPairsBonds,
    Bonds,
    Collisions,
    DistanceThresholdBonds,
    ListedBonds,
    NeighbourBonds,
)
from atomsim.scene.language.scene import Camera, Jitter, Render, Scene
from atomsim.scene.language.silence import Silence

__all__ = [
    "AllPairsBonds",
    "AtomsGroup",
    "BallGroup",
    "BlockGroup",
    "Bonds",
    "Camera",
    "Collisions",
    "Copies",
    "Declaration",
    "DistanceThresholdBonds",
    "Expectation",
    "Group",
    "Jitter",
    "ListedBonds",
    "NeighbourBonds",
    "PlaneGroup",
    "PolygonGroup",
    "Render",
    "Rest",
    "RingGroup",
    "Rotation",
    "Scene",
    "Silence",
    "Spin",
    "StringGroup",
    "Vector",
]
