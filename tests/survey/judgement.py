"""Whether a mesh is right, by what OpenCASCADE says of its file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mesh_facts import MeshFacts

#: Worst first. crash: a signal; hang: no end in time; refused: no mesh although OpenCASCADE finds faces; leak: closed
#: shells whose mesh has open edges; flipped: a negative volume; volume, area: off by more than the tolerance explains.
KINDS = ("crash", "hang", "refused", "leak", "flipped", "volume", "area")


@dataclass(frozen=True)
class Run:
    """How the command line ended: ``code`` is its exit status, or "hang"."""

    code: int | str
    seconds: float
    error: str = ""
    mesh: MeshFacts = MeshFacts()


@dataclass(frozen=True)
class Fault:
    """A fault of one of KINDS, in words."""

    kind: str
    words: str


def _is_near(value: float, truths: list[float | None], allowed: float) -> bool:
    return any(truth is not None and abs(value - truth) <= allowed for truth in truths)


def fault_of_run(truth: dict[str, Any], run: Run) -> Fault | None:
    """Judges how a run ended."""
    if run.code == "hang":
        return Fault("hang", f"no end within {run.seconds:.0f} s")
    if isinstance(run.code, int) and (run.code < 0 or run.code > 2):
        return Fault("crash", f"exit {run.code}: {run.error[-120:]}")
    if truth.get("error") or not truth.get("faces"):
        return None
    return Fault("refused", run.error[-200:]) if run.code != 0 else None


def fault_of_mesh(truth: dict[str, Any], mesh: MeshFacts, relative: float) -> Fault | None:
    """Judges a mesh that was made with a tolerance of ``relative`` times the model's size."""
    parts = truth["parts"]
    are_all = bool(parts) and sum(part["faces"] for part in parts) == truth["faces"]
    if are_all and all(part["closed"] for part in parts) and mesh.open_edges:
        return Fault("leak", f"{mesh.open_edges} open edges of {mesh.triangles} triangles")
    size, area = truth["diagonal"] or 0, truth["area"]
    allowed = 0.03 * abs(area or 0) + 3 * relative * size * size * 0.05
    if area and not _is_near(mesh.area, [area, truth["area_quick"]], allowed):
        return Fault("area", f"{mesh.area:.6g}, OpenCASCADE says {area:.6g}")
    if are_all and all(part["closed"] and part["valid"] for part in parts):
        return _fault_of_volume(truth, mesh, relative)
    return None


def _fault_of_volume(truth: dict[str, Any], mesh: MeshFacts, relative: float) -> Fault | None:
    volumes = [sum(part[key] or 0 for part in truth["parts"]) for key in ("volume", "volume_quick")]
    allowed = relative * (truth["diagonal"] or 0) * abs(truth["area"] or 0) + 0.002 * abs(volumes[0])
    if volumes[0] <= 0 or _is_near(mesh.volume, volumes, allowed):
        return None
    kind = "flipped" if mesh.volume < 0 else "volume"
    return Fault(kind, f"{mesh.volume:.6g}, OpenCASCADE says {volumes[0]:.6g}, allowed {allowed:.3g}")


def fault_of(truth: dict[str, Any], run: Run, relative: float) -> Fault | None:
    """Judges a run and its mesh; None if both are right, or if OpenCASCADE finds no faces in the file."""
    fault = fault_of_run(truth, run)
    if fault or run.code != 0 or truth.get("error") or not truth.get("faces"):
        return fault
    return fault_of_mesh(truth, run.mesh, relative)
