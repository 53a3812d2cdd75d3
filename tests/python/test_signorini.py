"""The Python package, over the C API."""

import gc
import importlib.util
import pathlib
import sys
import tempfile
import threading
import unittest

for needed in ("numpy", "scipy"):
    if importlib.util.find_spec(needed) is None:
        print(f"skipped: {needed} is not installed")
        sys.exit(77)

import numpy as np  # noqa: E402
import scipy.sparse as sparse  # noqa: E402

import signorini  # noqa: E402

M = np.array([[2.0, 1.0], [1.0, 2.0]])
Q = np.array([-5.0, -6.0])
Z = np.array([4.0, 7.0]) / 3.0


def nonsymmetric(n=40, seed=1):
    """A row dominant M with a positive diagonal: a P-matrix, one solution for every q."""
    random = np.random.default_rng(seed)
    matrix = random.uniform(-1.0, 1.0, (n, n)) * (random.uniform(size=(n, n)) < 0.3)
    np.fill_diagonal(matrix, 1.0 + np.abs(matrix).sum(axis=1))
    return matrix, random.uniform(-1.0, 1.0, n)


class Solves(unittest.TestCase):
    def assert_solution(self, result, matrix, q):
        self.assertTrue(result.is_solved, result)
        w = matrix @ result.z + q
        self.assertLess(np.abs(np.minimum(result.z, w)).max(), 1e-7)
        np.testing.assert_allclose(result.w, w, atol=1e-12)

    def test_lists_and_arrays(self):
        result = signorini.solve(M.tolist(), Q.tolist())
        self.assertEqual(result.status, "solved")
        np.testing.assert_allclose(result.z, Z)
        self.assertLess(result.certificate.unit_free_residual, 1e-8)
        self.assertEqual(len(result.attempts), 1)
        self.assertEqual("auto: " + result.attempts[0].solver, result.solver)
        self.assertGreaterEqual(result.statistics.solve_seconds, 0.0)
        self.assertIn("solved", repr(result))

    def test_every_layout_and_type_gives_the_same_bits(self):
        matrix, q = nonsymmetric()
        padded = np.zeros((80, 80))
        padded[::2, ::2] = matrix
        expected = signorini.solve(matrix, q, solver="lemke")
        self.assert_solution(expected, matrix, q)
        long = sparse.csr_matrix(matrix)
        long.indices = long.indices.astype(np.int64)
        long.indptr = long.indptr.astype(np.int64)
        dense = [np.asfortranarray(matrix), padded[::2, ::2], matrix.tolist()]
        for given in dense:
            self.assertEqual(signorini.solve(given, q, solver="lemke").z.tobytes(),
                             expected.z.tobytes())
        for given in (sparse.csr_matrix(matrix), sparse.csc_matrix(matrix),
                      sparse.coo_matrix(matrix), sparse.lil_matrix(matrix), long):
            self.assert_solution(signorini.solve(given, q, solver="lemke"), matrix, q)

    def test_entries_given_twice_are_summed_as_scipy_does(self):
        twice = sparse.csr_matrix(([1.0, 1.0, 1.0, 1.0, 2.0], [0, 0, 1, 0, 1], [0, 3, 5]))
        self.assertFalse(twice.has_canonical_format)
        np.testing.assert_allclose(signorini.solve(twice, Q).z, Z)
        self.assertEqual(twice.nnz, 5)  # the caller's is left alone

    def test_factored(self):
        random = np.random.default_rng(2)
        J = sparse.random(9, 12, density=0.4, random_state=3, format="csr")
        masses = [np.diag(random.uniform(1.0, 2.0, 6)) + 0.1 for _ in range(2)]
        q = random.uniform(-1.0, 0.0, 9)
        c = np.full(9, 0.01)
        W = sparse.block_diag([np.linalg.inv(m) for m in masses])
        A = (J @ W @ J.T).toarray() + np.diag(c)
        for keywords in ({"mass": masses}, {"inverse_mass": [np.linalg.inv(m) for m in masses]}):
            for given in (J, J.toarray(), J.tocsc()):
                problem = signorini.Problem.factored(given, q, compliance=c, **keywords)
                quick = signorini.Solver(quick_certificate=True).solve(problem)
                self.assert_solution(quick, A, q)
                self.assertIsNone(problem.matrix)
                self.assertEqual(len(problem), 9)
                self.assert_solution(signorini.Solver().solve(problem), A, q)

    def test_bounds_limits_and_cones(self):
        eye = np.eye(3)
        q = [-2.0, -5.0, 0.0]
        inf = np.inf
        result = signorini.solve(eye, q, lower=[0, -inf, -1], upper=[0.5, inf, 1])
        np.testing.assert_allclose(result.z, [0.5, 5.0, 0.0])
        result = signorini.solve(eye, q, limits=[(1, 0, 0.5), (2, 0, 0.5)])
        np.testing.assert_allclose(result.z, [2.0, 1.0, 0.0], atol=1e-7)
        result = signorini.solve(eye, q, cones=[(0, 3, 0.5)])
        np.testing.assert_allclose(result.z, [2.0, 1.0, 0.0], atol=1e-6)
        result = signorini.solve(eye, q, cones=[(0, 3, 0.5)], friction_law="associated")
        self.assertGreater(result.z[0], 2.001)

    def test_a_ray_proves_infeasibility(self):
        result = signorini.solve([[1.0, 0.0], [0.0, 0.0]], [1.0, -1.0], solver="lemke")
        self.assertEqual(result.status, "infeasible")
        self.assertFalse(result.is_solved)
        self.assertGreater(result.ray[1], 0.0)
        self.assertIsNone(signorini.solve(M, Q).ray)

    def test_islands(self):
        solver = signorini.Solver(certify_islands=True)
        result = solver.solve(signorini.Problem(np.eye(3), [-1.0, -2.0, 1.0]))
        self.assertEqual(result.island_of_row.tolist(), [0, 1, 2])
        self.assertEqual(len(result.island_certificates), 3)
        self.assertIsNone(signorini.solve(M, Q).island_of_row)

    def test_no_rows(self):
        self.assertTrue(signorini.solve(np.zeros((0, 0)), []).is_solved)
        self.assertTrue(signorini.solve(sparse.csr_matrix((0, 0)), []).is_solved)

    def test_bad_values_are_a_status(self):
        for bad in (np.nan, np.inf):
            result = signorini.solve(M, [bad, 1.0])
            self.assertEqual(result.status, "invalid input")
            self.assertIn("q[0]", result.detail)
            self.assertTrue(np.isnan(result.z).all())


