"""Complementarity and contact problems, solved and certified.

    w = M z + q,   0 <= z  ⊥  w >= 0        (with bounds, friction limits and cones: Problem)

>>> import signorini
>>> result = signorini.solve([[2.0, 1.0], [1.0, 2.0]], [-5.0, -6.0])
>>> print(result.status, result.z)
solved [1.33333333 2.33333333]

Arrays that come out (z, w, q, ...) are views of the library's own numbers and keep them alive. Arrays
that go in are handed over as they are where they are contiguous and of the right type; the library
takes its copy once, when a Problem is made, and q and the numbers of M can then be changed in place.

Wrong shapes, sizes and settings raise ValueError; how a solve ended is its result's status. The GIL is
released while a solver runs. A Solver runs one solve at a time (others wait); different solvers run
side by side. Do not write to a Problem while it is being solved.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable, Sequence

import numpy as np
import numpy.typing as npt

from . import _signorini

__all__ = [
    "Attempt",
    "Certificate",
    "ContactResult",
    "ContactSolver",
    "Island",
    "Problem",
    "Result",
    "Solver",
    "Statistics",
    "body_dtype",
    "contact_dtype",
    "make_bodies",
    "make_contacts",
    "solve",
    "solver_names",
]

__version__: str = _signorini.version

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Certificate:
    """How good z is, recomputed from the caller's data (lcp/certificate.h has the equations)."""

    natural_residual: float  # max |min(z, w)| / (1 + |q|)
    unit_free_residual: float  # max |min(M_ii z_i, w_i)| / |q|
    rounding_floor: float  # what rounding z costs the unit-free residual
    natural_floor: float  # what it costs the natural residual
    backward_error: float
    min_z: float
    min_w: float
    complementarity: float  # |z.w|
    cone_violation: float
    worst_row: int


@dataclass(frozen=True)
class Statistics:
    """What a solve cost; -1: the solver has no such thing."""

    iterations: int
    pivots: int
    factorizations: int
    refinements: int
    factor_bytes: int
    solve_seconds: float


@dataclass(frozen=True)
class Attempt:
    """One solver's part in a solve that tried several ("auto")."""

    solver: str
    reason: str
    status: str
    detail: str
    natural_residual: float
    unit_free_residual: float
    iterations: int
    pivots: int
    solve_seconds: float


def _numbers(values: Any) -> Array:
    return np.ascontiguousarray(values, dtype=np.float64)


def _optional(values: Any | None) -> Array | None:
    return None if values is None else _numbers(values)


def _indices(values: Any) -> npt.NDArray[np.int32]:
    """Indices as int32; what does not fit is refused, not wrapped round."""
    given = np.asarray(values)
    if given.size > 0 and not np.issubdtype(given.dtype, np.integer):
        raise ValueError(f"indices must be integers, got {given.dtype}")
    limits = np.iinfo(np.int32)
    if given.size > 0 and (given.min() < limits.min or given.max() > limits.max):
        raise ValueError("indices must fit 32 bits")
    return np.ascontiguousarray(given, dtype=np.int32)


def _is_sparse(M: Any) -> bool:
    return hasattr(M, "tocsr") and hasattr(M, "format")


def _compressed(M: Any, formats: tuple[str, ...]) -> Any:
    """M as it is where it is in one of the formats and has no entry twice; else a copy that is."""
    if M.format not in formats:
        M = M.tocsr() if "csr" in formats else M.tocsc()
    if not M.has_canonical_format:
        M = M.copy()
        M.sum_duplicates()  # scipy's meaning of an entry given twice
    return M


