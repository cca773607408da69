"""Version 1 of the scene language as frozen records; the string below each field documents it everywhere."""

from atomsim.scene.language.base import Declaration, Rest, Vector
from atomsim.scene.language.forces import Damping, Force, Gravity, Hold, Oscillate, Push, Tether, Torque
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
    "Damping",
    "Declaration",
    "DistanceThresholdBonds",
    "Force",
    "Gravity",
    "Group",
    "Hold",
    "Jitter",
    "ListedBonds",
    "NeighbourBonds",
    "Oscillate",
    "PlaneGroup",
    "PolygonGroup",
    "Push",
    "Render",
    "Rest",
    "RingGroup",
    "Rotation",
    "Scene",
    "Silence",
    "Spin",
    "StringGroup",
    "Tether",
    "Torque",
    "Vector",
]