class Views(unittest.TestCase):
    def test_results_are_views_that_keep_their_numbers_alive(self):
        z = signorini.solve(M, Q).z
        gc.collect()
        np.testing.assert_allclose(z, Z)
        self.assertFalse(z.flags.owndata)
        self.assertFalse(z.flags.writeable)
        result = signorini.solve(M, Q)
        self.assertEqual(result.z.ctypes.data, result.z.ctypes.data)

    def test_q_and_the_matrix_are_written_in_place(self):
        problem = signorini.Problem(M, Q)
        problem.q[:] = [1.0, -6.0]
        np.testing.assert_allclose(signorini.Solver().solve(problem).z, [0.0, 3.0])
        problem.matrix[3] = 4.0
        np.testing.assert_allclose(signorini.Solver().solve(problem).z, [0.0, 1.5])
        self.assertEqual(Q[0], -5.0)
        self.assertEqual(M[1, 1], 2.0)

    def test_a_warm_start_ends_at_once(self):
        solver = signorini.Solver("pgs", tolerance=1e-10)
        problem = signorini.Problem(*nonsymmetric())
        cold = solver.solve(problem)
        warm = solver.solve(problem, cold.z)
        self.assertTrue(warm.is_solved)
        self.assertLess(warm.statistics.iterations, cold.statistics.iterations)