class Problem:
    """Find z and w = M z + q with, for every row, 0 <= z_i, 0 <= w_i, z_i w_i = 0.

    M: n x n, a numpy array or a scipy.sparse matrix; may be nonsymmetric. See factored() for
    M = J W J^T. q: n numbers.

    lower, upper: bounds of z (default 0 and inf; -inf and inf make a free row, w_i = 0).
    limits: rows (row, normal_row, mu) with |z_row| <= mu z_normal_row.
    cones: rows (normal_row, dimension, mu) with |z_T| <= mu z_N over the rows from normal_row, for
    the friction_law "Coulomb" or "associated".
    """

    def __init__(
        self,
        M: Any,
        q: Any,
        *,
        lower: Any | None = None,
        upper: Any | None = None,
        limits: Iterable[Sequence[Any]] = (),
        cones: Iterable[Sequence[Any]] = (),
        friction_law: str = "Coulomb",
    ) -> None:
        self._handle = _signorini.Problem()
        if _is_sparse(M):
            if M.shape[0] != M.shape[1]:
                raise ValueError(f"M: must be square, got {M.shape[0]} x {M.shape[1]}")
            M = _compressed(M, ("csc", "csr"))
            self._handle.set_sparse(
                M.format == "csr", _indices(M.indptr), _indices(M.indices), _numbers(M.data),
                _numbers(q),
            )
        else:
            self._handle.set_dense(np.asarray(M, dtype=np.float64), _numbers(q))
        self._set_rows(lower, upper, limits, cones, friction_law)

    @classmethod
    def factored(
        cls,
        J: Any,
        q: Any,
        *,
        inverse_mass: Sequence[Any] | None = None,
        mass: Sequence[Any] | None = None,
        compliance: Any | None = None,
        lower: Any | None = None,
        upper: Any | None = None,
        limits: Iterable[Sequence[Any]] = (),
        cones: Iterable[Sequence[Any]] = (),
        friction_law: str = "Coulomb",
    ) -> Problem:
        """M = J W J^T + diag(compliance), never formed.

        J: n x m, a scipy.sparse matrix or an array. W: block diagonal, either by its blocks
        `inverse_mass` (symmetric positive definite, one a body) or by their inverses `mass`; the
        blocks' rows add up to m.
        """
        if (inverse_mass is None) == (mass is None):
            raise ValueError("factored: give either inverse_mass or mass")
        given = mass if inverse_mass is None else inverse_mass
        assert given is not None
        blocks = [np.atleast_2d(_numbers(block)) for block in given]
        for k, block in enumerate(blocks):
            if block.ndim != 2 or block.shape[0] != block.shape[1]:
                raise ValueError(f"factored: block {k} must be square, got {block.shape}")
        rows = sum(block.shape[0] for block in blocks)
        if not _is_sparse(J):
            from scipy.sparse import csr_matrix

            J = csr_matrix(np.asarray(J, dtype=np.float64))
        if J.shape[1] != rows:
            raise ValueError(f"J: has {J.shape[1]} columns, the blocks have {rows} rows")
        q = _numbers(q)
        if J.shape[0] != q.size:
            raise ValueError(f"q: {q.size} numbers for {J.shape[0]} rows of J")
        J = _compressed(J, ("csr",))
        problem = cls.__new__(cls)
        problem._handle = _signorini.Problem()
        problem._handle.set_factored(
            _indices(J.indptr),
            _indices(J.indices),
            _numbers(J.data),
            _indices([block.shape[0] for block in blocks]),
            np.concatenate([block.ravel(order="F") for block in blocks] or [np.empty(0)]),
            inverse_mass is None,
            _optional(compliance),
            q,
        )
        problem._set_rows(lower, upper, limits, cones, friction_law)
        return problem

    def _set_rows(
        self,
        lower: Any | None,
        upper: Any | None,
        limits: Iterable[Sequence[Any]],
        cones: Iterable[Sequence[Any]],
        friction_law: str,
    ) -> None:
        if friction_law not in ("Coulomb", "associated"):
            raise ValueError(
                f'friction_law: must be "Coulomb" or "associated", got "{friction_law}"'
            )
        if lower is not None or upper is not None:
            self._handle.set_bounds(_optional(lower), _optional(upper))
        limit = [list(each) for each in limits]
        if limit:
            row, normal, mu = zip(*limit)
            self._handle.set_limits(_indices(row), _indices(normal), _numbers(mu))
        cone = [list(each) for each in cones]
        if cone:
            normal, dimension, mu = zip(*cone)
            self._handle.set_cones(
                _indices(normal), _indices(dimension), _numbers(mu), friction_law == "associated"
            )

    def __len__(self) -> int:
        """The number of rows."""
        return self._handle.size()

    @property
    def q(self) -> Array:
        """q itself: writing to it changes the problem."""
        return self._handle.q()

    @property
    def matrix(self) -> Array | None:
        """The numbers of M themselves: n^2 by columns, or the entries of a sparse M by columns, rows
        ascending; None if M is factored. Writing to them changes the problem."""
        return self._handle.matrix()


