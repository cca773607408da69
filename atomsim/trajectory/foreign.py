"""Files that are no trajectories of ours: what each is by its first bytes, and what can read it."""

from __future__ import annotations

import re
from pathlib import Path

from atomsim.errors import InputError, Remedy

HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"

N_BYTES = 1 << 16
"""So many bytes of a file are looked at."""

_SIGNATURES: tuple[tuple[str, str, str], ...] = (
    (r"CDF[\x01\x02\x05]", "a netCDF file", "xarray, or MDAnalysis if it is one of AMBER"),
    (r".{4}CORD", "a DCD trajectory", "MDAnalysis, VMD or OVITO"),
    (r"\x00\x00\x07\xcb", "an XTC trajectory of GROMACS", "MDAnalysis, VMD or OVITO"),
    (r"\x00\x00\x07\xc9", "a TRR trajectory of GROMACS", "MDAnalysis, VMD or OVITO"),
    (r"(?:\xdf\x65){4}", "a GSD file of HOOMD-blue", "gsd, MDAnalysis or OVITO"),
    (r"ITEM: TIMESTEP", "a dump of LAMMPS", "OVITO or MDAnalysis"),
    (r"(?:HEADER|TITLE |REMARK|CRYST1|MODEL |ATOM  |HETATM)", "a PDB file", "MDAnalysis, VMD or OVITO"),
    (r"[ \t]*\d+[ \t]*\r?\n[^\n]*\n[ \t]*[A-Za-z]\w*(?:[ \t]+[-+.\d]\S*){3}", "an XYZ file", "OVITO, VMD or ASE"),
    (r"#usda|PXR-USDC", "a USD file", "usdview or Blender"),
    (r"\x93NUMPY", "an array of NumPy", "numpy.load"),
    (r"MATLAB 7\.3 MAT-file", "a MAT-file of MATLAB", "h5py"),
    (r"MATLAB 5\.0 MAT-file", "a MAT-file of MATLAB", "scipy.io.loadmat"),
    (r"PK\x03\x04", "a zip archive", "unzip, or numpy.load if it holds arrays"),
    (r"\x1f\x8b", "compressed with gzip", "gunzip"),
    (r"\x28\xb5\x2f\xfd", "compressed with zstd", "unzstd"),
    (r"BZh\d", "compressed with bzip2", "bunzip2"),
    (r"\xfd7zXZ\x00", "compressed with xz", "unxz"),
    (r"\x80[\x02-\x05]", "a pickle of Python", "the program that wrote it"),
    (r"\x89PNG|\xff\xd8\xff|GIF8|RIFF.{4}WEBP|%PDF|<svg|<\?xml", "a picture or a page", "a viewer"),
    (r"version https://git-lfs", "a pointer of Git LFS", "git lfs pull, which puts the file itself in its place"),
)
"""How a file begins, what it is then, and what reads it."""

_SCENE = re.compile(rb"""(?:^|[\n{,])[ \t]*["']?atomsim["']?[ \t]*:[ \t]*\d""")


def require_hdf5(path: Path, start: bytes) -> None:
    """Refuse a file that cannot be a finished trajectory.

    Args:
        path: the file.
        start: its first `N_BYTES`.

    Raises:
        InputError: the message says what it is, and what can read it.
    """
    if start.startswith(HDF5_SIGNATURE):
        return
    if not start:
        raise InputError(f"{path}: is empty, not a trajectory of atomsim")
    for pattern, kind, readers in _SIGNATURES:
        if re.match(pattern.encode("latin-1"), start, re.DOTALL):
            raise InputError(f"{path}: is {kind}, not a trajectory of atomsim; read it with {readers}")
    if _SCENE.search(start):
        raise InputError(f"{path}: is a scene, not a trajectory of atomsim", Remedy("run", path))
    raise InputError(f"{path}: not a trajectory of atomsim")