class Refuses(unittest.TestCase):
    def test_wrong_shapes_settings_and_names(self):
        inf = np.inf
        for make, text in (
            (lambda: signorini.solve(np.zeros((2, 3)), Q), "square"),
            (lambda: signorini.solve(np.zeros(4), Q), "square"),
            (lambda: signorini.solve(M, [1.0]), "q"),
            (lambda: signorini.solve(M, [[1.0, 2.0]]), "q"),
            (lambda: signorini.solve(sparse.csr_matrix((2, 3)), Q), "square"),
            (lambda: signorini.solve(sparse.csr_matrix(M), [1.0]), "M.indptr"),
            (lambda: signorini.solve(M, Q, lower=[0.0]), "lower"),
            (lambda: signorini.solve(M, Q, limits=[(0, 5, 1.0)]), "limits"),
            (lambda: signorini.solve(M, Q, limits=[(0.5, 1, 1.0)]), "integers"),
            (lambda: signorini.solve(M, Q, limits=[(2**40, 1, 1.0)]), "32 bits"),
            (lambda: signorini.solve(M, Q, cones=[(0, 3, 1.0)]), "cones"),
            (lambda: signorini.solve(M, Q, friction_law="none"), "friction_law"),
            (lambda: signorini.solve(M, Q, solver="lemkee"), "lemkee"),
            (lambda: signorini.solve(M, Q, tolerance=0.0), "tolerance"),
            (lambda: signorini.Solver(max_iterations=0.5), "max_iterations"),
            (lambda: signorini.Solver(time_limit=-inf), "time_limit"),
            (lambda: signorini.solve(M, Q, warm_start=[1.0]), "warm_start"),
            (lambda: signorini.solve([[1, 2], [0, 1]], Q, solver="dantzig"), "dantzig"),
            (lambda: signorini.Problem.factored(np.eye(2), Q), "inverse_mass"),
            (lambda: signorini.Problem.factored(np.eye(2), Q, mass=[np.eye(3)]), "columns"),
            (lambda: signorini.Problem.factored(np.eye(2), Q, mass=[-np.eye(2)]), "block 0"),
            (lambda: signorini.Problem.factored(np.eye(2), [1.0], mass=[np.eye(2)]), "q"),
            (lambda: signorini.Problem.factored(np.eye(2), Q, mass=[np.ones((1, 2))]), "block 0"),
            (lambda: signorini.ContactSolver(friction_model="ice"), "friction_model"),
            (lambda: signorini.ContactSolver(solver="none"), "none"),
            (lambda: signorini.ContactSolver(pyramid_sides=3), "pyramid_sides"),
        ):
            with self.assertRaisesRegex(ValueError, text):
                make()

    def test_types_that_are_no_numbers(self):
        with self.assertRaises((TypeError, ValueError)):
            signorini.solve("M", "q")
        with self.assertRaises((TypeError, ValueError)):
            signorini.solve(M, [1j, 2.0])

    def test_arrays_that_are_not_bodies(self):
        solver = signorini.ContactSolver()
        with self.assertRaisesRegex(ValueError, "body_dtype"):
            solver.solve(0.01, np.zeros(3), signorini.make_contacts(1))
        with self.assertRaisesRegex(ValueError, "contact_dtype"):
            solver.solve(0.01, signorini.make_bodies(1), np.zeros(3))
        with self.assertRaisesRegex(ValueError, "contiguous"):
            solver.solve(0.01, signorini.make_bodies(4)[::2], signorini.make_contacts(0))
        with self.assertRaisesRegex(ValueError, "contact"):
            solver.solve(0.01, signorini.make_bodies(2), signorini.make_contacts(1))
        with self.assertRaisesRegex(ValueError, "step"):
            solver.solve(0.0, signorini.make_bodies(2), signorini.make_contacts(0))