class Result:
    """What a solve returns."""

    def __init__(self, handle: _signorini.Result) -> None:
        self._handle = handle

    @property
    def status(self) -> str:
        """"solved", "solved to rounding", "infeasible", "no solution below Z", "ray unproven",
        "iteration limit", "time limit", "stalled", "numerical breakdown" or "invalid input". Only
        the first two claim an answer."""
        return self._handle.status()

    @property
    def is_solved(self) -> bool:
        """Whether the status claims an answer; the certificate says how good it is."""
        return self._handle.is_solved()

    @property
    def solver(self) -> str:
        """The solver's name, with the variant that ended the solve."""
        return self._handle.solver()

    @property
    def detail(self) -> str:
        """Why it ended so, and whatever was done beside the plain method; "": nothing to add."""
        return self._handle.detail()

    @property
    def z(self) -> Array:
        """The answer, or the best iterate (see status)."""
        return self._handle.z()

    @property
    def w(self) -> Array:
        """M z + q, recomputed from the caller's data."""
        return self._handle.w()

    @property
    def ray(self) -> Array | None:
        """The ray on which the solve ended, if it did."""
        return self._handle.ray()

    @property
    def ray_bound(self) -> float:
        """Z: every feasible z has |z|_1 >= Z; 0: nothing is known."""
        return self._handle.ray_bound()

    @property
    def certificate(self) -> Certificate:
        return Certificate(**self._handle.certificate())

    @property
    def statistics(self) -> Statistics:
        return Statistics(**self._handle.statistics())

    @property
    def attempts(self) -> list[Attempt]:
        """Every solver that "auto" tried, in order."""
        return [Attempt(**each) for each in self._handle.attempts()]

    @property
    def island_certificates(self) -> list[Certificate]:
        """With certify_islands: one for every set of rows that nothing connects."""
        return [Certificate(**each) for each in self._handle.island_certificates()]

    @property
    def island_of_row(self) -> npt.NDArray[np.int32] | None:
        """With certify_islands: the island of every row."""
        return self._handle.island_of_row()

    def __repr__(self) -> str:
        return f"<signorini.Result: {self.status}, {self.solver}, {self.z.size} rows>"


class Solver:
    """One solver with its settings and workspace. name: see solver_names().

    tolerance: of both residuals, in (0, 1). max_iterations: in the solver's own unit, -1: its own
    default. time_limit: seconds. certify_islands: one certificate for every set of rows that nothing
    connects, too. quick_certificate: that of a solved factored problem is a bound, at O(n). dump: a folder DIR[:OPTIONS] to which every solve is written, for
    signorini-solve to replay (docs/problem-folders.md).
    """

    def __init__(
        self,
        name: str = "auto",
        *,
        tolerance: float = 1e-8,
        max_iterations: int = -1,
        time_limit: float = float("inf"),
        certify_islands: bool = False,
        quick_certificate: bool = False,
        dump: str = "",
    ) -> None:
        self._handle = _signorini.Solver(name)
        self.name = name
        self._handle.set_number("tolerance", tolerance)
        self._handle.set_number("max_iterations", max_iterations)
        self._handle.set_number("time_limit", time_limit)
        self._handle.set_number("certify_islands", certify_islands)
        self._handle.set_number("quick_certificate", quick_certificate)
        if dump:
            self._handle.set_text("dump", dump)

    def solve(self, problem: Problem, warm_start: Any | None = None) -> Result:
        """Solves. warm_start: n numbers to start from, for solvers that can use them."""
        return Result(self._handle.solve(problem._handle, _optional(warm_start)))


