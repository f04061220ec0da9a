"""Potential-flow coefficients of the two bodies, by Capytaine: writes `spar.csv` and `barge.csv`.

`pip install capytaine`, then `python hydrodynamics.py`: three minutes on one core. The example itself does not need Capytaine.
Water is infinitely deep. Both bodies look alike from x and from y, so A22 = A11, A44 = A55, A24 = -A15, and the table has five coefficients.
"""

import pathlib

import capytaine as cpt
import numpy as np
from capytaine.bem.airy_waves import froude_krylov_force

DENSITY, GRAVITY = 1025.0, 9.80665  # [kg/m³], [m/s²]
HERE = pathlib.Path(__file__).resolve().parent
DOFS = ["Surge", "Heave", "Pitch", "Yaw"]
# Radiating motion and force of the columns A11, A33, A55, A15, A66 and B11 ... B66
PAIRS = [("Surge", "Surge"), ("Heave", "Heave"), ("Pitch", "Pitch"), ("Pitch", "Surge"), ("Yaw", "Yaw")]


def spar_mesh() -> cpt.Mesh:
    """The OC3 Hywind spar below water: diameters 6.5 m to 4 m depth, 9.4 m from 12 m to 120 m (Jonkman 2010, table 3-1).

    20 sides of the area of the circle; panels are shorter where the wave motion decays fastest."""
    sides = 20
    depths = [0, 1, 2, 3, 4, 5.5, 7, 8.5, 10, 12, 14, 17, 20, 24, 28, 33, 38, 44, 50, 57, 64, 72, 80, 90, 100, 110, 116, 120]
    radii = list(np.interp(depths, [0, 4, 12, 120], [3.25, 3.25, 4.7, 4.7])) + [3.0, 1.5, 0.0]
    depths = depths + [120, 120, 120]
    radii = np.array(radii) * np.sqrt(2 * np.pi / sides / np.sin(2 * np.pi / sides))
    return revolve(radii, -np.array(depths, dtype=float), sides)


def revolve(radii: np.ndarray, heights: np.ndarray, sides: int) -> cpt.Mesh:
    """Mesh of a vertical polygonal body from its profile [m], top first, normals outwards."""
    turns = 2 * np.pi * np.arange(sides) / sides
    rings = [np.c_[r * np.cos(turns), r * np.sin(turns), np.full(sides, z)] for r, z in zip(radii, heights)]
    faces = [[i * sides + j, (i + 1) * sides + j, (i + 1) * sides + k, i * sides + k]
             for i in range(len(radii) - 1) for j, k in ((j, (j + 1) % sides) for j in range(sides))]
    return cpt.Mesh(vertices=np.concatenate(rings), faces=np.array(faces))


def barge_mesh() -> cpt.Mesh:
    """A square box, 20 m wide, of 1000 t and 164 t of mooring lines: draft 2.838 m; panels of 1 m."""
    return cpt.mesh_parallelepiped(size=(20.0, 20.0, 2.838), resolution=(20, 20, 4), center=(0, 0, -1.419),
                                   missing_sides={"top"})


def write(name: str, mesh: cpt.Mesh, frequencies: np.ndarray) -> None:
    """Writes the table of a body: a row per angular frequency [rad/s], of which the last is infinite."""
    body = cpt.FloatingBody(mesh=mesh, lid_mesh=mesh.generate_lid(), dofs=cpt.rigid_body_dofs(rotation_center=(0, 0, 0)))
    solver, common = cpt.BEMSolver(), {"body": body, "rho": DENSITY, "g": GRAVITY}
    rows = []
    for omega in [*frequencies, np.inf]:
        radiation = {dof: solver.solve(cpt.RadiationProblem(omega=omega, radiating_dof=dof, **common)) for dof in DOFS}
        row = [omega, *(radiation[a].added_masses[b] for a, b in PAIRS)]
        row += [0.0 if omega == np.inf else radiation[a].radiation_dampings[b] for a, b in PAIRS]
        wave = np.zeros(3, dtype=complex)
        if omega < np.inf:
            problem = cpt.DiffractionProblem(omega=omega, wave_direction=0.0, **common)
            diffracted, undisturbed = solver.solve(problem).forces, froude_krylov_force(problem)
            wave = np.array([diffracted[dof] + undisturbed[dof] for dof in DOFS[:3]])
        row += [part for force in wave for part in (force.real, force.imag)]
        rows.append(row)
        print(name, f"{omega:.3f} rad/s", flush=True)
    columns = ["omega"] + [kind + pair for kind in "AB" for pair in ("11", "33", "55", "15", "66")]
    columns += [f"F{axis}_{part}" for axis in (1, 3, 5) for part in ("re", "im")]
    head = (f"Capytaine {cpt.__version__}, {mesh.nb_faces} panels, {DENSITY} kg/m3, {GRAVITY} m/s2, infinite depth; about the origin"
            f" at still water\nSI units; F e^(-i omega t) for a wave Re(e^(i(kx - omega t))); made by hydrodynamics.py\n")
    np.savetxt(HERE / f"{name}.csv", rows, fmt="%.6g", delimiter=",", header=head + ",".join(columns))


if __name__ == "__main__":
    write("spar", spar_mesh(), np.arange(1, 161) * 0.025)
    write("barge", barge_mesh(), np.arange(1, 161) * 0.025)