class Contacts(unittest.TestCase):
    H = 0.01

    def crate(self):
        bodies = signorini.make_bodies(2)
        bodies[0]["kind"] = 2
        bodies[1]["mass"] = 10.0
        bodies[1]["position"] = (0.0, 0.0, 0.5)
        bodies[1]["linear_velocity"] = (1.0, 0.0, -9.81 * self.H)
        contacts = signorini.make_contacts(4)
        contacts["body_a"] = 1
        contacts["body_b"] = 0
        contacts["normal"] = (0.0, 0.0, 1.0)
        contacts["friction"] = 0.5
        contacts["feature_id"] = range(4)
        corners = [(-0.5, -0.5, 0), (0.5, -0.5, 0), (-0.5, 0.5, 0), (0.5, 0.5, 0)]
        contacts["point_a"] = contacts["point_b"] = corners
        return bodies, contacts

    def test_a_crate_is_braked_by_friction(self):
        h = self.H
        bodies, contacts = self.crate()
        for model in ("cone", "pyramid", "box"):
            solver = signorini.ContactSolver(friction_model=model)
            result = solver.solve(h, bodies, contacts)
            self.assertEqual(result.status, "solved")
            np.testing.assert_allclose(result.velocities[1][0], 1.0 - 0.5 * 9.81 * h, atol=1e-7)
            np.testing.assert_allclose(result.normal_impulses.sum(), 10 * 9.81 * h, atol=1e-6)
            np.testing.assert_allclose(result.impulses.sum(axis=0)[0], -0.5 * 9.81 * 10 * h,
                                       atol=1e-6)
            self.assertLess(result.energy_change, 0.0)
            self.assertEqual(result.islands[0].contacts, 4)
            self.assertEqual(result.island_of_contact.tolist(), [0, 0, 0, 0])
            self.assertLess(result.certificate.unit_free_residual, 1e-8)
        empty = solver.solve(h, bodies, contacts[:0])
        self.assertTrue(empty.is_solved)
        np.testing.assert_array_equal(empty.velocities[1][:3], bodies[1]["linear_velocity"])

    def test_the_dial_meets_its_residual(self):
        bodies, contacts = self.crate()
        for accuracy, residual in (("preview", 1e-2), ("game", 1e-4), (1e-6, 1e-6)):
            result = signorini.ContactSolver(accuracy=accuracy).solve(self.H, bodies, contacts)
            self.assertEqual(result.status, "solved")
            self.assertLessEqual(result.islands[0].residual, residual * (1 + 1e-9))
            self.assertGreater(result.work, 0.0)
            self.assertEqual(result.work, result.islands[0].work)
            self.assertEqual(result.accuracy, accuracy if accuracy != 1e-6 else "1e-06 m/s")
            self.assertTrue(result.is_deterministic)
        self.assertEqual(signorini.ContactSolver().solve(self.H, bodies, contacts).accuracy, "")

    def test_a_budget_that_runs_out_is_a_status(self):
        bodies, contacts = self.crate()
        solver = signorini.ContactSolver(accuracy="engineering", budget_work=0.0)
        result = solver.solve(self.H, bodies, contacts)
        self.assertEqual(result.status, "iteration limit")
        self.assertNotEqual(result.detail, "")
        solver = signorini.ContactSolver(accuracy="engineering", budget_seconds=1e-9)
        result = solver.solve(self.H, bodies, contacts)
        self.assertEqual(result.status, "time limit")
        self.assertFalse(result.is_deterministic)
        for bad in ({"budget_work": 1.0}, {"accuracy": "gaming"}, {"accuracy": -1.0},
                    {"accuracy": "game", "budget_seconds": 0.0}):
            with self.assertRaises(ValueError):
                signorini.ContactSolver(**bad)


class Threads(unittest.TestCase):
    def test_one_solver_in_many_threads_is_queued_and_many_run_side_by_side(self):
        matrix, q = nonsymmetric(60)
        problem = signorini.Problem(matrix, q)
        shared = signorini.Solver("lemke")
        expected = shared.solve(problem).z.tobytes()
        wrong = []

        def work(solver):
            for _ in range(10):
                if solver.solve(problem).z.tobytes() != expected:
                    wrong.append(1)

        threads = [threading.Thread(target=work, args=(s,))
                   for s in (shared, shared, signorini.Solver("lemke"), signorini.Solver("lemke"))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_other_threads_run_while_a_solver_does(self):
        problem = signorini.Problem(*nonsymmetric(100))
        solver = signorini.Solver("lemke")
        gate = threading.Lock()
        gate.acquire()
        ran = []

        def wait_and_run():
            with gate:
                ran.append(1)

        thread = threading.Thread(target=wait_and_run)
        thread.start()
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1000.0)  # from here on only a released GIL lets the thread run
        try:
            gate.release()
            self.assertEqual(ran, [])
            for _ in range(1000):
                solver.solve(problem)
                if ran:
                    break
            self.assertEqual(ran, [1])
        finally:
            sys.setswitchinterval(interval)
            thread.join()


class Dumps(unittest.TestCase):
    def test_every_solve_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            try:
                solver = signorini.Solver(dump=folder)
            except ValueError as error:
                self.skipTest(str(error))  # a build without lcp/io
            solver.solve(signorini.Problem(M, Q))
            self.assertTrue((pathlib.Path(folder) / "000001" / "W.mtx").exists())


if __name__ == "__main__":
    unittest.main()