def solve(
    M: Any, q: Any, *, solver: str = "auto", warm_start: Any | None = None, tolerance: float = 1e-8,
    **rows: Any,
) -> Result:
    """Finds z >= 0 with w = M z + q >= 0 and z.w = 0. rows: the keywords of Problem."""
    return Solver(solver, tolerance=tolerance).solve(Problem(M, q, **rows), warm_start)


def solver_names() -> list[str]:
    """The names that Solver knows."""
    return _signorini.solver_names()


#: A body: kind 0 dynamic, 1 kinematic (driven), 2 fixed; SI units; orientation w, x, y, z.
body_dtype = np.dtype(
    [
        ("kind", np.int32),
        ("reserved", np.int32),
        ("mass", np.float64),
        ("inertia", np.float64, (3, 3)),  # about the centre of mass, body axes
        ("position", np.float64, 3),
        ("orientation", np.float64, 4),
        ("linear_velocity", np.float64, 3),  # after the step's forces
        ("angular_velocity", np.float64, 3),
    ]
)

#: A contact of the bodies numbered body_a and body_b; normal: unit, from B to A.
contact_dtype = np.dtype(
    [
        ("body_a", np.int32),
        ("body_b", np.int32),
        ("point_a", np.float64, 3),
        ("point_b", np.float64, 3),
        ("normal", np.float64, 3),
        ("gap", np.float64),  # normal.(point_a - point_b)
        ("friction", np.float64),
        ("restitution", np.float64),
        ("allowance", np.float64),  # m/s; NaN: from gap and restitution
        ("feature_id", np.uint64),
    ]
)



def make_bodies(count: int) -> npt.NDArray[np.void]:
    """An array of body_dtype to fill: dynamic, 1 kg, unit inertia, at rest in the origin."""
    bodies = np.zeros(count, body_dtype)
    bodies["mass"] = 1.0
    bodies["inertia"] = np.eye(3)
    bodies["orientation"] = (1.0, 0.0, 0.0, 0.0)
    return bodies


def make_contacts(count: int) -> npt.NDArray[np.void]:
    """An array of contact_dtype to fill: gap 0, no friction, no restitution; the rest is NaN or -1, so
    that what was forgotten is refused; allowance from gap and restitution."""
    contacts = np.zeros(count, contact_dtype)
    for field in ("body_a", "body_b"):
        contacts[field] = -1
    for field in ("point_a", "point_b", "normal", "allowance"):
        contacts[field] = np.nan
    return contacts


assert body_dtype.itemsize == _signorini.body_bytes
assert contact_dtype.itemsize == _signorini.contact_bytes


@dataclass(frozen=True)
class Island:
    """What was solved for a set of contacts that no dynamic body connects with others."""

    bodies: int
    contacts: int
    rows: int
    status: str
    unit_free_residual: float
    residual: float  # the same times |q|, m/s: what accuracy speaks of
    work: float  # with accuracy, in the units of budget_work; else 0


class ContactResult:
    """What a contact solve returns."""

    def __init__(self, handle: _signorini.ContactResult) -> None:
        self._handle = handle

    @property
    def status(self) -> str:
        """Of the islands the first that is not solved; see Result.status."""
        return self._handle.status()

    @property
    def is_solved(self) -> bool:
        return self._handle.is_solved()

    @property
    def detail(self) -> str:
        return self._handle.detail()

    @property
    def velocities(self) -> Array:
        """n x 6: linear (of the centre of mass) and angular, after the impulses."""
        return self._handle.velocities()

    @property
    def impulses(self) -> Array:
        """Of every contact on its body A, N s; on B: minus that."""
        return self._handle.impulses()

    @property
    def normal_impulses(self) -> Array:
        """N s, >= 0."""
        return self._handle.normal_impulses()

    @property
    def energy_change(self) -> float:
        """Of the kinetic energy, by the impulses, J."""
        return self._handle.energy_change()

    @property
    def certificate(self) -> Certificate:
        """Of the island that ended worst; NaN without contacts."""
        return Certificate(**self._handle.certificate())

    @property
    def accuracy(self) -> str:
        """The position of the dial: "game", "1e-06 m/s"; "": it was not used."""
        return self._handle.accuracy()

    @property
    def work(self) -> float:
        """What was spent, in the units of budget_work; 0 without the dial."""
        return self._handle.work()

    @property
    def is_deterministic(self) -> bool:
        """False where a clock decided when a solver stops: the same input need not give the same
        bits."""
        return self._handle.is_deterministic()

    @property
    def islands(self) -> list[Island]:
        return [Island(**each) for each in self._handle.islands()]

    @property
    def island_of_contact(self) -> npt.NDArray[np.int32]:
        return self._handle.island_of_contact()

    def __repr__(self) -> str:
        return f"<signorini.ContactResult: {self.status}, {len(self.normal_impulses)} contacts>"


class ContactSolver:
    """Contact impulses for a host with its own bodies, collision detection and integrator.

    friction_model: "cone" (Coulomb's), "pyramid" or "box". touching_tolerance (m) and
    restitution_threshold (m/s): restitution acts at closer, faster contacts. warm_start: from the
    impulses of the solve before, known again by bodies and feature_id.

    accuracy: the dial, one setting for whoever wants no others: "preview", "game", "engineering",
    "reference" or a residual in m/s (docs/accuracy-dial.md). It chooses model, solvers and tolerance;
    solver, friction_model, tolerance and max_iterations then count for nothing. With it, budget_work
    (a unit is a thousand rows swept once; a factorisation counts 30 sweeps) and budget_seconds limit
    one solve: where they run out the result is the best iterate, and its status says so.
    """

    _MODELS = {"pyramid": 0, "cone": 1, "box": 2}

    def __init__(
        self,
        *,
        solver: str = "auto",
        friction_model: str = "cone",
        pyramid_sides: int = 8,
        warm_start: bool = True,
        touching_tolerance: float = 1e-6,
        restitution_threshold: float = 0.0,
        tolerance: float = 1e-8,
        max_iterations: int = -1,
        time_limit: float = float("inf"),
        quick_certificate: bool = True,
        accuracy: str | float | None = None,
        budget_work: float = float("inf"),
        budget_seconds: float = float("inf"),
        dump: str = "",
    ) -> None:
        if friction_model not in self._MODELS:
            raise ValueError(
                f'friction_model: must be one of {sorted(self._MODELS)}, got "{friction_model}"'
            )
        self._handle = _signorini.ContactSolver()
        self._handle.set_text("solver", solver)
        self._handle.set_number("friction_model", self._MODELS[friction_model])
        self._handle.set_number("pyramid_sides", pyramid_sides)
        self._handle.set_number("warm_start", warm_start)
        self._handle.set_number("touching_tolerance", touching_tolerance)
        self._handle.set_number("restitution_threshold", restitution_threshold)
        self._handle.set_number("tolerance", tolerance)
        self._handle.set_number("max_iterations", max_iterations)
        self._handle.set_number("time_limit", time_limit)
        self._handle.set_number("quick_certificate", quick_certificate)
        if accuracy is not None:
            self._handle.set_text("accuracy", str(accuracy))
        self._handle.set_number("budget_work", budget_work)
        self._handle.set_number("budget_seconds", budget_seconds)
        if dump:
            self._handle.set_text("dump", dump)

    def solve(
        self, step: float, bodies: npt.NDArray[np.void], contacts: npt.NDArray[np.void]
    ) -> ContactResult:
        """All contact impulses at once: M (v+ - v) = J^T f, 0 <= f ⊥ J_n v+ + allowance >= 0, with
        friction. step: h, s; bodies, contacts: arrays of body_dtype and contact_dtype."""
        if getattr(bodies, "dtype", None) != body_dtype:
            raise ValueError("bodies: must be a numpy array of signorini.body_dtype")
        if getattr(contacts, "dtype", None) != contact_dtype:
            raise ValueError("contacts: must be a numpy array of signorini.contact_dtype")
        return ContactResult(self._handle.solve(step, bodies, contacts))
